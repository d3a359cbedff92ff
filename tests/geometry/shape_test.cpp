#include "bedload/geometry/shape.hpp"

#include <algorithm>
#include <functional>

#include "shape_support.hpp"

namespace bedload::test {
namespace {

constexpr double kRound = 1e-12;  // m, on bodies of about 1 m

/// The places (z, r) swept about the axis through `a` along the unit vector `u`, no two neighbours more than
/// `step` apart.
void sweep(std::vector<Vec3d>& points, const Vec3d& a, const Vec3d& u, double z0, double r0, double z1,
           double r1, double step) {
  const Vec3d e = std::abs(u.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d v = cross(u, e);
  v *= 1 / norm(v);
  const Vec3d w = cross(u, v);
  const int rings = 1 + int(std::hypot(z1 - z0, r1 - r0) / step);
  for (int i = 0; i <= rings; ++i) {
    const double z = z0 + (z1 - z0) * i / rings, r = r0 + (r1 - r0) * i / rings;
    const int count = 1 + int(2 * M_PI * r / step);
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * M_PI * k / count;
      points.push_back(a + z * u + r * (std::cos(angle) * v + std::sin(angle) * w));
    }
  }
}

/// The distance must be that of the nearest of `points`, placed `step` apart on the surface, and its sign
/// what `inside` says.
void expect_brute_force(const Shape& shape, const std::vector<Vec3d>& points, double step,
                        const std::function<bool(const Vec3d&)>& inside) {
  RandomPoints random(shape.bounds().grown(0.4));
  int within = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3d x = random();
    double least = INFINITY;
    for (const Vec3d& y : points) least = std::min(least, norm(x - y));
    const double d = shape.distance(x);
    EXPECT_LE(std::abs(d), least + kRound);
    EXPECT_GE(std::abs(d), least - 0.71 * step);  // half the diagonal of a cell of the sample
    EXPECT_EQ(d < 0, inside(x)) << x.x << " " << x.y << " " << x.z;
    within += d < 0;
  }
  EXPECT_GT(within, 5);
}

TEST(Box, DistanceBesideFacesEdgesAndCorners) {
  const auto box = make_box({0, 0, 0}, {1, 2, 3});
  EXPECT_DOUBLE_EQ(box->distance({0.4, 1, 1.5}), -0.4);
  EXPECT_DOUBLE_EQ(box->distance({1.5, 1, 1}), 0.5);
  EXPECT_DOUBLE_EQ(box->distance({1.3, 2.4, 1}), 0.5);
  EXPECT_DOUBLE_EQ(box->distance({-1, -2, 5}), 3);
  expect_near(box->nearest({1.3, 2.4, 1}).point, {1, 2, 1}, kRound);
  expect_near(box->nearest({1.3, 2.4, 1}).normal, {0.6, 0.8, 0}, kRound);
  expect_near(box->nearest({0.5, 1.9, 1}).point, {0.5, 2, 1}, kRound);
  expect_near(box->nearest({0.5, 2, 1}).normal, {0, 1, 0}, kRound);
  expect_near(box->nearest({0.5, 1, 0}).normal, {0, 0, -1}, kRound);
  EXPECT_EQ(box->bounds().max, (Vec3d{1, 2, 3}));
  expect_exact(*box);
}

TEST(Box, RefusesEmptyOnes) {
  EXPECT_EQ(error_in([] { make_box({0, 1, 0}, {1, 1, 1}); }), "box: max y = 1 m must exceed min y = 1 m");
}

TEST(Sphere, DistanceIsRadial) {
  const auto sphere = make_sphere({1, 2, 3}, 0.5);
  EXPECT_DOUBLE_EQ(sphere->distance({1, 2, 3}), -0.5);
  EXPECT_DOUBLE_EQ(sphere->distance({1, 5, 7}), 4.5);
  expect_near(sphere->nearest({1, 5, 7}).point, {1, 2.3, 3.4}, kRound);
  expect_near(sphere->nearest({1, 2.1, 3}).normal, {0, 1, 0}, kRound);
  EXPECT_NEAR(norm(sphere->nearest({1, 2, 3}).point - Vec3d{1, 2, 3}), 0.5, kRound);
  EXPECT_EQ(sphere->bounds().min, (Vec3d{0.5, 1.5, 2.5}));
  expect_exact(*sphere);
  EXPECT_EQ(error_in([] { make_sphere({}, -1); }), "sphere: radius = -1 m must be above 0");
}

TEST(Capsule, DistanceIsThatOfItsLine) {
  const auto capsule = make_capsule({0, 0, 0}, {0, 0, 2}, 0.5);
  EXPECT_DOUBLE_EQ(capsule->distance({0, 0, 1}), -0.5);
  EXPECT_DOUBLE_EQ(capsule->distance({3, 4, 1.5}), 4.5);
  EXPECT_DOUBLE_EQ(capsule->distance({0, 3, 6}), 4.5);
  EXPECT_DOUBLE_EQ(capsule->distance({0, 0, -1}), 0.5);
  EXPECT_EQ(capsule->bounds().max, (Vec3d{0.5, 0.5, 2.5}));
  expect_exact(*make_capsule({0.1, 0.2, 0.3}, {1, -1, 0.5}, 0.3));
}

TEST(Cylinder, DistanceBesideMantleEndsAndRim) {
  const auto cylinder = make_cylinder({0, 0, 1}, {0, 0, 3}, 0.5);
  EXPECT_DOUBLE_EQ(cylinder->distance({0, 0, 2}), -0.5);
  EXPECT_DOUBLE_EQ(cylinder->distance({0, 0.1, 1.2}), -0.2);
  EXPECT_DOUBLE_EQ(cylinder->distance({0, 1.5, 2}), 1);
  EXPECT_DOUBLE_EQ(cylinder->distance({0.2, 0, 3.5}), 0.5);
  EXPECT_DOUBLE_EQ(cylinder->distance({0, 3.5, 7}), 5);
  expect_near(cylinder->nearest({0, 3.5, 7}).normal, {0, 0.6, 0.8}, kRound);
  expect_near(cylinder->nearest({0.1, 0, 3}).normal, {0, 0, 1}, kRound);
  expect_near(cylinder->nearest({0.1, 0, 1}).normal, {0, 0, -1}, kRound);
  expect_near(cylinder->nearest({0, -0.5, 2}).normal, {0, -1, 0}, kRound);
  expect_near(cylinder->bounds().min, {-0.5, -0.5, 1}, kRound);
}

TEST(Cylinder, MatchesBruteForce) {
  const Vec3d a{0.2, -0.1, 0.3}, u{2.0 / 3, -1.0 / 3, 2.0 / 3};
  const double length = 1.2, radius = 0.4, step = 0.02;
  const auto cylinder = make_cylinder(a, a + length * u, radius);
  std::vector<Vec3d> points;
  sweep(points, a, u, 0, 0, 0, radius, step);
  sweep(points, a, u, 0, radius, length, radius, step);
  sweep(points, a, u, length, radius, length, 0, step);
  expect_brute_force(*cylinder, points, step, [&](const Vec3d& x) {
    const double z = dot(x - a, u);
    return z > 0 && z < length && norm(x - a - z * u) < radius;
  });
  expect_exact(*cylinder);
}

TEST(Cone, DistanceBesideItsMantle) {
  const auto cone = make_cone({0, 0, 0}, {0, 0, 4}, 3, 0);  // mantle 5 m long
  EXPECT_NEAR(cone->distance({0, 0, 0.5}), -0.5, kRound);
  EXPECT_NEAR(cone->distance({0, 0, 3}), -0.6, kRound);  // 1 m below the tip, sine 3/5
  EXPECT_NEAR(cone->distance({0, 0, 6}), 2, kRound);
  EXPECT_NEAR(cone->distance({1.5 + 0.8, 0, 2 + 0.6}), 1, kRound);
  expect_near(cone->nearest({2.3, 0, 2.6}).normal, {0.8, 0, 0.6}, kRound);
  EXPECT_NEAR(cone->distance({3, 0, -2}), 2, kRound);
}

TEST(Cone, MatchesBruteForce) {
  const Vec3d a{0, 0.5, 0}, u{0.6, 0, 0.8};
  const double step = 0.02;
  for (const auto& [ra, rb] : {std::pair{0.5, 0.2}, std::pair{0.0, 0.6}, std::pair{0.3, 0.9}}) {
    const auto cone = make_cone(a, a + u, ra, rb);
    std::vector<Vec3d> points;
    sweep(points, a, u, 0, 0, 0, ra, step);
    sweep(points, a, u, 0, ra, 1, rb, step);
    sweep(points, a, u, 1, rb, 1, 0, step);
    expect_brute_force(*cone, points, step, [&, ra = ra, rb = rb](const Vec3d& x) {
      const double z = dot(x - a, u);
      return z > 0 && z < 1 && norm(x - a - z * u) < ra + z * (rb - ra);
    });
    expect_exact(*cone);
  }
}

TEST(Cone, RefusesSizesThatMakeNone) {
  EXPECT_EQ(error_in([] { make_cone({}, {0, 0, 1}, 1, -0.5); }), "cone: radius -0.5 m must not be negative");
  EXPECT_EQ(error_in([] {
              make_cone({}, {0, 0, 1}, 0, 0);
            }),
            "cone: the larger radius = 0 m must be above 0");
  EXPECT_EQ(error_in([] {
              make_cylinder({1, 2, 3}, {1, 2, 3}, 1);
            }),
            "cylinder: its ends (1, 2, 3) and (1, 2, 3) m must lie apart");
}

TEST(Pipe, OpenAndClosedEnds) {
  const Vec3d a{0, 0, 0}, b{0, 0, 2};
  const auto open = make_pipe(a, b, 0.4, 0.5, PipeEnds::open);
  const auto closed_a = make_pipe(a, b, 0.4, 0.5, PipeEnds::closed_a);
  const auto closed_b = make_pipe(a, b, 0.4, 0.5, PipeEnds::closed_b);
  const auto closed = make_pipe(a, b, 0.4, 0.5, PipeEnds::closed);
  for (const auto& pipe : {open, closed_a, closed_b, closed}) {
    EXPECT_NEAR(pipe->distance({0.45, 0, 1}), -0.05, kRound);
    EXPECT_NEAR(pipe->distance({0.1, 0, 1}), 0.3, kRound);
    expect_near(pipe->nearest({0.1, 0, 1}).normal, {-1, 0, 0}, kRound);
    EXPECT_NEAR(pipe->distance({0, 1.5, 1}), 1, kRound);
  }
  EXPECT_NEAR(open->distance({0, 0, -0.05}), std::hypot(0.4, 0.05), kRound);
  EXPECT_NEAR(closed_a->distance({0, 0, -0.05}), -0.05, kRound);
  EXPECT_NEAR(closed_a->distance({0, 0, 0.1}), 0.1, kRound);
  EXPECT_NEAR(closed_a->distance({0, 0, 2.05}), std::hypot(0.4, 0.05), kRound);
  EXPECT_NEAR(closed_b->distance({0, 0, -0.05}), std::hypot(0.4, 0.05), kRound);
  EXPECT_NEAR(closed_b->distance({0.1, 0, 2.04}), -0.04, kRound);
  EXPECT_NEAR(closed->distance({0, 0, 2.3}), 0.2, kRound);
  EXPECT_NEAR(closed->distance({0, 0, -0.3}), 0.2, kRound);
  EXPECT_EQ(error_in([&] { make_pipe(a, b, 0.5, 0.5, PipeEnds::open); }),
            "pipe: outer radius = 0.5 m must exceed inner radius = 0.5 m");
}

TEST(Pipe, MatchesBruteForce) {
  const Vec3d a{0.1, 0.2, 0.3}, u{0, 0.6, 0.8};
  const double step = 0.02, ri = 0.3, ro = 0.5, t = ro - ri;
  for (const PipeEnds ends : {PipeEnds::open, PipeEnds::closed_a, PipeEnds::closed_b, PipeEnds::closed}) {
    const bool at_a = ends == PipeEnds::closed || ends == PipeEnds::closed_a;
    const bool at_b = ends == PipeEnds::closed || ends == PipeEnds::closed_b;
    const double begin = at_a ? -t : 0, end = at_b ? 1 + t : 1;
    const auto pipe = make_pipe(a, a + u, ri, ro, ends);
    std::vector<Vec3d> points;
    sweep(points, a, u, begin, ro, end, ro, step);
    sweep(points, a, u, 0, ri, 1, ri, step);
    sweep(points, a, u, begin, at_a ? 0 : ri, begin, ro, step);
    sweep(points, a, u, end, at_b ? 0 : ri, end, ro, step);
    if (at_a) sweep(points, a, u, 0, 0, 0, ri, step);
    if (at_b) sweep(points, a, u, 1, 0, 1, ri, step);
    expect_brute_force(*pipe, points, step, [&](const Vec3d& x) {
      const double z = dot(x - a, u), r = norm(x - a - z * u);
      return z > begin && z < end && r < ro && !(z > 0 && z < 1 && r < ri);
    });
    expect_exact(*pipe);
  }
}

TEST(Hollow, IsTheWallAroundTheShape) {
  const auto vessel = make_hollow(make_sphere({1, 0, 0}, 1), 0.2);
  EXPECT_NEAR(vessel->distance({1, 0, 0.3}), 0.7, kRound);
  EXPECT_NEAR(vessel->distance({1, 0, 1.05}), -0.05, kRound);
  EXPECT_NEAR(vessel->distance({1, 0, 1.15}), -0.05, kRound);
  EXPECT_NEAR(vessel->distance({1, 0, 1.5}), 0.3, kRound);
  expect_near(vessel->nearest({1, 0, 1.05}).normal, {0, 0, -1}, kRound);  // outward is into the hollow
  expect_near(vessel->nearest({1, 0, 1.15}).normal, {0, 0, 1}, kRound);
  expect_exact(*vessel);
  expect_exact(*make_hollow(make_box({0, 0, 0}, {1, 1, 1}), 0.3));
  EXPECT_EQ(error_in([] { make_hollow(make_sphere({}, 1), 0); }), "hollow: thickness = 0 m must be above 0");
}

/// The distance's sign must be what `inside` says, and nothing may lie nearer than it says.
void expect_bound(const Shape& shape, const std::function<bool(const Vec3d&)>& inside) {
  RandomPoints random(shape.bounds().grown(0.3)), direction(Bounds{{-1, -1, -1}, {1, 1, 1}});
  for (int n = 0; n < 2000; ++n) {
    const Vec3d x = random();
    const double d = shape.distance(x);
    EXPECT_EQ(d < 0, inside(x));
    for (int m = 0; m < 20; ++m) {
      const Vec3d way = direction();
      EXPECT_EQ(inside(x + (0.999 * std::abs(d) / std::max(norm(way), 1e-3)) * way), d < 0);
    }
  }
}

TEST(Union, JoinsItsShapes) {
  const auto both = make_union({make_sphere({0, 0, 0}, 1), make_box({0, -0.5, -0.5}, {2, 0.5, 0.5})});
  EXPECT_NEAR(both->distance({3, 0, 0}), 1, kRound);
  EXPECT_NEAR(both->distance({-2, 0, 0}), 1, kRound);
  EXPECT_NEAR(both->distance({1.5, 0.4, 0}), -0.1, kRound);
  expect_near(both->nearest({1.5, 0.4, 0}).normal, {0, 1, 0}, kRound);
  expect_bound(*both, [](const Vec3d& x) {
    return norm(x) < 1 || (x.x > 0 && x.x < 2 && std::abs(x.y) < 0.5 && std::abs(x.z) < 0.5);
  });
  EXPECT_EQ(both->bounds().min, (Vec3d{-1, -1, -1}));
  EXPECT_EQ(both->bounds().max, (Vec3d{2, 1, 1}));
  EXPECT_EQ(error_in([] { make_union({}); }), "union: must hold at least one shape");
}

TEST(Difference, CutsOneFromTheOther) {
  const auto drilled =
      make_difference(make_box({-1, -1, -1}, {1, 1, 1}), make_cylinder({0, 0, -2}, {0, 0, 2}, 0.5));
  EXPECT_NEAR(drilled->distance({0, 0.1, 0}), 0.4, kRound);
  EXPECT_NEAR(drilled->distance({0, 0.6, 0}), -0.1, kRound);
  EXPECT_NEAR(drilled->distance({0, 0.9, 0}), -0.1, kRound);
  expect_near(drilled->nearest({0, 0.6, 0}).normal, {0, -1, 0}, kRound);
  expect_near(drilled->nearest({0, 0.9, 0}).normal, {0, 1, 0}, kRound);
  expect_bound(*drilled, [](const Vec3d& x) {
    return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) < 1 && std::hypot(x.x, x.y) > 0.5;
  });
}

