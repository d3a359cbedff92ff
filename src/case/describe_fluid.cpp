// Parameters of the fluid.

#include "bedload/case/particle_file.hpp"
#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;

/// Of fluid on nodes, which fills the domain anyway: its velocity alone.
void node_fill(Parameters& p, FluidFill& f) {
  p("min", &f.min, {.unit = "m", .meaning = "lower corner of a box of fluid", .presence = required});
  p("max", &f.max, {.unit = "m", .meaning = "upper corner of the box", .presence = required});
  p("velocity", &f.velocity,
    {.unit = "m/s", .meaning = "initial velocity, three numbers or formulas in x, y, z"});
}

void fluid_fill(Parameters& p, FluidFill& f) {
  describe_fill_file(p, f.file, f.step,
                     ".csv or .vtkhdf file with particles of mass rho0 dx^3, instead of a box");
  if (f.file.empty() || p.everything())
    p("shape", &f.shape,
      {.meaning = "name of a shape to fill, instead of a box", .fallback = "none", .presence = optional});
  if ((f.file.empty() && f.shape.empty()) || p.everything()) {
    p("min", &f.min, {.unit = "m", .meaning = "lower corner of a box of fluid", .presence = required});
    p("max", &f.max, {.unit = "m", .meaning = "upper corner of the box", .presence = required});
  }
  if (!f.shape.empty() || p.everything())
    p("level", &f.level,
      {.unit = "m",
       .meaning = "shape: level up to which it is filled, measured upwards (against gravity)",
       .fallback = "to the top",
       .presence = unbounded});
  p("velocity", &f.velocity,
    {.unit = "m/s", .meaning = "initial velocity, three numbers or formulas in x, y, z"});
  p("species", &f.species,
    {.meaning = "name of the fluid.species of this fill", .fallback = "first species", .presence = optional});
}

void fluid_species(Parameters& p, FluidSpecies& s) {
  p("name", &s.name, {.meaning = "name by which fills refer to the species", .presence = required});
  p("mu", &s.mu,
    {.unit = "Pa s", .meaning = "dynamic (shear) viscosity", .range = above(0), .presence = required});
}

void describe_kernel(Parameters& p, FluidConfig& f) {
  p("fluid.kernel", &f.kernel, {.meaning = "smoothing kernel", .family = "models"});
  p("fluid.h_over_dx", &f.h_over_dx,
    {.meaning = "smoothing length over particle spacing (lucy: 2..4)",
     .range = f.kernel == KernelFunction::lucy ? within(2, 4) : within(1.2, 3)});
  p("fluid.variable_h", &f.variable_h,
    {.meaning = "the smoothing length of each particle follows its volume, within 0.5 to 2 sigma_h dx"});
  if (f.variable_h || p.everything())
    p("fluid.sigma_h", &f.sigma_h,
      {.meaning = "variable_h: smoothing length over the cube root of the particle's volume (plane flow: the "
                  "square root of its area); replaces h_over_dx",
       .range = within(1.2, 2)});
}

void describe_sdpd(Parameters& p, Config& c) {
  p("pressure.filter", &c.eos.filter,
    {.meaning = "SDPD: the pressure is averaged over the neighbours once per step; this also smooths real "
                "gradients"});
  p("sdpd.kT", &c.sdpd.kT,
    {.unit = "J",
     .meaning = "SDPD: thermal energy k_B T of the fluctuations; 0: no noise",
     .range = at_least(0)});
  p("sdpd.kI", &c.sdpd.kI,
    {.meaning = "sdpd_a: moment of inertia of a particle, divided by m dx^2", .range = within(0.01, 1)});
  p("sdpd.noise", &c.sdpd.noise,
    {.meaning = "SDPD: random numbers per pair of particles", .family = "models"});
  p("sdpd.force_scale", &c.sdpd.force_scale,
    {.meaning = "SDPD: factors on the four pair forces [pressure, friction, friction of spins, noise]; 0 "
                "switches a force off",
     .range = at_least(0)});
}

}  // namespace

