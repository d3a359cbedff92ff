// Parameters of shapes.

#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;

void copies(Parameters& p, CopiesConfig& c) {
  c.present = p.table("copies", c.present);
  if (!c.present) return;
  p("copies.count", &c.count,
    {.meaning = "how many copies of the shape it stands for, the first among them; they may overlap",
     .range = within(1, 10000),
     .presence = required});
  p("copies.about", &c.about, {.meaning = "about an axis: its direction; [0, 0, 0]: copies do not turn"});
  p("copies.centre", &c.centre, {.unit = "m", .meaning = "a point on that axis"});
  p("copies.angle", &c.angle,
    {.unit = "deg",
     .meaning = "from one copy to the next, right-handed about that axis",
     .range = within(-360, 360),
     .fallback = "360 / count",
     .presence = optional});
  p("copies.along", &c.along, {.unit = "m", .meaning = "in a row: from one copy to the next"});
}

void shape(Parameters& p, ShapeConfig& s) {
  p("name", &s.name, {.meaning = "by which walls, fills and other shapes know it", .presence = required});
  p("kind", &s.kind, {.meaning = "what it is", .presence = required, .family = "shapes"});
  using enum ShapeKind;
  const auto is = [&](std::initializer_list<ShapeKind> kinds) {
    for (const ShapeKind kind : kinds)
      if (s.kind == kind) return true;
    return p.everything();
  };
  if (is({box})) {
    p("min", &s.min, {.unit = "m", .meaning = "box: lower corner", .presence = required});
    p("max", &s.max, {.unit = "m", .meaning = "box: upper corner", .presence = required});
  }
  if (is({sphere})) p("centre", &s.centre, {.unit = "m", .meaning = "sphere: centre", .presence = required});
  if (is({capsule, cylinder, cone, pipe})) {
    p("a", &s.a, {.unit = "m", .meaning = "one end of the axis", .presence = required});
    p("b", &s.b, {.unit = "m", .meaning = "the other end", .presence = required});
  }
  if (is({sphere, capsule, cylinder, pipe}))
    p("radius", &s.radius,
      {.unit = "m", .meaning = "radius; pipe: of the bore", .range = above(0), .presence = required});
  if (is({cone})) {
    p("radius_a", &s.radius_a,
      {.unit = "m", .meaning = "cone: radius at a", .range = at_least(0), .presence = required});
    p("radius_b", &s.radius_b,
      {.unit = "m", .meaning = "cone: radius at b", .range = at_least(0), .presence = required});
  }
  if (is({pipe, hollow}))
    p("thickness", &s.thickness,
      {.unit = "m",
       .meaning = "pipe, hollow: thickness of the wall",
       .range = above(0),
       .fallback = "the kernel's reach, in whole wall.dx",
       .presence = optional});
  if (is({pipe})) p("ends", &s.ends, {.meaning = "pipe: which ends have a plate, as thick as the wall"});
  if (is({mesh})) {
    p("file", &s.file,
      {.meaning = "mesh: STL, OBJ or PLY file, numbers in m before scale; relative to the case",
       .presence = required});
    p("digest", &s.digest,
      {.meaning = "mesh: fingerprint that the file must have", .fallback = "any", .presence = optional});
    p("repair", &s.repair,
      {.meaning = "mesh: weld near vertices, drop triangles without area, turn the rest outwards"});
  }
  if (is({hollow, union_, difference}))
    p("of", &s.of, {.meaning = "names of shapes listed before", .presence = required});
  if (is({difference}))
    p("facet", &s.facet,
      {.unit = "m",
       .meaning = "difference: width of the triangles by which grains meet it",
       .range = above(0),
       .fallback = "extent / 4, at most diagonal / 100",
       .presence = optional});
  p("scale", &s.scale, {.meaning = "size / size as given", .range = above(0)});
  p("turn_axis", &s.turn_axis, {.meaning = "then turned about this axis through the origin"});
  p("turn_angle", &s.turn_angle, {.unit = "deg", .meaning = "by this angle, right-handed"});
  p("translate", &s.translate, {.unit = "m", .meaning = "then moved by this"});
  copies(p, s.copies);
}

}  // namespace

void describe_shapes(Parameters& p, std::vector<ShapeConfig>& shapes) {
  p.list("shape", shapes, ShapeConfig{}, shape);
}

}  // namespace bedload
