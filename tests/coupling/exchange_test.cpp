// Force and momentum between grains and fluid.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "kernels/drag/ergun.hpp"
#include "tests/support/coupled_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Irregular fluid full of grains; K dt / m of the order of one.
CoupledBox irregular(Config c, double shift = 0) {
  std::mt19937_64 random(11);
  const Vec3d lo{0.25, 0.25, 0.25}, hi{0.75, 0.75, 0.75};
  const bool all = c.domain.periodic[0];
  Cloud fluid = random_fluid(900, all ? c.domain.min : lo, all ? c.domain.max : hi, 1000, random);
  Pebbles grains = random_grains(80, all ? c.domain.min : lo, all ? c.domain.max : hi, 0.06, random);
  for (auto& v : fluid.v) v += Vec3d(shift, -2 * shift, shift);
  for (auto& v : grains.v) v += Vec3d(shift, -2 * shift, shift);
  return CoupledBox(c, fluid, grains);
}

/// What the grain solver would hand back after a step dt of drag alone, made larger by `factor`.
void drag_grains(CoupledBox& box, double dt) {
  const auto v = box.grains.v.values(), U = box.grains.fluid_velocity.values();
  const auto omega = box.grains.omega.values(), omega_f = box.grains.fluid_angular_velocity.values();
  const auto K = box.grains.drag_coefficient.values(), K_rot = box.grains.rot_drag_coefficient.values();
  std::vector<Real3> J, T;
  for (std::size_t j = 0; j < v.size(); ++j) {
    J.push_back(Real(dt) * K[j] * (U[j] - v[j]));
    T.push_back(Real(dt) * K_rot[j] * (omega_f[j] - omega[j]));
  }
  box.grains.impulse.assign(J);
  box.grains.spin_impulse.assign(T);
}

/// A sum that should vanish, and what it is to be measured against.
struct Balance {
  Vec3d sum;
  double scale = 0;
  void add(const Vec3d& v) {
    sum += v;
    scale += norm(v);
  }
  double error() const { return norm(sum) / scale; }
};

struct Balances {
  Balance momentum, spin, force, moment;
};

/// Impulse and force on both phases over one gather and react, and their moments about the origin. Of the
/// stress M theta on the mixture that each fluid particle stands for, it takes m theta and leaves the rest to
/// the grains.
Balances exchange(CoupledBox& box, double dt) {
  const auto before = box.fluid.v_rho.values();
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  box.coupling.push(box.fluid, box.grains, 0, true);
  box.coupling.gather(box.fluid, box.grains, {}, dt);
  drag_grains(box, dt);
  box.coupling.react(box.fluid, box.grains, dt);
  const auto after = box.fluid.v_rho.values();
  const auto mass = box.fluid.mass.values();
  const auto state = box.fluid.eos_state.values();
  const auto reaction = box.fluid.reaction.values(), kick = box.fluid.drag_kick.values(),
             theta = box.fluid.stress_acceleration.values();
  const auto at = box.fluid_places();
  Balances b;
  for (std::size_t a = 0; a < at.size(); ++a) {
    const Vec3d change = Vec3d(after[a].v) - Vec3d(before[a].v), p = change * double(mass[a]);
    EXPECT_LT(norm(change - Vec3d(kick[a])), kInvariant * (1 + norm(change)));
    const Vec3d f = Vec3d(reaction[a]) * double(mass[a]) +
                    Vec3d(theta[a]) * (double(mass[a]) - double(state[a].mass_over_eps));
    b.momentum.add(p);
    b.spin.add(cross(at[a], p));
    b.force.add(f);
    b.moment.add(cross(at[a], f));
  }
  const auto x = box.grains.x.values();
  const auto J = box.grains.impulse.values(), T = box.grains.spin_impulse.values(),
             F = box.grains.fluid_force.values();
  for (std::size_t j = 0; j < x.size(); ++j) {
    b.momentum.add(Vec3d(J[j]));
    b.spin.add(cross(x[j], Vec3d(J[j])));
    b.spin.add(Vec3d(T[j]));
    b.force.add(Vec3d(F[j]));
    b.moment.add(cross(x[j], Vec3d(F[j])));
  }
  return b;
}

