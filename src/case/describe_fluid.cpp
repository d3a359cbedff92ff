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
}

}  // namespace

void describe_fill_file(Parameters& p, std::string& file, std::int64_t& step, std::string_view meaning) {
  p("file", &file, {.meaning = meaning, .fallback = "none", .presence = optional});
  if (has_frames(file) || p.everything())
    p("step", &step,
      {.meaning = "frame of a .vtkhdf file, from 0; -1: the last", .range = within(-1, 2147483647)});
}

void describe_fluid(Parameters& p, FluidConfig& f) {
  p("fluid.dx", &f.dx, {.unit = "m", .meaning = "particle spacing", .range = above(0), .presence = required});
  p("fluid.kernel", &f.kernel, {.meaning = "smoothing kernel", .family = "models"});
  p("fluid.h_over_dx", &f.h_over_dx,
    {.meaning = "smoothing length / spacing (lucy: 2..4)",
     .range = f.kernel == KernelFunction::lucy ? within(2, 4) : within(1.2, 3)});
  p("fluid.rho0", &f.rho0, {.unit = "kg/m3", .meaning = "density at rest", .range = above(0)});
  p("fluid.mu", &f.mu, {.unit = "Pa s", .meaning = "shear viscosity; > 0 with grains", .range = at_least(0)});
  p("fluid.vmax", &f.vmax,
    {.unit = "m/s",
     .meaning = "fastest flow expected; at least sqrt(2 g H) and the walls'",
     .range = above(0),
     .fallback = "sqrt(2 g H)",
     .presence = optional});
  p("fluid.c_factor", &f.c_factor, {.meaning = "sound speed / vmax", .range = within(5, 50)});
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
  p("density.delta", &c.density.delta, {.meaning = "density diffusion; 0 off", .range = within(0, 0.2)});
  p("density.void_relaxation", &c.density.void_relaxation,
    {.meaning = "void relaxation: how fast pressure fades where the fluid leaves voids, in c/h; 0 off",
     .range = within(0, 10),
     .formerly = "consolidation"});
  p("density.cavitation_limit", &c.density.cavitation_limit,
    {.meaning = "fluid cavitates below rho/rho0 - 1 = minus this",
     .range = within(1e-4, 0.5),
     .formerly = "tension"});
  p("visc.model", &c.visc.model, {.meaning = "physical viscosity", .family = "laws"});
  p("visc.alpha", &c.visc.alpha,
    {.meaning = "artificial viscosity, linear [monaghan92]", .range = within(0, 1)});
  p("visc.beta", &c.visc.beta, {.meaning = "artificial viscosity, quadratic", .range = within(0, 2)});
  p("drive.f", &c.drive.f, {.unit = "N/m3", .meaning = "constant force per volume of space, on the fluid"});
  p("drive.rate", &c.drive.rate,
    {.unit = "1/s", .meaning = "per axis; fluid is pulled by -rate^2 (r - centre) in m/s2"});
  p("drive.centre", &c.drive.centre, {.unit = "m", .meaning = "where to"});
}

}  // namespace bedload
