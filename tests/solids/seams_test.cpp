// A surface is the same however many bodies it is put together from: grains neither hop nor bounce otherwise
// where these meet or overlap. Surfaces that differ all push.
#include <map>

#include "tests/geometry/mesh_support.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kLength = 0.1, kWidth = 0.05, kDepth = 0.02, kSeam = kLength / 12;

ShapePtr mesh(const Vec3d& min, const Vec3d& max) {
  TriangleSoup soup = test::cube();
  for (Vec3d& v : soup.vertices)
    for (int k = 0; k < 3; ++k) v[k] = min[k] + v[k] * (max[k] - min[k]);
  return std::make_shared<TriangleMesh>(soup, "slab");
}

/// Floors whose top is z = 0, cut across x at multiples of kSeam.
std::map<std::string, std::vector<WallBody>> floors() {
  const auto min = [](int k, double lap = 0) { return Vec3d{k * kSeam - lap, -kWidth, -kDepth}; };
  const auto max = [](int k, double top = 0) { return Vec3d{(k + 1) * kSeam, kWidth, top}; };
  WallBody plane;
  plane.name = "plane", plane.shape = WallShape::plane;
  plane.normal = {0, 0, 1};
  std::map<std::string, std::vector<WallBody>> all;
  std::vector<ShapePtr> flush;
  for (int k = -1; k < 13; ++k) {
    const WallBody box = test::body("box", min(k), max(k)),
                   triangles = test::shaped("mesh", mesh(min(k), max(k)));
    all["flush boxes"].push_back(box);
    all["overlapping boxes"].push_back(test::body("box", min(k, 0.6 * kSeam), max(k)));
    all["boxes that miss by rounding"].push_back(test::body("box", min(k), max(k, k % 2 ? 1e-9 : 0)));
    all["flush meshes"].push_back(triangles);
    all["boxes beside meshes"].push_back(k % 2 ? box : triangles);
    all["unions beside boxes"].push_back(
        k % 2 ? box
              : test::shaped("union", make_union({make_box(min(k), max(k) - Vec3d{kSeam / 2, 0, 0}),
                                                  make_box(min(k) + Vec3d{kSeam / 2, 0, 0}, max(k))})));
    all["rectangles beside boxes"].push_back(
        k % 2 ? box : test::tank(min(k) + Vec3d{0, 0, kDepth}, max(k, 0.05), "z-"));
    flush.push_back(make_box(min(k), max(k)));
  }
  all["a union"] = {test::shaped("union", make_union(flush))};
  all["boxes in a plane"] = all["flush boxes"];
  all["boxes in a plane"].push_back(plane);
  return all;
}

GrainBench on(const std::vector<WallBody>& bodies) {
  GrainBench b;
  b.config.wall.bodies = bodies;
  b.config.gravity = {0, 0, -9.81};
  return b;
}

/// The same floor as one box.
std::vector<WallBody> whole() {
  return {test::body("box", {-kSeam, -kWidth, -kDepth}, {13 * kSeam, kWidth, 0})};
}

/// How grains roll, slide and are slowed by rolling friction on a slope across seams, seen from the floor.
std::vector<Vec3d> across(const std::vector<WallBody>& bodies, const Vec3d& floor_velocity = {}) {
  GrainBench b = on(bodies);
  b.config.gravity = {1, 0, -9.81};
  b.config.contact.rolling = "epsd", b.config.grain.mu_r = 0.02;
  const double rest = b.R() - b.resting_overlap(b.mass() * 9.81);
  b.motion = [&](int, double t) {
    BodyPose p;
    p.translation = floor_velocity * t, p.v = floor_velocity;
    return p;
  };
  b.add({0.003, -0.02, rest}, Vec3d{0.5, 0, 0} + floor_velocity, {0, 0.5 / b.R(), 0});
  b.add({0.003, 0, rest}, Vec3d{0.5, 0.1, 0} + floor_velocity);
  b.add({0.003, 0.02, rest}, Vec3d{0.3, 0, -0.05} + floor_velocity, {0, 0, 100});
  b.start();
  b.run(1e-5, 6000);
  std::vector<Vec3d> out;
  for (Id id = 0; id < 3; ++id) {
    out.push_back(b.position(id) - floor_velocity * b.time);
    out.push_back(b.spin(id) * b.R());
  }
  return out;
}

