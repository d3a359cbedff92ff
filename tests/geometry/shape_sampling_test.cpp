#include "bedload/geometry/shape_sampling.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "bedload/geometry/slice.hpp"
#include "mesh_support.hpp"

namespace bedload::test {
namespace {

constexpr double kSpacing = 0.01;  // m
constexpr double kDepth = 0.05;    // m, five layers

/// Points found by place, for distances up to 2.5 spacings.
class Found {
 public:
  explicit Found(const std::vector<Vec3d>& points) {
    for (const Vec3d& x : points) cells_[cell(x)].push_back(x);
  }

  /// Calls f(distance in spacings) for each point near x.
  template <class F>
  void for_near(const Vec3d& x, F f) const {
    const auto [i, j, k] = cell(x);
    for (int n = 0; n < 27; ++n) {
      const auto found = cells_.find({i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1});
      if (found == cells_.end()) continue;
      for (const Vec3d& y : found->second) f(norm(x - y) / kSpacing);
    }
  }

  double nearest(const Vec3d& x) const {
    double least = INFINITY;
    for_near(x, [&](double r) { least = std::min(least, r); });
    return least;
  }

  double nearest_other(const Vec3d& x) const {
    double least = INFINITY;
    for_near(x, [&](double r) { least = r > 0 ? std::min(least, r) : least; });
    return least;
  }

  /// Sum of Wendland's C2 kernel, 1 where there is one particle per spacing^3; h = 1.25 spacings.
  double density(const Vec3d& x) const {
    constexpr double h = 1.25;
    double sum = 0;
    for_near(x, [&](double r) {
      const double t = std::max(0.0, 1 - r / (2 * h));
      sum += 21 / (16 * M_PI * h * h * h) * t * t * t * t * (1 + 2 * r / h);
    });
    return sum;
  }

