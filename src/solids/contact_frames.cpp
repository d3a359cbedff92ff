#include "src/solids/contact_frames.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "src/solids/solid_solver.hpp"

namespace BL_SOLVER {
namespace {

/// A contact, or what is near.
struct ContactLine {
  Id id, other = 0;        ///< grains; with a wall the other is 0
  std::uint32_t body = 0;  ///< number of the wall body from 1; 0: another grain
  Vec3d from, to;          ///< centres, or the point on the wall, m
  Vec3d point, normal;     ///< m; out of the other
  Vec3d force = {};        ///< on the grain, N
  double overlap = 0;      ///< m; negative: apart
  Vec3d spring = {};       ///< m
  double dissipated = 0;   ///< since it began, with spectra, J
  Vec3d film = {};         ///< of lubrication on the grain, N

  double normal_force() const { return dot(force, normal); }
  Vec3d tangential_force() const { return force - normal_force() * normal; }
  auto key() const { return std::tuple(id, body, other); }
};

/// One component after the other of what `get` finds in each line.
template <class T, class Get>
HostArray column(const char* name, const char* unit, const std::vector<ContactLine>& lines, Get get) {
  HostArray a{name, unit, FileType<T>::scalar, FileType<T>::components, {}};
  a.bytes.resize(lines.size() * sizeof(T));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const T value(get(lines[k]));
    std::memcpy(a.bytes.data() + k * sizeof(T), &value, sizeof(T));
  }
  return a;
}

double all_of(const ContactLoss& loss) { return loss.normal + loss.tangential; }

HostArray ends_of(const std::vector<ContactLine>& lines) {
  HostArray a{"ends", "m", Scalar::f64, 6, {}};
  a.bytes.resize(lines.size() * 6 * sizeof(double));
  double* at = a.as<double>();
  for (const ContactLine& line : lines)
    for (const Vec3d& end : {line.from, line.to})
      for (int k = 0; k < 3; ++k) *at++ = end[k];
  return a;
}

}  // namespace

void SolidSolver::record_forces(const GrainStore& g, const BodyPose* poses, double dt) {
  if (!forces_ || !parameters_.contacts) return;
  forces_->record(g.owned(), contact_pass(g, dt), list_.slots());
  if (wall_list_.size() > 0)
    forces_->record(wall_contacts(g, poses, dt), wall_list_.rows(),
                    std::size_t(walls_.contacts()) * g.size());
  if (!(parameters_.near_gap > 0)) return;
  if (single_films()) forces_->record(g.owned(), films(g, nullptr), list_.slots());
  forces_->record(wall_contacts(g, poses, dt), wall_list_.rows(), parameters_.near_gap,
                  range_beyond(parameters_.wall_laws, 1));
}

