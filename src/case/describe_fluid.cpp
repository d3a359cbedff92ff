// Parameters of the fluid.

#include "bedload/case/particle_file.hpp"
#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;

void fluid_fill(Parameters& p, FluidFill& f) {
  describe_fill_file(p, f.file, f.step,
                     "particles of mass rho0 dx^3 from a .csv or .vtkhdf file, instead of a block");
  if (f.file.empty() || p.everything())
    p("shape", &f.shape,
      {.meaning = "name of a shape to fill, instead of a box", .fallback = "none", .presence = optional});
  if ((f.file.empty() && f.shape.empty()) || p.everything()) {
    p("min", &f.min, {.unit = "m", .meaning = "lower corner of a block of fluid", .presence = required});
    p("max", &f.max, {.unit = "m", .meaning = "upper corner", .presence = required});
  }
  if (!f.shape.empty() || p.everything())
    p("level", &f.level,
      {.unit = "m",
       .meaning = "shape: filled up to this height against gravity",
       .fallback = "to the top",
       .presence = unbounded});
  p("velocity", &f.velocity, {.unit = "m/s", .meaning = "three numbers or formulas in x, y, z"});
  p("species", &f.species,
    {.meaning = "name of the fluid.species that it is of", .fallback = "the first", .presence = optional});
}

void fluid_species(Parameters& p, FluidSpecies& s) {
  p("name", &s.name, {.meaning = "by which fills name it", .presence = required});
  p("mu", &s.mu, {.unit = "Pa s", .meaning = "shear viscosity", .range = above(0), .presence = required});
}

void describe_sdpd(Parameters& p, Config& c) {
  p("pressure.filter", &c.eos.filter,
    {.meaning = "SDPD: pressure averaged over the neighbours, once a step; smears pressure out"});
  p("sdpd.kT", &c.sdpd.kT,
    {.unit = "J", .meaning = "energy k_B T of thermal fluctuations; 0: no noise", .range = at_least(0)});
  p("sdpd.kI", &c.sdpd.kI,
    {.meaning = "sdpd_a: moment of inertia of a particle / m dx^2", .range = within(0.01, 1)});
  p("sdpd.noise", &c.sdpd.noise, {.meaning = "random numbers of a pair", .family = "models"});
  p("sdpd.force_scale", &c.sdpd.force_scale,
    {.meaning = "factors on pressure, friction of velocities, that of spins, noise, to switch them off",
     .range = at_least(0)});
}

}  // namespace

void describe_fill_file(Parameters& p, std::string& file, std::int64_t& step, std::string_view meaning) {
  p("file", &file, {.meaning = meaning, .fallback = "none", .presence = optional});
  if (has_frames(file) || p.everything())
    p("step", &step,
      {.meaning = "frame of a .vtkhdf file, from 0; -1: the last", .range = within(-1, 2147483647)});
}

void describe_fluid(Parameters& p, FluidConfig& f) {
  p("fluid.model", &f.model, {.meaning = "what the fluid's particles do to each other", .family = "models"});
  p("fluid.dx", &f.dx, {.unit = "m", .meaning = "particle spacing", .range = above(0), .presence = required});
  p("fluid.kernel", &f.kernel, {.meaning = "smoothing kernel", .family = "models"});
  p("fluid.h_over_dx", &f.h_over_dx,
    {.meaning = "smoothing length / spacing (lucy: 2..4)",
     .range = f.kernel == KernelFunction::lucy ? within(2, 4) : within(1.2, 3)});
  p("fluid.variable_h", &f.variable_h,
    {.meaning = "each particle's smoothing length follows its volume, from 0.5 to 2 sigma_h dx"});
  if (f.variable_h || p.everything())
    p("fluid.sigma_h", &f.sigma_h,
      {.meaning =
           "variable_h: smoothing length / cube root of the particle's volume (plane flow: square root "
           "of its area), in place of h_over_dx",
       .range = within(1.2, 2)});
  p("fluid.rho0", &f.rho0, {.unit = "kg/m3", .meaning = "density at rest", .range = above(0)});
  p("fluid.mu", &f.mu, {.unit = "Pa s", .meaning = "shear viscosity; > 0 with grains", .range = at_least(0)});
  if (f.sdpd() || p.everything())
    p("fluid.zeta", &f.zeta,
      {.unit = "Pa s",
       .meaning = "bulk viscosity of SDPD, up to 5 mu / 3",
       .range = at_least(0),
       .fallback = "20 mu / 21",
       .presence = unbounded});
  p("fluid.vmax", &f.vmax,
    {.unit = "m/s",
     .meaning = "fastest flow expected; at least sqrt(2 g H) and the walls'",
     .range = above(0),
     .fallback = "sqrt(2 g H)",
     .presence = optional});
  p("fluid.c_factor", &f.c_factor, {.meaning = "sound speed / vmax", .range = within(5, 50)});
  p.list("fluid.species", f.species, FluidSpecies{}, fluid_species);
  p.list("fluid.fill", f.fills, FluidFill{}, fluid_fill);
}