TEST(Exchange, ConservesMomentumForEveryKernelAndLaw) {
  for (const char* kernel : {"wendland_c2", "cubic", "lucy"})
    for (const char* law : {"stokes", "ergun", "gidaspow", "di_felice"}) {
      Config c = unit_box(kernel == std::string("lucy") ? 0.24 : 0.12, 20);
      c.domain.periodic = {true, true, true};
      c.fluid.kernel = kernel;
      c.couple.drag = law;
      CoupledBox box = irregular(c);
      const Balances b = exchange(box, 0.05);
      EXPECT_GT(b.momentum.scale, 1) << kernel << " " << law;
      EXPECT_LT(b.momentum.error(), kInvariant) << kernel << " " << law;
      EXPECT_LT(b.force.error(), kInvariant) << kernel << " " << law;
    }
}

TEST(Exchange, ConservesAngularMomentumWithTheCouple) {
  for (const char* slip : {"local", "mean"}) {
    Config c = unit_box(0.12, 20);
    c.couple.slip = slip;
    CoupledBox box = irregular(c);
    const Balances b = exchange(box, 0.05);
    EXPECT_LT(b.momentum.error(), kInvariant) << slip;
    EXPECT_LT(b.force.error(), kInvariant) << slip;
    EXPECT_LT(b.spin.error(), kInvariant) << slip;
    EXPECT_LT(b.moment.error(), kInvariant) << slip;
  }
}

/// 80 grains and four that are twenty times as large, each with its own averaging length, in irregular fluid.
CoupledBox unlike_sizes(bool periodic) {
  Config c = unit_box(0.06, 20);
  c.domain.periodic = {periodic, periodic, periodic};
  c.grain.d_min = 0.006, c.grain.d_max = 0.12;
  std::mt19937_64 random(14);
  const double edge = periodic ? 0 : 0.25;
  const Vec3d lo{edge, edge, edge}, hi = Vec3d{1, 1, 1} - lo;
  Cloud fluid = random_fluid(6000, lo, hi, 1000, random);
  Pebbles grains = random_grains(84, lo, hi, c.grain.d_min, random);
  for (int j = 0; j < 4; ++j) grains.radius[20 * j] = c.grain.d_max / 2;
  return CoupledBox(c, fluid, grains);
}

TEST(Exchange, ConservesBothMomentaAmongGrainsOfUnlikeSizes) {
  for (const bool periodic : {true, false})
    for (const bool by_size : {false, true}) {
      CoupledBox box = unlike_sizes(periodic);
      if (by_size) {
        ASSERT_EQ(box.relist_by_size(), 2);
      }
      const Balances b = exchange(box, 0.05);
      EXPECT_GT(b.momentum.scale, 1e-3);
      EXPECT_LT(b.momentum.error(), kInvariant) << periodic << by_size;
      EXPECT_LT(b.force.error(), kInvariant) << periodic << by_size;
      if (periodic) continue;
      EXPECT_LT(b.spin.error(), kInvariant) << by_size;
      EXPECT_LT(b.moment.error(), kInvariant) << by_size;
    }
}

