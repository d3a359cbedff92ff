// Closest points of shapes: their distances are those of the shape itself, each feature is touched once, and
// what a contact remembers goes with it from triangle to triangle.
#include <functional>
#include <random>

#include "kernels/boundaries/sinks.hpp"
#include "kernels/fluid/wall_repulsion.hpp"
#include "tests/geometry/mesh_support.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

using namespace bedload::test;

/// Refers to host memory: for geometry built in a CPU variant.
#if !BL_CUDA
struct ClosestPoints {
  WallGeometry walls;
  Frame frame{{-1, -1, -1}, {1, 1, 1}, false, false, false};
  BodyPose still;

  explicit ClosestPoints(ShapePtr shape) : walls({test::shaped("wall", shape)}, {}) {}

  std::vector<ClosestPoint> operator()(const Vec3d& x, double reach) const {
    std::vector<ClosestPoint> points;
    for (const Surface& s : walls.surfaces())
      SurfaceView(s, still, frame, x)
          .each_closest_point(walls.view(), reach, 1e-9, [&](const ClosestPoint& f) { points.push_back(f); });
    return points;
  }
};

/// The nearest of them lies as far off as the shape is, in the direction of its gradient.
void expect_closest_points_of(ShapePtr shape) {
  const ClosestPoints points(shape);
  const Bounds bounds = shape->bounds();
  const double size = norm(bounds.max - bounds.min);
  RandomPoints random(bounds.grown(0.2 * size));
  for (int n = 0; n < 2000; ++n) {
    const Vec3d x = random();
    const SurfacePoint at = shape->nearest(x);
    const ClosestPoint* nearest = nullptr;
    const auto all = points(x, 2 * size);
    for (const ClosestPoint& f : all)
      if (!nearest || std::abs(f.distance) < std::abs(nearest->distance)) nearest = &f;
    ASSERT_TRUE(nearest);
    EXPECT_NEAR(nearest->distance, at.distance, 1e-6 * size) << x.x << " " << x.y << " " << x.z;
    EXPECT_NEAR(norm(nearest->normal), 1, 1e-12);
    EXPECT_LT(norm(nearest->normal - at.normal), 1e-5);
  }
}

ShapePtr scaled(ShapePtr shape, double scale) {
  Placement p;
  p.scale = scale;
  return make_placed(shape, p);
}

TEST(ClosestPoints, AreNearestWhereTheShapeIs) {
  const Vec3d a{-0.1, 0.05, -0.2}, b{0.2, 0.1, 0.15};
  expect_closest_points_of(make_sphere(a, 0.1));
  expect_closest_points_of(make_capsule(a, b, 0.1));
  expect_closest_points_of(make_cylinder(a, b, 0.1));
  expect_closest_points_of(make_cone(a, b, 0.15, 0.05));
  expect_closest_points_of(make_cone(a, b, 0, 0.1));
  expect_closest_points_of(make_pipe(a, b, 0.1, 0.15, PipeEnds::closed_a));
  expect_closest_points_of(scaled(std::make_shared<TriangleMesh>(l_prism(), "l"), 0.2));
  expect_closest_points_of(scaled(std::make_shared<TriangleMesh>(ball(3), "ball"), 0.3));
}

TEST(ClosestPoints, FollowAPlacement) {
  Placement p;
  p.scale = 0.7;
  p.rotation = Quat<double>::from_rotation({0.4, -1, 0.3});
  p.translation = {0.1, -0.2, 0.05};
  expect_closest_points_of(make_placed(make_box({-0.2, -0.1, -0.3}, {0.2, 0.1, 0.3}), p));
  expect_closest_points_of(make_placed(make_cone({-0.1, 0.1, 0}, {0.1, 0, 0.3}, 0.1, 0.2), p));
  expect_closest_points_of(make_placed(std::make_shared<TriangleMesh>(test::cube(0.3), "cube"), p));
}

