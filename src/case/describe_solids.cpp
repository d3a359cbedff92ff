// Parameters of walls, contacts and grains.

#include <string>

#include "bedload/case/contact_laws.hpp"
#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;

/// Keys of tables and formulas.
void motion_law(Parameters& p, const std::string& at, MotionPart& m) {
  const auto wanted = [&](MotionKind kind) { return m.kind == kind || p.everything(); };
  if (wanted(MotionKind::table)) {
    p(at + "file", &m.file,
      {.meaning = "table: CSV file, path relative to the case file; header t [s], x, y, z [m], rx, ry, rz "
                  "[deg], all but t optional",
       .fallback = "file or rows",
       .presence = optional});
    p(at + "rows", &m.rows,
      {.unit = "s, m, deg",
       .meaning = "table: rows [[t, x, y, z], ...] or [[t, x, y, z, rx, ry, rz], ...], instead of a file",
       .fallback = "file or rows",
       .presence = optional});
    p(at + "spline", &m.spline,
      {.meaning = "table: cubic interpolation of the rows; at rest before the first and after the last",
       .family = at == "motion." ? "shapes" : ""});
  }
  if (wanted(MotionKind::formula)) {
    p(at + "displacement", &m.displacement,
      {.unit = "m", .meaning = "formula: displacement, three numbers or formulas in t", .variables = "t"});
    p(at + "rotation", &m.rotation,
      {.unit = "deg",
       .meaning = "formula: rotation vector about motion.centre, three numbers or formulas in t",
       .variables = "t"});
  }
}

/// The wave of a piston or flap.
void wave(Parameters& p, const std::string& at, MotionPart& m) {
  WaveConfig& w = m.wave;
  p(at + "wave_height", &w.height,
    {.unit = "m",
     .meaning = "piston, flap: height of the waves, from trough to crest, below that at which they break",
     .range = above(0),
     .presence = required});
  p(at + "wave_period", &w.period,
    {.unit = "s", .meaning = "piston, flap: period of the waves", .range = above(0), .presence = required});
  p(at + "wave_depth", &w.depth,
    {.unit = "m",
     .meaning = "piston, flap: depth of still water before it",
     .range = above(0),
     .presence = required});
  p(at + "wave_order", &w.order,
    {.meaning = "piston, flap: order of the theory, 1 or 2; 2 makes no free second harmonics",
     .range = within(1, 2)});
  p(at + "wave_direction", &w.direction, {.meaning = "piston, flap: direction in which the waves run"});
  p(at + "wave_ramp", &w.ramp,
    {.meaning = "piston, flap: number of periods over which the motion rises to its full stroke",
     .range = at_least(0)});
}

/// One part of a motion; `at` stands before its keys. `bedload list shapes` shows it once, for a body.
void motion_part(Parameters& p, const std::string& at, MotionPart& m) {
  p(at + "kind", &m.kind, {.meaning = "kind of motion", .family = at == "motion." ? "shapes" : ""});
  const auto wanted = [&](MotionKind kind) { return m.kind == kind || p.everything(); };
  if (wanted(MotionKind::velocity))
    p(at + "velocity", &m.velocity,
      {.unit = "m/s", .meaning = "velocity: constant velocity", .presence = required});
  if (wanted(MotionKind::oscillation)) {
    p(at + "amplitude", &m.amplitude,
      {.unit = "m", .meaning = "oscillation: amplitude of the displacement, a vector", .presence = required});
    p(at + "frequency", &m.frequency,
      {.unit = "Hz", .meaning = "oscillation: frequency", .range = above(0), .presence = required});
  }
  if (wanted(MotionKind::rotation))
    p(at + "axis", &m.axis, {.meaning = "rotation: direction of the axis", .presence = required});
  const bool hinged = m.kind == MotionKind::rotation || m.kind == MotionKind::flap;
  if (hinged || wanted(MotionKind::table) || wanted(MotionKind::formula))
    p(at + "centre", &m.centre,
      {.unit = "m",
       .meaning =
           "rotation: a point on the axis; table, formula: centre of rotation; flap: a point on its hinge",
       .fallback = "required for rotation and flap, else [0, 0, 0]",
       .presence = hinged ? required : defaulted});
  if (wanted(MotionKind::rotation))
    p(at + "rate", &m.rate,
      {.unit = "rad/s", .meaning = "rotation: angular velocity, right-handed", .presence = required});
  if (wanted(MotionKind::velocity) || wanted(MotionKind::rotation))
    p(at + "factor", &m.factor,
      {.meaning = "velocity, rotation: factor on velocity or rate, a formula in t (s); the displacement is "
                  "the integral"});
  motion_law(p, at, m);
  if (wanted(MotionKind::piston) || wanted(MotionKind::flap)) wave(p, at, m);
  if (m.kind == MotionKind::fixed && !p.everything()) return;
  p(at + "start", &m.start,
    {.unit = "s",
     .meaning = "start of the motion; t in its formulas and tables counts from here",
     .range = at_least(0)});
  p(at + "stop", &m.stop,
    {.unit = "s",
     .meaning = "end of the motion",
     .range = above(m.start),
     .fallback = "never",
     .presence = optional});
}