HostStore SolidSolver::contact_lines(const GrainStore& g) const {
  std::vector<ContactLine> lines;
  const bool wet = single_films();
  if (forces_ && forces_->recorded()) {
    const HostVerletList list(list_);
    const auto touching = histories_.touching();
    const auto history = histories_.to_host();
    const double beyond = range_beyond(parameters_.pair_laws, 1);
    const auto force = forces_->of_pairs(), film = wet ? forces_->films() : std::vector<Real3>();
    const auto open = spectra_ ? spectra_->of_pairs().to_host() : std::vector<OpenContact>(list_.slots());
    const std::vector<Id> id = g.id.values();
    const std::vector<Vec3d> x = g.x.values();
    const std::vector<Real> radius = g.radius.values();
    for (Index i = 0; i < list_.rows(); ++i)
      list.view().each(i, [&](std::uint64_t slot, Index j) {
        if ((!touching[slot] && !(parameters_.near_gap > 0)) || id[i] > id[j]) return;
        const Vec3d r = frame_.separation(x[i], x[j]), n = r * (1 / norm(r));
        const double R_i = radius[i], R_j = radius[j];
        const double overlap = touching[slot] ? history[slot].overlap : R_i + R_j - norm(r);
        if (!touching[slot] && -overlap > std::max(parameters_.near_gap, beyond * R_i * R_j / (R_i + R_j)))
          return;
        lines.push_back({.id = id[i],
                         .other = id[j],
                         .from = x[i],
                         .to = x[i] - r,
                         .point = x[i] - (R_i - 0.5 * overlap) * n,
                         .normal = n,
                         .force = touching[slot] ? Vec3d(force[slot]) : Vec3d(),
                         .overlap = overlap,
                         .spring = touching[slot] ? history[slot].xi : Vec3d(),
                         .dissipated = touching[slot] ? all_of(open[slot].loss) : 0,
                         .film = wet ? Vec3d(film[slot]) : Vec3d()});
      });
    const auto count = wall_list_.remembered(g.owned().size());
    const auto at_walls = forces_->at_walls();
    const auto lost = spectra_ ? spectra_->at_walls() : std::vector<WallLosses>{};
    std::map<std::pair<Index, std::uint64_t>, NearWall> near_walls;  // by grain and key
    if (parameters_.near_gap > 0)
      for (const NearWall& wall : forces_->near_walls()) near_walls[{wall.grain, wall.key}] = wall;
    for (int k = 0; k < walls_.contacts(); ++k) {
      const std::vector<WallMemory> memory = wall_list_.memory(k, g.owned().size());
      for (Index i = 0; i < g.owned().size(); ++i) {
        if (Index(k) >= count[i]) continue;
        const double overlap = memory[i].history.overlap;
        const Vec3d n = memory[i].normal, point = x[i] - (double(radius[i]) - overlap) * n;
        lines.push_back({.id = id[i],
                         .body = walls_.surfaces()[memory[i].surface()].body + 1,
                         .from = x[i],
                         .to = point,
                         .point = point,
                         .normal = n,
                         .force = Vec3d(at_walls[std::size_t(k) * g.size() + i]),
                         .overlap = overlap,
                         .spring = memory[i].history.xi,
                         .dissipated = lost.empty() ? 0 : all_of(lost[i].of[k])});
        const auto film_there = near_walls.find({i, memory[i].key});
        if (film_there == near_walls.end()) continue;
        lines.back().film = Vec3d(film_there->second.film);
        near_walls.erase(film_there);
      }
    }
    for (const auto& [at, wall] : near_walls) {
      const Index i = wall.grain;
      if (!(wall.gap >= 0)) continue;
      const Vec3d point = x[i] - (double(radius[i]) + wall.gap) * wall.normal;
      lines.push_back({.id = id[i],
                       .body = walls_.surfaces()[Index(wall.key >> 32)].body + 1,
                       .from = x[i],
                       .to = point,
                       .point = point,
                       .normal = wall.normal,
                       .overlap = -wall.gap,
                       .film = Vec3d(wall.film)});
    }
    std::stable_sort(lines.begin(), lines.end(),
                     [](const ContactLine& a, const ContactLine& b) { return a.key() < b.key(); });
  }
  using Line = const ContactLine&;
  HostStore out{"contacts", lines.size(), {ends_of(lines)}};
  out.lines = true;
  out.arrays.push_back(column<Id>("id", "-", lines, [](Line c) { return c.id; }));
  out.arrays.push_back(column<Id>("other", "-", lines, [](Line c) { return c.other; }));
  out.arrays.push_back(column<std::uint32_t>("body", "-", lines, [](Line c) { return c.body; }));
  out.arrays.push_back(column<Real3>("point", "m", lines, [](Line c) { return c.point; }));
  out.arrays.push_back(column<Real3>("normal", "-", lines, [](Line c) { return c.normal; }));
  out.arrays.push_back(column<Real>("normal_force", "N", lines, [](Line c) { return c.normal_force(); }));
  out.arrays.push_back(
      column<Real3>("tangential_force", "N", lines, [](Line c) { return c.tangential_force(); }));
  out.arrays.push_back(column<Real>("overlap", "m", lines, [](Line c) { return c.overlap; }));
  out.arrays.push_back(column<Real3>("spring", "m", lines, [](Line c) { return c.spring; }));
  if (wet)
    out.arrays.push_back(column<Real3>("lubrication_force", "N", lines, [](Line c) { return c.film; }));
  if (spectra_)
    out.arrays.push_back(column<Real>("dissipated", "J", lines, [](Line c) { return c.dissipated; }));
  if (Context::current().several())
    out.arrays.push_back(column<std::uint32_t>("block", "-", lines, [](Line c) { return c.id; }));
  return out;
}

}  // namespace BL_SOLVER