TEST(ClosestPoints, OfAVesselLieOnBothSidesOfItsWall) {
  const ClosestPoints box(make_hollow(make_box({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}), 0.05));
  const auto corner = box({0.19, 0.18, 0.1}, 0.03);
  ASSERT_EQ(corner.size(), 2u) << "two faces seen from within";
  EXPECT_NEAR(corner[0].distance, 0.01, 1e-12);
  EXPECT_NEAR(corner[0].normal.x, -1, 1e-12);
  EXPECT_NEAR(corner[1].distance, 0.02, 1e-12);
  const auto outside = box({0.3, 0, 0}, 0.1);
  ASSERT_EQ(outside.size(), 1u);
  EXPECT_NEAR(outside[0].distance, 0.05, 1e-12);
  EXPECT_NEAR(outside[0].normal.x, 1, 1e-12);

  const ClosestPoints drum(make_hollow(make_cylinder({0, 0, -0.1}, {0, 0, 0.1}, 0.1), 0.02));
  const auto edge = drum({0.095, 0, 0.098}, 0.01);
  ASSERT_EQ(edge.size(), 2u) << "shell and end";
  EXPECT_NEAR(edge[0].distance + edge[1].distance, 0.007, 1e-12);
}
#endif

/// Random solids of every kind, moved, turned and scaled. One draw a statement: the same with every compiler.
class RandomShapes {
 public:
  explicit RandomShapes(unsigned seed) : rng_(seed) {}
  static constexpr int kKinds = 9;

  ShapePtr primitive(int kind) {
    const Vec3d a = point(0.2), along = direction();
    const Vec3d b = a + along * between(0.15, 0.4);
    const double r = between(0.05, 0.15), wall = between(0.02, 0.05);
    const int choice = int(rng_() % 12);
    switch (kind) {
      case 0:
        return make_sphere(a, r);
      case 1:
        return make_capsule(a, b, r);
      case 2:
        return make_cylinder(a, b, r);
      case 3:
        return make_cone(a, b, r, choice < 4 ? 0.0 : between(0.05, 0.15));
      case 4: {
        const auto ends =
            std::array{PipeEnds::open, PipeEnds::closed_a, PipeEnds::closed_b, PipeEnds::closed};
        return make_pipe(a, b, r, r + wall, ends[choice % 4]);
      }
      case 5:
        return make_box(a, a + Vec3d{between(0.1, 0.3), between(0.1, 0.3), between(0.1, 0.3)});
      case 6:
        return std::make_shared<TriangleMesh>(ball(2), "ball");
      case 7:
        return std::make_shared<TriangleMesh>(l_prism(), "l");
      default:
        return make_hollow(primitive(choice % 6), wall);
    }
  }
  ShapePtr placed(ShapePtr shape) {
    const Bounds b = shape->bounds();
    Placement p;
    p.scale = between(0.3, 0.6) / norm(b.max - b.min);
    const Vec3d axis = direction();
    p.rotation = Quat<double>::from_rotation(axis * between(0, 3));
    p.translation = (b.min + b.max) * -0.5 * p.scale + point(0.1);
    return make_placed(shape, p);
  }
  Vec3d direction() {
    Vec3d v;
    do v = point(1);
    while (norm(v) > 1 || norm(v) < 0.1);
    return v / norm(v);
  }
  Vec3d point(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(rng_); }

 private:
  std::mt19937_64 rng_;
};

/// Balls of radius R that must touch a wall, and some that must not, in places around it, on either side.
struct Balls {
  std::vector<Vec3d> x;
  std::vector<double> distance;  ///< of the wall's surface, m
};
Balls balls_around(const Shape& shape, RandomShapes& random, double R) {
  Balls balls;
  for (int tries = 0; tries < 4000 && balls.x.size() < 40; ++tries) {
    const SurfacePoint at = shape.nearest(random.point(0.45));
    const Vec3d x = at.point + at.normal * (R * random.between(0.3, 1.7));
    const double d = shape.clearance(x);
    if (d < 0.2 * R || std::abs(d - R) < 0.02 * R) continue;
    if (std::abs(d - shape.distance(x)) > 0.05 * R) continue;  // beside what a difference has cut away
    bool free = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) < 0.9;
    for (const Vec3d& y : balls.x) free = free && norm(x - y) > 2.2 * R;
    if (free) balls.x.push_back(x), balls.distance.push_back(d);
  }
  return balls;
}

