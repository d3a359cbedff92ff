// Parameters of the whole case: domain, coupling, time, outputs.

#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;
constexpr double kLargest = 9.2e18;  // of TOML's integers

void patches(Parameters& p, ProbeConfig& b) {
  p("radius", &b.radius,
    {.unit = "m",
     .meaning = "wall_pressure: of a disc, which counts as the square of its area",
     .range = above(0),
     .fallback = "a rectangle",
     .presence = optional});
  if (b.radius == 0 || p.everything()) {
    p("size", &b.size,
      {.unit = "m",
       .meaning = "wall_pressure: sides of a rectangle, [a, b]",
       .range = above(0),
       .fallback = "a disc",
       .presence = optional});
    p("count", &b.count,
      {.meaning = "wall_pressure: patches into which the rectangle is cut along a and b",
       .range = within(1, 1000),
       .fallback = "[1, 1]",
       .presence = optional});
  }
  p("normal", &b.normal,
    {.meaning = "wall_pressure: into the fluid", .fallback = "of the surface nearest to at"});
  p("along", &b.along,
    {.meaning = "wall_pressure: direction of side a", .fallback = "horizontal, to the right; x on a floor"});
}

void probe(Parameters& p, ProbeConfig& b) {
  p("name", &b.name, {.meaning = "file under probes/", .presence = required});
  p("type", &b.type, {.meaning = "what is measured", .presence = required, .family = "outputs"});
  using enum ProbeType;
  const auto wanted = [&](ProbeType type) { return b.type == type || p.everything(); };
  if (wanted(front) || wanted(box)) p("phase", &b.phase, {.meaning = "front, box: of which"});
  if (wanted(front)) {
    std::string direction(kFaces[2 * b.axis + (b.sign > 0)]);
    std::vector<Choice> directions;
    for (const auto& face : kFaces) directions.push_back({std::string(face), ""});
    p("direction", &direction, {.meaning = "front: which way", .fallback = "x+", .choices = directions});
    b.axis = direction[0] - 'x';
    b.sign = direction[1] == '+' ? 1 : -1;
  }
  if (wanted(point) || wanted(height) || wanted(wall_pressure))
    p("at", &b.at,
      {.unit = "m",
       .meaning = "point, height: place; wall_pressure: centre, on the surface; at t = 0",
       .presence = required});
  if (wanted(box)) {
    p("min", &b.min, {.unit = "m", .meaning = "box: lower corner", .presence = required});
    p("max", &b.max, {.unit = "m", .meaning = "box: upper corner", .presence = required});
  }
  if (wanted(force) || wanted(wall_pressure))
    p("body", &b.body,
      {.meaning = "force, wall_pressure: name of the wall body; point: of one that carries it (optional)",
       .presence = required});
  else if (wanted(point))
    p("body", &b.body, {.meaning = "name of a wall body that carries the point", .presence = optional});
  if (wanted(force)) {
    p("about", &b.about, {.unit = "m", .meaning = "force: torque about this point"});
    p("sample", &b.sample, {.meaning = "force: what a row holds"});
  }
  if (wanted(wall_pressure)) patches(p, b);
  p("every", &b.every,
    {.unit = "s", .meaning = "interval", .range = above(0), .fallback = "out.every", .presence = optional});
}

}  // namespace

void describe_top(Parameters& p, Config& c) {
  p("title", &c.title, {.meaning = "name of the case in outputs", .fallback = "none"});
  p("preset", &c.preset, {.meaning = "set of defaults under the case's own keys", .family = "presets"});
  p("gravity", &c.gravity, {.unit = "m/s2", .meaning = "acceleration of gravity"});
  p("tensile", &c.tensile,
    {.meaning = "1: pressure term against clumping [monaghan00]", .range = within(0, 1)});
  p("xsph", &c.xsph,
    {.meaning = "fraction of the neighbours' velocity in the motion (XSPH)", .range = within(0, 1)});
  p("shift.A", &c.shift,
    {.meaning = "particle shifting: how fast particles of straining fluid leave where they crowd, after "
                "[lind12]; 0 off; no effect with grains coupled both ways and with single layers",
     .range = within(0, 1000)});
}

