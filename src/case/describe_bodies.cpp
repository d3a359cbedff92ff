// Parameters of bodies that move freely.

#include "describe.hpp"

namespace bedload {

using enum Presence;

/// The constraints of a rigid body, whose keys begin with `at`.
template <class C>
void describe_constraints(Parameters& p, const std::string& at, C& c) {
  p(at + ".move", &c.move, {.meaning = "allowed translation of the centre of mass", .family = "models"});
  p(at + ".turn", &c.turn, {.meaning = "allowed rotation", .family = "models"});
  if (c.move == BodyMove::plane || c.move == BodyMove::axis || c.turn == BodyTurn::axis || p.everything())
    p(at + ".axis", &c.axis, {.meaning = "direction of the axis of move and turn", .presence = required});
}

void describe_rigid_group(Parameters& p, RigidConfig& r) {
  r.present = p.table("rigid", r.present);
  if (r.present) describe_constraints(p, "rigid", r);
}

void describe_scatter(Parameters& p, ScatterConfig& s) {
  s.present = p.table("free.scatter", s.present);
  if (!s.present) return;
  p("free.scatter.count", &s.count,
    {.meaning =
         "number of bodies of this shape, placed at random in a box; they are named <name>_1, <name>_2 ..",
     .range = within(1, 10000),
     .presence = required});
  p("free.scatter.min", &s.min,
    {.unit = "m", .meaning = "lower corner of the box, which holds whole bodies", .presence = required});
  p("free.scatter.max", &s.max, {.unit = "m", .meaning = "upper corner", .presence = required});
  p("free.scatter.gap", &s.gap,
    {.unit = "m", .meaning = "least distance between the spheres around two bodies", .range = at_least(0)});
  p("free.scatter.turned", &s.turned, {.meaning = "random orientations; false: all as the shape is"});
  p("free.scatter.seed", &s.seed, {.meaning = "seed of the random positions"});
}

void describe_clump(Parameters& p, ClumpConfig& c) {
  p("name", &c.name, {.meaning = "name by which fills refer to the clump", .presence = required});
  p("spheres", &c.spheres,
    {.meaning = "spheres [[x, y, z, r], ...] that make up the clump, 1 to 256 in any unit: fills scale them",
     .fallback = "spheres, file or shape",
     .presence = optional});
  p("file", &c.file,
    {.meaning = "text file with x, y, z and r of a sphere in each line, path relative to the case file",
     .fallback = "spheres, file or shape",
     .presence = optional});
  p("shape", &c.solid,
    {.meaning = "name of a shape, also of a mesh, that is filled with spheres from within, large ones first",
     .fallback = "spheres, file or shape",
     .presence = optional});
  if (!c.solid.empty() || p.everything())
    p("count", &c.count,
      {.meaning = "shape: number of spheres, fewer if they fill it",
       .range = within(1, 256),
       .fallback = "required with shape",
       .presence = optional});
  p("density", &c.density,
    {.unit = "kg/m3",
     .meaning = "density of the union of the spheres",
     .range = above(0),
     .fallback = "that of the material",
     .presence = optional});
  p("drag", &c.drag, {.meaning = "drag of the fluid on the clump"});
}

void describe_clumps_of(Parameters& p, std::string& clump, std::vector<double>& orientation) {
  p("clump", &clump,
    {.meaning = "name of the clump that all these grains are; sizes are diameters of the sphere of its "
                "volume, positions those of its centre of mass",
     .fallback = "spheres",
     .presence = optional});
  if (!clump.empty() || p.everything())
    p("orientation", &orientation,
      {.unit = "deg",
       .meaning = "clump: rotation vector [x, y, z] of all of them from the axes of its spheres",
       .fallback = "each at random",
       .presence = optional});
}

void describe_free_body(Parameters& p, FreeConfig& f) {
  f.present = p.table("free", f.present);
  if (!f.present) return;
  describe_scatter(p, f.scatter);
  p("free.density", &f.density,
    {.unit = "kg/m3",
     .meaning = "mean density of the body, whose shape must be closed; alternative to free.mass",
     .range = above(0),
     .fallback = "density or mass",
     .presence = optional});
  p("free.mass", &f.mass,
    {.unit = "kg",
     .meaning = "mass; alternative to free.density",
     .range = above(0),
     .fallback = "density or mass",
     .presence = optional});
  p("free.centre_of_mass", &f.centre_of_mass,
    {.unit = "m",
     .meaning = "centre of mass [x, y, z] at t = 0",
     .fallback = "that of the shape",
     .presence = optional});
  p("free.inertia", &f.inertia,
    {.unit = "kg m2",
     .meaning = "moments of inertia [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] about the centre of mass at t = 0, with "
                "Ixy = -integral of x y dm",
     .fallback = "that of the shape",
     .presence = optional});
  p("free.velocity", &f.velocity, {.unit = "m/s", .meaning = "initial velocity of the centre of mass"});
  p("free.spin", &f.spin, {.unit = "rad/s", .meaning = "initial angular velocity"});
  p("free.release_time", &f.release_time,
    {.unit = "s", .meaning = "time until which the body is held in place", .range = at_least(0)});
  describe_constraints(p, "free", f);
  if (f.move == BodyMove::none || p.everything())
    p("free.point", &f.point,
      {.unit = "m",
       .meaning = "move = \"none\": pivot [x, y, z], which stays in place",
       .fallback = "centre of mass",
       .presence = optional});
  p("free.fluid", &f.fluid,
    {.meaning = "the fluid exerts forces on the body; if false, the body still acts on the fluid"});
  p("free.contacts", &f.contacts, {.meaning = "the body collides with other wall bodies"});
  if (f.contacts || p.everything()) {
    p("free.E", &f.E,
      {.unit = "Pa",
       .meaning = "Young's modulus in contacts with other wall bodies",
       .range = within(1e4, 1e12),
       .fallback = "that of material, or grain.E",
       .presence = optional});
    p("free.nu", &f.nu,
      {.meaning = "Poisson's ratio in contacts with other wall bodies",
       .range = {.lo = -1, .hi = 0.5},
       .fallback = "that of material, or grain.nu",
       .presence = unbounded});
    p("free.mu", &f.mu,
      {.meaning = "coefficient of sliding friction against other wall bodies",
       .range = within(0, 5),
       .fallback = "that of material, or grain.mu",
       .presence = unbounded});
    p("free.mu_r", &f.mu_r,
      {.meaning =
           "coefficient of rolling friction against other wall bodies, with the law of contact.rolling",
       .range = within(0, 1)});
    p("free.e", &f.e,
      {.meaning = "coefficient of restitution against other wall bodies, for a single contact",
       .range = within(0.05, 1),
       .hint = "give a fraction, not percent?",
       .fallback = "that of material, or grain.e",
       .presence = optional});
    p("free.contact_radius", &f.contact_radius,
      {.unit = "m",
       .meaning = "effective radius R* of contacts with other wall bodies",
       .range = above(0),
       .fallback = "radius of each ball",
       .presence = optional});
    p("free.contact_spacing", &f.contact_spacing,
      {.unit = "m",
       .meaning =
           "spacing and diameter of the balls inside its surface that detect contacts with other wall bodies",
       .range = above(0),
       .fallback = "smallest extent / 4",
       .presence = optional});
    p.list("free.contact", f.balls, BodyBall{}, [](Parameters& q, BodyBall& ball) {
      q("centre", &ball.centre,
        {.unit = "m",
         .meaning = "centre of a contact ball at t = 0; listed balls replace the sampled ones",
         .presence = required});
      q("radius", &ball.radius,
        {.unit = "m", .meaning = "radius of the ball", .range = above(0), .presence = required});
    });
  }
}

}  // namespace bedload
