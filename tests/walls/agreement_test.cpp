// A wall is the same wall whichever way it is described: grains in it move alike.

#include "tests/geometry/mesh_support.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

using namespace bedload::test;

constexpr double kSide = 0.02;  // m

/// A column of grains that falls into a corner of the box [0, kSide]^3 and spreads over its floor.
struct Collapse {
  GrainBench b;

  explicit Collapse(const std::vector<WallBody>& walls) {
    b.config.gravity = {0, 0, -9.81};
    b.config.grain.mu = 0.4;
    b.config.grain.E = 1e7;
    b.config.grain.e = 0.4;
    b.config.contact.rolling = "epsd";
    b.config.grain.mu_r = 0.05;
    b.config.wall.bodies = walls;
    const double R = b.R();
    for (int k = 0; k < 5; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          b.add(Vec3d{1.02 + 2.05 * i + 0.01 * k, 1.02 + 2.05 * j + 0.013 * k * k, 1.02 + 2.05 * k} * R,
                {0.02 * j, 0.3, -0.1});
    b.start();
  }
  std::vector<Vec3d> places() const {
    std::vector<Vec3d> x;
    for (Id i = 0; i < b.x.size(); ++i) x.push_back(b.position(i));
    return x;
  }
  double contacts() const { return b.solver->totals(*b.grains).wall_contacts; }
};

double farthest_apart(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, norm(a[i] - b[i]));
  return most;
}

std::vector<WallBody> planes() {
  std::vector<WallBody> all;
  for (int face = 0; face < 6; ++face) {
    WallBody b;
    b.shape = "plane";
    b.point[face / 2] = face % 2 ? kSide : 0;
    b.normal[face / 2] = face % 2 ? -1 : 1;
    all.push_back(b);
  }
  return all;
}

/// The vessel in a solid block, as a CAD file would have it.
WallBody block() {
  const double wall = 0.005;
  const TriangleSoup outer = moved(test::cube(kSide + 2 * wall), {-wall, -wall, -wall});
  return test::shaped(
      "wall", std::make_shared<TriangleMesh>(together(outer, inside_out(test::cube(kSide))), "block"));
}

/// Rounding differs, and every collision multiplies it.
TEST(WallAgreement, ABoxOfPlanesRectanglesAndTrianglesHoldsACollapseAlike) {
  Collapse reference({test::tank({}, {kSide, kSide, kSide})});
  const auto start = reference.places();
  Collapse others[] = {
      Collapse(planes()), Collapse({block()}),
      Collapse({test::shaped("wall",
                             make_hollow(std::make_shared<TriangleMesh>(test::cube(kSide), "cube"), 0.005))}),
      Collapse({test::shaped("wall", make_hollow(make_box({}, {kSide, kSide, kSide}), 0.005))})};
  const double R = reference.b.R();
  double touching = 0;
  for (int stage = 0; stage < 3; ++stage) {
    reference.b.run(2e-5, 1000);
    touching = std::max(touching, reference.contacts());
    for (Collapse& other : others) {
      other.b.run(2e-5, 1000);
      const double apart = farthest_apart(other.places(), reference.places());
      const double most[] = {tolerance(1e-9, 1e-6, 1e-6), tolerance(1e-9, 1e-5, 1e-5),
                             tolerance(1e-6, 1e-2, 1e-2)};
      EXPECT_LT(apart, most[stage] * R);
      EXPECT_NEAR(other.contacts(), reference.contacts(), stage < 2 ? 0 : 1);  // of grains that graze a wall
    }
  }
  EXPECT_GT(touching, 10) << "the test means floor and sides to be met";
  EXPECT_GT(farthest_apart(reference.places(), start), 2 * R) << "and grains to be thrown about";
}

/// A mean over blocks of time, with its standard error.
struct Mean {
  std::vector<double> blocks;
  double value() const {
    double sum = 0;
    for (const double b : blocks) sum += b / double(blocks.size());
    return sum;
  }
  double error2() const {
    double sum = 0;
    for (const double b : blocks) sum += square(b - value());
    return sum / double(blocks.size() * (blocks.size() - 1));
  }
};

/// A bed that flows in a turning drum: its lean, degrees, and what torque it takes, over its weight, m.
struct DrumBed {
  Mean lean, lever;

  explicit DrumBed(ShapePtr inside) {
    const double rate = 12, dt = 4e-5;
    GrainBench b;
    b.config.gravity = {0, -9.81, 0};
    b.config.grain.mu = 0.5;
    b.config.contact.rolling = "epsd";
    b.config.grain.mu_r = 0.1;
    b.config.grain.E = 1.25e6;
    b.config.wall.bodies = {test::shaped("wall", make_hollow(inside, 0.005))};
    b.motion = [&](int, double t) {
      BodyPose p;
      p.rotation = Quat<double>::from_rotation({0, 0, rate * t});
      p.omega = {0, 0, rate};
      return p;
    };
    const double R = b.R();
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 6; ++i)
          // not in two planes: those hold until round-off has grown, and lean 15 degrees less
          b.add(Vec3d{2.1 * (i - 2.5) + 0.05 * j, -5.9 + 2.1 * j + 0.02 * k,
                      1.1 + 2.1 * k + 0.02 * ((i + 2 * j) % 5)} *
                R);
    b.start();
    b.run(dt, 5000);
    constexpr int kBlocks = 10, kLooks = 200;
    const double weight = double(b.x.size()) * b.mass() * 9.81;
    for (int block = 0; block < kBlocks; ++block) {
      Vec3d middle;
      double torque = 0;
      for (int look = 0; look < kLooks; ++look) {
        b.run(dt, 20);
        b.set_poses(1, 0);
        torque += b.solver->body_loads(*b.grains, b.poses())[0].torque().z / kLooks;
        for (const Vec3d& at : b.grains->x.values()) middle += at / (kLooks * double(b.x.size()));
      }
      lean.blocks.push_back(std::atan2(middle.x, -middle.y) * 180 / M_PI);
      lever.blocks.push_back(-torque / weight);
    }
  }
};

/// Beds never flow twice alike, so means agree within three standard errors.
TEST(SlowWallAgreement, ADrumAsCylinderAndAsMeshCarriesABedAlike) {
  const double radius = 0.0125, length = 0.0065;
  const int facets = 720;  // neighbours lean less than a degree: one contact
  const DrumBed exact(make_cylinder({0, 0, 0}, {0, 0, length}, radius));
  const DrumBed mesh(std::make_shared<TriangleMesh>(faceted_cylinder(radius, length, facets), "drum"));
  const auto print = [](const char* what, const Mean& a, const Mean& b) {
    std::cout << what << a.value() << " +- " << std::sqrt(a.error2()) << " as cylinder, " << b.value()
              << " +- " << std::sqrt(b.error2()) << " as mesh\n";
  };
  print("lean (deg) ", exact.lean, mesh.lean);
  print("lever (m) ", exact.lever, mesh.lever);
  EXPECT_GT(exact.lean.value(), 20) << "the drum carries the bed up";
  const double lean_error = 3 * std::sqrt(exact.lean.error2() + mesh.lean.error2());
  const double lever_error = 3 * std::sqrt(exact.lever.error2() + mesh.lever.error2());
  EXPECT_NEAR(mesh.lean.value(), exact.lean.value(), lean_error);
  EXPECT_NEAR(mesh.lever.value(), exact.lever.value(), lever_error);
  EXPECT_LT(lean_error, 8) << "degrees: the means say something";
  EXPECT_LT(lever_error, 0.2 * exact.lever.value());
}

}  // namespace
}  // namespace BL_SOLVER
