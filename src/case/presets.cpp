#include <cmath>

#include "bedload/case/read.hpp"
#include "reader.hpp"

namespace bedload {

namespace {

/// None of what keeps WCSPH smooth: thermal noise would trigger it.
void set_sdpd(Config& c) {
  c.shift = c.xsph = c.tensile = 0;
  c.tensile_one_sign = false;
  c.density.delta = c.density.void_relaxation = 0;
  c.pressure.damper = 0;
  c.pressure.linear_exact = false;
  c.density.cavitation_limit = 0.5;
  c.density.method = DensityMethod::summation;
  c.visc.model = ViscosityModel::none;
  c.wall.no_penetration = c.wall.repulsion = false;
  c.wall.suction = true;
  c.wall.energy_consistent = false;
  c.time.integrator = TimeIntegrator::kdk;
}

/// What DEMocritus does, but for velocities that are reversed at the edges of the domain.
void set_democritus(Config& c) {
  c.fluid.kernel = KernelFunction::lucy;
  c.fluid.h_over_dx = 3;
  c.fluid.model = FluidModel::sdpd_a;
  c.eos.type = EosType::democritus;
  c.eos.clip_negative = true;
  c.eos.filter = true;
  c.sdpd.noise = NoiseForm::tensor;
  c.density.count_grains = true;
  c.wall.type = WallType::frozen;
  c.contact.normal = NormalLaw::democritus;
  c.contact.tangential = SlidingLaw::democritus;
  c.contact.rolling = RollingLaw::none;
  c.couple.kernel = CouplingKernel::top_hat;
  c.couple.own_hc = false;
  c.couple.drag = DragLaw::gidaspow;
  c.couple.torque = false;
}

void set_he2018(Config& c) {
  c.fluid.h_over_dx = 1.3;
  c.density.delta = 0;
  c.density.void_relaxation = 0;
  c.pressure.damper = 0;
  c.pressure.linear_exact = false;
  c.wall.repulsion = c.wall.suction = true;
  c.wall.no_penetration = c.wall.energy_consistent = false;
  c.tensile = 1;
  c.tensile_one_sign = true;
  c.xsph = 0.3;
  c.shift = 0;
  c.contact.tangential = SlidingLaw::mindlin_deresiewicz;
  c.contact.rolling = RollingLaw::cdt;
  c.contact.clip_tension = false;
  c.contact.he_damping = true;
  c.couple.drag = DragLaw::gidaspow;
  c.couple.wall_normalise = false;
  c.couple.own_hc = false;
  c.couple.S_wet = 0.5;
  c.couple.integrator = DragIntegrator::explicit_steps;
  c.couple.torque = false;
  c.couple.angmom = false;
  c.couple.slip = DragSlip::mean;
  c.time.integrator = TimeIntegrator::euler;
}

/// Section 3 of [harting14]. A grain is wet where fluid fills more than half of its kernel, and dry
/// elsewhere.
void set_robinson2014(Config& c) {
  c.fluid.kernel = KernelFunction::cubic;
  c.fluid.variable_h = true;
  c.visc.model = ViscosityModel::signal;
  c.pressure.damper = 0;
  c.density.delta = 0;
  c.density.void_relaxation = 0;
  c.density.cavitation_limit = 0.5;
  c.wall.type = WallType::single_layer;
  c.wall.suction = true;
  c.wall.no_penetration = c.wall.energy_consistent = false;
  c.contact.normal = NormalLaw::linear;
  c.contact.tangential = SlidingLaw::none;
  c.contact.rolling = RollingLaw::none;
  c.contact.clip_tension = false;
  c.couple.wall_normalise = false;
  c.couple.own_hc = false;
  c.couple.S_dry = 0.499;
  c.couple.S_wet = 0.501;
  c.couple.torque = false;
  c.couple.angmom = false;
}

}  // namespace

Config defaults_of(const Value& root) {
  Config c;
  Reader reader(root);
  Parameters& read = reader;
  read("preset", &c.preset, {});
  switch (c.preset) {
    case Preset::standard:
      break;
    case Preset::he2018:
      set_he2018(c);
      break;
    case Preset::democritus:
      set_democritus(c);
      break;
    case Preset::robinson2014:
      set_robinson2014(c);
      break;
  }
  read("fluid.model", &c.fluid.model, {});
  read("fluid.variable_h", &c.fluid.variable_h, {});
  if (c.fluid.variable_h) c.shift = 0, c.pressure.linear_exact = false;  // they go with one smoothing length
  switch (c.fluid.model) {
    case FluidModel::wcsph:
    case FluidModel::lattice:
      break;
    case FluidModel::sdpd:
    case FluidModel::sdpd_a:
      set_sdpd(c);
      break;
  }
  return c;
}

Config settling_case(const Config& config) {
  Config dry;
  dry.domain = config.domain;
  dry.gravity = config.gravity;
  dry.shapes = config.shapes;
  dry.wall.bodies = config.wall.bodies;
  for (WallBody& body : dry.wall.bodies) {  // walls begin to move at t = 0
    body.motion = {};
    body.surface_velocity = {};
  }
  dry.contact = config.contact;
  dry.grain = config.grain;
  dry.grain.release_time = 0;
  if (std::isfinite(config.grain.settle_mu)) dry.grain.mu = config.grain.settle_mu;
  dry.grain.settle_mu = GrainConfig{}.settle_mu;
  dry.couple.mode = CouplingMode::off;
  dry.time.rayleigh = config.time.rayleigh;
  dry.time.contact = config.time.contact;
  dry.time.dt_dem = config.time.dt_dem;
  dry.time.force_dt = config.time.force_dt;
  dry.precision = config.precision;
  dry.seed = config.seed;
  dry.skin_grain = config.skin_grain;
  return dry;
}

}  // namespace bedload
