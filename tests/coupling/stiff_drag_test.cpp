// Drag far stiffer than the step, and the fluid's side of the step limit.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/coupling/limit_pass.hpp"
#include "tests/support/coupled_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kGrainMass = 2, kDiameter = 0.05, kStep = 0.1;
constexpr double kInertia = 0.1 * kGrainMass * kDiameter * kDiameter;

struct Way {
  const char* slip = "local";
  bool moments = false;
  const char* law = "stokes";
  double speed = 1;  ///< m/s
};

/// 300 grains and 200 fluid particles in a periodic box; by Stokes' law K dt / m of the grains is
/// `stiffness`.
CoupledBox suspension(double stiffness, const Way& way = {}) {
  Config c = unit_box(0.15, stiffness * kGrainMass / (kStep * 3 * M_PI * kDiameter));
  c.domain.periodic = {true, true, true};
  c.couple.drag = way.law;
  c.couple.torque = c.couple.angmom = way.moments;
  c.couple.slip = way.slip;
  std::mt19937_64 random(21);
  Cloud fluid = random_fluid(200, {0, 0, 0}, {1, 1, 1}, 1000, random);
  fluid.stress_acceleration.assign(200, {});
  for (auto& v : fluid.v) v = v * way.speed;
  return CoupledBox(c, fluid, random_grains(300, {0, 0, 0}, {1, 1, 1}, kDiameter, random));
}

struct Totals {
  double energy = 0, scale = 0;
  Vec3d momentum;
};
Totals totals(const CoupledBox& box) {
  Totals t;
  const auto add = [&](double m, const Vec3d& v) {
    t.energy += 0.5 * m * norm2(v);
    t.momentum += v * m;
    t.scale += m * norm(v);
  };
  const auto v_rho = box.fluid.v_rho.values();
  const auto mass = box.fluid.mass.values();
  for (std::size_t a = 0; a < mass.size(); ++a) add(mass[a], Vec3d(v_rho[a].v));
  for (const Real3& v : box.grains.v.values()) add(kGrainMass, Vec3d(v));
  for (const Real3& omega : box.grains.omega.values()) t.energy += 0.5 * kInertia * norm2(Vec3d(omega));
  return t;
}

/// Takes what moves at `of` towards `to` by the exponential update, in `substeps`; returns the impulse.
std::vector<Real3> relax(std::vector<Real3>& of, const std::vector<Real3>& to, const std::vector<Real>& K,
                         double inertia, int substeps) {
  std::vector<Real3> impulse(of.size());
  for (std::size_t j = 0; j < of.size(); ++j)
    for (int s = 0; s < substeps; ++s) {
      const Real3 change = Real(-std::expm1(-kStep / substeps * K[j] / inertia)) * (to[j] - of[j]);
      of[j] += change;
      impulse[j] += Real(inertia) * change;
    }
  return impulse;
}

/// One step of drag and spin drag alone, then the reaction.
void step(CoupledBox& box, int substeps) {
  box.coupling.gather(box.fluid, box.grains, {}, kStep);
  GrainStore& g = box.grains;
  auto v = g.v.values(), omega = g.omega.values();
  g.impulse.assign(relax(v, g.fluid_velocity.values(), g.drag_coefficient.values(), kGrainMass, substeps));
  g.spin_impulse.assign(
      relax(omega, g.fluid_angular_velocity.values(), g.rot_drag_coefficient.values(), kInertia, substeps));
  g.v.assign(v);
  g.omega.assign(omega);
  box.coupling.react(box.fluid, box.grains, kStep);
  box.coupling.read_survey();
}

/// In no step does energy rise; in all of them it falls, and momentum stays.
void expect_energy_falls(CoupledBox& box, int steps) {
  const double rounding = tolerance(1e-14, 1e-6, 1e-6);
  const Totals start = totals(box);
  Totals last = start;
  for (int n = 0; n < steps; ++n) {
    step(box, 1 + n % 3);
    const Totals now = totals(box);
    EXPECT_LE(now.energy, last.energy * (1 + rounding)) << "step " << n;
    last = now;
  }
  EXPECT_LT(norm(last.momentum - start.momentum), kInvariant * start.scale);
  EXPECT_LT(last.energy, start.energy);
}