/// A grain reads the fluid within four diameters of its own, and fluid the grains that reach it.
TEST(Exchange, IsAveragedOverTheLengthOfEachGrain) {
  for (const bool by_size : {false, true}) {
    CoupledBox box = unlike_sizes(true);
    if (by_size) {
      ASSERT_EQ(box.relist_by_size(), 2);
    }
    const auto before = box.fluid.eos_state.values();
    const auto eps_before = box.fluid.eps.values();
    box.coupling.gather(box.fluid, box.grains, {}, 0.05);
    const auto read = box.grains.eps.values();
    box.coupling.porosity(box.fluid, box.grains, {}, 0);
    const auto eps = box.fluid.eps.values();
    const auto at = box.fluid_places();
    const auto x = box.grains.x.values();
    const auto radius = box.grains.radius.values();
    std::vector<double> expected(at.size(), 1);
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double R = double(radius[j]), V = 4 * M_PI / 3 * R * R * R;
      const WendlandC2 w(std::max(0.06, 4 * R));
      double S = 0, seen = 0;
      for (std::size_t a = 0; a < at.size(); ++a) {
        const double W = double(w.W(Real(norm(box.frame.separation(at[a], x[j])))));
        const double share = double(before[a].mass_over_eps / before[a].rho) * W;
        S += share, seen += share * double(eps_before[a]);
        expected[a] -= V * W;
      }
      EXPECT_NEAR(read[j], seen / S, tolerance(1e-12, 1e-5, 1e-5)) << R << by_size;
    }
    for (std::size_t a = 0; a < at.size(); ++a)
      EXPECT_NEAR(eps[a], expected[a], tolerance(1e-12, 1e-6, 1e-6)) << by_size;
  }
}

/// Grain j by sums over all pairs, with Ergun's law.
struct ByAllPairs {
  std::vector<double> weight;  ///< phi_ja K_ja / K_j of each fluid particle
  double S = 0, eps = 0, rho = 0, wet = 0, K = 0;
  Vec3d U, omega_f, force;
};

ByAllPairs by_all_pairs(const CoupledBox& box, const std::vector<VelocityDensity<>>& v_rho, std::size_t j,
                        bool local) {
  const WendlandC2 w(Real(box.config.couple.hc));
  const auto at = box.fluid_places();
  const Vec3d x = box.grains.x.values()[j], v(box.grains.v.values()[j]);
  const auto mass = box.fluid.mass.values(), eps = box.fluid.eps.values();
  const auto theta = box.fluid.stress_acceleration.values();
  const double d = 2 * box.grains.radius.values()[j];
  ByAllPairs out;
  Vec3d mean_slip;
  for (std::size_t a = 0; a < at.size(); ++a) {
    const double vw = mass[a] / (eps[a] * v_rho[a].rho) * double(w.W(Real(norm(at[a] - x))));
    out.weight.push_back(vw);
    out.S += vw, out.eps += vw * eps[a], out.rho += vw * v_rho[a].rho;
    out.force += Vec3d(theta[a]) * (vw * v_rho[a].rho * M_PI / 6 * d * d * d);
    mean_slip += (Vec3d(v_rho[a].v) - v) * vw;
  }
  out.eps /= out.S, out.rho /= out.S;
  mean_slip = mean_slip * (1 / out.S);
  out.wet = std::clamp((out.S - 0.05) / 0.9, 0.0, 1.0);
  Vec3d centre;
  for (std::size_t a = 0; a < at.size(); ++a) {
    const double slip = norm(local ? Vec3d(v_rho[a].v) - v : mean_slip);
    out.weight[a] *=
        Ergun{}.K(Real(out.eps), Real(d), Real(out.rho), Real(box.config.fluid.mu), Real(slip)) / out.S;
    out.K += out.weight[a];
  }
  for (std::size_t a = 0; a < at.size(); ++a) {
    out.weight[a] /= out.K;
    out.U += Vec3d(v_rho[a].v) * out.weight[a];
    centre += at[a] * out.weight[a];
  }
  SymmetricMatrix<double> second;
  Vec3d circulation;
  for (std::size_t a = 0; a < at.size(); ++a) {
    second.add_outer(out.weight[a], at[a] - centre);
    circulation += cross(at[a] - centre, Vec3d(v_rho[a].v)) * out.weight[a];
  }
  out.omega_f = second.inertia().inverse() * circulation;
  if (box.config.couple.angmom) out.U -= cross(out.omega_f, centre - x);  // at the grain's centre
  out.K *= out.wet;
  return out;
}

