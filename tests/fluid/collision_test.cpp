// Fluid particles that come too near collide.
#include <gtest/gtest.h>

#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Particles on a line along x in a periodic box, m and m/s, of their masses in kg.
struct Line : FluidBox {
  Line(const Config& c, const std::vector<double>& x, const std::vector<double>& v,
       const std::vector<double>& m)
      : FluidBox(c) {
    position.clear(), velocity.clear(), mass.clear(), s.clear();
    for (std::size_t k = 0; k < x.size(); ++k) add({x[k], 0.05, 0.05}, {v[k], 0.3, 0}, m[k]);
    upload();
    solver->collide(fluid);
  }
  std::vector<double> speeds() const {
    std::vector<double> out(position.size());
    const auto id = fluid.id.values();
    const auto now = fluid.v_rho.values();
    for (std::size_t a = 0; a < id.size(); ++a) out[id[a]] = now[a].v.x;
    return out;
  }
};

Config colliding(double range, double restitution) {
  Config c = periodic_box(10);
  c.visc.collision = true;
  c.visc.collision_range = range, c.visc.collision_restitution = restitution;
  return c;
}

TEST(CollisionSmall, PairsReboundWithTheirMomentum) {
  const Config c = colliding(0.5, 0.2);
  const Line hit(c, {0.05, 0.054}, {1, -0.5}, {1e-3, 3e-3});
  const auto v = hit.speeds();
  EXPECT_NEAR(1e-3 * v[0] + 3e-3 * v[1], 1e-3 * 1 - 3e-3 * 0.5, 1e-9);
  EXPECT_NEAR(v[1] - v[0], 0.2 * 1.5, 1e-5);
  EXPECT_EQ(Line(c, {0.05, 0.056}, {1, -0.5}, {1e-3, 3e-3}).speeds()[0], 1) << "farther apart than the range";
  EXPECT_EQ(Line(c, {0.05, 0.054}, {-1, 0.5}, {1e-3, 3e-3}).speeds()[0], -1) << "parting";
}

TEST(CollisionSmall, ManyAtOnceAreShared) {
  // one that runs into two: half an impulse from each, and none of them is turned round twice
  const Config c = colliding(0.6, 0);
  const auto v = Line(c, {0.05, 0.054, 0.0555}, {1, 0, 0}, {1e-3, 1e-3, 1e-3}).speeds();
  EXPECT_NEAR(v[0], 0.5, 1e-6);
  EXPECT_NEAR(v[1], 0.25, 1e-6);
  EXPECT_NEAR(v[2], 0.25, 1e-6);
}

TEST(Collision, KeepsTheMomentumOfAFluidAndTakesEnergy) {
  Config c = colliding(1, 0.5);
  FluidBox box(c, 0.5, true);
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  for (Vec3d& v : box.velocity) v = {normal(rng), normal(rng), normal(rng)};
  box.upload();
  const auto sums = [&] {
    Vec3d p;
    double energy = 0, scale = 0;
    const auto m = box.fluid.mass.values();
    const auto v = box.fluid.v_rho.values();
    for (std::size_t a = 0; a < m.size(); ++a) {
      const Vec3d u = Vec3d(v[a].v);
      p += double(m[a]) * u, energy += 0.5 * m[a] * norm2(u), scale += m[a] * norm(u);
    }
    return std::tuple(p, energy, scale);
  };
  const auto [p0, e0, scale] = sums();
  box.solver->collide(box.fluid);
  const auto [p1, e1, same] = sums();
  EXPECT_LT(norm(p1 - p0), kInvariant * scale);
  EXPECT_LT(e1, 0.95 * e0);
}

}  // namespace
}  // namespace BL_SOLVER