/// What is far from a wall is not pushed by it, what is near is pushed away from it: grains and fluid, at
/// every kind of shape, from outside and from the hollow within.
void expect_wall_pushes(const ShapePtr& shape, RandomShapes& random, const std::string& what,
                        bool directed = true) {
  SCOPED_TRACE(what);
  const double R = 0.012;
  const Balls balls = balls_around(*shape, random, R);
  ASSERT_GT(balls.x.size(), 10u);
  GrainBench b;
  b.config.domain.min = {-1, -1, -1}, b.config.domain.max = {1, 1, 1};
  b.config.grain.d = 2 * R;
  b.config.grain.E = 1e6;
  b.config.wall.bodies = {test::shaped("wall", shape)};
  for (const Vec3d& x : balls.x) b.add(x);
  b.start();
  b.run(1e-7, 1);
  const Frame frame({-1, -1, -1}, {1, 1, 1}, false, false, false);
  BodyPose still;
  still.repulsion = true;
  for (std::size_t i = 0; i < balls.x.size(); ++i) {
    const SurfacePoint at = shape->nearest(balls.x[i]);
    const Vec3d push = b.velocity(Id(i));
    const bool near = balls.distance[i] < R;
    EXPECT_EQ(norm(push) > 0, near) << balls.distance[i] / R << " R away";
    if (near && directed) {
      EXPECT_GT(dot(push, at.normal), 0.3 * norm(push)) << "it is pushed off the wall";
    }
#if !BL_CUDA
    const WallRepulsion fluid{{1, Real(R), 1e6}, {}, frame, b.walls->view(), {&still, 1}};
    Vec3d off;
    fluid.each(balls.x[i], {}, 0, [&](const SurfacePush& push) { off += Vec3d(push.acceleration); });
    EXPECT_EQ(norm(off) > 0, near) << "fluid, " << balls.distance[i] / R << " R away";
    if (near && directed) {
      EXPECT_GT(dot(off, at.normal), 0.3 * norm(off));
    }
#endif
  }
}

TEST(RandomShapes, PushGrainsOffFromEverySide) {
  RandomShapes random(7);
  for (int n = 0; n < 5 * RandomShapes::kKinds; ++n) {
    const ShapePtr shape = random.placed(random.primitive(n % RandomShapes::kKinds));
    expect_wall_pushes(shape, random, "shape " + std::to_string(n));
  }
  for (int n = 0; n < 12; ++n) {
    const ShapePtr one = random.placed(random.primitive(n % 7));
    const ShapePtr other = random.placed(random.primitive((n + 3) % 7));
    const ShapePtr both = make_union({one, other});
    expect_wall_pushes(both, random, "union " + std::to_string(n));
  }
  for (int n = 0; n < 4; ++n) {
    const Vec3d middle = random.point(0.1);
    const ShapePtr rest = make_difference(make_box({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}),
                                          make_sphere(middle, random.between(0.15, 0.25)), 0.004);
    // beside what is cut away its normal may be that of the surface which is gone
    expect_wall_pushes(rest, random, "difference " + std::to_string(n), false);
  }
}

#if !BL_CUDA
/// Who is close enough for a closest point is never passed over, wherever the shape has moved and turned.
TEST(RandomShapes, AreNotPassedOver) {
  RandomShapes random(11);
  int near = 0;
  for (int n = 0; n < 20 * RandomShapes::kKinds; ++n) {
    const ShapePtr shape = random.placed(random.primitive(n % RandomShapes::kKinds));
    const ClosestPoints points(shape);
    BodyPose pose;
    pose.rotation = Quat<double>::from_rotation(random.direction());
    for (int k = 0; k < 50; ++k) {
      const Vec3d x = random.point(0.6);
      const double reach = random.between(0, 0.2);
      for (const Surface& s : points.walls.surfaces()) {
        const SurfaceView view(s, pose, points.frame, x);
        bool touched = false;
        view.each_closest_point(points.walls.view(), reach, 1e-9, [&](const ClosestPoint& closest) {
          touched = touched || closest.distance >= -reach;
        });
        near += touched;
        EXPECT_FALSE(touched && view.beyond(points.walls.view(), reach)) << "shape " << n;
      }
    }
  }
  EXPECT_GT(near, 200);
}

