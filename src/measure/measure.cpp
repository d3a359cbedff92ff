// Diagnostics: masses, momenta, energies and extremes.

#include <algorithm>
#include <cmath>

#include "bedload/parallel/reductions.hpp"
#include "kernels/boundaries/sinks.hpp"
#include "kernels/fluid/views.hpp"
#include "src/measure/fluid_contents.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

/// mass, momentum 3, angular momentum 3, kinetic, potential, elastic, spin energy, mass times place 3.
struct FluidTotals {
  FluidContents fluid;
  EquationOfState eos;
  Vec3d gravity;  ///< true gravity: the acceleration of a frame has no potential energy here
  Drive drive;    ///< nor has its constant part
  Span<const Real> compression;
  double inertia;  ///< of a particle over its mass, m2
  Span<const Real3> spin;
  BL_HD void operator()(Index a, double* out) const {
    const double m = fluid.mass[a];
    const Vec3d w = inertia > 0 ? Vec3d(spin[a]) : Vec3d{};
    const Vec3d at = fluid.at(a), v = fluid.velocity(a), l = cross(at, v) + inertia * w;
    out[0] = m;
    for (int k = 0; k < 3; ++k) out[1 + k] = m * v[k], out[4 + k] = m * l[k];
    out[7] = 0.5 * m * norm2(v);
    out[8] = m * (drive.energy(a) - dot(gravity, at));
    out[9] = m * eos.energy(compression[a]);
    out[10] = 0.5 * m * inertia * norm2(w);
    for (int k = 0; k < 3; ++k) out[11 + k] = m * at[k];
  }
};

/// Rates of change of fluid momentum, N: by gravity and drive, by everything except grains, by grains
/// including their part of the stress.
struct MomentumRates {
  double rate;  ///< 1 / step, 1/s
  Vec3d gravity;
  Drive drive;
  FluidContents fluid;
  Span<const Real3> stress_acceleration, acc, reaction, drag_kick;
  BL_HD void operator()(Index a, double* out) const {
    const double m = fluid.mass[a];
    const EosState<> state = fluid.state[a];
    const Real3 driven = drive(a, state);
    for (int k = 0; k < 3; ++k) {
      const double grains = (double(state.mass_over_eps) - m) * stress_acceleration[a][k];
      out[k] = m * (gravity[k] + driven[k]);
      out[3 + k] = m * double(acc[a][k]) + grains;
      if (reaction) out[6 + k] = m * (double(reaction[a][k]) + rate * drag_kick[a][k]) - grains;
    }
  }
};

/// Force of the fluid on grains 3, number of grains outside the domain.
struct GrainLoads {
  Frame frame;
  Span<const Vec3d> x;
  Span<const Real3> fluid_force, drag_force;
  BL_HD void operator()(Index i, double* out) const {
    for (int k = 0; k < 3; ++k) out[k] = double(fluid_force[i][k]) + drag_force[i][k];
    out[3] = outside(frame, x[i]) ? 1 : 0;
  }
};

/// Correction by LinearFit: force 3 (N) and its power on the fluid (W).
struct CorrectionBody {
  FluidContents fluid;
  Span<const Real4> correction;
  BL_HD void operator()(Index a, double* out) const {
    const Vec3d acc(correction[a].xyz()), force = double(fluid.state[a].mass_over_eps) * acc;
    for (int k = 0; k < 3; ++k) out[k] = force[k];
    out[3] = double(fluid.mass[a]) * dot(acc, fluid.velocity(a));
  }
};
/// Power of the pressure of the acoustic damper, with the rate of volume from continuity, W.
struct DamperBody {
  double damping, rho0;  ///< Pa s, kg/m3
  FluidContents fluid;
  Span<const Real> rate;
  BL_HD void operator()(Index a, double* out) const {
    out[0] = -double(fluid.mass[a]) * rho0 * damping * square(double(rate[a]) / double(fluid.state[a].rho));
  }
};