TEST(StiffDrag, NeverGainsEnergyAndKeepsMomentum) {
  // by the turbulent part of their drag, too, grains are up to a thousand times lighter than it asks for
  for (const Way& way : {Way{"local", false}, Way{"local", true}, Way{"mean", false},
                         Way{"local", true, "ergun", 10}, Way{"local", true, "ergun", 1e4},
                         Way{"local", false, "di_felice", 1e4}, Way{"mean", false, "ergun", 1e4}})
    for (int power = -2; power <= 8; ++power) {
      SCOPED_TRACE(testing::Message() << way.slip << ", moments " << way.moments << ", " << way.law
                                      << ", K dt / m = 1e" << power);
      CoupledBox box = suspension(std::pow(10.0, power), way);
      expect_energy_falls(box, 40);
    }
}

/// A heavy grain beside the surface of water that turns: the fluid that carries its force lies to one side.
TEST(StiffDrag, NeverGainsEnergyBesideASurface) {
  for (const char* slip : {"local", "mean"})
    for (const double stiffness : {1e-3, 1e-1, 1.0, 10.0, 1e3})
      for (const double height : {0.45, 0.5, 0.55, 0.6}) {
        Config c = unit_box(0.15, stiffness * kGrainMass / (kStep * 3 * M_PI * kDiameter));
        c.couple.drag = "stokes";
        c.couple.slip = slip;
        std::mt19937_64 random(8);
        Cloud fluid = random_fluid(400, {0.2, 0.2, 0.2}, {0.8, 0.8, 0.5}, 1000, random);
        fluid.stress_acceleration.assign(400, {});
        for (std::size_t a = 0; a < 400; ++a)
          fluid.v[a] = cross(Vec3d{5, 0, 0}, fluid.x[a] - Vec3d{0.5, 0.5, height});
        CoupledBox box(c, fluid, {{{0.5, 0.5, height}}, {{}}, {{}}, {kDiameter / 2}});
        SCOPED_TRACE(testing::Message() << slip << ", K dt / m = " << stiffness << ", height " << height);
        expect_energy_falls(box, 20);
      }
}

TEST(StiffDrag, IsBoundedByTheSoftestFluidAround) {
  CoupledBox free = suspension(3), bound = suspension(3);
  free.coupling.gather(free.fluid, free.grains, {}, 0);  // no time, no bound
  bound.coupling.gather(bound.fluid, bound.grains, {}, kStep);
  const WendlandC2 w(0.15);
  const auto at = free.fluid_places();
  const auto x = free.grains.x.values();
  const auto K = free.grains.drag_coefficient.values(), K_bound = bound.grains.drag_coefficient.values();
  const auto mass = free.fluid.mass.values();
  const auto state = free.fluid.eos_state.values();
  const auto weight = [&](std::size_t a, std::size_t j) {
    return state[a].mass_over_eps / state[a].rho *
           double(w.W(Real(norm(free.frame.separation(at[a], x[j])))));
  };
  std::vector<double> rate(at.size());
  for (std::size_t j = 0; j < x.size(); ++j) {
    double S = 0;
    for (std::size_t a = 0; a < at.size(); ++a) S += weight(a, j);
    for (std::size_t a = 0; a < at.size(); ++a) rate[a] += weight(a, j) / S * K[j] / mass[a];
  }
  std::uint64_t limited = 0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    double most = 0;
    for (std::size_t a = 0; a < at.size(); ++a)
      if (weight(a, j) > 0) most = std::max(most, kStep * rate[a]);
    EXPECT_NEAR(K_bound[j], K[j] * std::min(1.0, 1 / most), 4 * kInvariant * K[j]);
    limited += most > 1;
  }
  const CouplingCounters counters = bound.coupling.counters(bound.fluid, bound.grains);
  EXPECT_EQ(counters.limited, limited);
  EXPECT_GT(limited, 0u);
  EXPECT_EQ(counters.wet, 300u);
  const double dt = 0.5 / *std::max_element(rate.begin(), rate.end());
  EXPECT_NEAR(bound.coupling.stable_dt(), dt, 4 * kInvariant * dt);
}