TEST(Exchange, FluidTakesWhatASumOverAllPairsGives) {
  const double dt = 0.05;
  for (const bool local : {true, false}) {
    Config c = unit_box(0.12, 20);
    c.couple.drag = "ergun";
    c.couple.slip = local ? "local" : "mean";
    c.couple.angmom = false;
    CoupledBox box = irregular(c);
    const auto before = box.fluid.v_rho.values();
    exchange(box, dt);
    const auto mass = box.fluid.mass.values(), K = box.grains.drag_coefficient.values();
    const auto U = box.grains.fluid_velocity.values(), J = box.grains.impulse.values();
    const auto kick = box.fluid.drag_kick.values();
    std::vector<Vec3d> expected(mass.size());
    for (std::size_t j = 0; j < K.size(); ++j) {
      const auto weight = by_all_pairs(box, before, j, local).weight;
      for (std::size_t a = 0; a < mass.size(); ++a) {
        const Vec3d own = Vec3d(before[a].v - U[j]) * (local ? dt * K[j] : 0);
        expected[a] -= (Vec3d(J[j]) + own) * (weight[a] / mass[a]);
      }
    }
    for (std::size_t a = 0; a < mass.size(); ++a)
      EXPECT_LT(norm(Vec3d(kick[a]) - expected[a]), 4 * kInvariant)
          << "particle " << a << ", local " << local;
  }
}

TEST(Exchange, WaterThatTurnsAsAWholeIsNotSlowedByItsSlip) {
  std::mt19937_64 random(4);
  Cloud fluid = random_fluid(3000, {0, 0, 0}, {1, 1, 1}, 1000, random);
  const Vec3d spin{1, -2, 0.5}, drift{3, 0, 1};
  for (std::size_t a = 0; a < fluid.x.size(); ++a) fluid.v[a] = drift + cross(spin, fluid.x[a]);
  CoupledBox box(unit_box(0.12, 20), fluid,
                 random_grains(20, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, 0.06, random));
  box.coupling.gather(box.fluid, box.grains, {}, 0.05);
  box.grains.impulse.buffer().zero();
  box.grains.spin_impulse.buffer().zero();
  EXPECT_GT(box.grains.drag_coefficient.values()[0], 0);
  box.coupling.react(box.fluid, box.grains, 0.05);
  for (const Real3& kick : box.fluid.drag_kick.values()) EXPECT_LT(norm(kick), 30 * kInvariant);
}

TEST(Exchange, LosesAngularMomentumWithoutTheCouple) {
  Config c = unit_box(0.12, 20);
  c.couple.angmom = false;
  CoupledBox box = irregular(c);
  const Balances b = exchange(box, 0.05);
  EXPECT_LT(b.momentum.error(), kInvariant);
  EXPECT_GT(b.spin.error(), 1e-3);
}

TEST(Exchange, IsTheSameForAMovingObserver) {
  CoupledBox still = irregular(unit_box(0.12, 20)), moving = irregular(unit_box(0.12, 20), 4);
  for (CoupledBox* box : {&still, &moving}) box->coupling.gather(box->fluid, box->grains, {}, 0.05);
  const auto K = still.grains.drag_coefficient.values(), K_moving = moving.grains.drag_coefficient.values();
  const auto omega = still.grains.fluid_angular_velocity.values(),
             omega_moving = moving.grains.fluid_angular_velocity.values();
  const auto U = still.grains.fluid_velocity.values(), U_moving = moving.grains.fluid_velocity.values();
  for (std::size_t j = 0; j < K.size(); ++j) {
    EXPECT_NEAR(K_moving[j], K[j], kInvariant * K[j]);
    EXPECT_LE(norm(omega_moving[j] - omega[j]), kInvariant * norm(omega[j]));
    EXPECT_LE(norm(U_moving[j] - U[j] - Real3(4, -8, 4)), 10 * kInvariant);
  }
}

