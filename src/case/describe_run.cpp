// Parameters of the whole case: domain, coupling, time, outputs.

#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;
constexpr double kLargest = 9.2e18;  // of TOML's integers

/// Points along a line, in a plane or a grid.
void points(Parameters& p, ProbeConfig& b) {
  p("span", &b.span,
    {.unit = "m",
     .meaning =
         "point, height, field: vectors from `at` to the last point along a line; two make a plane, three a "
         "grid of points",
     .fallback = "one point",
     .presence = optional});
  if (!b.span.empty() && !p.everything())
    p("count", &b.count,
      {.meaning = "number of points along each span, ends included",
       .range = within(2, 1000),
       .presence = required});
}

void patches(Parameters& p, ProbeConfig& b) {
  p("radius", &b.radius,
    {.unit = "m",
     .meaning =
         "wall_pressure: radius of a disc, computed as a square of the same area; field: of the kernel "
         "by which grains count at a point",
     .range = above(0),
     .fallback = "size is used",
     .presence = optional});
  if (b.radius == 0 || p.everything()) {
    p("size", &b.size,
      {.unit = "m",
       .meaning = "wall_pressure: sides [a, b] of a rectangle",
       .range = above(0),
       .fallback = "radius is used",
       .presence = optional});
    p("count", &b.count,
      {.meaning =
           "wall_pressure: number of patches of the rectangle along a and b; point, height, field: number of "
           "points along each span, ends included",
       .range = within(1, 1000),
       .fallback = "[1, 1]",
       .presence = optional});
  }
  p("normal", &b.normal,
    {.meaning = "wall_pressure: normal, pointing into the fluid",
     .fallback = "normal of the surface nearest to at"});
  p("along", &b.along,
    {.meaning =
         "wall_pressure: direction of side a; height: direction of the line along which it is measured, "
         "such as up a slope",
     .fallback = "horizontal, to the right, x on a floor; height: upwards"});
}

void probe(Parameters& p, ProbeConfig& b) {
  p("name", &b.name, {.meaning = "name of the probe and of its file in probes/", .presence = required});
  p("type", &b.type, {.meaning = "measured quantity", .presence = required, .family = "outputs"});
  using enum ProbeType;
  const auto wanted = [&](ProbeType type) { return b.type == type || p.everything(); };
  if (wanted(front) || wanted(box) || wanted(flux))
    p("phase", &b.phase, {.meaning = "front, box, flux: measured phase"});
  if (wanted(front) || wanted(flux)) {
    std::string direction(kFaces[2 * b.axis + (b.sign > 0)]);
    std::vector<Choice> directions;
    for (const auto& face : kFaces) directions.push_back({std::string(face), ""});
    p("direction", &direction,
      {.meaning = "front: direction in which the front is measured; flux: direction of positive flow",
       .fallback = "x+",
       .choices = directions});
    b.axis = direction[0] - 'x';
    b.sign = direction[1] == '+' ? 1 : -1;
  }
  if (wanted(point) || wanted(height) || wanted(field) || wanted(wall_pressure))
    p("at", &b.at,
      {.unit = "m",
       .meaning = "point, height, field: position; wall_pressure: centre, on the surface; at t = 0",
       .presence = required});
  if (wanted(point) || wanted(height) || wanted(field)) points(p, b);
  if (b.type == field && !p.everything())
    p("radius", &b.radius,
      {.unit = "m",
       .meaning = "field: radius of the kernel by which grains count at a point",
       .range = above(0),
       .presence = required});
  if (wanted(field))
    p("sample_every", &b.sample_every,
      {.unit = "s",
       .meaning = "field: rows are means over instants this far apart since the row before",
       .range = above(0),
       .fallback = "a row is of one instant",
       .presence = optional});
  if (b.type == height && !p.everything())
    p("along", &b.along, {.meaning = "height: direction of the line", .fallback = "upwards"});
  if (wanted(box) || wanted(flux) || wanted(mixing)) {
    p("min", &b.min, {.unit = "m", .meaning = "box, flux, mixing: lower corner", .presence = required});
    p("max", &b.max,
      {.unit = "m",
       .meaning =
           "box, mixing: upper corner; flux: of a box around the section, over whose length it is averaged",
       .presence = required});
  }
  if (wanted(force) || wanted(wall_pressure))
    p("body", &b.body,
      {.meaning = "force, wall_pressure: name of the wall body; point: name of the wall body with which the "
                  "point moves (optional)",
       .presence = required});
  else if (wanted(point))
    p("body", &b.body,
      {.meaning = "point: name of the wall body with which the point moves", .presence = optional});
  if (wanted(force)) {
    p("about", &b.about, {.unit = "m", .meaning = "force: reference point of the torque"});
    p("sample", &b.sample, {.meaning = "force: mean or instantaneous values"});
  }
  if (wanted(wall_pressure)) patches(p, b);
  if (wanted(mixing)) {
    p("of", &b.of,
      {.meaning =
           "mixing: name of the grain.material that is one kind, \"grain\" for that of grain.*; the other "
           "kind is the rest",
       .fallback = "larger_than is used",
       .presence = optional});
    if (b.of.empty() || p.everything())
      p("larger_than", &b.larger_than,
        {.unit = "m",
         .meaning = "mixing: diameter that the grains of one kind exceed",
         .range = above(0),
         .presence = required});
    p("cell", &b.cell,
      {.unit = "m",
       .meaning = "mixing: edge of the cells that are the samples",
       .range = above(0),
       .presence = required});
  }
  p("every", &b.every,
    {.unit = "s",
     .meaning = "output interval",
     .range = above(0),
     .fallback = "out.every",
     .presence = optional});
}

}  // namespace