void motion_parts(Parameters& p, const std::string& at, MotionConfig& m) {
  p.list(at + "add", m.add, MotionPart{}, [](Parameters& q, MotionPart& part) { motion_part(q, "", part); });
}

void body_motion(Parameters& p, MotionConfig& m, bool removable) {
  motion_part(p, "motion.", m);
  if (removable && (m.kind != MotionKind::fixed || p.everything()))
    p("motion.remove_when_clear", &m.remove_when_clear,
      {.meaning = "the body is removed once it is above all fluid and grains"});
  motion_parts(p, "motion.", m);
}

/// Of a body made of particles.
void particle_wall(Parameters& p, WallBody& b) {
  p("slip", &b.slip, {.meaning = "slip or no slip of the fluid", .fallback = "wall.slip"});
  if (b.single_layer() || p.everything())
    p("force", &b.force, {.meaning = "single_layer: repulsive force on the fluid", .fallback = "wall.force"});
  if (!b.single_layer() || p.everything()) {
    p("no_penetration", &b.no_penetration,
      {.meaning = "penetration limit: stops fluid within fluid.dx / 4 of the surface",
       .fallback = "wall.no_penetration"});
    p("repulsion", &b.repulsion,
      {.meaning = "Monaghan repulsion near the surface; frozen walls always have it",
       .fallback = "wall.repulsion"});
  }
  p("dx", &b.dx,
    {.unit = "m",
     .meaning = "spacing of its particles, fluid.dx/4..fluid.dx; single_layer: at most fluid.dx/2",
     .range = above(0),
     .fallback = "wall.dx; single_layer: at most fluid.dx/2",
     .presence = optional});
}