TEST(Exchange, GrainsReadWhatASumOverAllPairsGives) {
  for (const bool local : {true, false}) {
    Config c = unit_box(0.12, 20);
    c.couple.drag = "ergun";
    c.couple.slip = local ? "local" : "mean";
    CoupledBox box = irregular(c);
    box.coupling.porosity(box.fluid, box.grains, {}, 0);
    box.coupling.push(box.fluid, box.grains, 0, true);
    box.coupling.gather(box.fluid, box.grains, {}, 0);  // of no step, which could not bear the drag
    const auto eps = box.grains.eps.values(), wet = box.grains.wetness.values(),
               K = box.grains.drag_coefficient.values();
    const auto U = box.grains.fluid_velocity.values(), F = box.grains.fluid_force.values(),
               omega_f = box.grains.fluid_angular_velocity.values();
    const double volume = M_PI / 6 * std::pow(0.06, 3), near = 4 * kInvariant;
    for (std::size_t j = 0; j < K.size(); ++j) {
      const ByAllPairs expected = by_all_pairs(box, box.fluid.v_rho.values(), j, local);
      EXPECT_NEAR(wet[j], expected.wet, near);
      EXPECT_NEAR(eps[j], expected.eps, near);
      EXPECT_LT(norm(Vec3d(U[j]) - expected.U), near);
      EXPECT_LT(norm(Vec3d(F[j]) - expected.force), near * 9 * 1000 * volume);
      EXPECT_NEAR(K[j], expected.K, 2 * near * K[j]) << "local " << local;
      EXPECT_LT(norm(Vec3d(omega_f[j]) - expected.omega_f), near * (10 + norm(expected.omega_f)));
    }
  }
}

TEST(Exchange, GrainsFeelTheRotationOfTheFluid) {
  Config c = unit_box(0.12, 1);
  std::mt19937_64 random(4);
  Cloud fluid = random_fluid(3000, {0, 0, 0}, {1, 1, 1}, 1000, random);
  const Vec3d spin{1, -2, 0.5}, drift{3, 0, 1};
  for (std::size_t a = 0; a < fluid.x.size(); ++a) fluid.v[a] = drift + cross(spin, fluid.x[a]);
  CoupledBox box(c, fluid, random_grains(20, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, 0.06, random));
  box.coupling.gather(box.fluid, box.grains, {}, 0.01);
  for (const Real3& omega : box.grains.fluid_angular_velocity.values())
    EXPECT_LT(norm(Vec3d(omega) - spin), 30 * kInvariant * norm(spin));
}

TEST(Exchange, UniformStressPushesAGrainAsItsVolume) {
  Config c = unit_box(0.12, 1);
  c.couple.mode = "one_way";
  std::mt19937_64 random(9);
  Cloud fluid = fluid_at(random_points(2500, {0, 0, 0}, {1, 1, 1}, random), 1 / 13.57, 1000, 0.6);
  const Vec3d theta{0.5, -3, 9.81};  // still water: - g
  for (auto& t : fluid.stress_acceleration) t = theta;
  CoupledBox box(c, fluid, random_grains(30, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, 0.06, random));
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  box.coupling.push(box.fluid, box.grains, 0, true);
  box.coupling.gather(box.fluid, box.grains, {}, 0.01);
  const double volume = M_PI / 6 * std::pow(0.06, 3);
  const Vec3d expected = theta * (volume * 1000);
  const auto F = box.grains.fluid_force.values();
  const auto wet = box.grains.wetness.values();
  int told = 0;  // grains whose wetness tells how much fluid is around them
  for (std::size_t j = 0; j < F.size(); ++j) {
    EXPECT_GT(wet[j], 0.3);  // fluid lies at random
    if (wet[j] == 1) continue;
    EXPECT_LT(norm(Vec3d(F[j]) - expected * (0.05 + 0.9 * wet[j])), 4 * kInvariant * norm(expected));
    ++told;
  }
  EXPECT_GT(told, 5);
  EXPECT_NEAR(expected.z, 1000 * 9.81 * volume, 1e-9);  // buoyancy is of the intrinsic density
}