/// Power of particle shifting on the potential energy, and of the drive, W.
struct DriftBody {
  Vec3d gravity;
  Drive drive;
  FluidContents fluid;
  Span<const Real3> drift;  ///< empty: none
  BL_HD void operator()(Index a, double* out) const {
    if (drift) out[0] = -double(fluid.mass[a]) * dot(gravity, Vec3d(drift[a]));
    out[1] = double(fluid.mass[a]) * dot(Vec3d(drive(a, fluid.state[a])), fluid.velocity(a));
  }
};
/// Power of the repulsion of fluid by surfaces, W; numbers of particles that the penetration limit stops,
/// whose repulsion is the largest allowed, whose drift by shifting ends at a surface, and that inlets repel.
struct StoppedBody {
  WallRepulsion walls;
  OrificeRepulsion inlets;
  FluidContents fluid;
  Span<const Real3> heading;      ///< from RepelPass, m/s
  Span<const FluidPowers> terms;  ///< may be empty
  BL_HD void operator()(Index a, double* out) const {
    const Vec3d at = fluid.at(a);
    const Real3 shift = terms ? terms[a].shift : Real3{};
    Real3 left = shift;
    Vec3d force;
    const auto take = [&](const SurfacePush& push) {
      force += double(fluid.mass[a]) * Vec3d(push.acceleration);
      if (push.stopped) out[1] = 1;
      if (push.capped) out[2] = 1;
    };
    walls.each(at, heading[a], walls.sheet(a), take, kNone, &left);
    out[0] = dot(force, fluid.velocity(a));
    out[3] = norm2(left - shift) > 0;
    out[4] = norm2(inlets(at, fluid.v_rho[a].v)) > 0;
  }
};
/// Sums of FluidPowers, W, and numbers of particles.
struct PowersBody {
  Span<const FluidPowers> powers;
  BL_HD void operator()(Index a, double* out) const {
    const FluidPowers& p = powers[a];
    out[0] = p.viscosity, out[1] = p.artificial_viscosity, out[2] = p.density_diffusion, out[3] = p.voids;
    out[4] = p.pressure, out[5] = p.fades, out[6] = p.spreads, out[7] = p.shift_limited;
  }
};
/// Number of wet wall particles at the lowest pressure that they may have.
struct ThinWallBody {
  EquationOfState eos;
  Real least;  ///< compression of walls with a density of their own
  Span<const WallState<>> state;
  Span<const Real> compression;
  WallBodies bodies;
  BL_HD void operator()(Index b, double* out) const {
    if (state[b].mass == 0) return;
    const WallKind kind = bodies[b].kind;
    const bool own = kind == WallKind::frozen || kind == WallKind::mirrored;
    if (own && compression[b] != kNoCompression)
      out[0] = compression[b] <= least;
    else
      out[0] = state[b].rho <= Real(1 + 1e-6) * eos.rho0 * (1 + eos.compression(Real(-1e30)));
  }
};
struct CavitatingBody {
  Span<const Real> compression;
  Real least;
  BL_HD void operator()(Index a, double* out) const {
    out[0] = compression[a] < least, out[1] = compression[a] <= kThinnest;
  }
};

struct PressureBody {
  Span<const EosState<>> eos_state;
  double sign;
  BL_HD double operator()(Index a) const { return sign * eos_state[a].pressure(); }
};
struct DensityBody {
  Span<const EosState<>> eos_state;
  double sign;
  BL_HD double operator()(Index a) const { return sign * eos_state[a].rho; }
};
struct PorosityBody {
  Span<const Real> eps;
  BL_HD double operator()(Index a) const { return -double(eps[a]); }
};

}  // namespace