/// What the nearest triangle hides is not looked at: contacts are those of all triangles within reach, with
/// and without a memory of the last one.
TEST(MeshContacts, AreThoseOfAllTrianglesWithinReach) {
  RandomShapes random(17);
  std::mt19937_64 rng(19);
  std::uniform_real_distribution<double> height(-0.02, 0.02);
  TriangleSoup rough = ball(5);
  for (Vec3d& v : rough.vertices) v *= 1 + height(rng);
  std::array<WallMemory, kMostWallContacts> last;
  std::array<WallMemory*, kMostWallContacts> slots;
  for (std::size_t k = 0; k < last.size(); ++k) slots[k] = &last[k];
  int several = 0, fine = 0;
  for (const TriangleSoup& soup : {rough, ball(3), l_prism(), test::cube()}) {
    const ShapePtr shape = random.placed(std::make_shared<TriangleMesh>(soup, "mesh"));
    const ClosestPoints points(shape);
    const SurfaceSet walls = points.walls.view();
    for (int n = 0; n < 400; ++n) {
      const SurfacePoint at = shape->nearest(random.point(0.4));
      const double R = random.between(0.01, 0.2);
      Index remembered = 0;
      for (const double off : {random.between(-0.1, 0.99), random.between(0.9, 0.999)}) {
        const Vec3d x = at.point + at.normal * (off * R);
        SurfaceContacts<AllKinds, kCountedWallContacts> found({slots.data(), &remembered, 0},
                                                              walls.surfaces.data, kCountedWallContacts);
        auto all = found;
        found.seek(walls, 0, points.still, points.frame, x, 1e-4 * R, R, R);
        SurfaceView(walls.surfaces[0], points.still, points.frame, x)
            .each_closest_point(walls, R, 1e-4 * R, [&](const ClosestPoint& c) { all.add(0, c, R, R); });
        found.resolve(), all.resolve();
        ASSERT_EQ(found.size(), all.size()) << n << ", " << off << " R above the surface";
        for (int k = 0; k < all.size(); ++k) {
          EXPECT_EQ(found[k].key(), all[k].key());
          EXPECT_EQ(found[k].closest.distance, all[k].closest.distance);
          EXPECT_EQ(norm(found[k].closest.normal - all[k].closest.normal), 0);
          if (k < kMostWallContacts) last[k] = {all[k].key(), all[k].closest.normal, {}};
        }
        remembered = Index(std::min(all.size(), kMostWallContacts));
        several += all.size() > 1;
        fine += walls.meshes[0].fine(R) && off > 0;
      }
    }
  }
  EXPECT_GT(several, 100);
  EXPECT_GT(fine, 300) << "where the nearest point is found first";
}

/// An outlet takes what lies in it.
TEST(RandomShapes, TakeWhatLiesWithin) {
  RandomShapes random(13);
  int within = 0;
  for (int n = 0; n < 4 * RandomShapes::kKinds; ++n) {
    const ShapePtr shape = random.placed(random.primitive(n % RandomShapes::kKinds));
    const ClosestPoints points(shape);
    for (int k = 0; k < 2000; ++k) {
      const Vec3d x = random.point(0.4);
      if (std::abs(shape->distance(x)) < 1e-4) continue;
      bool taken = false;
      for (const Surface& s : points.walls.surfaces())
        taken = taken || inside(points.walls.view(), s, points.frame, x);
      EXPECT_EQ(taken, shape->distance(x) < 0)
          << "shape " << n << ", " << shape->distance(x) << " m from its surface";
      within += taken;
    }
  }
  EXPECT_GT(within, 800);
}
#endif

/// Grains against one shape, and against what should do the same.
struct Pressed {
  Vec3d force, torque;
  double contacts;
};
Pressed press(const std::vector<WallBody>& bodies, const Vec3d& x, const Vec3d& v = {}, int steps = 0) {
  GrainBench b;
  b.config.wall.bodies = bodies;
  b.add(x, v);
  b.start();
  if (steps > 0) b.run(1e-6, steps);
  return {b.force(), b.torque(), b.solver->totals(*b.grains).wall_contacts};
}

