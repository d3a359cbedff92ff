// What continuity, diffusion and voids do to the density of one particle, pair by pair, by hand.

#include <gtest/gtest.h>

#include "kernels/fluid/density_pass.hpp"
#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kRho0 = 1000, kH = 0.1, kDt = 1e-3;
constexpr double kRounding = tolerance(1e-12, 1e-5, 1e-5);  // of differences of numbers near one

/// Particle a at the origin, its neighbour b at -r, a wall particle at -r_w.
struct Pair {
  WendlandC2 w{kH};
  Real3 r{Real(0.05), Real(-0.02), Real(0.04)}, r_w{Real(-0.03), Real(0.06), Real(-0.05)};
  double diffusion = 0, stiffening = 5, least = -0.02, fading = 0, spreading = 0;
  Vec3d hydrostatic;
  std::vector<VelocityDensity<>> flux, wall_v_rho;
  std::vector<EosState<>> eos_state;
  std::vector<WallState<>> wall_state;
  std::vector<Real> s{0}, s_new{0}, rate{0}, wall_work{0};

  /// Masses over porosity as fractions of what fills the kernel's cube of h / 2, densities over rho0.
  Pair(double fill_a, double fill_b, double rho_a = 1, double rho_b = 1, double eps_a = 1, double eps_b = 1) {
    const double M = kRho0 * cube(kH / 2);
    flux = {{{}, Real(kRho0 * rho_a)}, {{}, Real(kRho0 * rho_b)}};
    eos_state = {{Real(fill_a * M), 0, Real(kRho0 * rho_a), Real(eps_a)},
                 {Real(fill_b * M), 0, Real(kRho0 * rho_b), Real(eps_b)}};
  }
  double volume(int k) const { return eos_state[k].mass_over_eps / eos_state[k].rho; }
  double F() const { return w.F(std::sqrt(norm2(r))); }
  double W() const { return w.W(std::sqrt(norm2(r))); }
  /// What the two fill of the kernel.
  double filled() const { return volume(0) * double(w.W(Real(0))) + volume(1) * W(); }
  double void_fraction() const {
    const double gradient = volume(1) * F() * double(norm(r));
    return 1 - filled() - double(CutFraction::of(w)(Real(gradient)));
  }

  template <bool kSmooth, bool kPorous>
  auto pass() {
    const auto in = [](const auto& host) { return Span(host.data(), Index(host.size())); };
    const auto out = [](auto& host) { return Span(host.data(), Index(host.size())); };
    return DensityPass<WendlandC2, NoShifting, NoFit, kSmooth, kPorous, OneLength>{
        .w = w,
        .fluid = {in(flux), in(eos_state)},
        .walls = {in(wall_v_rho), in(wall_state), {}},
        .diffusion = Real(diffusion),
        .hydrostatic = Real3(hydrostatic),
        .stiffening = Real(stiffening),
        .rho0 = Real(kRho0),
        .dt = Real(kDt),
        .compression = in(s),
        .compression_new = out(s_new),
        .cut = CutFraction::of(w),
        .least = Real(least),
        .fading = Real(fading),
        .spreading = Real(spreading),
        .compression_rate = out(rate),
        .shift = {},
        .drift = {},
        .fit = {},
        .lengths = {},
        .wall_work = in(wall_work)};
  }
  /// By how much s of a changes over the step.
  template <bool kSmooth = true, bool kPorous = true>
  double change() {
    const auto p = pass<kSmooth, kPorous>();
    auto sum = p.start(0);
    p.pair(sum, r, norm2(r), eos_state[1].mass_over_eps, flux[1], eos_state[1], Unread{});
    if (!wall_state.empty()) p.wall_pair(sum, r_w, norm2(r_w), wall_v_rho[0], wall_state[0], wall_work[0]);
    p.finish(0, sum);
    return double(s_new[0]) - double(s[0]);
  }
  /// The same of b.
  double change_of_other() {
    Pair other = *this;
    std::swap(other.flux[0], other.flux[1]);
    std::swap(other.eos_state[0], other.eos_state[1]);
    other.r = -r;
    return other.change();
  }
};

#define EXPECT_CHANGE(found, expected) EXPECT_NEAR(found, expected, 5 * kRounding * std::abs(expected) + 1e-9)

TEST(DensityPass, ContinuityIsThatOfTheFluxOverThePorosity) {
  Pair p(1, 0.8, 1, 1.01, 0.6, 0.9);
  p.flux[0] = {{Real(0.3), Real(-0.2), Real(0.5)}, p.flux[0].rho};
  p.flux[1] = {{Real(-0.1), Real(0.4), Real(0.2)}, p.flux[1].rho};
  const double rate = double(p.eos_state[1].mass_over_eps) * p.F() * dot(Vec3d{0.4, -0.6, 0.3}, Vec3d(p.r));
  const double expected = -kDt * rate / (0.6 * kRho0);
  EXPECT_CHANGE((p.change<false, true>()), expected);
  EXPECT_CHANGE(kDt * p.rate[0], expected);
  EXPECT_CHANGE((p.change<true, true>()), expected);
}