TEST(Seams, AreNotFeltByWhatRollsAndSlides) {
  const auto expected = across(whole());
  ASSERT_GT(expected[0].x, 3 * kSeam);
  for (const auto& [name, bodies] : floors())
    for (const Vec3d& v : {Vec3d{}, Vec3d{0.02, 0.1, 0}}) {
      if (norm(v) > 0 && name == "boxes in a plane") continue;  // these move within it
      const auto seen = across(bodies, v);
      for (std::size_t k = 0; k < seen.size(); ++k)
        EXPECT_LT(norm(seen[k] - expected[k]), 1e-4 * norm(expected[k]))  // a degree is one surface: 1.5e-4
            << name << ", at " << norm(v) << " m/s, grain " << k / 2 << (k % 2 ? ", spin" : ", place");
    }
}

TEST(Seams, DoNotChangeTheRebound) {
  for (const auto& [name, bodies] : floors()) {
    GrainBench b = on(bodies);
    b.config.gravity = {}, b.config.grain.e = 0.5;
    for (int k = 0; k < 5; ++k)  // from the seam to a contact's width beside it
      b.add({6 * kSeam + 0.02 * k * b.R(), 4 * k * b.R(), 1.01 * b.R()}, {0, 0, -0.5});
    b.start();
    b.run(1e-6, 1000);
    for (Id id = 0; id < 5; ++id) {
      EXPECT_NEAR(b.velocity(id).z, 0.25, 2e-3) << name << ", grain " << id;
      EXPECT_LT(std::abs(b.velocity(id).x), 2e-3) << name << ", grain " << id;
    }
  }
}

TEST(Seams, HandTheSpringsOfAContactOver) {
  // the least force of friction's spring on a grain that rolls down a slope
  const auto least = [](const std::vector<WallBody>& bodies) {
    GrainBench b = on(bodies);
    b.config.gravity = {3, 0, -9.81};
    b.add({0.0005, 0, b.R() - b.resting_overlap(b.mass() * 9.81)}, {0.3, 0, 0}, {0, 0.3 / b.R(), 0});
    b.start();
    b.run(1e-5, 500);
    double force = 1;
    for (int k = 0; k < 2000; ++k) {
      b.run(1e-5, 1);
      force = std::min(force, -b.force().x / (2.0 / 7 * 3 * b.mass()));
    }
    EXPECT_GT(b.position().x, kSeam);
    return force;
  };
  const double expected = least(whole());
  EXPECT_GT(expected, 0.95);
  for (const auto& [name, bodies] : floors()) EXPECT_NEAR(least(bodies), expected, 1e-3) << name;
}

TEST(Seams, LeaveSurfacesThatDiffer) {
  const auto pressed = [](const std::vector<WallBody>& bodies, const Vec3d& at,
                          const std::function<BodyPose(int, double)>& motion) {
    GrainBench b;
    b.config.wall.bodies = bodies;
    b.motion = motion;
    b.add(at);
    b.start();
    b.run(1e-9, 1);
    return std::pair{b.force(), b.solver->totals(*b.grains).wall_contacts};
  };
  const auto still = [](int, double) { return BodyPose{}; };
  const double R = GrainBench().R(), in = 0.999 * R;
  const WallBody floor = test::body("box", {-0.05, -0.05, -0.02}, {0.05, 0.05, 0}),
                 wall = test::body("box", {-0.07, -0.05, -0.02}, {-0.05, 0.05, 0.05}),
                 stop = test::body("box", {-0.07, -0.05, 0}, {-0.05, 0.05, 0.05});
  for (const WallBody& side : {wall, stop}) {
    const auto [force, contacts] = pressed({floor, side}, {-0.05 + in, 0, in}, still);
    EXPECT_EQ(contacts, 2);
    EXPECT_NEAR(force.x / force.z, 1, 1e-4);
  }
  std::vector<WallBody> slats = {wall};
  for (int k = 0; k < 60; ++k)  // more within the contact than a grain may touch
    slats.push_back(test::body("box", {-0.05 + in + (k - 30) * 4e-3 * R, -0.05, -0.02},
                               {-0.05 + in + (k - 29) * 4e-3 * R, 0.05, 0}));
  const auto [force, contacts] = pressed(slats, {-0.05 + in, 0, in}, still);
  EXPECT_EQ(contacts, 2) << "slats";
  EXPECT_NEAR(force.x / force.z, 1, 1e-4) << "slats";
  for (const double lean : {0.4, 10.0, 45.0, 80.0}) {  // of either side of a groove
    const double angle = lean * M_PI / 180;
    const auto leaning = [&](int body, double) {
      BodyPose p;
      p.rotation = Quat<double>::from_rotation({0, body ? -angle : angle, 0});
      return p;
    };
    const auto [force, contacts] = pressed({floor, floor}, {0, 0, in / std::cos(angle)}, leaning);
    EXPECT_EQ(contacts, lean < 0.5 ? 1 : 2) << lean << " degrees";
  }
}