TEST(Exchange, StillWaterInAUniformBedStaysStill) {
  const double d = 0.1, spacing = 0.11, length = 8 * spacing, dx = spacing / 2;
  Config c = unit_box(2 * d, 1e-3);
  c.domain.max = {length, length, length};
  c.domain.periodic = {true, true, true};
  Pebbles grains{lattice(c.domain.min, c.domain.max, spacing), {}, {}, {}};
  grains.v.resize(grains.x.size());
  grains.omega.resize(grains.x.size());
  grains.radius.assign(grains.x.size(), d / 2);
  const double eps = 1 - M_PI / 6 * std::pow(d / spacing, 3);
  Cloud fluid = fluid_at(lattice(c.domain.min, c.domain.max, dx), dx, 1000, eps);
  for (auto& t : fluid.stress_acceleration) t = {0, 0, 9.81};
  CoupledBox box(c, fluid, grains);
  exchange(box, 1e-4);
  for (const Real3& reaction : box.fluid.reaction.values()) EXPECT_LT(norm(reaction), 1e-3 * 9.81);
  const double volume = M_PI / 6 * d * d * d;
  for (const Real3& F : box.grains.fluid_force.values())
    EXPECT_NEAR(F.z, 1000 * 9.81 * volume, 2e-2 * 9810 * volume);
}

TEST(Exchange, OneWayLeavesTheFluidAlone) {
  Config c = unit_box(0.12, 1e6);  // stiff: two-way would limit it
  c.couple.mode = "one_way";
  c.couple.drag = "stokes";
  CoupledBox box = irregular(c);
  const auto before = box.fluid.v_rho.values();
  const Balances b = exchange(box, 0.05);
  const auto after = box.fluid.v_rho.values();
  for (std::size_t a = 0; a < before.size(); ++a) EXPECT_EQ(before[a].v, after[a].v);
  for (const Real3& reaction : box.fluid.reaction.values()) EXPECT_EQ(reaction, Real3{});
  const auto K = box.grains.drag_coefficient.values(), wet = box.grains.wetness.values();
  const auto eps = box.grains.eps.values();  // in which is their own volume
  for (std::size_t j = 0; j < K.size(); ++j)
    EXPECT_NEAR(K[j] * eps[j], wet[j] * 3 * M_PI * 1e6 * 0.06, 0.02 * K[j]) << "at the flux";
  EXPECT_EQ(box.coupling.stable_dt(), std::numeric_limits<double>::infinity());
  EXPECT_GT(b.momentum.scale, 0);
}

/// Everything once on a few particles, for checkers of memory and races.
TEST(SmallExchange, RunsEveryKernel) {
  for (const auto& kernel : kNames<KernelFunction>)
    for (const auto& law : kNames<DragLaw>)
      for (bool couple : {false, true}) {
        if (law.value == DragLaw::table) continue;  // it has no formula
        Config c = unit_box(kernel.value == KernelFunction::lucy ? 0.5 : 0.25, 20);
        c.fluid.kernel = kernel.value;
        c.couple.drag = law.value;
        c.couple.angmom = c.couple.torque = couple;
        std::mt19937_64 random(2);
        Cloud fluid = random_fluid(60, {0, 0, 0}, {1, 1, 1}, 1000, random);
        CoupledBox box(c, fluid, random_grains(35, {0, 0, 0}, {1, 1, 1}, 0.12, random));
        // a step of time.drag = 0.5 is half of the stable one without a couple
        box.coupling.gather(box.fluid, box.grains, {}, 0);
        const double dt = box.coupling.stable_dt();
        box.coupling.gather(box.fluid, box.grains, {}, dt);
        EXPECT_TRUE(couple || box.coupling.counters(box.fluid, box.grains).limited == 0);
        box.coupling.gather(box.fluid, box.grains, {}, 2.1 * dt);
        EXPECT_GT(box.coupling.counters(box.fluid, box.grains).limited, 0u);
        const Balances b = exchange(box, 0.01);
        EXPECT_LT(b.momentum.error(), kInvariant);
        EXPECT_LT(b.force.error(), kInvariant);
        box.coupling.porosity(box.fluid, box.grains, {}, 0);
        const auto wet = box.grains.wetness.values();
        EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).wet,
                  std::uint64_t(std::count_if(wet.begin(), wet.end(), [](Real w) { return w > 0; })));
      }
}

}  // namespace
}  // namespace BL_SOLVER
