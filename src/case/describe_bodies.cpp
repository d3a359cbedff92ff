// Parameters of bodies that move freely.

#include "describe.hpp"

namespace bedload {

using enum Presence;

/// The constraints of a rigid body, whose keys begin with `at`.
template <class C>
void describe_constraints(Parameters& p, const std::string& at, C& c) {
  p(at + ".move", &c.move, {.meaning = "where its centre of mass may go", .family = "models"});
  p(at + ".turn", &c.turn, {.meaning = "how it may turn", .family = "models"});
  if (c.move == BodyMove::plane || c.move == BodyMove::axis || c.turn == BodyTurn::axis || p.everything())
    p(at + ".axis", &c.axis, {.meaning = "direction for move and turn", .presence = required});
}

void describe_rigid_group(Parameters& p, RigidConfig& r) {
  r.present = p.table("rigid", r.present);
  if (r.present) describe_constraints(p, "rigid", r);
}

void describe_free_body(Parameters& p, FreeConfig& f) {
  f.present = p.table("free", f.present);
  if (!f.present) return;
  p("free.density", &f.density,
    {.unit = "kg/m3",
     .meaning = "of the body's closed shape",
     .range = above(0),
     .fallback = "density or mass",
     .presence = optional});
  p("free.mass", &f.mass,
    {.unit = "kg",
     .meaning = "instead of a density",
     .range = above(0),
     .fallback = "density or mass",
     .presence = optional});
  p("free.centre_of_mass", &f.centre_of_mass,
    {.unit = "m", .meaning = "[x, y, z] at t = 0", .fallback = "of the shape", .presence = optional});
  p("free.inertia", &f.inertia,
    {.unit = "kg m2",
     .meaning = "[Ixx, Iyy, Izz, Ixy, Ixz, Iyz] about the centre of mass at t = 0, Ixy = -integral of x y dm",
     .fallback = "of the shape",
     .presence = optional});
  p("free.velocity", &f.velocity, {.unit = "m/s", .meaning = "of the centre of mass at the start"});
  p("free.spin", &f.spin, {.unit = "rad/s", .meaning = "angular velocity at the start"});
  p("free.release_time", &f.release_time,
    {.unit = "s", .meaning = "held in place until then", .range = at_least(0)});
  describe_constraints(p, "free", f);
  if (f.move == BodyMove::none || p.everything())
    p("free.point", &f.point,
      {.unit = "m",
       .meaning = "move = \"none\": pivot [x, y, z], which stays in place",
       .fallback = "centre of mass",
       .presence = optional});
  p("free.fluid", &f.fluid, {.meaning = "the fluid acts on it; if not, it still acts on the fluid"});
  p("free.contacts", &f.contacts, {.meaning = "touches other wall bodies"});
  if (f.contacts || p.everything()) {
    p("free.E", &f.E,
      {.unit = "Pa",
       .meaning = "against other bodies: Young's modulus",
       .range = within(1e4, 1e12),
       .fallback = "grain.E",
       .presence = optional});
    p("free.nu", &f.nu,
      {.meaning = "Poisson's ratio",
       .range = {.lo = -1, .hi = 0.5},
       .fallback = "grain.nu",
       .presence = unbounded});
    p("free.mu", &f.mu,
      {.meaning = "sliding friction", .range = within(0, 5), .fallback = "grain.mu", .presence = unbounded});
    p("free.mu_r", &f.mu_r, {.meaning = "rolling friction, by contact.rolling", .range = within(0, 1)});
    p("free.e", &f.e,
      {.meaning = "restitution of a lone contact",
       .range = within(0.05, 1),
       .hint = "give a fraction, not percent?",
       .fallback = "grain.e",
       .presence = optional});
    p("free.contact_radius", &f.contact_radius,
      {.unit = "m",
       .meaning = "reduced radius R* of its contacts",
       .range = above(0),
       .fallback = "of each ball",
       .presence = optional});
    p("free.contact_spacing", &f.contact_spacing,
      {.unit = "m",
       .meaning = "of the balls within its surface by which it touches, twice their radius",
       .range = above(0),
       .fallback = "a quarter of the least extent",
       .presence = optional});
    p.list("free.contact", f.balls, BodyBall{}, [](Parameters& q, BodyBall& ball) {
      q("centre", &ball.centre,
        {.unit = "m", .meaning = "instead of sampled balls: where, at t = 0", .presence = required});
      q("radius", &ball.radius,
        {.unit = "m", .meaning = "of the ball", .range = above(0), .presence = required});
    });
  }
}

}  // namespace bedload