/// In a bowl of planes each of which it touches, a grain has eight contacts; the others are counted.
TEST(Seams, CountsTheContactsThatAreLeftOut) {
  for (const int planes : {7, 8, 9, 12, 40}) {
    GrainBench b;
    const double R = b.R();
    for (int k = 0; k < planes; ++k) {
      const double angle = 2 * M_PI * k / planes, lean = 0.5 + 0.2 * (k % 2);
      const Vec3d normal{std::sin(lean) * std::cos(angle), std::sin(lean) * std::sin(angle), std::cos(lean)};
      b.plane(-(0.999 - 1e-5 * k) * R * normal, normal);
    }
    b.add({0, 0, 0});
    b.add({0, 0, 5 * R});
    b.start();
    EXPECT_EQ(b.solver->dropped_contacts(*b.grains, b.poses()), std::max(0, planes - 8)) << planes;
    EXPECT_EQ(b.solver->totals(*b.grains).wall_contacts, std::min(planes, 8));
  }
}

TEST(Seams, OfBodiesThatMoveApartAreTrue) {
  const WallBody left = test::body("box", {-0.05, -0.05, -0.02}, {0, 0.05, 0}),
                 right = test::body("box", {0, -0.05, -0.02}, {0.05, 0.05, 0});
  // beside the seam, of which the right side rises, sinks or slides
  const auto force = [&](double x, const Vec3d& shift, const Vec3d& velocity) {
    GrainBench b;
    b.config.wall.bodies = {left, right};
    b.motion = [&](int body, double) {
      BodyPose p;
      if (body == 1) p.translation = shift, p.v = velocity;
      return p;
    };
    b.add({x, 0, 0.999 * b.R()});
    b.start();
    b.run(1e-7, 1);
    return b.force();
  };
  const double R = GrainBench().R(), alone = force(-5 * R, {}, {}).z, x = 0.01 * R;
  EXPECT_NEAR(force(-x, {}, {}).z / alone, 1, 1e-4);
  EXPECT_NEAR(force(x, {0, 0, -0.01}, {}).z / alone, std::pow(0.95, 1.5), 1e-3) << "the edge that is left";
  EXPECT_GT(force(x, {0, 0, 1e-3 * R}, {}).z / alone, 2) << "it has risen";
  EXPECT_LT(norm(force(-x, {}, {0, 1, 0}) - Vec3d{0, 0, alone}), 1e-3 * alone) << "the left one is still";
  EXPECT_GT(force(x, {}, {0, 1, 0}).y, 1e-3 * alone) << "the right one drags";
}

TEST(Seams, BetweenMaterialsGiveNoEnergy) {
  // a grain that is stuck on a soft floor takes its spring to a hard one
  Config c;
  c.grain.d = 2.7e-3;
  c.wall.bodies = {test::body("box", {}, {1, 1, 1}), test::body("box", {}, {1, 1, 1})};
  c.wall.bodies[1].E = 1e12, c.wall.bodies[1].mu = 2;
  const Real R = Real(1.35e-3), m = Real(2.5e-5);
  for (const char* law : {"mindlin", "mindlin_deresiewicz", "linear"}) {
    c.contact.tangential = law, c.grain.mu_r = 0.1;
    const SolidParameters p = solid_parameters(c);
    const auto sideways = [&](const ContactLaw& of, const ContactHistory& h) {
      ContactHistory bare = h;
      bare.xi = bare.couple = {};
      return of.stored(R, m, h) - of.stored(R, m, bare);
    };
    for (int from : {0, 1}) {
      const ContactLaw &left = p.wall_laws[from], &now = p.wall_laws[1 - from];
      ContactHistory h{{1e-7, 2e-7, 0}, {0, 1e-9, 0}, 1e-6};
      const double had = sideways(left, h);
      now.take_over(left, R, m, h);
      EXPECT_LE(sideways(now, h), had * (1 + 1e-5)) << law;
      EXPECT_GT(norm(h.xi), 0) << law;
    }
  }
}

}  // namespace
}  // namespace BL_SOLVER