void describe_top(Parameters& p, Config& c) {
  p("title", &c.title, {.meaning = "title of the case in outputs", .fallback = "none"});
  p("preset", &c.preset,
    {.meaning = "set of default values; keys of the case take precedence", .family = "presets"});
  p("gravity", &c.gravity, {.unit = "m/s2", .meaning = "acceleration of gravity"});
  if (!of_particles(p, c.fluid)) return;
  p("tensile", &c.tensile,
    {.meaning = "tensile term, a pair pressure against clumping of particles [monaghan00]; 1: on, 0: off",
     .range = within(0, 1)});
  p("xsph", &c.xsph,
    {.meaning = "XSPH: weight of the neighbours' velocity in the motion of particles; 0: off",
     .range = within(0, 1)});
  p("shift.A", &c.shift,
    {.meaning =
         "particle shifting: how fast particles of straining fluid leave where they crowd, after "
         "[lind12]; 0 off; no effect with single layers and, among grains coupled both ways, where the "
         "cell Reynolds number of fluid.vmax is 1000 or more",
     .range = within(0, 1000)});
}

void describe_domain(Parameters& p, Config& c) {
  DomainConfig& d = c.domain;
  p("domain.min", &d.min, {.unit = "m", .meaning = "lower corner of the domain", .presence = required});
  p("domain.max", &d.max, {.unit = "m", .meaning = "upper corner of the domain", .presence = required});
  p("domain.periodic", &d.periodic,
    {.meaning = "periodic axes [x, y, z]; a period must exceed 2 kappa h and 4 R"});
  p("domain.shear_rate", &d.shear_rate,
    {.unit = "1/s",
     .meaning = "Lees-Edwards boundaries: mean dv_x/dz imposed on fluid in a periodic domain, whose images "
                "across z move along x [lees72]; with grains on a lattice alone; 0: off"});
  if (!of_particles(p, c.fluid)) return;
  p("domain.two_d", &d.two_d,
    {.meaning = "plane flow in x and z: one layer of particles that represents the domain's length along y; "
                "without grains"});
  p("domain.reflect.slip", &d.reflect.slip,
    {.meaning = "reflecting boundaries with slip, of \"x-\" .. \"z+\": fluid particles and grains whose "
                "centres cross are reflected, position and normal velocity; these sides have no wall "
                "particles and no contacts with grains",
     .fallback = "none",
     .presence = optional});
  p("domain.reflect.no_slip", &d.reflect.no_slip,
    {.meaning =
         "reflecting boundaries without slip: as reflect.slip, but the whole velocity is reversed [tsuzuki]",
     .fallback = "none",
     .presence = optional});
}