/// particles: it is made of them.
void wall_body(Parameters& p, WallBody& b, const ContactConfig& contact, bool particles) {
  p("name", &b.name, {.meaning = "name of the body in probes, outputs and messages", .presence = required});
  p("shape", &b.shape,
    {.meaning = "shape of the body",
     .presence = required,
     .family = "shapes",
     .or_else = "the name of a [[shape]]"});
  const bool plane = b.shape == WallShape::plane;
  if (b.shape == WallShape::tank || b.shape == WallShape::box || p.everything()) {
    p("min", &b.min, {.unit = "m", .meaning = "tank, box: lower corner", .presence = required});
    p("max", &b.max, {.unit = "m", .meaning = "tank, box: upper corner", .presence = required});
  }
  if (b.shape == WallShape::tank || p.everything())
    p("faces", &b.faces, {.meaning = "tank: sides that exist, of \"x-\" .. \"z+\"", .fallback = "all"});
  if (plane || p.everything()) {
    p("point", &b.point, {.unit = "m", .meaning = "plane: a point on the plane", .presence = required});
    p("normal", &b.normal, {.meaning = "plane: normal, pointing into the flow", .presence = required});
  }
  p("type", &b.type, {.meaning = "boundary condition for the fluid", .fallback = "wall.type"});
  p("surface_velocity", &b.surface_velocity,
    {.unit = "m/s",
     .meaning = "velocity of a surface that slides in its own plane (lid, belt), in the body's axes"});
  if (particles) particle_wall(p, b);
  if (b.stops_grains() || p.everything()) {
    p("material", &b.material,
      {.meaning =
           "name of the grain.material of the wall; mu, mu_r and e on it are then the mean of the grain's "
           "and its own",
       .fallback = "as the grains on it",
       .presence = optional});
    p("mu", &b.mu,
      {.meaning = "coefficient of sliding friction of grains on the wall",
       .range = within(0, 5),
       .fallback = "mean with material, or grain.mu",
       .presence = unbounded});
    p("mu_r", &b.mu_r,
      {.meaning = "coefficient of rolling friction of grains on the wall",
       .range = within(0, 1),
       .fallback = "mean with material, or grain.mu_r",
       .presence = unbounded});
    p("e", &b.e,
      {.meaning = "coefficient of restitution of grains on the wall",
       .range = within(least_restitution(contact), 1),
       .hint = "give a fraction, not percent?",
       .fallback = "mean with material, or grain.e",
       .presence = optional});
    p("E", &b.E,
      {.unit = "Pa",
       .meaning = "Young's modulus of the wall",
       .range = within(1e4, 1e12),
       .fallback = "that of material, or grain.E",
       .presence = optional});
    p("nu", &b.nu,
      {.meaning = "Poisson's ratio of the wall",
       .range = {.lo = -1, .hi = 0.5},
       .fallback = "that of material, or grain.nu",
       .presence = unbounded});
    p("wear", &b.wear,
      {.meaning =
           "wear by grains: a map in frames wear/<name>.vtkhdf; the shape of the wall does not change"});
    if (b.wear != WearLaw::none || p.everything()) {
      p("k_over_H", &b.k_over_H,
        {.unit = "1/Pa",
         .meaning = "dimensionless wear coefficient of Archard's law over the hardness of the wall; of "
                    "Finnie's, c/(psi K p)",
         .range = within(1e-18, 1e-9),
         .presence = required});
      p("wear_patch", &b.wear_patch,
        {.unit = "m",
         .meaning = "edge of the patches of the map",
         .range = above(0),
         .fallback = "largest diameter of grains",
         .presence = optional});
    }
  }
  body_motion(p, b.motion, particles);
  if (particles) describe_free_body(p, b.free);
}

void grain_material(Parameters& p, GrainMaterial& m, const ContactConfig& contact) {
  p("name", &m.name,
    {.meaning = "name by which fills and inlets refer to the material", .presence = required});
  p("rho", &m.rho,
    {.unit = "kg/m3",
     .meaning = "density",
     .range = above(0),
     .fallback = "grain.rho",
     .presence = optional});
  p("E", &m.E,
    {.unit = "Pa",
     .meaning = "Young's modulus",
     .range = within(1e4, 1e12),
     .fallback = "grain.E",
     .presence = optional});
  p("nu", &m.nu,
    {.meaning = "Poisson's ratio",
     .range = {.lo = -1, .hi = 0.5},
     .fallback = "grain.nu",
     .presence = unbounded});
  p("mu", &m.mu,
    {.meaning = "coefficient of sliding friction; between two materials that of their contact.pair, else the "
                "mean of both",
     .range = within(0, 5),
     .fallback = "grain.mu",
     .presence = unbounded});
  p("mu_r", &m.mu_r,
    {.meaning = "rolling friction, likewise",
     .range = within(0, 1),
     .fallback = "grain.mu_r",
     .presence = unbounded});
  p("e", &m.e,
    {.meaning = "restitution, likewise",
     .range = within(least_restitution(contact), 1),
     .hint = "give a fraction, not percent?",
     .fallback = "grain.e",
     .presence = optional});
}