TEST(Difference, HasNoLidWhereItIsCut) {
  const double facet = 0.05;
  const auto drilled = make_difference(make_box({-1, -1, -1}, {1, 1, 1}),
                                       make_cylinder({0, 0, -1.05}, {0, 0, 1.05}, 0.5), facet);
  const auto placed = make_placed(drilled, {2, {}, {10, 0, 0}});
  const auto far = make_union({make_sphere({9, 9, 9}, 1), drilled});
  for (const double z : {0.0, 0.9, 1.02, 1.2, 3.0}) {
    const Vec3d x{0, 0, z};
    const double exact = std::hypot(0.5, std::max(z - 1, 0.0));
    EXPECT_LE(drilled->distance(x), exact + kRound);
    EXPECT_NEAR(drilled->clearance(x), exact - facet / 4, 0.3 * facet) << z;
    EXPECT_NEAR(placed->clearance(2.0 * x + Vec3d{10, 0, 0}), 2 * drilled->clearance(x), kRound);
    EXPECT_EQ(far->clearance(x), drilled->clearance(x));
  }
  EXPECT_LT(drilled->distance({0, 0, 1.02}), 0.1) << "of the top that is cut away";
  EXPECT_NEAR(make_hollow(drilled, 0.1)->clearance({0, 0, 2}), drilled->clearance({0, 0, 2}) - 0.1, kRound);
  EXPECT_EQ(drilled->clearance({0.9, 0, 0.9}), drilled->distance({0.9, 0, 0.9})) << "inside";
  EXPECT_EQ(drilled->clearance({2, 0, 0}), 1);
}