void describe_fill_file(Parameters& p, std::string& file, std::int64_t& step, std::string_view meaning) {
  p("file", &file, {.meaning = meaning, .fallback = "none", .presence = optional});
  if (has_frames(file) || p.everything())
    p("step", &step,
      {.meaning = "frame of the .vtkhdf file, from 0; -1: the last", .range = within(-1, 2147483647)});
}

void describe_fluid(Parameters& p, FluidConfig& f) {
  p("fluid.model", &f.model, {.meaning = "fluid model", .family = "models"});
  p("fluid.dx", &f.dx,
    {.unit = "m",
     .meaning = "initial particle spacing; lattice: spacing of the nodes, which must divide the domain",
     .range = above(0),
     .presence = required});
  if (of_particles(p, f)) describe_kernel(p, f);
  p("fluid.rho0", &f.rho0, {.unit = "kg/m3", .meaning = "reference density", .range = above(0)});
  p("fluid.mu", &f.mu,
    {.unit = "Pa s", .meaning = "dynamic (shear) viscosity; must be > 0 with grains", .range = at_least(0)});
  if (f.model->own_viscosity || p.everything())
    p("fluid.zeta", &f.zeta,
      {.unit = "Pa s",
       .meaning = "SDPD: bulk viscosity, at most 5 mu / 3",
       .range = at_least(0),
       .fallback = "20 mu / 21",
       .presence = unbounded});
  p("fluid.vmax", &f.vmax,
    {.unit = "m/s",
     .meaning =
         "highest flow speed expected, which sets the sound speed, and the step of a lattice; sqrt(2 g "
         "H), the speed of walls or that of inlets is used where it is higher",
     .range = above(0),
     .fallback = "sqrt(2 g H)",
     .presence = optional});
  if (!of_particles(p, f)) return p.list("fluid.fill", f.fills, FluidFill{}, node_fill);
  p("fluid.c_factor", &f.c_factor, {.meaning = "numerical sound speed over vmax", .range = within(5, 50)});
  p.list("fluid.species", f.species, FluidSpecies{}, fluid_species);
  p.list("fluid.fill", f.fills, FluidFill{}, fluid_fill);
}

void describe_lattice(Parameters& p, LatticeConfig& l) {
  p("lattice.collision", &l.collision, {.meaning = "collision of populations", .family = "models"});
  if (l.collision == LatticeCollision::trt || p.everything())
    p("lattice.magic", &l.magic,
      {.meaning = "trt: magic number Lambda; 3/16 sets walls half-way between nodes",
       .range = above_to(0, 1)});
  p("lattice.velocity", &l.velocity,
    {.meaning =
         "fluid.vmax in nodes per step, which sets the time step; compressibility errors grow with its "
         "square",
     .range = above_to(0, 0.15)});
  p("lattice.tau_max", &l.tau_max,
    {.meaning = "upper limit of the relaxation time, in steps, which shortens the time step of viscous fluid",
     .range = above_to(0.505, 2)});
  p("lattice.tau", &l.tau,
    {.meaning = "relaxation time in steps, which sets the time step instead of velocity and tau_max",
     .range = within(0.505, 2),
     .fallback = "by velocity and tau_max",
     .presence = optional});
  p("lattice.mass_every", &l.mass_every,
    {.meaning =
         "number of steps after which the mass of the fluid is restored to that at the start; 0: never",
     .range = within(0, 1000000)});
}