void CoupledSimulation::report_powers(const Drive& drive, double corrections, std::vector<Quantity>& out) {
  FluidSolver& solver = stepper_.fluid();
  FluidStore& fluid = state_.fluid;
  const FluidContents contents(state_.frame, fluid);
  const double dt = state_.clock.last_dt;
  const auto powers = solver.powers(fluid, state_.walls, state_.poses_now(), stepper_.moment(), dt);
  SumReduction<8, PowersBody>::Value p;
  for (int k = 0; k < 8; ++k)  // not computed; SDPD has none of the limits
    p.v[k] = k >= 5 && !config_.fluid.model->smoothed ? 0 : std::nan("");
  const bool reported = all_reduce(powers ? 1 : 0, [](int& into, int one) { into |= one; }) > 0;
  if (reported) p = sum_over<8>(fluid.owned(), PowersBody{powers});
  double moving = 0;  // power of the pairs of moving walls on the fluid
  for (std::uint32_t b = 0; b < std::uint32_t(state_.motion.bodies()) && state_.walls.everywhere() > 0; ++b) {
    const RigidMotion motion = state_.motion.pose(int(b), state_.clock.time);
    if (norm2(motion.v) + norm2(motion.omega) == 0) continue;
    const LoadSum load =
        total(state_.walls.owned(),
              WallLoadReduction{particles_of(b, state_.walls, state_.poses_now()), wall_forces().pressure});
    moving -= dot(load.force(), motion.v) + dot(load.torque(), motion.omega);
  }
  static const char* const terms[] = {"viscosity", "artificial_viscosity", "density_diffusion", "voids"};
  for (int k = 0; k < 4; ++k) out.push_back({std::string("power_") + terms[k], "W", p.v[k]});
  out.push_back({"power_wall_pressure", "W", p.v[4] - moving});
  out.push_back({"power_moving_walls", "W", moving - corrections});
  const auto d = sum_over<2>(fluid.owned(), DriftBody{.gravity = config_.gravity,
                                                      .drive = drive,
                                                      .fluid = contents,
                                                      .drift = span_if(solver.shifts(), fluid.drift)});
  out.push_back({"power_shifting", "W", d.v[0]});
  out.push_back({"power_drive", "W", d.v[1]});
  SumReduction<5, StoppedBody>::Value r{};
  if (solver.repels())
    r = sum_over<5>(fluid.owned(), StoppedBody{.walls = solver.repulsion(fluid, state_.poses_now(), dt),
                                               .inlets = solver.orifice_repulsion(state_.poses_now(), dt),
                                               .fluid = contents,
                                               .heading = fluid.heading,
                                               .terms = powers});
  const auto w =
      sum_over<1>(state_.walls.owned(), ThinWallBody{.eos = solver.eos(),
                                                     .least = max_of(solver.eos().least, kThinnest),
                                                     .state = state_.walls.state,
                                                     .compression = state_.walls.compression,
                                                     .bodies = {state_.walls.body, state_.poses_now()}});
  out.push_back({"power_penetration_limit", "W", r.v[0]});
  out.push_back({"fluid_stopped_at_walls", "-", r.v[1]});
  out.push_back({"fluid_repulsion_limited", "-", r.v[2]});
  if (!config_.inlets.empty()) out.push_back({"fluid_repelled_by_inlets", "-", r.v[4]});
  const auto thin = sum_over<2>(fluid.owned(), CavitatingBody{fluid.compression, solver.eos().least});
  out.push_back({"fluid_cavitating", "-", thin.v[0]});
  out.push_back({"fluid_thinnest", "-", thin.v[1]});
  out.push_back({"walls_thinnest", "-", w.v[0]});
  out.push_back({"fluid_beside_voids", "-", p.v[5]});
  out.push_back({"fluid_spreading", "-", p.v[6]});
  out.push_back({"fluid_shift_limited", "-", p.v[7]});
  out.push_back({"fluid_shift_stopped", "-", reported ? r.v[3] : p.v[7]});
}

std::vector<Loss> CoupledSimulation::losses() { return state_.open.losses(state_.grains, state_.clock.time); }