void grain_fill(Parameters& p, GrainFill& f) {
  describe_fill_file(p, f.file, f.step, ".csv or .vtkhdf file with the grains, instead of a box");
  if (f.file.empty() || p.everything())
    p("positions", &f.positions,
      {.unit = "m",
       .meaning = "positions of the grains, instead of a box",
       .fallback = "none",
       .presence = optional});
  const bool listed = !f.file.empty() || !f.positions.empty();
  if (listed || p.everything())
    p("relative", &f.relative,
      {.meaning = "positions, also those of a file, are fractions of the domain's side lengths, from its "
                  "lower corner"});
  if (!f.positions.empty() || p.everything()) {
    p("velocities", &f.velocities,
      {.unit = "m/s",
       .meaning = "initial velocities of the grains in `positions`, one each",
       .fallback = "velocity",
       .presence = optional});
    p("spins", &f.spins,
      {.unit = "rad/s",
       .meaning = "initial angular velocities of the grains in `positions`, one each",
       .fallback = "spin",
       .presence = optional});
  }
  if (!listed || p.everything())
    p("every", &f.every,
      {.meaning =
           "sites of a lattice of spacing fluid.dx in the box or shape, instead of random positions; [i, j, "
           "k]: every i-th, j-th and k-th along x, y and z; [n]: every n-th, counted along x, then y, then z",
       .range = within(1, 1e6),
       .fallback = "none",
       .presence = optional});
  if (!listed || p.everything()) {
    p("shape", &f.shape,
      {.meaning = "name of a shape to fill, instead of a box", .fallback = "none", .presence = optional});
    if (f.shape.empty() || p.everything()) {
      p("min", &f.min, {.unit = "m", .meaning = "lower corner of the box to fill", .presence = required});
      p("max", &f.max, {.unit = "m", .meaning = "upper corner of the box to fill", .presence = required});
    }
  }
  if ((!listed && f.every.empty()) || p.everything()) {
    p("count", &f.count,
      {.meaning = "number of grains; alternative to mass and packing_fraction",
       .range = within(1, 2147483647),
       .fallback = "one of three required",
       .presence = optional});
    p("mass", &f.mass,
      {.unit = "kg",
       .meaning = "total mass of the grains; alternative to count and packing_fraction",
       .range = above(0),
       .fallback = "one of three required",
       .presence = optional});
    p("packing_fraction", &f.packing_fraction,
      {.meaning = "volume fraction of grains in the box or shape; alternative to count and mass",
       .range = above_to(0, 1),
       .fallback = "one of three required",
       .presence = optional});
  }
  p("velocity", &f.velocity, {.unit = "m/s", .meaning = "initial velocity"});
  p("spin", &f.spin, {.unit = "rad/s", .meaning = "initial angular velocity"});
  p("replaces_fluid", &f.replaces_fluid,
    {.meaning = "each grain replaces the fluid particle nearest to it, whose mass is distributed over the "
                "others of its fluid.fill"});
  describe_grain_material(p, f.material);
  describe_clumps_of(p, f.clump, f.orientation);
  describe_rigid_group(p, f.rigid);
  p.list("sizes", f.sizes, SizeClass{}, describe_grain_size);
}

}  // namespace

void describe_grain_material(Parameters& p, std::string& material) {
  p("material", &material,
    {.meaning = "name of the grain.material of the grains",
     .fallback = "material of grain.*",
     .presence = optional});
}

void describe_lubrication(Parameters& p, LubricationConfig& l) {
  p("lubrication.forces", &l.forces,
    {.meaning = "lubrication forces of the fluid film between near grains, and between grains and walls",
     .family = "laws"});
  p("lubrication.cut_off", &l.cut_off,
    {.unit = "R*", .meaning = "gap above which lubrication is zero", .range = above_to(0, 2)});
  p("lubrication.least_gap", &l.least_gap,
    {.unit = "R*",
     .meaning = "gap below which lubrication no longer increases; below cut_off",
     .range = within(1e-4, 2)});
}

