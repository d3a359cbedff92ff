// Viscous accelerations of one pair, by hand.

#include <gtest/gtest.h>

#include "kernels/fluid/collision_pass.hpp"
#include "kernels/fluid/drive.hpp"
#include "kernels/fluid/pair_terms.hpp"
#include "kernels/fluid/shifting.hpp"
#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kNear = tolerance(1e-11, 1e-5, 1e-5);

TEST(Viscosity, OfAPairByHand) {
  const double mu = 2, M = 0.4, rho_a = 1010, rho_b = 990;
  const Real3 r{Real(0.03), 0, Real(0.04)}, v{Real(0.5), Real(-1), Real(2)};
  for (const double thickness : {0.0, 0.01}) {
    const WendlandC2 w(0.05, thickness);
    const double F = w.F(Real(0.05)), k = -M * 2 * mu * F / (rho_a * rho_b);
    const auto of = [&](ViscosityModel model) {
      return Vec3d(Viscosity::of(model, mu, 1000, 20, w)(Real(M), Real(rho_a), Real(rho_b), v, r, norm2(r),
                                                         w.F(Real(0.05))));
    };
    EXPECT_LT(norm(of(ViscosityModel::morris) / k - Vec3d(v)), kNear);
    const double d = thickness > 0 ? 2 : 3;
    // r^2 + 1e-4 h^2
    const double along = (d + 2) * dot(Vec3d(v), Vec3d(r)) / (0.0025 * (1 + 1e-4));
    EXPECT_LT(norm(of(ViscosityModel::monaghan) / k - along * Vec3d(r)), 3 * kNear) << d;
    EXPECT_FALSE(Viscosity::of(ViscosityModel::none, mu, 1000, 20, w).acts());
  }
}

/// |S|^2 = S : S, S being the symmetric part of the gradient; simple shear at the rate g: g / sqrt 2.
TEST(Shifting, StrainIsTheNormOfTheSymmetricPart) {
  Strain<Real> shear{};
  shear.add(Real(1), {0, 0, 3}, {1, 0, 0});  // dv_z / dx
  EXPECT_NEAR(shear.magnitude(), 3 / std::sqrt(2.0), 1e-5);
  Strain<Real> turn{};
  turn.add(Real(1), {0, 0, 3}, {1, 0, 0});
  turn.add(Real(1), {-3, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(turn.magnitude(), 0, 1e-6);
  Strain<Real> pull{};
  pull.add(Real(2), {1, 0, 0}, {1, 0, 0});
  pull.add(Real(1), {0, -2, 0}, {0, 1, 0});
  EXPECT_NEAR(pull.magnitude(), std::sqrt(8.0), 1e-5);
}

TEST(Shifting, StopsInTheOutermostLayer) {
  EXPECT_EQ(Shifting::inside(Real(0.15)), 1);
  EXPECT_NEAR(Shifting::inside(Real(0.25)), 0.5, 1e-5);
  EXPECT_EQ(Shifting::inside(Real(0.31)), 0);
  EXPECT_EQ(Shifting::inside(Real(0.9)), 0);
}

/// A force per volume of 300 N/m3 on fluid of 1.5 kg and 1000 kg/m3 at a porosity of 0.4, m/s2.
double driven(DriveMode mode, bool shared) {
  const std::vector<FluidPosition> x(1);
  const Drive drive{{{{-1, -1, -1}, {1, 1, 1}, false, false, false}, {0, 0, 300}, {}, -1},
                    {x.data(), 1},
                    mode,
                    shared,
                    {},
                    {},
                    false};
  return drive(0, {Real(1.5 / 0.4), 0, 1000, Real(0.4)}).z;
}

/// On fluid alone all of a force per volume is the fluid's; with grains each takes that of its own volume.
TEST(Drive, OfFluidByVolumeMassOrParticle) {
  EXPECT_NEAR(driven(DriveMode::volume, false), 300 / (0.4 * 1000), 1e-5);
  EXPECT_NEAR(driven(DriveMode::volume, true), 300 / 1000.0, 1e-5);
  EXPECT_NEAR(driven(DriveMode::mass, false), 300, 1e-4);
  EXPECT_NEAR(driven(DriveMode::particle, false), 300 / 1.5, 1e-4);
}

/// Change of velocity of 2 kg of fluid by 6 kg that it nears at 1 m/s.
double struck(double restitution, double pairs) {
  std::vector<VelocityDensity<>> v{{{0, 0, -1}, 1000}, {{}, 1000}}, next(2);
  std::vector<Real> mass{2, 6}, count{1, Real(pairs)};
  const auto all = [](auto& of) { return Span(of.data(), Index(of.size())); };
  const CollisionPass pass{.range2 = Real(0.01),
                           .restitution = Real(restitution),
                           .guard = Real(1e-14),
                           .v_rho = all(v),
                           .mass = all(mass),
                           .count = all(count),
                           .v_next = all(next)};
  auto sum = pass.start(0);
  const Real3 r{0, 0, Real(0.05)};
  pass.pair(sum, r, norm2(r), Real(1), v[1], mass[1], count[1]);
  pass.finish(0, sum);
  return double(next[0].v.z) + 1;
}

TEST(Collision, ExchangesTheImpulseOfBalls) {
  EXPECT_NEAR(struck(0, 1), 0.75, 1e-5);
  EXPECT_NEAR(struck(0.5, 1), 1.5 * 0.75, 1e-5);
  EXPECT_NEAR(struck(0.5, 3), 0.5 * 0.75, 1e-5);
}

}  // namespace
}  // namespace BL_SOLVER
