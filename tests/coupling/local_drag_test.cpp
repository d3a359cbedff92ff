// Drag where the slip or the bed differs within the reach of the coupling: jets, and beds beside orifices.
#include <gtest/gtest.h>

#include <tuple>

#include "kernels/coupling/drag_pass.hpp"
#include "kernels/drag/di_felice.hpp"
#include "kernels/drag/ergun.hpp"
#include "tests/support/coupled_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

TEST(DragLine, MeetsTheLawAtBothSlipsAndStaysPositive) {
  const auto di_felice = [](Real w) { return DiFelice{}.K(Real(0.45), Real(1e-3), 1000, Real(1e-3), w); };
  const DragLine line = drag_line(di_felice, Real(0.1), Real(1.5));
  EXPECT_GT(line.slope, 0);
  EXPECT_FALSE(line.limited);
  EXPECT_NEAR(line.at(Real(0.1)) / di_felice(Real(0.1)), 1, kInvariant);
  EXPECT_NEAR(line.at(Real(1.5)) / di_felice(Real(1.5)), 1, kInvariant);
  // what falls with the slip, and what rises faster than it
  const DragLine flat = drag_line([](Real w) { return 2 - w; }, Real(0.1), Real(0.5));
  EXPECT_EQ(flat.slope, 0);
  EXPECT_TRUE(flat.limited);
  EXPECT_NEAR(flat.still, 1.5, kInvariant);
  const DragLine steep = drag_line([](Real w) { return w * w; }, Real(0.1), Real(0.5));
  EXPECT_NEAR(steep.still, 0, kInvariant);
  EXPECT_NEAR(steep.slope, 0.5, kInvariant);
  EXPECT_TRUE(steep.limited);
  // in proportion, and not at all, to rounding
  EXPECT_FALSE(drag_line([](Real w) { return Real(0.3) * w; }, Real(0.1), Real(0.5)).limited);
  EXPECT_FALSE(drag_line([](Real) { return Real(0.3); }, Real(0.1), Real(0.5)).limited);
  // one slip, known to rounding
  const DragLine one = drag_line(di_felice, Real(0.1), Real(0.1 * (1 + 4 * kInvariant)));
  EXPECT_EQ(one.slope, 0);
  EXPECT_FALSE(one.limited);
  EXPECT_NEAR(one.still / di_felice(Real(0.1)), 1, 4 * kInvariant);
}

/// Creeping flow through a dense bed, half of it twice as fast: Di Felice's drag falls with the slip, as its
/// power of the porosity does. Faster fluid has more drag; so has fluid without a bed.
TEST(LocalDrag, CountsGrainsWhoseDragFallsWithTheSlip) {
  const double d = 0.06, dx = 0.02;
  for (const auto& [slip, eps, speed, expected] : {std::tuple{"local", 0.3, 0.5, 2},
                                                   {"local", 0.3, 500.0, 0},
                                                   {"local", 0.9, 0.5, 0},
                                                   {"mean", 0.3, 0.5, 0}}) {
    Config c = unit_box(0.12, 1e-3);
    c.couple.slip = slip;
    Cloud fluid = fluid_at(lattice({0, 0, 0}, {1, 1, 1}, dx), dx, 1000, eps);
    for (std::size_t a = 0; a < fluid.x.size(); ++a)
      fluid.v[a] = {0, 0, (fluid.x[a].x < 0.5 ? 1 : 2) * speed * 1e-3 / (1000 * d)};
    CoupledBox box(c, fluid, {{{0.5, 0.5, 0.5}, {0.5, 0.6, 0.4}}, {{}, {}}, {{}, {}}, {d / 2, d / 2}});
    EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).bent, 0u) << "before any is looked at";
    box.coupling.gather(box.fluid, box.grains, {}, 1e-6);
    EXPECT_EQ(int(box.coupling.counters(box.fluid, box.grains).bent), expected)
        << slip << " " << eps << " " << speed;
  }
}