/// A prism along y whose top follows the points (x, z), finely cut or not; its bottom at z = -0.05.
ShapePtr ridge(const std::vector<std::pair<double, double>>& top, int cuts) {
  TriangleSoup soup;
  const std::uint32_t n = std::uint32_t(top.size()), rows = std::uint32_t(cuts) + 1;
  for (std::uint32_t r = 0; r < rows; ++r)
    for (const double low : {0.0, 1.0})
      for (const auto& [x, z] : top)
        soup.vertices.push_back({x, -0.05 + 0.1 * r / cuts, low > 0 ? -0.05 : z});
  const auto at = [&](std::uint32_t row, bool low, std::uint32_t k) { return (2 * row + low) * n + k; };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    soup.triangles.push_back({a, b, c});
    soup.triangles.push_back({a, c, d});
  };
  for (std::uint32_t r = 0; r + 1 < rows; ++r) {
    for (std::uint32_t k = 0; k + 1 < n; ++k) {
      quad(at(r, false, k), at(r, false, k + 1), at(r + 1, false, k + 1), at(r + 1, false, k));
      quad(at(r, true, k), at(r + 1, true, k), at(r + 1, true, k + 1), at(r, true, k + 1));
    }
    quad(at(r, false, 0), at(r + 1, false, 0), at(r + 1, true, 0), at(r, true, 0));
    quad(at(r, false, n - 1), at(r, true, n - 1), at(r + 1, true, n - 1), at(r + 1, false, n - 1));
  }
  for (std::uint32_t k = 0; k + 1 < n; ++k) {
    quad(at(0, false, k), at(0, true, k), at(0, true, k + 1), at(0, false, k + 1));
    quad(at(rows - 1, false, k), at(rows - 1, false, k + 1), at(rows - 1, true, k + 1),
         at(rows - 1, true, k));
  }
  return std::make_shared<TriangleMesh>(soup, "ridge");
}

constexpr double kR = 1.35e-3, kReach = 0.99 * kR;

double plane_force() {
  GrainBench plane;
  plane.plane({0, 0, 0}, {0, 0, 1});
  plane.add({0, 0, kReach});
  plane.start();
  return plane.force().z;
}

TEST(MeshContacts, FlatTrianglesPushAsAPlane) {  // T-28
  const double f = plane_force(), near = tolerance(1e-9, 1e-5, 1e-5) * f;
  for (int cuts : {1, 4, 400}) {  // 400: triangles smaller than the contact
    std::vector<std::pair<double, double>> flat;
    for (int k = 0; k <= cuts; ++k) flat.push_back({-0.05 + 0.1 * k / cuts, 0});
    const auto bodies = {test::shaped("wall", ridge(flat, cuts))};
    for (const Vec3d& x : {Vec3d{0, 0, 0}, {0.0101, 0.0003, 0}, {0.025, 0.025, 0}, {0.0250001, 0.013, 0}}) {
      const Pressed p = press(bodies, x + Vec3d{0, 0, kReach});
      EXPECT_EQ(p.contacts, 1) << cuts << ": " << x.x << " " << x.y;
      EXPECT_LT(norm(p.force - Vec3d{0, 0, f}), near) << cuts;
    }
  }
}

TEST(MeshContacts, EdgeGrooveAndCornerCountOnce) {  // T-28
  const double f = plane_force(), near = tolerance(1e-9, 1e-5, 1e-5) * f;
  const auto roof = {test::shaped("wall", ridge({{-0.05, -0.02}, {0, 0}, {0.05, -0.02}}, 3))};
  Pressed p = press(roof, {0, 0.004, kReach});
  EXPECT_EQ(p.contacts, 1) << "convex edge";
  EXPECT_LT(norm(p.force - Vec3d{0, 0, f}), near);

  const double h = std::sqrt(0.5);
  const auto groove = {test::shaped("wall", ridge({{-0.03, 0.03}, {0, 0}, {0.03, 0.03}}, 3))};
  p = press(groove, {0, 0.004, kReach / h});
  EXPECT_EQ(p.contacts, 2) << "groove";
  EXPECT_LT(norm(p.force - Vec3d{0, 0, 2 * h * f}), 2 * near);

  const auto block = {test::shaped("wall", std::make_shared<TriangleMesh>(test::cube(0.05), "cube"))};
  const double third = kReach / std::sqrt(3.0);
  p = press(block, {0.05 + third, 0.05 + third, 0.05 + third});
  EXPECT_EQ(p.contacts, 1) << "vertex";
  EXPECT_NEAR(norm(p.force), f, near);
  EXPECT_NEAR(p.force.x, p.force.z, near);
}