TEST(Placed, MovesTurnsAndScales) {
  const auto quarter = Quat<double>::from_rotation({0, 0, M_PI / 2});  // x to y
  const auto placed = make_placed(make_box({0, 0, 0}, {1, 2, 3}), {2, quarter, {10, 0, 0}});
  // Now it reaches from (6, 0, 0) to (10, 2, 6).
  expect_near(placed->bounds().min, {6, 0, 0}, kRound);
  expect_near(placed->bounds().max, {10, 2, 6}, kRound);
  EXPECT_NEAR(placed->distance({8, 1.5, 3}), -0.5, kRound);
  EXPECT_NEAR(placed->distance({8, 3, 3}), 1, kRound);
  expect_near(placed->nearest({8, 3, 3}).normal, {0, 1, 0}, kRound);
  expect_near(placed->nearest({8, 3, 3}).point, {8, 2, 3}, kRound);
  expect_exact(*make_placed(make_cone({0, 0, 0}, {0, 0, 1}, 0.5, 0.1),
                            {0.3, Quat<double>::from_rotation({1, 2, 0.5}), {1, -1, 2}}));
  EXPECT_EQ(error_in([] {
              make_placed(make_sphere({}, 1), {0, {}, {}});
            }),
            "placed shape: scale = 0 must be above 0");
}

TEST(Placement, UndoesItself) {
  const Placement placement{0.7, Quat<double>::from_rotation({0.3, -2, 1}), {1, 2, 3}};
  expect_near(placement.undo(placement.apply({0.1, 0.2, 0.3})), {0.1, 0.2, 0.3}, kRound);
}

}  // namespace
}  // namespace bedload::test