TEST(DensityPass, WallsCountByTheirVolumeAtRestOrByTheirMass) {
  Pair p(1, 0);
  p.flux[0] = {{Real(0.3), Real(-0.2), Real(0.5)}, Real(kRho0)};
  p.wall_v_rho = {{{Real(0.1), Real(0.1), Real(-0.1)}, Real(1040)}};
  const double F = p.w.F(std::sqrt(norm2(p.r_w))), M = kRho0 * cube(kH / 2);
  const double apart = dot(Vec3d{0.2, -0.3, 0.6}, Vec3d(p.r_w));
  p.wall_state = {{.mass = Real(1.04 * M), .rho = 1040}};  // extrapolated: as much as at rho0
  EXPECT_CHANGE((p.change<false, true>()), -kDt * M * F * apart / kRho0);
  p.wall_state[0].frozen = 1;  // frozen: as much as it has
  EXPECT_CHANGE((p.change<false, true>()), -kDt * 1.04 * M * F * apart / kRho0);
}

TEST(DensityPass, FluidPaysForTheWorkOfItsWalls) {
  Pair p(1, 0, 1.02, 1, 0.6);
  p.wall_v_rho = {{{}, Real(kRho0)}};
  p.wall_state = {{.mass = Real(kRho0 * cube(kH / 2)), .rho = Real(kRho0)}};
  p.wall_work = {Real(0.03 * cube(kH) * cube(kH))};
  const double rate = square(1.02 * kRho0) / double(p.eos_state[0].mass_over_eps) * double(p.wall_work[0]) *
                      double(p.w.W(std::sqrt(norm2(p.r_w))));
  EXPECT_CHANGE((p.change<false, true>()), -kDt * rate / (0.6 * kRho0));
}

TEST(DensityPass, DiffusionTakesTheMeanPorosityAndTheSlopeAtTheMeanDensity) {
  Pair p(1, 0.8, 1.02, 1.05, 0.6, 0.9);
  p.diffusion = 0.3;
  p.hydrostatic = {100, 200, -400};
  const double still = 1 - 5 * 0.035;  // (rho0 / rho)^(gamma - 2)
  const double slope = 1050 - 1020 + still * dot(p.hydrostatic, Vec3d(p.r));
  const double diffused = 0.75 * p.volume(1) * p.F() * slope;
  EXPECT_CHANGE(p.change(), kDt * 0.3 * diffused / (0.6 * kRho0));
}

TEST(DensityPass, DiffusionKeepsWhatAPairHasTogether) {
  Pair p(1, 0.8, 0.99, 1.03, 0.6, 0.9);
  p.diffusion = 0.3;
  p.hydrostatic = {0, 0, -400};
  // eps V ds, what a particle gains of mass at its volume
  const double a = 0.6 * p.volume(0) * p.change(), b = 0.9 * p.volume(1) * p.change_of_other();
  EXPECT_GT(std::abs(a), 0);
  EXPECT_NEAR(a, -b, 10 * kRounding * std::abs(a));
}

TEST(DensityPass, DensityGrowsByWhatOverfillsTheKernelBeyondTwoPercent) {
  const double alone = cube(kH / 2) * double(WendlandC2(kH).W(Real(0)));  // of the kernel
  for (const double beyond : {-0.01, -0.001, 0.001, 0.03}) {
    Pair p(1, 0);
    p.spreading = 40;
    const double both = 1.02 + beyond, W = cube(kH / 2) * p.W();
    p.eos_state[1].mass_over_eps = Real((both - alone) / W * kRho0 * cube(kH / 2));
    ASSERT_NEAR(p.filled(), both, 1e-5);
    EXPECT_NEAR(p.change(), beyond > 0 ? kDt * 40 * beyond : 0, kDt * 40 * 3e-6) << beyond;
  }
}

TEST(DensityPass, PressureFadesWhereThereIsAVoidAndSuctionStays) {
  Pair p(1.5, 1.5);
  p.fading = 200;
  const double empty = p.void_fraction();
  ASSERT_GT(empty, 0.05);
  p.s[0] = Real(0.03);
  EXPECT_CHANGE(p.change(), -kDt * 200 * empty * 0.03);
  p.fading = 1e9;  // no further than to rest
  EXPECT_CHANGE(p.change(), -0.03);
  p.s[0] = Real(-0.01);
  EXPECT_EQ(p.change(), 0) << "stretched, not fragmented";
}

TEST(DensityPass, FragmentedFluidFollowsItsVoidBeyondTwoPercent) {
  Pair p(1.5, 1.5);
  p.fading = 200;
  p.s[0] = Real(-0.3);
  const double empty = p.void_fraction();
  ASSERT_GT(empty, 0.05);
  EXPECT_CHANGE(p.change(), kDt * 200 * (0.02 - empty + 0.3));
  p.fading = 1e9;  // at once
  EXPECT_CHANGE(p.change(), 0.02 - empty + 0.3);
  Pair whole(1.5, 45);  // no void: as far as it cavitates, no further
  ASSERT_LT(whole.void_fraction(), 0.02);
  whole.fading = 200;
  whole.s[0] = Real(-0.3);
  EXPECT_CHANGE(whole.change(), kDt * 200 * (-0.02 + 0.3));
}

}  // namespace
}  // namespace BL_SOLVER
