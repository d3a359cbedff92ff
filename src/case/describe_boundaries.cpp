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
  p("name", &i.name, {.meaning = "name of the inlet in diagnostics and messages", .presence = required});
  p("shape", &i.shape, {.meaning = "shape of the orifice", .family = "shapes"});
  p("centre", &i.centre, {.unit = "m", .meaning = "centre of the orifice", .presence = required});
  p("direction", &i.direction,
    {.meaning = "direction of the inflow, normal to the orifice", .presence = required});
  if (i.shape == OrificeShape::disc || p.everything())
    p("radius", &i.radius, {.unit = "m", .meaning = "disc: radius", .range = above(0), .presence = required});
  if (i.shape == OrificeShape::rectangle || p.everything()) {
    p("half_a", &i.half_a,
      {.unit = "m",
       .meaning = "rectangle: vector from the centre to the midpoint of a side",
       .presence = required});
    p("half_b", &i.half_b,
      {.unit = "m",
       .meaning = "rectangle: vector from the centre to the midpoint of the adjacent side",
       .presence = required});
  }
  p("rate", &i.rate,
    {.unit = "m3/s",
     .meaning = "volume flow rate of the inflow at density rho0; alternative to velocity",
     .range = above(0),
     .fallback = "one of two required",
     .presence = optional});
  p("velocity", &i.velocity,
    {.unit = "m/s",
     .meaning = "velocity of the fluid in the orifice; alternative to rate",
     .range = above(0),
     .fallback = "one of two required",
     .presence = optional});
  p("factor", &i.factor,
    {.meaning = "factor on rate or velocity, a formula in t (s); negative values count as 0"});
  p("ramp", &i.ramp,
    {.unit = "s",
     .meaning = "time that opening and closing take",
     .range = above(0),
     .fallback = "10 h/c",
     .presence = optional});
  start_and_stop(p, i.start, i.stop, "time at which the inlet begins to open",
                 "time at which the inlet begins to close");
}

void outlet(Parameters& p, OutletConfig& o) {
  p("name", &o.name, {.meaning = "name of the outlet in diagnostics and messages", .presence = required});
  p("phase", &o.phase, {.meaning = "phase that is removed"});
  p("shape", &o.shape,
    {.meaning = "region in which particles are removed",
     .family = "shapes",
     .or_else = "the name of a [[shape]]"});
  if (o.shape == OutletShape::box || p.everything()) {
    p("min", &o.min, {.unit = "m", .meaning = "box: lower corner", .presence = required});
    p("max", &o.max, {.unit = "m", .meaning = "box: upper corner", .presence = required});
  }
  if (o.shape == OutletShape::plane || p.everything()) {
    p("point", &o.point, {.unit = "m", .meaning = "plane: a point on the plane", .presence = required});
    p("normal", &o.normal, {.meaning = "plane: normal, pointing out of the flow", .presence = required});
  }
}

void grain_inlet(Parameters& p, GrainInletConfig& i) {
  p("name", &i.name,
    {.meaning = "name of the grain inlet in diagnostics and messages", .presence = required});
  p("shape", &i.shape,
    {.meaning = "region in which grains are inserted at random positions", .family = "shapes"});
  if (i.shape == GrainInletShape::box || p.everything()) {
    p("min", &i.min, {.unit = "m", .meaning = "box: lower corner", .presence = required});
    p("max", &i.max, {.unit = "m", .meaning = "box: upper corner", .presence = required});
  }
  if (i.shape == GrainInletShape::disc || p.everything()) {
    p("centre", &i.centre, {.unit = "m", .meaning = "disc: centre", .presence = required});
    p("direction", &i.direction, {.meaning = "disc: direction of the axis", .presence = required});
    p("radius", &i.radius, {.unit = "m", .meaning = "disc: radius", .range = above(0), .presence = required});
  }
  p("rate", &i.rate,
    {.unit = "1/s",
     .meaning = "number of grains inserted per second; alternative to mass_rate",
     .range = above(0),
     .fallback = "one of two required",
     .presence = optional});
  p("mass_rate", &i.mass_rate,
    {.unit = "kg/s",
     .meaning = "mass of grains inserted per second; alternative to rate",
     .range = above(0),
     .fallback = "one of two required",
     .presence = optional});
  p("velocity", &i.velocity, {.unit = "m/s", .meaning = "velocity of inserted grains"});
  describe_grain_material(p, i.material);
  describe_clumps_of(p, i.clump, i.orientation);
  start_and_stop(p, i.start, i.stop, "start of insertion, at grain.release_time or later",
                 "end of insertion");
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
