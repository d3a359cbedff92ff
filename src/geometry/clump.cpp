#include "bedload/geometry/clump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/geometry/body.hpp"
#include "bedload/geometry/shape.hpp"
#include "bedload/parallel/host_loop.hpp"

namespace bedload {
namespace {

using std::numbers::pi;

Vec3d centre_of(const ClumpSphere& s) { return {s[0], s[1], s[2]}; }
double volume_of(double r) { return 4 * pi / 3 * r * r * r; }

/// A whole sphere.
void add_sphere(SolidMoments& all, const Vec3d& x, double r) {
  const double v = volume_of(r);
  all.add(v, x);
  for (int k = 0; k < 3; ++k) all.second[k] += v * r * r / 5;
}

/// What the lines along z of the cell [x, x + h] x [y, y + h] hold: z from `lo` to `hi`.
void add_chord(SolidMoments& all, double h, double x, double y, double lo, double hi) {
  const double v = h * h * (hi - lo);
  all.add(v, {x, y, (lo + hi) / 2});
  all.second[0] += v * h * h / 12, all.second[1] += v * h * h / 12;
  all.second[2] += v * (hi - lo) * (hi - lo) / 12;
}

/// The union of spheres, line by line.
SolidMoments union_moments(const std::vector<ClumpSphere>& spheres) {
  constexpr int kLines = 512;  // across the longer side
  double lo[2] = {1e300, 1e300}, hi[2] = {-1e300, -1e300};
  for (const ClumpSphere& s : spheres)
    for (int k = 0; k < 2; ++k) lo[k] = std::min(lo[k], s[k] - s[3]), hi[k] = std::max(hi[k], s[k] + s[3]);
  const double h = std::max(hi[0] - lo[0], hi[1] - lo[1]) / kLines;
  int n[2];
  for (int k = 0; k < 2; ++k) {
    n[k] = int(std::ceil((hi[k] - lo[k]) / h));
    lo[k] = (lo[k] + hi[k] - n[k] * h) / 2;  // the same on both sides
  }
  SolidMoments all;
  std::vector<const ClumpSphere*> row;
  std::vector<std::pair<double, double>> chords;
  for (int j = 0; j < n[1]; ++j) {
    const double y = lo[1] + (j + 0.5) * h;
    row.clear();
    for (const ClumpSphere& s : spheres)
      if (std::abs(y - s[1]) < s[3]) row.push_back(&s);
    for (int i = 0; i < n[0]; ++i) {
      const double x = lo[0] + (i + 0.5) * h;
      chords.clear();
      for (const ClumpSphere* s : row) {
        const double dx = x - (*s)[0], dy = y - (*s)[1], half2 = (*s)[3] * (*s)[3] - dx * dx - dy * dy;
        if (half2 > 0) chords.emplace_back((*s)[2] - std::sqrt(half2), (*s)[2] + std::sqrt(half2));
      }
      if (chords.empty()) continue;
      std::sort(chords.begin(), chords.end());
      auto [from, to] = chords.front();
      for (const auto& [next, end] : chords) {
        if (next > to) add_chord(all, h, x, y, from, to), from = next;
        to = std::max(to, end);
      }
      add_chord(all, h, x, y, from, to);
    }
  }
  return all;
}

bool overlap(const ClumpSphere& a, const ClumpSphere& b) {
  return norm(centre_of(a) - centre_of(b)) < a[3] + b[3];
}

SolidMoments moments_of(const std::vector<ClumpSphere>& spheres) {
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (overlap(spheres[i], spheres[j])) return union_moments(spheres);
  SolidMoments all;
  for (const ClumpSphere& s : spheres) add_sphere(all, centre_of(s), s[3]);
  return all;
}

/// 1 / m_eff = 1 / m + (a x n) . I^-1 (a x n) against a blow along n at a; the mean over n has
/// (a^2 tr I^-1 - a . I^-1 a) / 3.
double contact_mass(const ClumpShape& shape) {
  const PrincipalInertia principal = principal_inertia(shape.inertia);
  double sum = 0;
  for (const ClumpSphere& s : shape.spheres) {
    const Vec3d a = principal.axes.conjugate().rotate(centre_of(s));
    double turns = 0;
    for (int k = 0; k < 3; ++k) turns += (norm2(a) - a[k] * a[k]) / principal.moments[k] / 3;
    sum += 1 / (1 + pi / 6 * turns);
  }
  return sum;
}

}  // namespace

ClumpShape clump_shape(const std::vector<ClumpSphere>& spheres) {
  const SolidMoments m = moments_of(spheres);
  const double d = std::cbrt(6 * m.volume / pi);
  const Vec3d middle = m.middle();
  ClumpShape shape;
  double sum = 0;
  for (const ClumpSphere& s : spheres) {
    const Vec3d x = (centre_of(s) - middle) / d;
    const double r = s[3] / d, v = volume_of(r);
    shape.spheres.push_back({x.x, x.y, x.z, r});
    shape.reach = std::max(shape.reach, norm(x) + r);
    shape.offset += v * x;
    sum += v;
  }
  shape.fullness = spheres.size() == 1 ? 1 : m.volume / d / d / d / sum;
  shape.offset = shape.offset / sum;
  // about the centre of mass, per unit of density and d^5
  const double xx = m.second[0] - m.volume * middle.x * middle.x,
               yy = m.second[1] - m.volume * middle.y * middle.y,
               zz = m.second[2] - m.volume * middle.z * middle.z;
  const double d5 = d * d * d * d * d, round_off = 1e-9 * (xx + yy + zz);
  const auto product = [&](int k, double apart) {
    const double p = m.second[k] - m.volume * apart;
    return std::abs(p) < round_off ? 0 : -p / d5;
  };
  shape.inertia = {(yy + zz) / d5,
                   (xx + zz) / d5,
                   (xx + yy) / d5,
                   product(3, middle.x * middle.y),
                   product(4, middle.x * middle.z),
                   product(5, middle.y * middle.z)};
  shape.contact_mass = contact_mass(shape);
  return shape;
}

std::vector<ClumpSphere> inner_spheres(const Shape& shape, std::size_t count) {
  constexpr double kCells = 40;  // across the longest side
  const Bounds bounds = shape.bounds();
  const Vec3d side = bounds.max - bounds.min;
  const double step = std::max({side.x, side.y, side.z}) / kCells;
  std::vector<Vec3d> places;
  for (double z = bounds.min.z + step / 2; z < bounds.max.z; z += step)
    for (double y = bounds.min.y + step / 2; y < bounds.max.y; y += step)
      for (double x = bounds.min.x + step / 2; x < bounds.max.x; x += step) places.push_back({x, y, z});
  std::vector<double> room(places.size());
  host_for_each(places.size(), [&](std::size_t n) { room[n] = -shape.distance(places[n]); });
  std::vector<ClumpSphere> spheres;
  const auto left_by = [](const ClumpSphere& s, const Vec3d& x) { return norm(x - centre_of(s)) - s[3] / 2; };
  while (spheres.size() < count) {
    const auto best = std::max_element(room.begin(), room.end());
    if (!(*best > step / 2)) break;
    Vec3d x = places[best - room.begin()];
    // from the best place of the raster to the best near it
    double most = *best;
    for (double by = step / 2; by > step / 100; by /= 2)
      for (int k = 0; k < 6; ++k) {
        Vec3d to = x;
        to[k / 2] += k % 2 == 0 ? by : -by;
        double at = -shape.distance(to);
        for (const ClumpSphere& s : spheres) at = std::min(at, left_by(s, to));
        if (at > most) most = at, x = to;
      }
    spheres.push_back({x.x, x.y, x.z, -shape.distance(x)});
    for (std::size_t n = 0; n < places.size(); ++n)
      room[n] = std::min(room[n], left_by(spheres.back(), places[n]));
  }
  return spheres;
}

Quat<double> clump_rotation(const std::vector<double>& vector, CounterRandom random) {
  if (vector.size() == 3)
    return Quat<double>::from_rotation(pi / 180 * Vec3d{vector[0], vector[1], vector[2]});
  const double u = random.uniform(), a = 2 * pi * random.uniform(), b = 2 * pi * random.uniform();
  return {std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
          std::sqrt(u) * std::sin(b)};
}

std::vector<std::pair<Vec3d, double>> turned_spheres(const ClumpShape& shape, double d,
                                                     const Quat<double>& turn) {
  std::vector<std::pair<Vec3d, double>> all;
  for (const auto& [x, y, z, r] : shape.spheres) all.emplace_back(turn.rotate(d * Vec3d{x, y, z}), d * r);
  return all;
}

std::vector<ClumpSphere> read_spheres(const std::filesystem::path& file) {
  std::error_code unknown;
  std::ifstream in(file);
  if (!in || !std::filesystem::is_regular_file(file, unknown))
    throw CaseError(fmt::format("{}: cannot be read", file.string()));
  std::vector<ClumpSphere> spheres;
  std::string line;
  for (int n = 1; std::getline(in, line); ++n) {
    line.resize(std::min(line.size(), line.find('#')));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';' || c == '\r'; }, ' ');
    std::istringstream words(line);
    ClumpSphere s{};
    std::string word;
    std::size_t k = 0;
    for (; words >> word; ++k) {
      char* end = nullptr;
      const double x = std::strtod(word.c_str(), &end);
      if (k >= 4 || *end != '\0' || !(std::abs(x) <= 1e30))
        throw CaseError(
            fmt::format("{}:{}: must hold four numbers, x y z r, not \"{}\"", file.string(), n, word));
      s[k] = x;
    }
    if (k == 0) continue;
    if (k < 4) throw CaseError(fmt::format("{}:{}: must hold four numbers, x y z r", file.string(), n));
    spheres.push_back(s);
  }
  return spheres;
}

}  // namespace bedload