void describe_fluid_models(Parameters& p, Config& c) {
  p("eos.type", &c.eos.type, {.meaning = "equation of state", .family = "laws"});
  p("eos.gamma", &c.eos.gamma, {.meaning = "tait: exponent", .range = within(1, 7)});
  p("eos.background", &c.eos.background,
    {.unit = "Pa",
     .meaning = "tait: background pressure, the pressure at rho0; keeps fluid without a free surface from "
                "fragmenting",
     .range = at_least(0)});
  p("eos.p0", &c.eos.p0,
    {.unit = "Pa", .meaning = "democritus: pressure scale, which sets the sound speed", .range = above(0)});
  p("eos.alpha", &c.eos.alpha, {.meaning = "democritus: exponent", .range = at_least(1)});
  p("eos.beta", &c.eos.beta, {.unit = "Pa", .meaning = "democritus: constant subtracted from the pressure"});
  p("eos.clip_negative", &c.eos.clip_negative, {.meaning = "negative pressure is set to 0"});
  p("pressure.damper", &c.pressure.damper,
    {.meaning = "acoustic damper: bulk viscosity that damps sound and leaves shear alone, over rho0 c h "
                "[sun23]; 0: off",
     .range = within(0, 1)});
  p("pressure.linear_exact", &c.pressure.linear_exact,
    {.meaning = "where viscosity dominates at the scale of a particle, its pressure force is exact for a "
                "linear pressure field, but momentum is not conserved exactly; needs shift.A > 0"});
  if (c.fluid.model->thermal || p.everything()) describe_sdpd(p, c);
  p("density.delta", &c.density.delta,
    {.meaning = "density diffusion (delta-SPH): coefficient; 0: off", .range = within(0, 0.2)});
  p("density.void_relaxation", &c.density.void_relaxation,
    {.meaning = "void relaxation: rate at which pressure fades where the fluid has voids, over c/h; 0: off",
     .range = within(0, 10),
     .formerly = "consolidation"});
  p("density.cavitation_limit", &c.density.cavitation_limit,
    {.meaning = "cavitation limit: the fluid separates where rho/rho0 - 1 falls below minus this value",
     .range = within(1e-4, 0.5),
     .formerly = "tension"});
  if (c.fluid.model->summation || p.everything()) {
    p("density.method", &c.density.method,
      {.meaning = "SDPD: method that gives the density", .family = "models"});
    p("density.reinit_every", &c.density.reinit_every,
      {.meaning = "SDPD, continuity: number of steps after which the density is averaged over the "
                  "neighbours; 0: never",
       .range = within(0, 1000000)});
    p("density.count_grains", &c.density.count_grains,
      {.meaning = "SDPD, summation: grains count as fluid of their volume (\"single pressure\") [tsuzuki]"});
  }
  p("visc.model", &c.visc.model, {.meaning = "formulation of the physical viscosity", .family = "laws"});
  p("visc.alpha", &c.visc.alpha,
    {.meaning = "artificial viscosity: linear coefficient [monaghan92]", .range = within(0, 1)});
  p("visc.beta", &c.visc.beta,
    {.meaning = "artificial viscosity: quadratic coefficient", .range = within(0, 2)});
  p("visc.collision", &c.visc.collision,
    {.meaning = "fluid particles that approach each other within collision_range collide like solid "
                "particles [shakibaeinia12]"});
  p("visc.collision_range", &c.visc.collision_range,
    {.unit = "fluid.dx",
     .meaning = "collision: distance below which fluid particles collide",
     .range = above_to(0, 1)});
  p("visc.collision_restitution", &c.visc.collision_restitution,
    {.meaning = "collision: coefficient of restitution", .range = within(0, 1)});
}

void describe_drive(Parameters& p, Config& c) {
  p("drive.f", &c.drive.f,
    {.unit = "N/m3", .meaning = "driving force per volume of space; drive.mode: per mass or per particle"});
  p("drive.factor", &c.drive.factor,
    {.meaning = "factor on drive.f, a formula in x, y, z, t; lattice: in t", .variables = "xyzt"});
  p("drive.mode", &c.drive.mode, {.meaning = "quantity to which drive.f refers", .family = "models"});
  if (!of_particles(p, c.fluid)) return;
  p("drive.on", &c.drive.on, {.meaning = "phases on which drive.f acts", .family = "models"});
  p("drive.opposed", &c.drive.opposed,
    {.meaning = "axis along which the domain is halved; drive.f is reversed in the upper half",
     .family = "models"});
  p("drive.rate", &c.drive.rate,
    {.unit = "1/s",
     .meaning = "harmonic potential: per axis, the fluid is accelerated by -rate^2 (r - centre), in m/s2"});
  p("drive.centre", &c.drive.centre, {.unit = "m", .meaning = "centre of the harmonic potential"});
}

}  // namespace bedload