void describe_grain_size(Parameters& p, SizeClass& s) {
  p("kind", &s.kind, {.meaning = "one diameter or a distribution", .family = "shapes"});
  p("mass_fraction", &s.mass_fraction,
    {.meaning = "mass of grains in this entry, relative to the other entries; instead of number_fraction",
     .range = above(0),
     .fallback = "by number",
     .presence = optional});
  if (s.mass_fraction == 0 || p.everything())
    p("number_fraction", &s.number_fraction,
      {.meaning = "number of grains in this entry, relative to the other entries",
       .range = above(0),
       .formerly = "share"});
  const auto wanted = [&](SizeKind kind) { return s.kind == kind || p.everything(); };
  if (wanted(SizeKind::one_size))
    p("d", &s.d, {.unit = "m", .meaning = "class: diameter", .range = above(0), .presence = required});
  if (wanted(SizeKind::log_normal)) {
    p("median", &s.median,
      {.unit = "m",
       .meaning = "log_normal: median diameter (by number)",
       .range = above(0),
       .presence = required});
    p("sigma", &s.sigma,
      {.meaning = "log_normal: standard deviation of ln d", .range = above_to(0, 2), .presence = required});
  }
  if (wanted(SizeKind::log_normal) || wanted(SizeKind::uniform)) {
    const bool uniform = s.kind == SizeKind::uniform;
    p("d_min", &s.d_min,
      {.unit = "m",
       .meaning = "uniform, log_normal: smallest diameter",
       .range = uniform || s.median == 0 ? above(0) : Interval{.lo = 0, .hi = s.median},
       .fallback = "median exp(-3 sigma)",
       .presence = uniform ? required : optional});
    p("d_max", &s.d_max,
      {.unit = "m",
       .meaning = "uniform, log_normal: largest diameter",
       .range = above(uniform ? s.d_min : s.median),
       .fallback = "median exp(3 sigma)",
       .presence = uniform ? required : optional});
  }
  if (wanted(SizeKind::sieve)) {
    p("openings", &s.openings,
      {.unit = "m",
       .meaning = "sieve: mesh openings, in increasing order",
       .range = above(0),
       .presence = required});
    p("passing", &s.passing,
      {.meaning = "sieve: mass fraction that passes each mesh, from 0 to 1",
       .range = within(0, 1),
       .hint = "give fractions, not percent?",
       .presence = required});
  }
}

void describe_frame(Parameters& p, FrameConfig& frame) {
  motion_part(p, "frame.motion.", frame.motion);
  motion_parts(p, "frame.motion.", frame.motion);
}

namespace {

/// Of walls made of particles.
void particle_walls(Parameters& p, WallConfig& w) {
  p("wall.dx", &w.dx,
    {.unit = "m",
     .meaning = "spacing of wall particles, fluid.dx/4..fluid.dx",
     .range = above(0),
     .fallback = "fluid.dx",
     .presence = optional});
  p("wall.type", &w.type,
    {.meaning = "boundary condition for the fluid, default of wall.body.type", .family = "models"});
  p("wall.slip", &w.slip,
    {.meaning = "slip or no slip of the fluid, default of wall.body.slip", .family = "models"});
  p("wall.force", &w.force,
    {.meaning = "repulsive force of single layers, default of wall.body.force", .family = "models"});
  p("wall.no_penetration", &w.no_penetration,
    {.meaning = "penetration limit, default of wall.body.no_penetration: stops fluid within fluid.dx / 4 of "
                "a surface"});
  p("wall.repulsion", &w.repulsion,
    {.meaning = "Monaghan repulsion [monaghan94], default of wall.body.repulsion"});
  p("wall.energy_consistent", &w.energy_consistent,
    {.meaning = "with wall.suction: the work of wall pressure is taken from the fluid next to the walls, so "
                "that walls at rest add no energy; for WCSPH with \"kdk\", not with mdbc walls, single "
                "layers or fluid.variable_h"});
  p("wall.suction", &w.suction,
    {.meaning = "suction: walls may pull on fluid by negative pressure, as in a closed vessel; without it "
                "fluid separates freely from walls"});
  p("wall.rep_D", &w.rep_D,
    {.unit = "m2/s2",
     .meaning = "strength D of the repulsion and of single layers; kajtar: K = D/5",
     .range = above(0),
     .fallback = "5 g H",
     .presence = optional});
  p("wall.rep_r0", &w.rep_r0,
    {.unit = "m",
     .meaning = "range of the repulsion, at most fluid.dx",
     .range = above(0),
     .fallback = "0.5 fluid.dx",
     .presence = optional});
  p("wall.layer_r0", &w.layer_r0,
    {.unit = "m",
     .meaning = "range of the monaghan force of single layers, from their spacing to fluid.dx",
     .range = above(0),
     .fallback = "fluid.dx",
     .presence = optional});
}

}  // namespace