TEST(MeshContacts, AGrainThatSlidesOverTrianglesFeelsAPlane) {
  std::vector<std::pair<double, double>> flat;
  for (int k = 0; k <= 50; ++k) flat.push_back({-0.05 + 0.002 * k, 0});
  const auto slide = [](std::function<void(GrainBench&)> wall) {
    GrainBench b;
    b.config.gravity = {0, 0, -9.81};
    wall(b);
    b.add({-0.0203, 0.0007, b.R() - b.resting_overlap(b.mass() * 9.81)}, {0.3, 0.07, 0});
    b.start();
    b.run(1e-5, 6000);  // over some nine edges
    return std::pair{b.position(), b.spin()};
  };
  const auto [x, w] =
      slide([&](GrainBench& b) { b.config.wall.bodies = {test::shaped("wall", ridge(flat, 50))}; });
  const auto [y, u] = slide([](GrainBench& b) { b.plane({0, 0, 0}, {0, 0, 1}); });
  EXPECT_GT(y.x, -0.01);
  EXPECT_LT(norm(x - y), tolerance(1e-9, 1e-7, 1e-7));
  EXPECT_LT(norm(w - u), tolerance(1e-6, 1e-2, 1e-2));
}

TEST(MeshContacts, TheInsideHoldsWhatIsPressedThroughAFace) {
  // a vessel of triangles, far too soft: centres pass its floor and come back
  GrainBench b;
  b.config.grain.E = 1e4;
  b.config.wall.bodies = {
      test::shaped("wall", make_hollow(std::make_shared<TriangleMesh>(test::cube(0.05), "cube"), 0.01))};
  b.add({0.02, 0.02, 1.5 * b.R()}, {0.1, 0, -1.5});
  b.start();
  double lowest = 1;
  for (int k = 0; k < 50; ++k) {
    b.run(1e-5, 20);
    lowest = std::min(lowest, b.position().z);
  }
  EXPECT_LT(lowest, 0) << "the test means the centre to pass";
  EXPECT_GT(b.velocity().z, 0.5) << "thrown back";
}

TEST(MeshContacts, ADrilledPlateHoldsOneGrainAndLetsAnotherThrough) {
  GrainBench b;
  b.config.gravity = {0, 0, -9.81};
  b.config.grain.e = 0.3;
  b.config.wall.bodies = {
      test::shaped("wall", make_difference(make_box({-0.02, -0.02, -0.004}, {0.02, 0.02, 0}),
                                           make_cylinder({0.005, 0, -1}, {0.005, 0, 1}, 2 * b.R()), 5e-4))};
  b.add({-0.01, 0.003, 1.1 * b.R()});
  b.add({0.005, 0, 1.1 * b.R()});
  b.start();
  b.run(1e-5, 6000);
  EXPECT_NEAR(b.position(0).z, b.R(), 1e-3 * b.R());
  EXPECT_NEAR(norm(b.position(0) - Vec3d{-0.01, 0.003, b.position(0).z}), 0, 1e-3 * b.R());
  EXPECT_NEAR(b.position(1).z, 1.1 * b.R() - 0.5 * 9.81 * b.time * b.time, 1e-3 * b.R()) << "falls freely";
}

TEST(MeshContacts, ADrumAsCylinderAndAsMeshCarriesAGrainAlike) {
  const double radius = 0.02, rate = 20;
  const int facets = 720;  // neighbours lean less than a degree: one contact
  const auto mesh = std::make_shared<TriangleMesh>(faceted_cylinder(radius, 0.01, facets), "drum");
  const auto height = [&](ShapePtr shape) {
    GrainBench b;
    b.config.gravity = {0, -9.81, 0};
    b.config.grain.mu = 0.5;
    b.config.contact.rolling = "epsd";
    b.config.grain.mu_r = 0.2;
    b.config.wall.bodies = {test::shaped("wall", make_hollow(shape, 0.005))};
    b.motion = [&](int, double t) {
      BodyPose p;
      p.rotation = Quat<double>::from_rotation({0, 0, rate * t});
      p.omega = {0, 0, rate};
      return p;
    };
    b.add({0, -radius + b.R(), 0.005});
    b.start();
    double top = -1;
    for (int k = 0; k < 200; ++k) {
      b.run(1e-5, 100);
      top = std::max(top, b.position().y);
    }
    return top;
  };
  const double exact = height(make_cylinder({0, 0, 0}, {0, 0, 0.01}, radius));
  EXPECT_GT(exact, -radius + 1.5e-3) << "the drum lifts the grain";
  EXPECT_NEAR(height(mesh), exact, 0.03 * (exact + radius));
}

}  // namespace
}  // namespace BL_SOLVER
