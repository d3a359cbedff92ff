#include "src/lattice/lattice_solver.hpp"

#include <algorithm>
#include <string>

#include "bedload/parallel/dense.hpp"
#include "bedload/parallel/reductions.hpp"
#include "kernels/lattice/sheared_sides.hpp"

namespace BL_SOLVER {
namespace {

using namespace lattice;

const char* const kAxis[3] = {"x", "y", "z"};

template <class To, class From>
std::vector<To> converted(const std::vector<From>& from) {
  std::vector<To> to;
  to.reserve(from.size());
  for (const auto& f : from) to.push_back(To(f));
  return to;
}

}  // namespace

LatticeSolver::LatticeSolver(const LatticeParameters& parameters, ResolvedGrains* grains)
    : p_(parameters),
      grains_(grains),
      drive_factor_(p_.drive.factor, "xyzt"),
      rate_(Relaxation::of(p_.tau, p_.magic)) {}

void LatticeSolver::fill(const Setup::Nodes& nodes) {
  for (int k = 0; k < 3; ++k) grid_.n[k] = nodes.count[std::size_t(k)];
  first_ = nodes.first;
  nodes_.resize(grid_.size());
  nodes_.solid.assign(nodes.solid);
  count_ = double(std::count(nodes.solid.begin(), nodes.solid.end(), 0u));
  populations_.resize(std::size_t(kVelocities) * grid_.size());
  const auto& l = nodes.links;
  links_.resize(Index(l.node.size()));
  links_.node.assign(l.node);
  links_.direction.assign(l.direction);
  links_.body.assign(l.body);
  links_.fraction.assign(converted<Real>(l.fraction));
  if (p_.sheared()) links_.resize(LayerNode::count(grid_));
  find_ranges();
  std::vector<Real3> velocity;
  for (const Vec3d& v : nodes.v) velocity.push_back(Real3(v / p_.units.velocity()));
  velocity_.assign(velocity);
}

void LatticeSolver::find_ranges() {
  ranges_.assign(p_.walls.size(), {});
  const std::vector<std::uint32_t> body = links_.body.values();
  for (std::uint32_t b = 0; b < ranges_.size(); ++b) {
    const auto [first, last] = std::equal_range(body.begin(), body.end(), b);
    ranges_[b] = {Index(first - body.begin()), Index(last - body.begin())};
  }
}

Vec3d LatticeSolver::place(Index node) const {
  const NodeGrid::Place at = grid_.place(node);
  return first_ + p_.units.dx * Vec3d{double(at.of[0]), double(at.of[1]), double(at.of[2])};
}

Populations LatticeSolver::populations(bool odd) const {
  return {const_cast<Real*>(populations_.data()), grid_, odd};
}

Real3 LatticeSolver::force_at(double time) const {
  Vec3d a = drive_factor_({}, time) * p_.drive.f;
  if (p_.drive.mode == DriveMode::volume) a *= 1 / p_.units.rho;
  return Real3((a + p_.gravity) / p_.units.acceleration());
}

void LatticeSolver::begin() {
  odd_ = false;
  force_ = force_at(0);
  clear_layers(0);
  if (grains_) grains_->cover(grid_, first_, nodes_);
  const Vec3d slope = p_.static_gravity * (3 / p_.units.acceleration());
  for_each({0, grid_.size()}, BeginPass{populations(odd_), force_, slope, nodes_.solid, velocity_});
  velocity_ = Buffer<Real3>();
  const auto t = sum_over<9>({0, grid_.size()}, NodeTotals{moments(), nodes_.solid});
  excess_ = excess_of(t.v);
  momentum_ = {t.v[2], t.v[3], t.v[4]};
}

void LatticeSolver::step(double time, std::int64_t number, bool held) {
  const LatticeUnits& units = p_.units;
  if (grains_ && !held) {
    clear_layers(time + units.dt);
    grains_->follow(moments(), first_, nodes_);
  }
  follow_images(time);
  odd_ = number % 2 == 1;
  follow_walls(time + 0.5 * units.dt, odd_);
  force_ = force_at(time + units.dt);
  if (grains_) grains_->exchange(populations(odd_), first_, nodes_, Vec3d(force_), number, held);
  for_each_node(grid_.size(), grid_.n[1] * grid_.n[2],
                CollidePass{populations(odd_), rate_, force_, nodes_.solid});
  driven_ += (count_ * units.momentum()) * Vec3d(force_);
  if (p_.mass_every > 0 && number % p_.mass_every == 0) restore_mass();
}

void LatticeSolver::follow_walls(double time, bool odd, bool counted) {
  const LatticeUnits& units = p_.units;
  for (std::size_t b = 0; b < ranges_.size(); ++b) {
    const Range r = ranges_[b];
    if (r.size() == 0) continue;
    const RigidMotion m = p_.walls[b].motion.at(time);
    const Vec3d slide = m.turned() ? m.rotation.rotate(p_.walls[b].slide) : p_.walls[b].slide;
    const SurfaceMotion body{(m.v + slide) / units.velocity(), units.dt * m.omega,
                             (m.origin() - first_) / units.dx};
    LinkPass pass{populations(odd), body, links_.links(r), nodes_.solid, {}, {}};
    if (counted) {
      pass.force = {links_.force.span().data + r.begin, r.size()};
      pass.received = {links_.received.span().data + r.begin, r.size()};
    }
    for_each({0, r.size()}, pass);
  }
}

SideImages LatticeSolver::images_at(double time) const {
  const double height = (grid_.n[2] - 2.0) * p_.units.dx, speed = p_.shear_rate * height,
               length = grid_.n[0] * p_.units.dx;
  return {p_.sheared(), std::remainder(speed * time, length) / p_.units.dx, speed / p_.units.velocity()};
}

void LatticeSolver::clear_layers(double time) {
  if (!p_.sheared()) return;
  for_each({0, LayerNode::count(grid_)}, ClearLayersPass{grid_, nodes_.solid});
  if (grains_) grains_->shear(images_at(time));
}

void LatticeSolver::follow_images(double time, bool counted) {
  if (!p_.sheared()) return;
  ImagePass pass{moments(), images_at(time + 0.5 * p_.units.dt), nodes_.solid, {}};
  if (counted) pass.received = links_.received;
  for_each({0, LayerNode::count(grid_)}, pass);
}

Vec3d LatticeSolver::by_images() const {
  if (!p_.sheared()) return {};
  const auto t = sum_over<3>({0, LayerNode::count(grid_)}, ImageTotals{links_.received});
  return Vec3d{} - p_.units.momentum() * Vec3d{t.v[0], t.v[1], t.v[2]};
}

void LatticeSolver::restore_mass() {
  const auto t = sum_over<9>({0, grid_.size()}, NodeTotals{moments(), nodes_.solid});
  const double lacking = excess_ - excess_of(t.v);
  restored_ += lacking;
  for_each({0, grid_.size()}, AddMassPass{populations(odd_), lacking / t.v[0], nodes_.solid});
}

NodeExtremes LatticeSolver::extremes() const {
  return reduce({0, grid_.size()}, ExtremesReduction{moments(), nodes_.solid});
}

FluidSums LatticeSolver::totals() const {
  const LatticeUnits& units = p_.units;
  const auto t = sum_over<9>({0, grid_.size()}, NodeTotals{moments(), nodes_.solid});
  const Vec3d raw{t.v[2], t.v[3], t.v[4]}, about_first{t.v[5], t.v[6], t.v[7]};
  FluidSums sums;
  sums.nodes = t.v[0];
  sums.mass = units.mass() * (t.v[0] + t.v[1]);
  sums.momentum = units.momentum() * (raw - 0.5 * t.v[0] * Vec3d(force_));
  sums.angular = units.momentum() * units.dx * about_first + cross(first_, sums.momentum);
  sums.kinetic = units.energy() * t.v[8];
  sums.residual = units.momentum() * (raw - momentum_) - driven() - by_images();
  if (grains_) sums.residual += grains_->sums().received;
  for (std::size_t b = 0; b < ranges_.size(); ++b) sums.residual += wall(int(b), 0).impulse;
  return sums;
}

Vec3d LatticeSolver::driven() const { return grains_ ? driven_ - grains_->sums().displaced : driven_; }

WallSums LatticeSolver::wall(int body, double time) const {
  const LatticeUnits& units = p_.units;
  const Range r = ranges_[std::size_t(body)];
  WallSums out;
  if (r.size() == 0) return out;
  const Vec3d centre = (motion(body, time).origin() - first_) / units.dx;
  const auto t = sum_over<13>({0, r.size()}, LinkTotals{grid_,
                                                        centre,
                                                        links_.links(r),
                                                        {links_.force.span().data + r.begin, r.size()},
                                                        {links_.received.span().data + r.begin, r.size()}});
  const auto vec = [&](int k) { return Vec3d{t.v[k], t.v[k + 1], t.v[k + 2]}; };
  out.force = units.force() * vec(0);
  out.torque = units.force() * units.dx * vec(3);
  out.impulse = units.momentum() * vec(6);
  out.turned = units.momentum() * units.dx * vec(9) + cross(first_, out.impulse);
  out.work = units.energy() * t.v[12];
  return out;
}

std::vector<NodeValue> LatticeSolver::values(const std::vector<Index>& nodes) const {
  Buffer<Index> at;
  at.assign(nodes);
  Buffer<Real4> out(nodes.size());
  for_each({0, Index(nodes.size())}, NodeStatePass{moments(), nodes_.solid, at, out});
  std::vector<NodeValue> values;
  for (const Real4& s : out.to_host())
    values.push_back({p_.units.velocity() * Vec3d(s.xyz()), p_.units.pressure() * double(s.w), s.w > -1});
  return values;
}

std::vector<Real4> LatticeSolver::states() const {
  Buffer<Real4> out(grid_.size());
  for_each({0, grid_.size()}, NodeStatePass{moments(), nodes_.solid, {}, out});
  return out.to_host();
}

std::vector<RowSums> LatticeSolver::stress(int axis, double time, bool held,
                                           Buffer<PairMoment<>>& of_grains) {
  // what arrives from walls and grains; the next step finds it anew, at the same places
  follow_images(time, false);
  follow_walls(time + 0.5 * p_.units.dt, !odd_, false);
  if (grains_) grains_->stresslets(populations(!odd_), first_, nodes_, held, of_grains);
  const Index n = RowStressPass::rows(grid_, axis);
  Buffer<RowSums> out(n);
  for_each({0, n}, RowStressPass{populations(!odd_), force_, double(rate_.even), axis, nodes_.solid, out});
  return out.to_host();
}

void LatticeSolver::save(SavedState& out) const {
  HostStore nodes = nodes_.save();
  const std::size_t n = grid_.size();
  for (int i = 0; i < kVelocities; ++i) {
    HostArray a{"population_" + std::to_string(i), "-", FileType<Real>::scalar, 1, {}};
    a.bytes.resize(n * sizeof(Real));
    copy_to_host(a.bytes.data(), populations_.data() + std::size_t(i) * n, a.bytes.size());
    nodes.arrays.push_back(std::move(a));
  }
  out.stores.push_back(std::move(nodes));
  out.stores.push_back(links_.save());
  const auto add = [&](const std::string& name, const char* unit, double value) {
    out.scalars.push_back({name, unit, value});
  };
  for (int k = 0; k < 3; ++k) {
    const std::string axis = kAxis[k];
    add("nodes_" + axis, "-", grid_.n[k]);
    add("first_node_" + axis, "m", first_[k]);
    add("start_momentum_" + axis, "-", momentum_[k]);
    add("driven_" + axis, "kg m/s", driven_[k]);
  }
  add("start_excess", "-", excess_);
  add("restored", "-", restored_);
  add("fluid_nodes", "-", count_);
}

void LatticeSolver::load(const HostStore& nodes, const HostStore& links,
                         const std::function<double(const std::string&)>& scalar, double time,
                         std::int64_t step) {
  for (int k = 0; k < 3; ++k) {
    const std::string axis = kAxis[k];
    grid_.n[k] = Index(scalar("nodes_" + axis));
    first_[k] = scalar("first_node_" + axis);
    momentum_[k] = scalar("start_momentum_" + axis);
    driven_[k] = scalar("driven_" + axis);
  }
  excess_ = scalar("start_excess");
  restored_ = scalar("restored");
  count_ = scalar("fluid_nodes");
  const std::size_t n = grid_.size();
  if (n != nodes.count) throw FileError("checkpoint has another number of nodes than it states");
  nodes_.load(nodes);
  links_.load(links);
  find_ranges();
  populations_.resize(std::size_t(kVelocities) * n);
  for (int i = 0; i < kVelocities; ++i) {
    const HostArray* a = nodes.find("population_" + std::to_string(i));
    if (!a || a->type != FileType<Real>::scalar || a->count() != n)
      throw FileError("checkpoint has no array fluid/population_" + std::to_string(i));
    copy_to_device(populations_.data() + std::size_t(i) * n, a->bytes.data(), a->bytes.size());
  }
  odd_ = step % 2 == 1;
  force_ = force_at(time);
  if (grains_) grains_->shear(images_at(time)), grains_->forget_links();
}

}  // namespace BL_SOLVER
