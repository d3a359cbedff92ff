// Mass, centre and inertia of solids; the balls by which they touch.

#include <gtest/gtest.h>

#include "bedload/core/error.hpp"
#include "bedload/geometry/body.hpp"
#include "mesh_support.hpp"
#include "tests/support/walls.hpp"

namespace bedload::test {
namespace {

WallBody body_of(ShapePtr shape, double density = 1000) {
  WallBody b = shaped("shape", shape);
  b.free.present = true;
  b.free.density = density;
  return b;
}
void expect_mass(const MassProperties& m, double mass, const Vec3d& centre,
                 const std::array<double, 6>& inertia, double near) {
  double size = 0;
  for (const double j : inertia) size = std::max(size, std::abs(j));
  EXPECT_NEAR(m.mass / mass, 1, near);
  EXPECT_LT(norm(m.centre - centre), near * std::sqrt(size / mass));
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(m.inertia[k], inertia[k], near * size) << k;
}

constexpr double kPi = 3.14159265358979323846;

TEST(BodyMass, OfPrimitivesIsAsInTables) {
  const double near = 1e-12;
  const MassProperties box = mass_properties(body_of(make_box({0, 0, 0}, {0.1, 0.2, 0.4})));
  expect_mass(box, 8, {0.05, 0.1, 0.2}, {8 / 12.0 * 0.2, 8 / 12.0 * 0.17, 8 / 12.0 * 0.05, 0, 0, 0}, near);

  const double ball = 1000 * 4.0 / 3 * kPi * 0.027, j = 0.4 * ball * 0.09;
  expect_mass(mass_properties(body_of(make_sphere({1, 2, 3}, 0.3))), ball, {1, 2, 3}, {j, j, j, 0, 0, 0},
              near);

  const double rod = 1000 * kPi * 0.01 * 0.5, across = rod * (3 * 0.01 + 0.25) / 12;
  expect_mass(mass_properties(body_of(make_cylinder({0, 0, 1}, {0.5, 0, 1}, 0.1))), rod, {0.25, 0, 1},
              {rod * 0.005, across, across, 0, 0, 0}, near);

  const double cone = 1000 * kPi * 0.01 * 0.4 / 3;
  const double side = cone * (3 / 20.0 * 0.01 + 3 / 80.0 * 0.16);
  expect_mass(mass_properties(body_of(make_cone({0, 0, 0}, {0, 0, 0.4}, 0.1, 0))), cone, {0, 0, 0.1},
              {side, side, 0.3 * cone * 0.01, 0, 0, 0}, near);

  const double tube = 1000 * kPi * (0.04 - 0.01) * 0.3, wall = tube * (3 * 0.05 + 0.09) / 12;
  expect_mass(mass_properties(body_of(make_pipe({0, 0, 0}, {0, 0, 0.3}, 0.1, 0.2, PipeEnds::open))), tube,
              {0, 0, 0.15}, {wall, wall, tube * 0.05 / 2, 0, 0, 0}, near);

  // a cylinder and two half balls, whose centres lie 3/8 R beyond its ends
  const double R = 0.1, L = 0.3, c = 1000 * kPi * R * R * L, h = 1000 * 2.0 / 3 * kPi * R * R * R;
  const double end = L / 2 + 3.0 / 8 * R;
  const double perp = c * (3 * R * R + L * L) / 12 + 2 * h * (83.0 / 320 * R * R + end * end);
  expect_mass(mass_properties(body_of(make_capsule({0, 0, -0.15}, {0, 0, 0.15}, R))), c + 2 * h, {},
              {perp, perp, c * R * R / 2 + 0.8 * h * R * R, 0, 0, 0}, near);
}

TEST(BodyMass, OfATurnedMeshIsThatOfTheSolid) {
  Placement p;
  p.scale = 0.5;
  p.rotation = Quat<double>::from_rotation({0, 0, kPi / 4});
  p.translation = {1, -2, 0.5};
  const auto mesh =
      mass_properties(body_of(make_placed(std::make_shared<TriangleMesh>(cube(0.2), "cube"), p)));
  EXPECT_GT(mesh.mass, 0);
  const Bounds own = TriangleMesh(cube(0.2), "cube").bounds();
  const auto box = mass_properties(body_of(make_placed(make_box(own.min, own.max), p)));
  expect_mass(mesh, box.mass, box.centre, box.inertia, 1e-12);
  // unequal sides give products of inertia: about 45 degrees, half the difference of the two moments
  const auto slab = mass_properties(body_of(make_placed(make_box({-2, -1, -1}, {2, 1, 1}), p)));
  const double m = slab.mass;
  EXPECT_NEAR(slab.inertia[3] / m, -(4.0 - 1.0) / 12 / 2, 1e-12) << "Ixy = -integral of x y dm";
}

TEST(BodyMass, OfUnionsAndVesselsComesFromARaster) {
  const auto overlapping =
      make_union({make_box({0, 0, 0}, {0.2, 0.1, 0.1}), make_box({0.1, 0, 0}, {0.3, 0.1, 0.1})});
  expect_mass(mass_properties(body_of(overlapping)), 3, {0.15, 0.05, 0.05},
              {3 * 0.02 / 12, 3 * 0.1 / 12, 3 * 0.1 / 12, 0, 0, 0}, 1e-2);
  const double shell = 1000 * 4.0 / 3 * kPi * (0.15 * 0.15 * 0.15 - 0.001),
               j = 0.4 * shell * (std::pow(0.15, 5) - 1e-5) / (0.15 * 0.15 * 0.15 - 0.001);
  expect_mass(mass_properties(body_of(make_hollow(make_sphere({}, 0.1), 0.05))), shell, {},
              {j, j, j, 0, 0, 0}, 1e-2);
}

TEST(BodyMass, OfASliceIsThatOfItsSlab) {
  DomainConfig plane;
  plane.min = {-1, 0, -1}, plane.max = {1, 0.3, 1};
  plane.two_d = true;
  // moments about y alone count there
  const auto expect_slab = [&](ShapePtr shape, double area, const Vec3d& centre, double moment) {
    const MassProperties m = mass_properties(body_of(shape), plane);
    EXPECT_NEAR(m.mass / (1000 * area * 0.3), 1, 1e-4);
    EXPECT_LT(norm(m.centre - centre), 1e-4 * std::sqrt(area));
    EXPECT_EQ(m.centre.y, 0.15);
    EXPECT_NEAR(m.inertia[1] / (m.mass * moment), 1, 1e-4);
    EXPECT_NEAR(m.inertia[0] + m.inertia[2] - m.inertia[1], m.mass * 0.3 * 0.3 / 6, 1e-4 * m.mass * 0.015);
  };
  const double disc = kPi * 0.01, low = kPi * (0.04 - 0.0225);
  expect_slab(make_cylinder({0.1, -2, 0.2}, {0.1, 2, 0.2}, 0.1), disc, {0.1, 0.15, 0.2}, 0.005);
  expect_slab(make_sphere({0.1, 0, 0.2}, 0.2), low, {0.1, 0.15, 0.2}, (0.04 - 0.0225) / 2);
  Placement turned;
  turned.rotation = Quat<double>::from_rotation({0, 0.4, 0});
  turned.translation = {0.3, 0, -0.2};
  const auto mesh = std::make_shared<TriangleMesh>(cube(0.4), "cube");
  const Vec3d middle = 0.5 * (mesh->bounds().min + mesh->bounds().max);
  Vec3d centre = turned.rotation.rotate(middle) + turned.translation;
  centre.y = 0.15;
  expect_slab(make_placed(mesh, turned), 0.16, centre, 0.16 / 6);
}

TEST(BodyMass, TakesWhatIsGivenAndAsksForTheRest) {
  WallBody b = body_of(make_box({0, 0, 0}, {1, 1, 1}), 0);
  b.free.mass = 6;
  expect_mass(mass_properties(b), 6, {0.5, 0.5, 0.5}, {1, 1, 1, 0, 0, 0}, 1e-12);
  b.free.centre_of_mass = {0.5, 0.5, 0.25};
  b.free.inertia = {1, 2, 2.5, 0, 0.1, 0};
  expect_mass(mass_properties(b), 6, {0.5, 0.5, 0.25}, {1, 2, 2.5, 0, 0.1, 0}, 1e-15);
  b.solid.shape = nullptr;
  b.shape = "tank";
  EXPECT_NO_THROW(mass_properties(b));
  b.free.inertia.clear();
  EXPECT_THROW(mass_properties(b), CaseError);
}

TEST(BodyMass, PrincipalAxesTurnItBack) {
  const std::array<double, 6> j{2, 3, 4, 0.3, -0.2, 0.5};
  const PrincipalInertia p = principal_inertia(j);
  for (const Vec3d& v : {Vec3d{1, 0, 0}, {0, 1, 0}, {0.3, -2, 1}}) {
    const Vec3d w = p.axes.conjugate().rotate(v);
    const Vec3d got = p.axes.rotate({p.moments.x * w.x, p.moments.y * w.y, p.moments.z * w.z});
    const Vec3d want{j[0] * v.x + j[3] * v.y + j[4] * v.z, j[3] * v.x + j[1] * v.y + j[5] * v.z,
                     j[4] * v.x + j[5] * v.y + j[2] * v.z};
    EXPECT_LT(norm(got - want), 1e-14);
  }
}

TEST(BodyBalls, OfAPlaneFlowLieInItsMiddle) {
  DomainConfig plane;
  plane.max = {1, 0.3, 1};
  plane.two_d = true;
  for (const ShapePtr& shape :
       {make_box({0, -1, 0}, {0.2, 1, 0.3}), make_capsule({0.5, -1, 0.5}, {0.5, 1, 0.5}, 0.1)}) {
    WallBody b = body_of(shape);
    b.free.contact_spacing = 0.02;
    const auto balls = contact_balls(b, plane);
    EXPECT_GT(balls.size(), 25u);
    for (const BodyBall& ball : balls) {
      EXPECT_EQ(ball.centre.y, 0.15);
      EXPECT_NEAR(ball.radius, -shape->distance(ball.centre), 1e-12);
    }
  }
}

TEST(BodyBalls, TouchTheSurfaceFromWithin) {
  DomainConfig domain;
  domain.max = {1, 1, 1};
  for (const ShapePtr& shape :
       {make_box({0, 0, 0}, {0.2, 0.1, 0.3}), make_cylinder({0, 0, 0}, {0, 0, 0.2}, 0.1)}) {
    WallBody b = body_of(shape);
    b.free.contact_spacing = 0.02;
    const auto balls = contact_balls(b, domain);
    Bounds reached;
    for (const BodyBall& ball : balls) {
      EXPECT_NEAR(ball.radius, -shape->distance(ball.centre), 1e-12);
      EXPECT_LT(ball.radius, 0.021);
      reached.add(ball.centre + Vec3d{ball.radius, ball.radius, ball.radius});
      reached.add(ball.centre - Vec3d{ball.radius, ball.radius, ball.radius});
    }
    RandomPoints random(shape->bounds());
    for (int n = 0; n < 200; ++n) {
      const Vec3d at = shape->nearest(random()).point;
      double gap = 1;
      for (const BodyBall& ball : balls) gap = std::min(gap, norm(ball.centre - at) - ball.radius);
      EXPECT_LT(gap, b.free.contact_spacing)
          << "no ball near (" << at.x << ", " << at.y << ", " << at.z << ")";
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(reached.min[k], shape->bounds().min[k], 2e-3);
      EXPECT_NEAR(reached.max[k], shape->bounds().max[k], 2e-3);
    }
  }
  const auto lone = contact_balls(body_of(make_sphere({1, 2, 3}, 0.5)), domain);
  ASSERT_EQ(lone.size(), 1u);
  EXPECT_EQ(lone[0].radius, 0.5);
  EXPECT_EQ(lone[0].centre, Vec3d(1, 2, 3));
}

}  // namespace
}  // namespace bedload::test
