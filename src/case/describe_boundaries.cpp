// Parameters of openings: where fluid and grains come in and go out.

#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;

void start_and_stop(Parameters& p, double& start, double& stop, std::string_view opens,
                    std::string_view closes) {
  p("start", &start, {.unit = "s", .meaning = opens, .range = at_least(0)});
  p("stop", &stop,
    {.unit = "s", .meaning = closes, .range = above(start), .fallback = "never", .presence = unbounded});
}

void inlet(Parameters& p, InletConfig& i) {
  p("name", &i.name, {.meaning = "by which diagnostics and messages know it", .presence = required});
  p("shape", &i.shape, {.meaning = "of the orifice", .family = "shapes"});
  p("centre", &i.centre, {.unit = "m", .meaning = "of the orifice", .presence = required});
  p("direction", &i.direction, {.meaning = "of the flow, across the orifice", .presence = required});
  if (i.shape == OrificeShape::disc || p.everything())
    p("radius", &i.radius, {.unit = "m", .meaning = "disc", .range = above(0), .presence = required});
  if (i.shape == OrificeShape::rectangle || p.everything()) {
    p("half_a", &i.half_a,
      {.unit = "m", .meaning = "rectangle: from its centre to the middle of a side", .presence = required});
    p("half_b", &i.half_b,
      {.unit = "m", .meaning = "rectangle: to the middle of the next side", .presence = required});
  }
  p("rate", &i.rate,
    {.unit = "m3/s",
     .meaning = "volume of fluid at rho0 let in; or velocity",
     .range = above(0),
     .fallback = "one of two",
     .presence = optional});
  p("velocity", &i.velocity,
    {.unit = "m/s",
     .meaning = "of the fluid in the orifice",
     .range = above(0),
     .fallback = "one of two",
     .presence = optional});
  p("factor", &i.factor, {.meaning = "of rate or velocity, a formula in t (s); below zero counts as zero"});
  p("ramp", &i.ramp,
    {.unit = "s",
     .meaning = "opening and closing take this long",
     .range = above(0),
     .fallback = "10 h/c",
     .presence = optional});
  start_and_stop(p, i.start, i.stop, "begins to open", "begins to close");
}

void outlet(Parameters& p, OutletConfig& o) {
  p("name", &o.name, {.meaning = "by which diagnostics and messages know it", .presence = required});
  p("phase", &o.phase, {.meaning = "what it takes"});
  p("shape", &o.shape,
    {.meaning = "where particles are taken out", .family = "shapes", .or_else = "the name of a [[shape]]"});
  if (o.shape == OutletShape::box || p.everything()) {
    p("min", &o.min, {.unit = "m", .meaning = "box: lower corner", .presence = required});
    p("max", &o.max, {.unit = "m", .meaning = "box: upper corner", .presence = required});
  }
  if (o.shape == OutletShape::plane || p.everything()) {
    p("point", &o.point, {.unit = "m", .meaning = "plane: a point on it", .presence = required});
    p("normal", &o.normal, {.meaning = "plane: direction out of the flow", .presence = required});
  }
}

void grain_inlet(Parameters& p, GrainInletConfig& i) {
  p("name", &i.name, {.meaning = "by which diagnostics and messages know it", .presence = required});
  p("shape", &i.shape, {.meaning = "where grains are dropped in, at random", .family = "shapes"});
  if (i.shape == GrainInletShape::box || p.everything()) {
    p("min", &i.min, {.unit = "m", .meaning = "box: lower corner", .presence = required});
    p("max", &i.max, {.unit = "m", .meaning = "box: upper corner", .presence = required});
  }
  if (i.shape == GrainInletShape::disc || p.everything()) {
    p("centre", &i.centre, {.unit = "m", .meaning = "disc: its centre", .presence = required});
    p("direction", &i.direction, {.meaning = "disc: its axis", .presence = required});
    p("radius", &i.radius, {.unit = "m", .meaning = "disc", .range = above(0), .presence = required});
  }
  p("rate", &i.rate,
    {.unit = "1/s",
     .meaning = "grains dropped; or mass_rate",
     .range = above(0),
     .fallback = "one of two",
     .presence = optional});
  p("mass_rate", &i.mass_rate,
    {.unit = "kg/s",
     .meaning = "mass of the grains dropped",
     .range = above(0),
     .fallback = "one of two",
     .presence = optional});
  p("velocity", &i.velocity, {.unit = "m/s", .meaning = "of a grain as it comes in"});
  describe_grain_material(p, i.material);
  start_and_stop(p, i.start, i.stop, "from then on, after grain.release_time", "and until then");
  p.list("sizes", i.sizes, SizeClass{}, describe_grain_size);
}

}  // namespace

void describe_inlets(Parameters& p, std::vector<InletConfig>& inlets) {
  p.list("inlet", inlets, InletConfig{}, inlet);
}

void describe_outlets(Parameters& p, std::vector<OutletConfig>& outlets) {
  p.list("outlet", outlets, OutletConfig{}, outlet);
}

void describe_grain_inlets(Parameters& p, std::vector<GrainInletConfig>& inlets) {
  p.list("grain_inlet", inlets, GrainInletConfig{}, grain_inlet);
}

}  // namespace bedload