void describe_coupling(Parameters& p, CouplingConfig& c) {
  p("couple.mode", &c.mode, {.meaning = "coupling of fluid and grains", .family = "models"});
  p("couple.hc", &c.hc,
    {.unit = "m",
     .meaning = "coupling length h_c: smoothing length with which fluid is averaged around grains",
     .range = above(0),
     .fallback = "max(h, 4 d_max/kappa); with own lengths max(h, 4 d_min/kappa)",
     .presence = optional});
  p("couple.own_hc", &c.own_hc,
    {.meaning =
         "own lengths: where the largest grain is at least twice as wide as the smallest, each grain has "
         "its own coupling length, max(couple.hc, 4 d/kappa); otherwise all have couple.hc"});
  p("couple.between", &c.between,
    {.meaning =
         "grains of four to eight fluid.dx, too large for drag laws and too small for the fluid to flow "
         "around them",
     .family = "models"});
  p("couple.kernel", &c.kernel,
    {.meaning = "kernel of the averages over fluid and grains", .family = "models"});
  p("couple.eps_min", &c.eps_min, {.meaning = "lower limit of the porosity", .range = within(0.1, 0.5)});
  p("couple.wall_normalise", &c.wall_normalise,
    {.meaning = "volume and buoyancy of a grain near a wall are normalised by the part of its kernel that "
                "lies outside walls"});
  p("couple.spreading", &c.spreading,
    {.meaning = "spreading: rate at which the density rises where fluid particles among grains overfill "
                "their volume, over c/h; 0: off",
     .range = within(0, 1)});
  p("couple.undisturbed", &c.undisturbed,
    {.meaning =
         "undisturbed flow: the grain's own wake and volume are subtracted from the flow and porosity that "
         "set its drag; without it, single grains settle too fast by a fraction of up to 0.54 d / h_c"});
  p("couple.S_dry", &c.S_dry,
    {.meaning = "wetness: a grain is dry, without drag, where fluid fills less than this fraction of the "
                "kernel outside walls",
     .range = above_to(0, 0.9)});
  p("couple.S_wet", &c.S_wet,
    {.meaning =
         "wetness: a grain is fully wet from this fraction on; linear from S_dry to S_wet, must exceed S_dry",
     .range = above_to(0, 1)});
  p("couple.torque", &c.torque, {.meaning = "the fluid exerts a torque on grains"});
  p("couple.angmom", &c.angmom,
    {.meaning = "reaction couple on the fluid, so that the exchange conserves angular momentum"});
  p("couple.slip", &c.slip, {.meaning = "slip velocity in the drag law", .family = "models"});
  p("couple.suspension_viscosity", &c.suspension,
    {.meaning = "suspension viscosity: viscosity of fluid and grains together, over fluid.mu",
     .family = "models"});
  p("couple.phi_max", &c.phi_max,
    {.meaning = "solid volume fraction at which couple.suspension_viscosity diverges; fractions above 0.95 "
                "phi_max count as 0.95 phi_max",
     .range = within(0.4, 0.8)});
  p("drag.law", &c.drag, {.meaning = "drag law of grains", .family = "laws"});
  if (c.drag == DragLaw::table || p.everything()) {
    const auto p_table = [&](std::string_view key, std::vector<double>& list, Interval range,
                             std::string_view meaning) {
      p(key, &list,
        {.meaning = meaning, .range = range, .presence = c.drag == DragLaw::table ? required : optional});
    };
    p_table("drag.porosity", c.table.porosity, above_to(0, 1), "table: porosities, in increasing order");
    p_table("drag.reynolds", c.table.reynolds, at_least(0),
            "table: Reynolds numbers rho eps w d / mu of the superficial slip velocity, increasing from 0");
    p_table("drag.factor", c.table.factor, above(0),
            "table: drag over Stokes drag, K / (3 pi mu d); for each porosity one number per entry of "
            "drag.reynolds");
  }
  p("drag.integrator", &c.integrator,
    {.meaning = "time integration of the drag on grains", .family = "models"});
}

