// What a viscometer reads: masses, velocities, what drives them, stress by parts.

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
  const Real3 gravity{gravity_.at(clock_.time)};
  if (name == "fluid" && has_fluid()) {
    const Range all = fluid_.owned();
    out.count = all.size();
    const Span<const Real4> state = fluid_.m_state;
    out.arrays.push_back(made<Real3, PointPass<FluidPosition>>("position", "m", all, frame_,
                                                               Span<const FluidPosition>(fluid_.x)));
    out.arrays.push_back(made<Real3, VelocityPass>("velocity", "m/s", all, Span<const Real4>(fluid_.v_rho)));
    out.arrays.push_back(fluid_.mass.to_host());
    out.arrays.push_back(made<Real, MixtureVolume>("volume", "m3", all, state));
    out.arrays.push_back(made<Real3, DrivingForce>("drive", "N", all, gravity, fluid_solver_->drive(fluid_),
                                                   Span<const Real>(fluid_.mass), state));
    fluid_solver_->moments(fluid_, walls_, clock_.last_dt, fluid_moments_);
    out.arrays.push_back(moments("stress_pressure", fluid_moments_.pressure));
    out.arrays.push_back(moments("stress_friction", fluid_moments_.friction));
    if (fluid_moments_.noise.size() > 0) out.arrays.push_back(moments("stress_noise", fluid_moments_.noise));
  } else if (name == "grains" && has_grains()) {
    const Range all = grains_.owned();
    out.count = all.size();
    const MassPerR3 mass_per_r3 = matter_.of(grains_);
    const Span<const Real> radius = grains_.radius;
    out.arrays.push_back(
        made<Real3, PointPass<Vec3d>>("position", "m", all, frame_, Span<const Vec3d>(grains_.x)));
    out.arrays.push_back(renamed(grains_.v, "velocity"));
    out.arrays.push_back(made<Real, GrainMass>("mass", "kg", all, mass_per_r3, radius));
    out.arrays.push_back(made<Real, GrainVolume>("volume", "m3", all, radius));
    out.arrays.push_back(
        made<Real3, GrainDrivingForce>("drive", "N", all, gravity, mass_per_r3, radius, drive_grains()));
    solid_solver_->contact_moments(grains_, contact_moments_);
    out.arrays.push_back(moments("stress_contact", contact_moments_));
    if (solid_solver_->lubricates()) {
      solid_solver_->film_moments(grains_, contact_moments_);
      out.arrays.push_back(moments("stress_lubrication", contact_moments_));
    }
  }
  return out;
}

}  // namespace bedload::inline BL_VARIANT