void describe_domain(Parameters& p, DomainConfig& d) {
  p("domain.min", &d.min, {.unit = "m", .meaning = "lower corner", .presence = required});
  p("domain.max", &d.max, {.unit = "m", .meaning = "upper corner, above domain.min", .presence = required});
  p("domain.periodic", &d.periodic, {.meaning = "per axis; a period exceeds 2 kappa h and 4 R"});
  p("domain.two_d", &d.two_d,
    {.meaning =
         "plane flow in x and z, one layer of particles that stands for the domain's length along y, without "
         "grains"});
  p("domain.shear_rate", &d.shear_rate,
    {.unit = "1/s",
     .meaning =
         "mean dv_x/dz that Lees-Edwards boundaries impose on fluid in a periodic domain: images across "
         "z move along x [lees72]; 0 none"});
  p("domain.reflect.slip", &d.reflect.slip,
    {.meaning =
         "sides, of \"x-\" .. \"z+\", at which particles and grains that cross them are put back as by a "
         "mirror: place and velocity along the normal are reversed; these sides have no particles and touch "
         "no grain",
     .fallback = "none",
     .presence = optional});
  p("domain.reflect.no_slip", &d.reflect.no_slip,
    {.meaning = "sides that put back likewise, but reverse the whole velocity [tsuzuki]",
     .fallback = "none",
     .presence = optional});
}

void describe_coupling(Parameters& p, CouplingConfig& c) {
  p("couple.mode", &c.mode, {.meaning = "what fluid and grains exchange", .family = "models"});
  p("couple.hc", &c.hc,
    {.unit = "m",
     .meaning = "smoothing length of the coupling",
     .range = above(0),
     .fallback = "max(h, 4 d_max/kappa)",
     .presence = optional});
  p("couple.kernel", &c.kernel,
    {.meaning = "by which grains and fluid weigh each other", .family = "models"});
  p("couple.eps_min", &c.eps_min, {.meaning = "lowest porosity", .range = within(0.1, 0.5)});
  p("couple.wall_normalise", &c.wall_normalise,
    {.meaning = "a grain beside a wall has all its volume, and its buoyancy, on this side of it"});
  p("couple.spreading", &c.spreading,
    {.meaning =
         "how fast fluid among grains whose particles overfill their volume grows denser, in c/h; 0 off",
     .range = within(0, 1)});
  p("couple.undisturbed", &c.undisturbed,
    {.meaning = "a grain's own wake and volume are taken off the flow and porosity that set its drag; off, "
                "lone grains are too fast by up to 0.54 d / h_c"});
  p("couple.S_dry", &c.S_dry,
    {.meaning = "a grain is dry where fluid fills less than this of the kernel that walls leave free",
     .range = above_to(0, 0.9)});
  p("couple.S_wet", &c.S_wet,
    {.meaning = "and fully wetted from here on, above S_dry; linear in between", .range = above_to(0, 1)});
  p("couple.torque", &c.torque, {.meaning = "fluid torque on grains"});
  p("couple.angmom", &c.angmom, {.meaning = "reaction couple: what is exchanged keeps angular momentum"});
  p("couple.slip", &c.slip, {.meaning = "what slip drag follows", .family = "models"});
  p("couple.suspension_viscosity", &c.suspension,
    {.meaning = "by how much grains thicken the fluid around them, over fluid.mu", .family = "models"});
  p("couple.phi_max", &c.phi_max,
    {.meaning = "volume fraction of grains at which couple.suspension_viscosity is infinite; it counts up to "
                "0.95 of that",
     .range = within(0.4, 0.8)});
  p("drag.law", &c.drag, {.meaning = "drag on a grain", .family = "laws"});
  if (c.drag == DragLaw::table || p.everything()) {
    const auto p_table = [&](std::string_view key, std::vector<double>& list, Interval range,
                             std::string_view meaning) {
      p(key, &list,
        {.meaning = meaning, .range = range, .presence = c.drag == DragLaw::table ? required : optional});
    };
    p_table("drag.porosity", c.table.porosity, above_to(0, 1), "table: porosities, rising");
    p_table("drag.reynolds", c.table.reynolds, at_least(0),
            "table: Reynolds numbers of the superficial slip, rho eps w d / mu, rising from 0");
    p_table("drag.factor", c.table.factor, above(0),
            "table: drag over Stokes drag, K / (3 pi mu d); for each porosity a number for each of "
            "drag.reynolds");
  }
  p("drag.integrator", &c.integrator, {.meaning = "how drag advances a grain", .family = "models"});
}