void describe_time(Parameters& p, Config& c) {
  const auto fraction = [](std::string_view meaning) {
    return About{.meaning = meaning, .range = above_to(0, 0.5)};
  };
  TimeConfig& t = c.time;
  p("time.end", &t.end,
    {.unit = "s", .meaning = "end time of the run", .range = above(0), .presence = required});
  const bool particles = of_particles(p, c.fluid);
  if (particles)
    p("time.dt", &t.dt,
      {.unit = "s",
       .meaning = "fixed time step",
       .range = above(0),
       .fallback = "adaptive",
       .presence = optional});
  p("time.dt_dem", &t.dt_dem,
    {.unit = "s",
     .meaning = "fixed DEM substep of the grains",
     .range = above(0),
     .fallback = "adaptive",
     .presence = optional});
  p("time.force_dt", &t.force_dt,
    {.meaning = "a fixed step above its stability limit gives a warning instead of an error"});
  if (particles) {
    p("time.cfl", &t.cfl, fraction("safety factor of the CFL limit (sound)"));
    p("time.visc", &t.visc, fraction("safety factor of the viscous limit"));
    if (c.fluid.model->own_viscosity || p.everything())
      p("time.friction", &t.friction,
        fraction("SDPD: safety factor of the friction limit, the time in which friction stops a particle"));
    p("time.body", &t.body, fraction("safety factor of the acceleration limit"));
    p("time.drag", &t.drag, fraction("safety factor of the drag limit"));
  }
  p("time.rayleigh", &t.rayleigh, fraction("DEM substep over the Rayleigh time of a grain"));
  p("time.contact", &t.contact, fraction("DEM substep over the duration of a contact"));
  if (particles)
    p("time.integrator", &t.integrator, {.meaning = "time integration scheme", .family = "models"});
  p("run.precision", &c.precision, {.meaning = "floating-point precision", .family = "models"});
  p("run.simd", &c.simd,
    {.meaning = "instruction set of the CPU; results differ by round-off", .family = "models"});
  p("run.block", &c.block,
    {.meaning =
         "cells of the neighbour search each way in a block, which one device owns: 1, 2, 4 or 8; results "
         "differ by round-off",
     .range = within(1, 8)});
  p("run.seed", &c.seed, {.meaning = "seed of all random numbers", .range = within(0, kLargest)});
  p("run.max_lost", &c.max_lost,
    {.meaning = "fraction of the fluid, grains or free bodies that may leave the domain other than by "
                "outlets; beyond it the run ends with exit code 4",
     .range = within(0, 1)});
  p("run.skin_fluid", &c.skin_fluid,
    {.unit = "fluid.dx",
     .meaning = "skin of the fluid's neighbour lists; up to four times as wide for fast particles where "
                "lists would last fewer than eight steps",
     .range = within(0.01, 2)});
  p("run.skin_grain", &c.skin_grain,
    {.unit = "d_min", .meaning = "skin of the grains' neighbour lists", .range = within(0.01, 2)});
}

void describe_output(Parameters& p, OutputConfig& o) {
  p("out.every", &o.every,
    {.unit = "s", .meaning = "output interval of frames", .range = above(0), .presence = required});
  p("out.diagnostics_every", &o.diagnostics_every,
    {.unit = "s",
     .meaning = "output interval of diagnostics.csv",
     .range = above(0),
     .fallback = "out.every",
     .presence = optional});
  p("out.walls", &o.walls, {.meaning = "frames of the wall particles are written, too"});
  p("out.fields", &o.fields,
    {.meaning =
         "fields in frames, such as \"velocity\"; position, id, radius and body are always written; of "
         "grains also \"contact_stress\", which is written only if it is named",
     .fallback = "all",
     .presence = optional});
  p("out.energy", &o.energy,
    {.meaning =
         "energy balance of the grains in diagnostics.csv: what contacts dissipate, the work of walls, "
         "gravity and fluid, and the residual; evaluates contacts twice"});
  p("out.spectra", &o.spectra,
    {.meaning =
         "spectra.csv: how much energy single contacts of grains dissipate from beginning to end, by pair of "
         "materials and sizes, and spectra_peaks.csv: their peak elastic energies and normal forces; with "
         "the columns of out.energy"});
  if (o.spectra || p.everything()) {
    p("out.spectra_bins", &o.spectra_bins,
      {.meaning = "bins of the spectra a decade", .range = within(5, 50)});
    p("out.spectra_from", &o.spectra_from,
      {.unit = "J",
       .meaning =
           "lower edge of the first bin, which has all lower energies too; the last ends 14 decades above",
       .range = within(1e-30, 1)});
    p("out.spectra_from_force", &o.spectra_from_force,
      {.unit = "N",
       .meaning = "lower edge of the first bin of peak forces; the last ends 14 decades above",
       .range = within(1e-30, 1e6)});
    p("out.spectra_sizes", &o.spectra_sizes,
      {.unit = "m",
       .meaning = "diameters between classes of sizes, each with spectra of its own; in rising order",
       .range = above(0),
       .fallback = "one class",
       .presence = optional});
  }
  p("out.contacts", &o.contacts,
    {.meaning = "frames contacts.vtkhdf of single contacts of grains, with their forces",
     .family = "outputs"});
  p("out.bodies", &o.bodies,
    {.meaning = "wall bodies with a table bodies/<name>.csv of motion, forces and power",
     .family = "outputs"});
  p("checkpoint.every", &o.checkpoint_every,
    {.unit = "s", .meaning = "interval of checkpoints; 0: only at the end", .range = at_least(0)});
  p.list("probe", o.probes, ProbeConfig{}, probe);
}

void describe_paper(Parameters& p, Config& c) {
  p("paper.he_damping", &c.contact.he_damping,
    {.meaning =
         "Hertz damping of He et al. (2018), eq. 20b, with which the restitution is lower than grain.e"});
  p("paper.he_tensile", &c.tensile_one_sign,
    {.meaning = "tensile term: factor 0.01 for both signs of the pressure"});
}

}  // namespace bedload
