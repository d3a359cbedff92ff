// Data for the viscometer: masses, velocities, driving forces, stress by part.

#include "src/measure/arrays.hpp"
#include "src/time/coupled_simulation.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

struct MixtureVolume {
  Span<const Real4> m_state;
  Span<Real> out;
  BL_HD void operator()(Index a) const { out[a] = m_state[a].x / m_state[a].z; }
};
struct DrivingForce {
  Real3 gravity;  ///< m/s2
  Drive drive;
  Span<const Real> mass;
  Span<const Real4> m_state;
  Span<Real3> out;
  BL_HD void operator()(Index a) const { out[a] = mass[a] * (gravity + drive(a, m_state[a])); }
};
struct GrainMass {
  MassPerR3 mass_per_r3;
  Span<const Real> radius;
  Span<Real> out;
  BL_HD void operator()(Index i) const { out[i] = Real(mass_per_r3(i)) * cube(radius[i]); }
};
struct GrainVolume {
  Span<const Real> radius;
  Span<Real> out;
  BL_HD void operator()(Index i) const { out[i] = Real(4.0 / 3) * kPi * cube(radius[i]); }
};
struct GrainDrivingForce {
  Real3 gravity;  ///< m/s2
  MassPerR3 mass_per_r3;
  Span<const Real> radius;
  Span<const Real3> drive;  ///< N; empty: none
  Span<Real3> out;
  BL_HD void operator()(Index i) const {
    out[i] = Real(mass_per_r3(i)) * cube(radius[i]) * gravity;
    if (drive) out[i] += drive[i];
  }
};

HostArray moments(const char* name, const Buffer<PairMoment<>>& buffer) {
  HostArray a{name, "J", FileType<Real>::scalar, 9, {}};
  a.bytes.resize(buffer.size() * sizeof(PairMoment<>));
  copy_to_host(a.bytes.data(), buffer.data(), a.bytes.size());
  return a;
}

}  // namespace

HostStore CoupledSimulation::rheology(const std::string& name) {
  HostStore out{name, 0, {}};
  const Real3 gravity{state_.gravity.at(state_.clock.time)};
  if (name == "fluid" && state_.has_fluid) {
    const Range all = state_.fluid.owned();
    out.count = all.size();
    const Span<const Real4> state = state_.fluid.m_state;
    out.arrays.push_back(made<Real3, PointPass<FluidPosition>>("position", "m", all, state_.frame,
                                                               Span<const FluidPosition>(state_.fluid.x)));
    out.arrays.push_back(
        made<Real3, VelocityPass>("velocity", "m/s", all, Span<const Real4>(state_.fluid.v_rho)));
    out.arrays.push_back(state_.fluid.mass.to_host());
    out.arrays.push_back(made<Real, MixtureVolume>("volume", "m3", all, state));
    out.arrays.push_back(made<Real3, DrivingForce>("drive", "N", all, gravity,
                                                   stepper_.fluid().drive(state_.fluid, stepper_.moment()),
                                                   Span<const Real>(state_.fluid.mass), state));
    stepper_.fluid().moments(state_.fluid, state_.walls, stepper_.moment(), state_.clock.last_dt,
                             fluid_moments_);
    out.arrays.push_back(moments("stress_pressure", fluid_moments_.pressure));
    out.arrays.push_back(moments("stress_friction", fluid_moments_.friction));
    if (fluid_moments_.noise.size() > 0) out.arrays.push_back(moments("stress_noise", fluid_moments_.noise));
  } else if (name == "grains" && state_.has_grains) {
    const Range all = state_.grains.owned();
    out.count = all.size();
    const MassPerR3 mass_per_r3 = state_.matter.of(state_.grains);
    const Span<const Real> radius = state_.grains.radius;
    out.arrays.push_back(made<Real3, PointPass<Vec3d>>("position", "m", all, state_.frame,
                                                       Span<const Vec3d>(state_.grains.x)));
    out.arrays.push_back(renamed(state_.grains.v, "velocity"));
    out.arrays.push_back(made<Real, GrainMass>("mass", "kg", all, mass_per_r3, radius));
    out.arrays.push_back(made<Real, GrainVolume>("volume", "m3", all, radius));
    out.arrays.push_back(made<Real3, GrainDrivingForce>("drive", "N", all, gravity, mass_per_r3, radius,
                                                        stepper_.drive_grains()));
    stepper_.solids().contact_moments(state_.grains, contact_moments_);
    out.arrays.push_back(moments("stress_contact", contact_moments_));
    if (stepper_.solids().lubricates()) {
      stepper_.solids().film_moments(state_.grains, contact_moments_);
      out.arrays.push_back(moments("stress_lubrication", contact_moments_));
    }
  }
  return out;
}

}  // namespace bedload::inline BL_VARIANT