 private:
  using Cell = std::array<long, 3>;
  static Cell cell(const Vec3d& x) {
    Cell c;
    for (int k = 0; k < 3; ++k) c[k] = long(std::floor(x[k] / (2.5 * kSpacing)));
    return c;
  }
  std::map<Cell, std::vector<Vec3d>> cells_;
};

struct Limits {
  double volume;  // of the layers, m3
  int layers = 5;
  double hole = 0.95;          // greatest distance of a place of the surface from a particle, spacings
  double closest = 0.77;       // least distance of two particles, spacings
  double mean_density = 0.01;  // deviations from 1 / spacing^3
  double density = 0.05;
};

/// Samples a body at least five layers thick and tests what makes its wall tight and even.
void expect_even(const Shape& shape, const Limits& limits) {
  const std::vector<Vec3d> points = sample_shape(shape, kSpacing, kDepth);
  const Found found(points);
  EXPECT_NEAR(double(points.size()) * kSpacing * kSpacing * kSpacing / limits.volume, 1, 0.003);

  std::array<int, 5> layers{};
  double closest = INFINITY, farthest = 0, off_layer = 0;
  for (const Vec3d& x : points) {
    const double depth = -shape.distance(x) / kSpacing;
    const int layer = int(depth);
    ASSERT_TRUE(layer >= 0 && layer < 5) << depth;
    off_layer = std::max(off_layer, std::abs(depth - (layer + 0.5)));
    ++layers[layer];
    const double nearest = found.nearest_other(x);
    closest = std::min(closest, nearest), farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(off_layer, 1e-5);
  for (int n = 0; n < limits.layers; ++n) EXPECT_GT(layers[n], 0);
  EXPECT_GT(closest, limits.closest);
  EXPECT_LT(farthest, 1.2);

  RandomPoints random(shape.bounds().grown(kSpacing));
  double surface_hole = 0, hole = 0, sum = 0, least = INFINITY, most = 0;
  int on_surface = 0, wide = 0, middle = 0;
  while (on_surface < 20000) {
    const Vec3d x = random();
    const SurfacePoint s = shape.nearest(x);
    const double depth = -s.distance / kSpacing;
    if (std::abs(depth) < 1) {
      const double r = found.nearest(s.point);
      ++on_surface, wide += r > std::sqrt(0.75), surface_hole = std::max(surface_hole, r);
    }
    if (depth > 0 && depth < 5) hole = std::max(hole, found.nearest(x));
    if (depth > 2.4 && depth < 2.6) {
      const double density = found.density(x);
      ++middle, sum += density, least = std::min(least, density), most = std::max(most, density);
    }
  }
  EXPECT_LT(surface_hole, limits.hole);
  // wider than in a cubic lattice; the pattern, and with it this fraction, changes with the last digit of any
  // number
  EXPECT_LT(wide, limits.hole > 1 ? 0.04 * on_surface : 0.005 * on_surface);
  EXPECT_LT(hole, 1);
  ASSERT_GT(middle, 200);
  EXPECT_NEAR(sum / middle, 1, limits.mean_density);
  EXPECT_GT(least, 1 - limits.density);
  EXPECT_LT(most, 1 + limits.density);
}

double shell(double outer, double inner) {
  return 4.0 / 3 * M_PI * (std::pow(outer, 3) - std::pow(inner, 3));
}

TEST(ShapeSampling, Sphere) {
  expect_even(*make_sphere({0.003, 0.5, -0.2}, 0.12), {.volume = shell(0.12, 0.07)});
}

TEST(ShapeSampling, SmallSphere) {
  // 5.2 spacings: the number follows the volume, not which lattice points happen to lie inside.
  expect_even(*make_sphere({0.003, 0.5, -0.2}, 0.052), {.volume = shell(0.052, 0.002), .mean_density = 0.03});
}

TEST(ShapeSampling, CylindricalVessel) {
  // Five layers: two from its inner side, two from its outer side, one midway.
  const double r = 0.1, l = 0.15, t = kDepth;
  // The wall's outer rims are quarters of rings: centroid 4 t / (3 pi) beyond r.
  const double rims = 2 * 2 * M_PI * (r + 4 * t / (3 * M_PI)) * M_PI * t * t / 4;
  expect_even(*make_hollow(make_cylinder({0, 0, 0}, {0.05, 0.1, 0.1}, r), t),
              {.volume = M_PI * (2 * r * t + t * t) * l + 2 * M_PI * r * r * t + rims, .layers = 3});
}

TEST(ShapeSampling, CubeHasParticlesBelowItsEdges) {
  const Placement turned{1, Quat<double>::from_rotation({0.3, 0.5, 0.2}), {0.1, 0.2, 0.3}};
  const double side = 0.173, core = side - 2 * kDepth;
  expect_even(*make_placed(make_box({0, 0, 0}, {side, side, side}), turned),
              {.volume = side * side * side - core * core * core, .hole = 1});
}

TEST(ShapeSampling, Cone) {
  // Its rim is sharper than a right angle, so that the first layer ends farther from it.
  const double h = 0.24, ra = 0.12, rb = 0.05;
  const double slope = std::hypot(h, ra - rb) / h;  // wall thickness across the axis, per depth
  const double a = ra - kDepth * slope - kDepth * (ra - rb) / h,
               b = rb - kDepth * slope + kDepth * (ra - rb) / h;
  // The core ends in its tip, below the upper end by more than kDepth if b < 0.
  const double core_height = b >= 0 ? h - 2 * kDepth : (h - 2 * kDepth) * a / (a - b), tip = std::max(b, 0.0);
  expect_even(
      *make_cone({0, 0, 0}, {0, 0.144, 0.192}, ra, rb),
      {.volume = M_PI / 3 * (h * (ra * ra + ra * rb + rb * rb) - core_height * (a * a + a * tip + tip * tip)),
       .hole = 1.08});
}

TEST(ShapeSampling, Mesh) {
  MeshOptions options;
  options.placement = {0.13, Quat<double>::from_rotation({0.1, 0.7, 0.4}), {}};
  const TriangleMesh mesh(l_prism(), "l", options);
  const double s = 0.13, t = kDepth;
  // Without the L at depth t and below, whose concave edge is rounded with radius t.
  const double core = (2 * s - 2 * t) * (s - 2 * t) + (s - 2 * t) * s;
  const double rounding = t * t - M_PI / 4 * t * t;
  expect_even(mesh, {.volume = 3 * s * s * s - (core + rounding) * (s - 2 * t), .hole = 1});
}

TEST(ShapeSampling, LayersFollowTheDepth) {
  const auto sphere = make_sphere({}, 0.1);
  const auto deepest = [&](double depth) {
    double most = 0;
    for (const Vec3d& x : sample_shape(*sphere, kSpacing, depth)) most = std::max(most, -sphere->distance(x));
    return most / kSpacing;
  };
  EXPECT_NEAR(deepest(0.01), 0.5, 1e-6);
  EXPECT_NEAR(deepest(0.02), 1.5, 1e-6);
  EXPECT_NEAR(deepest(0.021), 2.5, 1e-6);
  // All of it.
  EXPECT_NEAR(double(sample_shape(*sphere, kSpacing, 1).size()), shell(0.1, 0) * 1e6,
              0.01 * shell(0.1, 0) * 1e6);
}

TEST(ShapeSampling, ThinBodiesAreFilledMidway) {
  const auto plate = make_box({0, 0, 0}, {0.2, 0.2, 0.006});
  const auto points = sample_shape(*plate, kSpacing, 0.03);
  EXPECT_NEAR(double(points.size()), 0.6 * 400, 0.02 * 240);
  for (const Vec3d& x : points) EXPECT_NEAR(x.z, 0.003, 1e-6);
  const auto thicker = make_box({0, 0, 0}, {0.2, 0.2, 0.025});
  int outer = 0, middle = 0;
  for (const Vec3d& x : sample_shape(*thicker, kSpacing, 0.03)) {
    if (std::min({x.x, 0.2 - x.x, x.y, 0.2 - x.y}) < 0.03) continue;
    outer += std::abs(std::abs(x.z - 0.0125) - 0.0075) < 1e-6;
    middle += std::abs(x.z - 0.0125) < 0.3 * kSpacing;
  }
  EXPECT_NEAR(outer, 2 * 14 * 14, 40);
  EXPECT_NEAR(middle, 0.5 * 14 * 14, 30);
}

TEST(ShapeSampling, SameEveryTime) {
  const auto cone = make_cone({0, 0, 0}, {0, 0.1, 0.1}, 0.1, 0.02);
  const auto once = sample_shape(*cone, kSpacing, 0.03);
  EXPECT_GT(once.size(), 1000u);
  EXPECT_EQ(sample_shape(*cone, kSpacing, 0.03), once);
}

TEST(ShapeSampling, RefusesWhatCannotBeFilled) {
  const auto sphere = make_sphere({}, 1);
  EXPECT_EQ(error_in([&] { sample_shape(*sphere, 0, 1); }), "wall particles: spacing = 0 m must be above 0");
  EXPECT_EQ(error_in([&] { sample_shape(*sphere, 0.1, -1); }),
            "wall particles: depth = -1 m must be above 0");
  EXPECT_EQ(error_in([&] { sample_shape(*sphere, 1e-7, 1e-6); }),
            "wall particles: spacing = 1e-07 m is too small for a body of 3.4641 m");
}

const Vec3d kShifts[] = {{0.1, 0.2, 0.3},          {-0.7, 1.0 / 3, 0.013}, {3.1, -1.7, 0.9},
                         {0.0025, 0.005, 0.00125}, {1e-9, -1e-9, 1e-9},    {1.0 / 7, -13.37, 105.3}};  // m

/// How far two layouts differ, seen from their bodies, in spacings; infinite if in number or order.
double difference(const std::vector<Vec3d>& here, const std::vector<Vec3d>& there, const Vec3d& shift) {
  if (here.size() != there.size()) return INFINITY;
  double most = 0;
  for (std::size_t n = 0; n < here.size(); ++n) most = std::max(most, norm(here[n] + shift - there[n]));
  return most / kSpacing;
}

TEST(ShapeSampling, LayoutOfASmallSphereDoesNotFollowTheRoundingOfItsPlace) {
  for (int n = 125; n <= 165; n += 5) {  // across, in hundredths of a spacing
    const double r = n * 0.005 * kSpacing;
    const Vec3d at{0.05, 0.05, 0.05};
    for (const Vec3d& shift : kShifts)
      EXPECT_LT(difference(sample_shape(*make_sphere(at, r), kSpacing, kDepth),
                           sample_shape(*make_sphere(at + shift, r), kSpacing, kDepth), shift),
                1e-6)
          << 2 * r << " m, moved by " << shift.x;
  }
}

/// Shapes with sides of whole, half and other numbers of spacings, their coordinates moved by `by`.
std::vector<std::pair<std::string, ShapePtr>> all_shapes(double a, const Vec3d& by) {
  const auto at = [&](double x, double y, double z) { return by + a * Vec3d{x, y, z}; };
  const auto l = std::make_shared<TriangleMesh>(l_prism(), "l", MeshOptions{.placement = {a, {}, {}}});
  const ShapePtr box = make_box(at(0, 0, 0), at(2, 1.5, 1)), ball = make_sphere(at(0, 0, 1), a);
  const Quat<double> turn = Quat<double>::from_rotation({0.3, 0.5, 0.2});
  const auto turned_about = [&](const ShapePtr& shape, const Vec3d& place) {
    return make_placed(shape, {1, turn, place - turn.rotate(place)});
  };
  return {
      {"box", box},
      {"ball", ball},
      {"capsule", make_capsule(at(0, 0, 0), at(0, 0, 2), a / 2)},
      {"cylinder", make_cylinder(at(0, 0, 0), at(0.3, 0.4, 2), a / 2)},
      {"cone", make_cone(at(0, 0, 0), at(0, 0, 2), a, 0)},
      {"pipe", make_pipe(at(0, 0, 0), at(2, 0, 0), a, a + 2 * kSpacing, PipeEnds::closed_a)},
      {"mesh", make_placed(l, {1, {}, by})},
      {"turned mesh", make_placed(l, {1, turn, by})},
      {"turned box", turned_about(box, at(1, 0, 0))},
      {"union", make_union({box, ball})},
      {"copies", make_union({box, turned_about(box, at(3, 0, 0))})},
      {"hollow", make_hollow(box, 2 * kSpacing)},
      {"difference", make_difference(box, make_cylinder(at(1, 1, -1), at(1, 1, 2), a / 2))},
      {"slice", std::make_shared<Slice>(ball, by.y, kSpacing)},
  };
}

TEST(ShapeSampling, NoLayoutFollowsTheRoundingOfItsPlace) {
  for (const double spacings : {1.0, 2.5}) {
    std::vector<std::vector<Vec3d>> here;
    for (const auto& [name, shape] : all_shapes(spacings * kSpacing, {}))
      here.push_back(sample_shape(*shape, kSpacing, kDepth));
    for (const Vec3d& shift : kShifts) {
      const auto there = all_shapes(spacings * kSpacing, shift);
      for (std::size_t n = 0; n < there.size(); ++n)
        EXPECT_LT(difference(here[n], sample_shape(*there[n].second, kSpacing, kDepth), shift), 1e-6)
            << there[n].first << " of " << spacings << " spacings, moved by " << shift.x << " m";
    }
  }
}

}  // namespace
}  // namespace bedload::test