/// The reaction tells how stiff drag was, so that the next exchange need not look, and looks where it must.
TEST(StiffDrag, IsToldByTheReaction) {
  for (const Way& way : {Way{"local", false}, Way{"local", true}, Way{"mean", false}, Way{"mean", true}}) {
    SCOPED_TRACE(testing::Message() << way.slip << ", moments " << way.moments);
    CoupledBox box = suspension(3, way), bound = suspension(3, way);
    box.coupling.gather(box.fluid, box.grains, {}, 0);
    const double looked_for = box.coupling.stable_dt();
    const auto K = box.grains.drag_coefficient.values();
    const double dt = 1e-3 * kStep;
    box.coupling.react(box.fluid, box.grains, dt);
    box.coupling.read_survey();
    EXPECT_NEAR(box.coupling.stable_dt(), looked_for, 4 * kInvariant * looked_for);
    const auto told = box.coupling.stable_dt();
    box.coupling.gather(box.fluid, box.grains, {}, dt);  // far from stiff: as it was
    EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).limited, 0u);
    EXPECT_EQ(box.coupling.stable_dt(), told);
    box.coupling.gather(box.fluid, box.grains, {}, kStep);
    bound.coupling.gather(bound.fluid, bound.grains, {}, kStep);
    EXPECT_GT(box.coupling.counters(box.fluid, box.grains).limited, 0u);
    const auto K_now = box.grains.drag_coefficient.values(), K_bound = bound.grains.drag_coefficient.values();
    for (std::size_t j = 0; j < K.size(); ++j) {
      EXPECT_LE(K_now[j], K[j] * (1 + kInvariant));
      EXPECT_NEAR(K_now[j], K_bound[j], 1e-2 * K[j]);
    }
  }
}

TEST(SpinDecay, OfAGrainInStillFluidIsKirchhoffs) {
  const double d = 0.06, rho_s = 2500, mu = 20;
  Config c = unit_box(0.12, mu);
  std::mt19937_64 random(31);
  Cloud fluid = fluid_at(lattice({0, 0, 0}, {1, 1, 1}, 0.06), 0.06, 1000, 1);
  Pebbles grain{{{0.5, 0.48, 0.51}}, {{0, 0, 0}}, {{1, -2, 0.5}}, {d / 2}};
  CoupledBox box(c, fluid, grain);
  const double inertia = 0.4 * rho_s * M_PI / 6 * d * d * d * d * d / 4;
  const double rate = M_PI * mu * d * d * d / inertia;
  const double dt = 1e-3 / rate;
  box.coupling.gather(box.fluid, box.grains, {}, dt);
  EXPECT_NEAR(box.grains.rot_drag_coefficient.values()[0] / inertia, rate, 1e-3 * rate);

  // the angular momentum that the grain loses turns the fluid
  const Real3 torque_impulse = Real(dt) * box.grains.rot_drag_coefficient.values()[0] *
                               (box.grains.fluid_angular_velocity.values()[0] - box.grains.omega.values()[0]);
  box.grains.impulse.buffer().zero();
  box.grains.spin_impulse.assign({torque_impulse});
  box.coupling.react(box.fluid, box.grains, kStep);
  const auto at = box.fluid_places();
  const auto v_rho = box.fluid.v_rho.values();
  const auto mass = box.fluid.mass.values();
  Vec3d spin, momentum;
  double scale = 0;
  for (std::size_t a = 0; a < at.size(); ++a) {
    const Vec3d p = Vec3d(v_rho[a].v) * double(mass[a]);
    spin += cross(at[a], p);
    momentum += p;
    scale += norm(p);
  }
  EXPECT_GT(scale, 0);
  EXPECT_LT(norm(momentum), kInvariant * scale);
  EXPECT_LT(norm(spin + Vec3d(torque_impulse)), 10 * kInvariant * norm(Vec3d(torque_impulse)));
}

}  // namespace
}  // namespace BL_SOLVER