void describe_time(Parameters& p, Config& c) {
  const auto fraction = [](std::string_view meaning) {
    return About{.meaning = meaning, .range = above_to(0, 0.5)};
  };
  TimeConfig& t = c.time;
  p("time.end", &t.end, {.unit = "s", .meaning = "end of the run", .range = above(0), .presence = required});
  p("time.dt", &t.dt,
    {.unit = "s", .meaning = "fixed step", .range = above(0), .fallback = "adaptive", .presence = optional});
  p("time.dt_dem", &t.dt_dem,
    {.unit = "s",
     .meaning = "fixed step of the grains",
     .range = above(0),
     .fallback = "adaptive",
     .presence = optional});
  p("time.force_dt", &t.force_dt, {.meaning = "a fixed step above its limit only warns"});
  p("time.cfl", &t.cfl, fraction("fraction of the limit by sound"));
  p("time.visc", &t.visc, fraction("by viscosity"));
  if (c.fluid.sdpd() || p.everything())
    p("time.friction", &t.friction, fraction("SDPD: of the time in which friction stops a particle"));
  p("time.body", &t.body, fraction("by acceleration"));
  p("time.drag", &t.drag, fraction("by drag"));
  p("time.rayleigh", &t.rayleigh, fraction("by Rayleigh waves in a grain"));
  p("time.contact", &t.contact, fraction("of a contact's duration"));
  p("time.integrator", &t.integrator, {.meaning = "scheme", .family = "models"});
  p("run.precision", &c.precision, {.meaning = "number types", .family = "models"});
  p("run.simd", &c.simd,
    {.meaning = "instructions of the CPU; results differ by rounding", .family = "models"});
  p("run.seed", &c.seed, {.meaning = "of everything random", .range = within(0, kLargest)});
  p("run.max_lost", &c.max_lost,
    {.meaning =
         "fraction of fluid, grains or free bodies that may leave the domain where no outlet is; more: exit "
         "code 4",
     .range = within(0, 1)});
  p("run.skin_fluid", &c.skin_fluid,
    {.unit = "fluid.dx",
     .meaning = "margin of the fluid's neighbour lists; up to four times that for what is fast, while they "
                "would last less than eight steps",
     .range = within(0.01, 2)});
  p("run.skin_grain", &c.skin_grain,
    {.unit = "d_min", .meaning = "margin of the grains' neighbour lists", .range = within(0.01, 2)});
}

void describe_output(Parameters& p, OutputConfig& o) {
  p("out.every", &o.every,
    {.unit = "s", .meaning = "interval of frames", .range = above(0), .presence = required});
  p("out.diagnostics_every", &o.diagnostics_every,
    {.unit = "s",
     .meaning = "interval of diagnostics.csv",
     .range = above(0),
     .fallback = "out.every",
     .presence = optional});
  p("out.walls", &o.walls, {.meaning = "frames of the walls too"});
  p("out.bodies", &o.bodies,
    {.meaning = "wall bodies with a table bodies/<name>.csv: motion, forces, power", .family = "outputs"});
  p("checkpoint.every", &o.checkpoint_every,
    {.unit = "s", .meaning = "interval; 0: only at the end", .range = at_least(0)});
  p.list("probe", o.probes, ProbeConfig{}, probe);
}

void describe_paper(Parameters& p, Config& c) {
  p("paper.he_damping", &c.contact.he_damping,
    {.meaning = "Hertz damping of He et al. (20b): e comes out low"});
  p("paper.he_tensile", &c.tensile_one_sign, {.meaning = "tensile term 0.01 for both signs of P"});
}

}  // namespace bedload