/// A grain in fluid that rests but for a jet along z, with the fraction of its weights that the jet has.
TEST(LocalDrag, AJetPushesByItsOwnSpeed) {
  const double d = 0.06, dx = 0.02, mu = 1e-3;
  const Vec3d speed{0, 0, 2};
  for (const bool local : {true, false}) {
    Config c = unit_box(0.12, mu);
    c.couple.angmom = false;  // with it, the jet's velocity at the grain's centre counts
    c.couple.slip = local ? "local" : "mean";
    Cloud fluid = fluid_at(lattice({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}, dx), dx, 1000, 0.5);
    const auto in_jet = [](const Vec3d& x) {
      return std::abs(x.x - 0.53) < 0.04 && std::abs(x.y - 0.5) < 0.04;
    };
    const WendlandC2 w(0.12);
    double jet = 0, all = 0;
    for (std::size_t a = 0; a < fluid.x.size(); ++a) {
      const double weight = w.W(Real(norm(fluid.x[a] - Vec3d{0.5, 0.5, 0.5})));
      all += weight;
      if (!in_jet(fluid.x[a])) continue;
      fluid.v[a] = speed;
      jet += weight;
    }
    const double f = jet / all;
    ASSERT_GT(f, 0.05);
    ASSERT_LT(f, 0.5);
    CoupledBox box(c, fluid, {{{0.5, 0.5, 0.5}}, {{0, 0, 0}}, {{0, 0, 0}}, {d / 2}});
    box.coupling.gather(box.fluid, box.grains, {}, 1e-6);
    const auto law = [&](double slip) {
      return DiFelice{}.K(Real(0.5), Real(d), 1000, Real(mu), Real(slip));
    };
    const double drag = box.grains.drag_coefficient.values()[0] * box.grains.fluid_velocity.values()[0].z;
    const double expected = f * speed.z * law(local ? speed.z : f * speed.z);
    EXPECT_NEAR(drag, expected, 10 * kInvariant * expected) << local;
    if (local) continue;
    EXPECT_LT(drag, 0.5 * f * speed.z * law(speed.z)) << "the two ways hardly differ";
  }
}

/// Uniform flow through a uniform bed: its drag is the same beside an orifice, though porosity is one there.
TEST(LocalDrag, BesideAnOrificeIsThatOfTheBed) {
  const double d = 0.05, spacing = d / std::cbrt(0.5 * 6 / M_PI), length = 12 * spacing, flux = 0.2;
  const auto drag = [&](const char* slip, bool open) {
    Config c = unit_box(2 * d, 1e-3);
    c.domain.max = {length, length, length};
    c.domain.periodic = {true, true, true};
    c.fluid.dx = 0.02;
    c.couple.drag = "ergun";
    c.couple.slip = slip;
    if (open) {
      InletConfig inlet;
      inlet.shape = "disc";
      inlet.centre = {length / 2, length / 2, length / 2};
      inlet.direction = {0, 0, 1};
      inlet.radius = 0.05;
      c.inlets = {inlet};
    }
    Pebbles grains{lattice(c.domain.min, c.domain.max, spacing), {}, {}, {}};
    const std::size_t n = grains.x.size();
    grains.v.resize(n), grains.omega.resize(n), grains.radius.assign(n, d / 2);
    CoupledBox box(c, fluid_at(lattice(c.domain.min, c.domain.max, length / 32), length / 32, 1000, 1),
                   grains);
    box.coupling.porosity(box.fluid, box.grains, {}, 0);
    auto v_rho = box.fluid.v_rho.values();
    const auto eps = box.fluid.eps.values();
    for (std::size_t a = 0; a < v_rho.size(); ++a) v_rho[a] = {Real3(0, 0, Real(flux / eps[a])), 1000};
    box.fluid.v_rho.assign(v_rho);
    box.coupling.gather(box.fluid, box.grains, {}, 1e-6);
    std::vector<double> all;
    const auto K = box.grains.drag_coefficient.values();
    const auto U = box.grains.fluid_velocity.values();
    for (std::size_t j = 0; j < n; ++j) all.push_back(K[j] * U[j].z);
    return all;
  };
  for (const char* slip : {"local", "mean"}) {
    const auto bed = drag(slip, false), beside = drag(slip, true);
    // the law of mean porosity and slip within the kernel is not the mean of the law, by which some grains
    // feel more and some less
    const double each = slip == std::string("local") ? 0.21 : 0.14;
    double mean = 0;
    for (std::size_t j = 0; j < bed.size(); ++j) {
      EXPECT_NEAR(beside[j] / bed[j], 1, each) << slip << " " << j;
      mean += beside[j] / bed[j] / double(bed.size());
    }
    EXPECT_NEAR(mean, 1, 0.015) << slip;
  }
}

}  // namespace
}  // namespace BL_SOLVER