std::vector<Quantity> CoupledSimulation::diagnostics() {
  static const char* const axis[3] = {"x", "y", "z"};
  stepper_.share_all();
  std::vector<Quantity> out;
  const auto vec = [&](const std::string& name, const char* unit, const Vec3d& v) {
    for (int k = 0; k < 3; ++k) out.push_back({name + "_" + axis[k], unit, v[k]});
  };
  Vec3d wall_on_fluid;
  if (state_.has_fluid) {
    const Drive drive = stepper_.fluid().drive(state_.fluid, stepper_.moment());
    const Spin* spin = stepper_.fluid().spin();
    const FluidContents contents(state_.frame, state_.fluid);
    const auto t =
        sum_over<14>(state_.fluid.owned(),
                     FluidTotals{.fluid = contents,
                                 .eos = stepper_.fluid().eos(),
                                 .gravity = config_.gravity,
                                 .drive = drive,
                                 .compression = state_.fluid.compression,
                                 .inertia = spin ? spin->inertia : 0,
                                 .spin = spin ? Span<const Real3>(spin->omega) : Span<const Real3>()});
    out.push_back({"fluid_mass", "kg", t.v[0]});
    vec("fluid_centre", "m", t.v[0] > 0 ? Vec3d{t.v[11], t.v[12], t.v[13]} * (1 / t.v[0]) : Vec3d{});
    vec("fluid_momentum", "kg m/s", {t.v[1], t.v[2], t.v[3]});
    vec("fluid_angular_momentum", "kg m2/s", {t.v[4], t.v[5], t.v[6]});
    out.push_back({"fluid_kinetic_energy", "J", t.v[7]});
    out.push_back({"fluid_potential_energy", "J", t.v[8]});
    out.push_back({"fluid_elastic_energy", "J", t.v[9]});
    if (spin) out.push_back({"fluid_spin_energy", "J", t.v[10]});
    const FluidLoads& loads = fluid_loads();
    for (int b = 0; b < state_.motion.bodies(); ++b) wall_on_fluid -= loads.all(b).force();
    const auto l = sum_over<9>(state_.fluid.owned(),
                               MomentumRates{.rate = state_.clock.last_dt > 0 ? 1 / state_.clock.last_dt : 0,
                                             .gravity = state_.gravity.at(state_.clock.time),
                                             .drive = drive,
                                             .fluid = contents,
                                             .stress_acceleration = state_.fluid.stress_acceleration,
                                             .acc = state_.fluid.acc,
                                             .reaction = span_if(state_.two_way, state_.fluid.reaction),
                                             .drag_kick = state_.fluid.drag_kick});
    const Vec3d body{l.v[0], l.v[1], l.v[2]}, total{l.v[3], l.v[4], l.v[5]};
    // columns do not depend on options, which may change at a restart
    const bool corrected = state_.fluid.correction.used(), damped = state_.fluid.compression_rate.used();
    SumReduction<4, CorrectionBody>::Value c{};
    if (corrected) c = sum_over<4>(state_.fluid.owned(), CorrectionBody{contents, state_.fluid.correction});
    SumReduction<1, DamperBody>::Value d{};
    if (damped)
      d = sum_over<1>(state_.fluid.owned(), DamperBody{stepper_.fluid().damping(), config_.fluid.rho0,
                                                       contents, state_.fluid.compression_rate});
    const Vec3d of_fluid{c.v[0], c.v[1], c.v[2]};
    // part of the loads reported on bodies, and so of the opposite, the forces of walls on the fluid
    LoadSum of_bodies = LoadSum::zero();
    double power_of_bodies = 0;
    for (int b = 0; b < state_.motion.walls(); ++b) {
      const LoadSum load = correction(b);
      const RigidMotion motion = state_.motion.pose(b, state_.clock.time);
      LoadSum::combine(of_bodies, load);
      power_of_bodies += dot(load.force(), motion.v) + dot(load.torque(), motion.omega);
    }
    wall_on_fluid -= of_bodies.force();
    const Vec3d corrections = of_fluid + of_bodies.force();
    vec("force_pressure_correction", "N", corrections);
    out.push_back({"power_pressure_correction", "W", c.v[3] + power_of_bodies});
    out.push_back({"power_acoustic_damper", "W", d.v[0]});
    report_powers(drive, power_of_bodies, out);
    vec("force_walls_on_fluid", "N", wall_on_fluid);
    vec("force_grains_on_fluid", "N", {l.v[6], l.v[7], l.v[8]});
    // pair sums balance: the rest is round-off
    vec("fluid_force_residual", "N", total - body - wall_on_fluid - corrections);
    out.push_back({"fluid_speed_max", "m/s", std::sqrt(stepper_.fluid_extremes().v2)});
    const auto largest = [&](auto body) {  // NaN without fluid
      const double found = max_over(state_.fluid.owned(), body);
      return state_.fluid.everywhere() > 0 ? found : std::nan("");
    };
    out.push_back({"pressure_max", "Pa", largest(PressureBody{state_.fluid.eos_state, 1})});
    out.push_back({"pressure_min", "Pa", -largest(PressureBody{state_.fluid.eos_state, -1})});
    out.push_back({"density_max", "kg/m3", largest(DensityBody{state_.fluid.eos_state, 1})});
    out.push_back({"density_min", "kg/m3", -largest(DensityBody{state_.fluid.eos_state, -1})});
    out.push_back({"fluid_count", "-", double(state_.fluid.everywhere())});
    if (!state_.shells.surfaces().empty())
      out.push_back({"fluid_pairs_through_walls", "-",
                     stepper_.fluid().pairs_through(state_.fluid, state_.shells.view(), state_.poses_now())});
  }
  if (state_.has_grains) {
    const auto s = stepper_.solids().totals(state_.grains);
    out.push_back({"grain_mass", "kg", s.mass});
    vec("grain_centre", "m", s.centre);
    vec("grain_momentum", "kg m/s", s.momentum);
    vec("grain_angular_momentum", "kg m2/s", s.angular);
    out.push_back({"grain_kinetic_energy", "J", s.kinetic});
    out.push_back({"grain_rotational_energy", "J", s.rotational});
    out.push_back({"grain_potential_energy", "J", -s.mass * dot(config_.gravity, s.centre)});
    out.push_back({"grain_elastic_energy", "J", s.elastic});
    for (const Quantity& q : stepper_.solids().energy_terms(state_.grains)) out.push_back(q);
    out.push_back({"grain_speed_max", "m/s", stepper_.grain_watch().speed});
    out.push_back({"overlap_max", "-", s.max_overlap});
    out.push_back({"coordination_number", "-", s.coordination});
    const auto f = sum_over<4>(
        state_.grains.owned(),
        GrainLoads{state_.frame, state_.grains.x, state_.grains.fluid_force, state_.grains.drag_force});
    vec("force_fluid_on_grains", "N", {f.v[0], f.v[1], f.v[2]});
    out.push_back({"grain_count", "-", double(state_.grains.everywhere())});
    out.push_back({"grains_outside", "-", f.v[3]});
    const Clumps& clumps = std::as_const(stepper_).solids().clumps();
    if (clumps.any()) out.push_back({"clump_count", "-", double(clumps.store().size())});
  }
  if (state_.coupled) {
    const auto c = stepper_.coupling().counters(state_.fluid, state_.grains);
    const double least = -max_over(state_.fluid.owned(), PorosityBody{state_.fluid.eps});
    out.push_back({"porosity_min", "-", state_.fluid.everywhere() > 0 ? least : std::nan("")});
    out.push_back({"porosity_floor_hits", "-", double(c.floor_hits)});
    out.push_back({"drag_limited_grains", "-", double(c.limited)});
    out.push_back({"wet_grains", "-", double(c.wet)});
    out.push_back({"grains_at_porosity_floor", "-", double(c.densest)});
    out.push_back({"grains_in_corners", "-", double(c.cornered)});
    out.push_back({"grains_without_couple", "-", double(c.uncoupled)});
    out.push_back({"drag_line_limited_grains", "-", double(c.bent)});
  }
  if (state_.has_grains || state_.bodies.any()) {
    double dropped = state_.bodies.dropped_contacts(state_.poses_now());
    if (state_.has_grains) dropped += stepper_.solids().dropped_contacts(state_.grains, state_.poses_now());
    out.push_back({"wall_contacts_dropped", "-", dropped});
  }
  if (state_.bodies.any()) {
    const BodyTotals t = state_.bodies.totals(state_.clock.time);
    out.push_back({"body_mass", "kg", t.mass});
    vec("body_momentum", "kg m/s", t.momentum);
    vec("body_angular_momentum", "kg m2/s", t.angular);
    out.push_back({"body_kinetic_energy", "J", t.kinetic});
    out.push_back({"body_rotational_energy", "J", t.rotational});
    out.push_back({"body_potential_energy", "J", t.potential});
    out.push_back({"bodies_outside", "-", double(t.outside)});
  }
  for (const Quantity& q : state_.open.report(state_.clock.time)) out.push_back(q);
  out.push_back({"rebuilds", "-", double(stepper_.rebuilds())});
  return out;
}

}  // namespace BL_SOLVER
