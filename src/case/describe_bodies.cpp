// Parameters of bodies that move freely.

#include "describe.hpp"

namespace bedload {

using enum Presence;

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
  p("free.move", &f.move,
    {.meaning = "where its centre of mass may go",
     .family = "models",
     .choices = {{"all", "anywhere"},
                 {"plane", "across free.axis"},
                 {"axis", "along free.axis"},
                 {"none", "nowhere; free.point of the body stays in place"}}});
  p("free.turn", &f.turn,
    {.meaning = "how it may turn",
     .family = "models",
     .choices = {{"all", "any way"}, {"axis", "about free.axis"}, {"none", "not at all"}}});
  const bool axial = f.move == "plane" || f.move == "axis" || f.turn == "axis" || p.everything();
  if (axial)
    p("free.axis", &f.axis, {.meaning = "direction for free.move and free.turn", .presence = required});
  if (f.move == "none" || p.everything())
    p("free.point", &f.point,
      {.unit = "m",
       .meaning = "move = \"none\": pivot [x, y, z]",
       .fallback = "centre of mass",
       .presence = optional});
  p("free.fluid", &f.fluid, {.meaning = "feels the fluid; if not, the fluid still feels the body"});
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