void describe_walls(Parameters& p, Config& c) {
  WallConfig& w = c.wall;
  const bool particles = of_particles(p, c.fluid);
  if (particles) particle_walls(p, w);
  WallBody prototype;
  prototype.type = w.type;
  prototype.force = w.force;
  prototype.slip = w.slip;
  prototype.no_penetration = w.no_penetration;
  prototype.repulsion = w.repulsion;
  p.list("wall.body", w.bodies, prototype,
         [&](Parameters& q, WallBody& body) { wall_body(q, body, c.contact, particles); });
}

void describe_grains(Parameters& p, Config& c) {
  GrainConfig& g = c.grain;
  p("grain.d", &g.d,
    {.unit = "m",
     .meaning = "diameter of grains in fills and inlets without sizes",
     .range = above(0),
     .fallback = "required without sizes",
     .presence = optional});
  p("grain.rho", &g.rho, {.unit = "kg/m3", .meaning = "density of the grains", .range = above(0)});
  p("grain.E", &g.E, {.unit = "Pa", .meaning = "Young's modulus of the grains", .range = within(1e4, 1e12)});
  p("grain.nu", &g.nu, {.meaning = "Poisson's ratio of the grains", .range = {.lo = -1, .hi = 0.5}});
  p("grain.mu", &g.mu, {.meaning = "coefficient of sliding friction", .range = within(0, 5)});
  p("grain.mu_r", &g.mu_r, {.meaning = "coefficient of rolling friction", .range = within(0, 1)});
  p("grain.e", &g.e,
    {.meaning = "coefficient of restitution (linear: 0.136..1; without clip_tension: 0.01..1)",
     .range = within(least_restitution(c.contact), 1),
     .hint = "give a fraction, not percent?"});
  p("grain.settle", &g.settle,
    {.meaning =
         "settling: a DEM run without fluid before t = 0 makes the bed, which is cached for later runs"});
  p("grain.settle_time", &g.settle_time,
    {.unit = "s",
     .meaning = "longest settling time",
     .range = above(0),
     .fallback = "20 sqrt(2 H/g)",
     .presence = optional});
  p("grain.settle_mu", &g.settle_mu,
    {.meaning = "coefficient of sliding friction while settling; lower values give denser beds",
     .range = within(0, 5),
     .fallback = "grain.mu",
     .presence = unbounded});
  p("grain.release_time", &g.release_time,
    {.unit = "s", .meaning = "time until which all grains are held in place", .range = at_least(0)});
  p("grain.resolve", &g.resolve,
    {.meaning =
         "which grains of fills, in fluid to which they are coupled, the fluid flows around: they become "
         "free bodies",
     .family = "models"});
  p("grain.fixed", &g.fixed, {.meaning = "grains are held in place for the whole run"});
  p.list("grain.material", g.materials, GrainMaterial{},
         [&](Parameters& q, GrainMaterial& m) { grain_material(q, m, c.contact); });
  p.list("clump", g.clumps, ClumpConfig{}, describe_clump);
  p.list("grain.fill", g.fills, GrainFill{}, grain_fill);
}

}  // namespace bedload
