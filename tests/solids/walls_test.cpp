// Grains against surfaces: geometry, motion, loads, boxes that keep their contents.
#include <array>
#include <limits>

#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

WallBody box(const Vec3d& min, const Vec3d& max, const char* shape = "box") {
  WallBody b;
  b.shape = shape;
  b.min = min;
  b.max = max;
  return b;
}

TEST(Surfaces, NearestPointsOfABox) {
  Config c;
  c.domain.min = {-1, -1, -1}, c.domain.max = {1, 1, 1};
  c.wall.bodies = {box({0, 0, 0}, {0.2, 0.4, 0.6})};
  const WallGeometry geometry(c.wall.bodies, c.domain);
  const auto& surfaces = geometry.surfaces();
  ASSERT_EQ(surfaces.size(), 1u);
  const Frame frame(c.domain.min, c.domain.max, false, false, false);
  struct Seen {
    Vec3d normal, point;
    double distance;
  };
  const BodyPose still;
  auto at = [&](const Vec3d& x) {
    Seen seen{};
    const SurfaceView view(surfaces[0], still, frame, x);
    view.each_closest_point(geometry.view(), 1, 1e-9, [&](const ClosestPoint& f) {
      seen = {f.normal, view.point(f), f.distance};
    });
    return seen;
  };
  EXPECT_NEAR(at({0.3, 0.1, 0.1}).distance, 0.1, 1e-15);
  EXPECT_NEAR(at({0.3, 0.5, 0.1}).distance, 0.1 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(at({0.3, 0.5, 0.7}).distance, 0.1 * std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(at({0.18, 0.2, 0.3}).distance, -0.02, 1e-15) << "inside: to the nearest face";
  EXPECT_NEAR(at({0.18, 0.2, 0.3}).normal.x, 1, 1e-15);
  EXPECT_LT(norm(at({0.3, 0.5, 0.7}).point - Vec3d(0.2, 0.4, 0.6)), 1e-15);
}

TEST(Surfaces, TankHasARectangleForEachListedFaceLookingInwards) {
  Config c;
  c.domain.min = {0, 0, 0}, c.domain.max = {1, 1, 1};
  c.wall.bodies = {box({0, 0, 0}, {1, 1, 1}, "tank")};
  c.wall.bodies[0].faces[5] = false;
  const WallGeometry geometry(c.wall.bodies, c.domain);
  const auto& surfaces = geometry.surfaces();
  ASSERT_EQ(surfaces.size(), 5u);
  for (const Surface& s : surfaces) {
    EXPECT_EQ(s.kind, SurfaceKind::rectangle);
    EXPECT_NEAR(dot(Vec3d(0.5, 0.5, 0.5) - s.centre, s.axis[2]), 0.5, 1e-15);
    EXPECT_NEAR(dot(cross(s.axis[0], s.axis[1]), s.axis[2]), 1, 1e-15);
  }
}

TEST(Surfaces, HaveNoEdgeAtAPeriodicBoundary) {
  GrainBench b;
  b.config.domain.periodic = {true, false, false};
  b.config.wall.bodies = {box({-0.1, -0.1, -0.05}, {0.1, 0.1, 0}),
                          box({-0.1, -0.1, -0.05}, {0.1, 0.1, 0.05}, "tank")};
  const WallGeometry geometry(b.config.wall.bodies, b.config.domain);
  for (const Surface& s : geometry.surfaces()) {
    bool endless = false;
    for (int k = 0; k < 3; ++k) endless = endless || (std::isinf(s.half[k]) && s.axis[k].x != 0);
    EXPECT_TRUE(endless || std::abs(s.axis[2].x) == 1);
  }
  b.config.wall.bodies.pop_back();
  b.add({0, 0, 0.9 * b.R()});
  b.start();
  b.grains->x.assign({{0.1 + 0.3 * b.R(), 0, 0.9 * b.R()}});  // has crossed, not wrapped yet
  b.solver->evaluate(*b.grains, b.poses());
  EXPECT_EQ(b.force().x, 0);
  EXPECT_GT(b.force().z, 0);
}

/// Force on a grain at x above the box [-0.05, 0]^3, turned and moved with its body.
Vec3d force_at(const Vec3d& x, const Quat<double>& turn = {}, const Vec3d& shift = {}) {
  GrainBench b;
  b.config.wall.bodies = {box({-0.05, -0.05, -0.05}, {0, 0, 0})};
  b.motion = [&](int, double) {
    BodyPose p;
    p.rotation = turn;
    p.translation = shift;
    return p;
  };
  b.add(turn.rotate(x) + shift);
  b.start();
  return turn.conjugate().rotate(b.force());
}

TEST(Walls, FaceEdgeAndCornerOfABoxPushAsAPlaneWould) {
  const double R = 1.35e-3, depth = 1e-2 * R, reach = R - depth;
  GrainBench plane;
  plane.plane({0, 0, 0}, {0, 0, 1});
  plane.add({0, 0, reach});
  plane.start();
  const double f = plane.force().z;
  ASSERT_GT(f, 0);
  const double near = tolerance(1e-9, 1e-5, 1e-5) * f;
  const Quat<double> turn = Quat<double>::from_rotation({0.3, -0.7, 0.4});
  const Vec3d shift{0.01, -0.02, 0.03};
  const Vec3d ways[] = {
      {0, 0, 1}, {1, 0, 0}, {0, std::sqrt(0.5), std::sqrt(0.5)}, Vec3d(1, 1, 1) * (1 / std::sqrt(3.0))};
  const Vec3d starts[] = {{-0.02, -0.02, 0}, {0, -0.02, -0.01}, {-0.02, 0, 0}, {0, 0, 0}};
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT(norm(force_at(starts[k] + ways[k] * reach) - ways[k] * f), near) << k;
    EXPECT_LT(norm(force_at(starts[k] + ways[k] * reach, turn, shift) - ways[k] * f), near) << k << " turned";
  }
}

TEST(Walls, RectangleIsFeltFromBothSidesAndPushesBackWhatHasPassed) {
  GrainBench b;
  b.config.wall.bodies = {box({-0.02, -0.02, 0}, {0.02, 0.02, 0.02}, "tank")};
  b.config.wall.bodies[0].faces = {false, false, false, false, true, false};  // floor only
  b.config.grain.E = 1e4;  // far too soft: centres pass the floor
  b.add({0, 0, 1.5 * b.R()}, {0, 0, -1.5});
  b.add({0.01, 0, -1.5 * b.R()}, {0, 0, 0.1});
  b.add({0.02 + 1.5 * b.R(), 0, 0}, {-0.1, 0, 0});
  b.add({0.03, 0.03, 0.002}, {0, 0, -0.5});  // beside the patch
  b.start();
  double lowest = 1;
  for (int k = 0; k < 600; ++k) {
    b.run(1e-5, 20);
    lowest = std::min(lowest, b.position(0).z);
  }
  EXPECT_LT(lowest, 0) << "the test means the centre to pass";
  EXPECT_GT(b.velocity(0).z, 0.5) << "thrown back";
  EXPECT_LT(b.velocity(1).z, -0.05) << "from below";
  EXPECT_GT(b.velocity(2).x, 0.05) << "from beyond its edge";
  EXPECT_NEAR(b.velocity(3).z, -0.5, 1e-6) << "nothing there";
}

#if !BL_CUDA  // the host reads the surfaces
TEST(Walls, HoldWhatHasTouchedThemOnItsSideUpToTheReach) {
  Config c;
  c.domain.min = {-1, -1, -1}, c.domain.max = {1, 1, 1};
  c.wall.bodies = {box({-0.5, -0.5, 0}, {0.5, 0.5, 0.5}, "tank")};
  c.wall.bodies[0].faces = {false, false, false, false, true, false};
  const WallGeometry geometry(c.wall.bodies, c.domain);
  const Frame frame(c.domain.min, c.domain.max, false, false, false);
  const double R = 0.01, reach = 1.2 * R;
  WallMemory memory;
  WallMemory* slots[] = {&memory};
  Index count = 0;
  const auto found = [&](double z) {
    SurfaceContacts<> out({slots, &count, 0}, geometry.view().surfaces.data, 1);
    out.seek(geometry.view(), 0, BodyPose{}, frame, {0, 0, z}, 1e-4 * R, R, reach);
    out.resolve();
    out.drop_apart(R);
    return out;
  };
  for (const double side : {1.0, -1.0}) {
    count = 0;
    EXPECT_EQ(found(1.1 * side * R).size(), 0) << "it has not touched";
    ASSERT_EQ(found(0.9 * side * R).size(), 1);
    memory = {found(0.9 * side * R)[0].key(), {0, 0, side}, {}}, count = 1;
    EXPECT_EQ(found(1.1 * side * R).size(), 1);
    EXPECT_EQ(found(1.3 * side * R).size(), 0);
    const auto passed = found(-0.1 * side * R);
    ASSERT_EQ(passed.size(), 1);
    EXPECT_NEAR(passed[0].closest.distance, -0.1 * R, 1e-12) << "its centre has passed the patch";
    EXPECT_EQ(passed[0].closest.normal, Vec3d(0, 0, side));
  }
}
#endif

/// Where a grain is after sliding and rolling along faces, an edge and into a corner of a tank, with
/// friction, beside another body, which it never meets.
std::vector<Vec3d> along_a_tank(const std::function<void(GrainBench&)>& with) {
  GrainBench b;
  b.config.grain.mu_r = 0.05;
  b.config.contact.rolling = "cdt";
  b.config.gravity = {-3, -4, -9};
  b.config.wall.bodies = {box({0, 0, 0}, {0.05, 0.05, 0.05}, "tank")};
  with(b);
  const double R = b.R(), in = 0.999 * R;
  b.add({8 * R, 8 * R, in}, {-0.3, -0.1, 0}, {30, 0, 10});
  b.add({8 * R, in, in}, {-0.3, 0, 0}, {0, 50, 0});
  b.add({in, in, in}, {0.05, 0.1, 0}, {10, 20, 30});
  b.add({in, in, 0.05 + 0.3 * R}, {0, 0, -0.1});  // on the rim
  b.start();
  b.run(1e-5, 200);
  std::vector<Vec3d> out;
  for (Id i = 0; i < 4; ++i) out.insert(out.end(), {b.position(i), b.velocity(i), b.spin(i)});
  return out;
}

TEST(SmallWalls, ActTheSameBesideBodiesOfOtherKinds) {
  const auto flat = along_a_tank([](GrainBench&) {});
  EXPECT_LT(flat[0].x, 8 * 1.35e-3 - 0.3e-3);
  EXPECT_NE(norm(flat[8]), 0) << "no spin in the corner";
  const Vec3d far{0.09, 0.09, 0.09};
  const std::function<void(GrainBench&)> others[] = {
      [&](GrainBench& b) { b.config.wall.bodies.push_back(test::shaped("ball", make_sphere(far, 0.005))); },
      [&](GrainBench& b) {
        b.plane({0, 0, -0.09}, {0, 0, 1}), b.config.wall.bodies[1].mu_r = 0;
      }};
  for (const auto& other : others) {
    const auto beside = along_a_tank(other);
    for (std::size_t k = 0; k < flat.size(); ++k) {
      const double scale = std::array{1e-3, 0.1, 50.0}[k % 3];
      EXPECT_LT(norm(beside[k] - flat[k]), tolerance(1e-9, 1e-3, 1e-3) * scale) << k;
    }
  }
}

TEST(Walls, LoadOfRestingGrainsIsTheirWeight) {
  GrainBench b;
  b.config.gravity = {0, 0, -9.81};
  b.config.wall.bodies = {box({-0.05, -0.05, 0}, {0.05, 0.05, 0.05}, "tank"),
                          box({0.06, 0, 0}, {0.07, 0.01, 0.01})};
  b.config.contact.rolling = "epsd";
  const double rest = b.R() - b.resting_overlap(b.mass() * 9.81);
  for (int i = 0; i < 10; ++i) b.add({0.004 * i - 0.02, 0.01, rest});
  b.start();
  b.run(1e-5, 500);
  b.set_poses(1, 0);
  const auto loads = b.solver->body_loads(*b.grains, b.poses());
  ASSERT_EQ(loads.size(), 2u);
  const double weight = 10 * b.mass() * 9.81;
  EXPECT_NEAR(loads[0].force().z / -weight, 1, 1e-4);
  EXPECT_NEAR(loads[0].torque().x / (-weight * 0.01), 1, 1e-4);
  EXPECT_NEAR(loads[0].torque().y / (weight * -0.002), 1, 1e-3);
  EXPECT_EQ(norm(loads[1].force()), 0);
  const GrainTotals t = b.solver->totals(*b.grains);
  EXPECT_EQ(t.wall_contacts, 10);
  EXPECT_EQ(t.contacts, 0);
  const double overlap = b.resting_overlap(b.mass() * 9.81);
  EXPECT_NEAR(t.max_overlap / (overlap / (2 * b.R())), 1, 1e-3);
  EXPECT_NEAR(t.elastic / (10 * 0.4 * b.mass() * 9.81 * overlap), 1, 1e-3);
}

TEST(Walls, MovingWallThrowsTheGrainAndARemovedOneLetsItGo) {
  GrainBench b;
  b.config.grain.e = 1;
  b.config.grain.mu = 0;
  b.config.wall.bodies = {box({-0.02, -0.02, -0.02}, {0, 0.02, 0.02})};
  const double V = 0.2;
  b.motion = [&](int, double t) {
    BodyPose p;
    p.translation = {V * t, 0, 0};
    p.v = {V, 0, 0};
    return p;
  };
  b.add({1.02 * b.R(), 0, 0});
  b.start();
  b.run(1e-6, 2000);
  EXPECT_NEAR(b.velocity().x / (2 * V), 1, 1e-3);

  GrainBench gone;
  gone.plane({0, 0, 0}, {0, 0, 1});
  gone.config.gravity = {0, 0, -9.81};
  gone.add({0, 0, 0.99 * gone.R()});
  gone.motion = [](int, double) {
    BodyPose p;
    p.present = 0;
    return p;
  };
  gone.start();
  gone.run(1e-5, 1000);
  EXPECT_NEAR(gone.velocity().z, -0.0981, 1e-6);
  EXPECT_EQ(gone.solver->totals(*gone.grains).wall_contacts, 0);
}

TEST(Walls, RotatingPlaneCarriesTheGrainRound) {
  // turntable: the contact velocity is omega x r
  GrainBench b;
  b.config.gravity = {0, 0, -9.81};
  b.plane({0, 0, 0}, {0, 0, 1});
  const double rate = 5, r = 0.02;
  b.motion = [&](int, double t) {
    BodyPose p;
    p.rotation = Quat<double>::from_rotation({0, 0, rate * t});
    p.omega = {0, 0, rate};
    return p;
  };
  b.add({r, 0, b.R() - b.resting_overlap(b.mass() * 9.81)});
  b.start();
  b.run(1e-6, 1000);  // slipping all the while
  const Vec3d f = b.force();
  EXPECT_GT(f.y, 0);
  EXPECT_NEAR(f.y / (b.config.grain.mu * f.z), 1, 1e-2);
}

TEST(Walls, BeltRunsTheWayThatItsBodyIsTurned) {
  GrainBench b;
  b.plane({0, 0, 0}, {0, 0, 1});
  b.motion = [](int, double) {
    BodyPose p;
    p.rotation = Quat<double>::from_rotation({0, 0, M_PI / 2});
    p.slide = {0.3, 0, 0};
    return p;
  };
  b.add({0, 0, 0.999 * b.R()});
  b.start();
  b.run(1e-7, 10);
  const Vec3d f = b.force();
  EXPECT_GT(f.y, 0);
  EXPECT_LT(std::abs(f.x), 1e-5 * f.y);
}

/// A body that has gone round a period, and grains beside it that have not, are where they were.
TEST(Walls, AreMetByTheirNearestImage) {
  const auto load = [](int periods) {
    GrainBench b;
    b.config.domain.periodic = {true, false, false};
    b.config.wall.bodies = {box({-0.02, -0.02, -0.02}, {0.02, 0.02, 0})};
    b.motion = [&](int, double) {
      BodyPose p;
      p.translation = {0.2 * periods, 0, 0};
      p.omega = {0, 0, 5};
      return p;
    };
    b.add({0.015, 0.005, 0.999 * b.R()});
    b.start();
    b.run(1e-7, 10);
    b.set_poses(1, 0);
    const LoadSum sum = b.solver->body_loads(*b.grains, b.poses())[0];
    return std::pair{sum.force(), sum.torque()};
  };
  const auto [force, torque] = load(0);
  EXPECT_LT(force.z, 0);
  EXPECT_NEAR(torque.y / (-0.015 * force.z), 1, 0.02) << "but for friction at that depth";
  for (const int periods : {-1, 3}) {
    const auto [far, turning] = load(periods);
    EXPECT_LT(norm(far - force), tolerance(1e-9, 1e-5, 1e-5) * norm(force)) << periods;
    EXPECT_LT(norm(turning - torque), tolerance(1e-9, 1e-5, 1e-5) * norm(torque)) << periods;
  }
}

TEST(Walls, HaveFrictionAndRestitutionOfTheirOwn) {
  GrainBench b;
  b.config.gravity = {0, 0, -9.81};
  b.config.contact.rolling = "epsd";
  b.config.grain.mu = 0.3, b.config.grain.mu_r = 0.02, b.config.grain.e = 0.9;
  b.config.wall.bodies = {box({-0.05, -0.05, -0.01}, {0.05, 0, 0}), box({-0.05, 0, -0.01}, {0.05, 0.05, 0})};
  b.config.wall.bodies[0].mu = 0.1, b.config.wall.bodies[0].mu_r = 0.1, b.config.wall.bodies[0].e = 0.5;
  const double rest = b.R() - b.resting_overlap(b.mass() * 9.81);
  for (double y : {-0.02, 0.02}) b.add({-0.03, y, rest}, {0.5, 0, 0});                       // slides
  for (double y : {-0.03, 0.03}) b.add({-0.03, y, rest}, {0.2, 0, 0}, {0, 0.2 / b.R(), 0});  // rolls
  for (double y : {-0.04, 0.04}) b.add({-0.03, y, b.R()}, {0, 0, -0.2});                     // jumps
  b.start();
  const double dt = 1e-6;
  b.run(dt, 1000);
  // contacts last a little longer the more they damp, and gravity takes 2 % of this speed in one
  const double fallen = 9.81 * (b.time - b.contact_time(0.2, true));
  EXPECT_NEAR((b.velocity(4).z + fallen) / 0.2, 0.5, 5e-3);
  EXPECT_NEAR((b.velocity(5).z + fallen) / 0.2, 0.9, 5e-3);
  b.run(dt, 19000);
  // the elastic couple takes its time to come to its limit
  EXPECT_NEAR((0.5 - b.velocity(0).x) / (0.1 * 9.81 * b.time), 1, 2e-3);
  EXPECT_NEAR((0.5 - b.velocity(1).x) / (0.3 * 9.81 * b.time), 1, 2e-3);
  EXPECT_NEAR((0.2 - b.velocity(2).x) / (5.0 / 7.0 * 0.1 * 9.81 * b.time), 1, 5e-3);
  EXPECT_NEAR((0.2 - b.velocity(3).x) / (5.0 / 7.0 * 0.02 * 9.81 * b.time), 1, 5e-3);
}

}  // namespace
}  // namespace BL_SOLVER