void describe_fluid_models(Parameters& p, Config& c) {
  p("eos.type", &c.eos.type, {.meaning = "equation of state", .family = "laws"});
  p("eos.gamma", &c.eos.gamma, {.meaning = "Tait exponent", .range = within(1, 7)});
  p("eos.background", &c.eos.background,
    {.unit = "Pa",
     .meaning = "tait: pressure at rho0, for fluid without a free surface, which it keeps from fragmenting",
     .range = at_least(0)});
  p("eos.p0", &c.eos.p0, {.unit = "Pa", .meaning = "democritus: pressure scale", .range = above(0)});
  p("eos.alpha", &c.eos.alpha, {.meaning = "democritus: exponent", .range = at_least(1)});
  p("eos.beta", &c.eos.beta, {.unit = "Pa", .meaning = "democritus: background; the sound speed is derived"});
  p("eos.clip_negative", &c.eos.clip_negative, {.meaning = "no pressure below zero"});
  p("pressure.damper", &c.pressure.damper,
    {.meaning =
         "acoustic damper: bulk viscosity that takes energy from sound alone, in rho0 c h [sun23]; 0 off",
     .range = within(0, 1)});
  p("pressure.linear_exact", &c.pressure.linear_exact,
    {.meaning =
         "where viscosity rules the scale of a particle, its pressure force is made exact for a pressure "
         "that is linear in space, at the cost of exact momentum; needs shift.A"});
  const bool sdpd = c.fluid.sdpd() || p.everything();
  if (sdpd) describe_sdpd(p, c);
  p("density.delta", &c.density.delta, {.meaning = "density diffusion; 0 off", .range = within(0, 0.2)});
  p("density.void_relaxation", &c.density.void_relaxation,
    {.meaning = "void relaxation: how fast pressure fades where the fluid leaves voids, in c/h; 0 off",
     .range = within(0, 10),
     .formerly = "consolidation"});
  p("density.cavitation_limit", &c.density.cavitation_limit,
    {.meaning = "fluid cavitates below rho/rho0 - 1 = minus this",
     .range = within(1e-4, 0.5),
     .formerly = "tension"});
  if (sdpd) {
    p("density.method", &c.density.method,
      {.meaning = "SDPD: where the density comes from", .family = "models"});
    p("density.reinit_every", &c.density.reinit_every,
      {.meaning = "SDPD, continuity: steps after which density is averaged over the neighbours; 0: never",
       .range = within(0, 1000000)});
    p("density.count_grains", &c.density.count_grains,
      {.meaning = "SDPD, summation: grains count as fluid of their volume, \"single pressure\" [tsuzuki]"});
  }
  p("visc.model", &c.visc.model, {.meaning = "physical viscosity", .family = "laws"});
  p("visc.alpha", &c.visc.alpha,
    {.meaning = "artificial viscosity, linear [monaghan92]", .range = within(0, 1)});
  p("visc.beta", &c.visc.beta, {.meaning = "artificial viscosity, quadratic", .range = within(0, 2)});
  p("visc.collision", &c.visc.collision,
    {.meaning = "fluid particles that approach each other within collision_range collide, as if solid "
                "[shakibaeinia12]"});
  p("visc.collision_range", &c.visc.collision_range,
    {.unit = "fluid.dx", .meaning = "distance from which they collide", .range = above_to(0, 1)});
  p("visc.collision_restitution", &c.visc.collision_restitution,
    {.meaning = "restitution of these collisions", .range = within(0, 1)});
  p("drive.f", &c.drive.f,
    {.unit = "N/m3", .meaning = "force per volume of space or (drive.mode) by mass or particle"});
  p("drive.factor", &c.drive.factor, {.meaning = "of drive.f; a formula in x, y, z, t", .variables = "xyzt"});
  p("drive.mode", &c.drive.mode, {.meaning = "what drive.f is counted by", .family = "models"});
  p("drive.on", &c.drive.on, {.meaning = "what it acts on", .family = "models"});
  p("drive.opposed", &c.drive.opposed,
    {.meaning = "axis along which drive.f is reversed in the upper half of the domain", .family = "models"});
  p("drive.rate", &c.drive.rate,
    {.unit = "1/s", .meaning = "per axis; fluid is pulled by -rate^2 (r - centre) in m/s2"});
  p("drive.centre", &c.drive.centre, {.unit = "m", .meaning = "where to"});
}

}  // namespace bedload
