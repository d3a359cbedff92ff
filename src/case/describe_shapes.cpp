// Parameters of shapes.

#include "describe.hpp"

namespace bedload {
namespace {

using enum Presence;

void copies(Parameters& p, CopiesConfig& c) {
  c.present = p.table("copies", c.present);
  if (!c.present) return;
  p("copies.count", &c.count,
    {.meaning = "number of copies of the shape, including the first; they may overlap",
     .range = within(1, 10000),
     .presence = required});
  p("copies.about", &c.about,
    {.meaning = "direction of the axis about which copies are rotated; [0, 0, 0]: no rotation"});
  p("copies.centre", &c.centre, {.unit = "m", .meaning = "a point on the axis of rotation"});
  p("copies.angle", &c.angle,
    {.unit = "deg",
     .meaning = "rotation from one copy to the next, right-handed about the axis",
     .range = within(-360, 360),
     .fallback = "360 / count",
     .presence = optional});
  p("copies.along", &c.along, {.unit = "m", .meaning = "translation from one copy to the next"});
}

void shape(Parameters& p, ShapeConfig& s) {
  p("name", &s.name,
    {.meaning = "name by which walls, fills and other shapes refer to it", .presence = required});
  p("kind", &s.kind, {.meaning = "kind of shape", .presence = required, .family = "shapes"});
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
    p("a", &s.a,
      {.unit = "m", .meaning = "capsule, cylinder, cone, pipe: one end of the axis", .presence = required});
    p("b", &s.b,
      {.unit = "m", .meaning = "capsule, cylinder, cone, pipe: other end of the axis", .presence = required});
  }
  if (is({sphere, capsule, cylinder, pipe}))
    p("radius", &s.radius,
      {.unit = "m",
       .meaning = "sphere, capsule, cylinder: radius; pipe: inner radius",
       .range = above(0),
       .presence = required});
  if (is({cone})) {
    p("radius_a", &s.radius_a,
      {.unit = "m", .meaning = "cone: radius at a", .range = at_least(0), .presence = required});
    p("radius_b", &s.radius_b,
      {.unit = "m", .meaning = "cone: radius at b", .range = at_least(0), .presence = required});
  }
  if (is({pipe, hollow, terrain}))
    p("thickness", &s.thickness,
      {.unit = "m",
       .meaning = "pipe, hollow: wall thickness; terrain: thickness along the vertical, before scale",
       .range = above(0),
       .fallback = "kernel support, in whole wall.dx; terrain: solid to that far below its lowest point",
       .presence = optional});
  if (is({pipe})) p("ends", &s.ends, {.meaning = "pipe: ends closed by a plate as thick as the wall"});
  if (is({mesh, terrain})) {
    p("file", &s.file,
      {.meaning = "mesh: STL, OBJ or PLY file; terrain: one of these, open, or an ESRI ASCII grid of heights "
                  "(.asc); coordinates in m before scale; path relative to the case file",
       .presence = required});
    p("digest", &s.digest,
      {.meaning = "mesh, terrain: checksum of the file; another one is an error",
       .fallback = "any",
       .presence = optional});
    p("repair", &s.repair,
      {.meaning = "mesh, terrain: merge close vertices, remove triangles without area, orient the others "
                  "outwards"});
  }
  if (is({hollow, union_, difference}))
    p("of", &s.of,
      {.meaning = "hollow, union, difference: names of shapes listed before", .presence = required});
  if (is({difference}))
    p("facet", &s.facet,
      {.unit = "m",
       .meaning = "difference: edge length of the triangles of its surface for contacts with grains",
       .range = above(0),
       .fallback = "extent / 4, at most diagonal / 100",
       .presence = optional});
  p("scale", &s.scale, {.meaning = "scale factor, applied first", .range = above(0)});
  p("turn_axis", &s.turn_axis,
    {.meaning = "direction of an axis through the origin; the shape is rotated about it after scaling"});
  p("turn_angle", &s.turn_angle, {.unit = "deg", .meaning = "angle of this rotation, right-handed"});
  p("translate", &s.translate, {.unit = "m", .meaning = "translation, applied after scaling and rotation"});
  copies(p, s.copies);
}

}  // namespace

void describe_shapes(Parameters& p, std::vector<ShapeConfig>& shapes) {
  p.list("shape", shapes, ShapeConfig{}, shape);
}

}  // namespace bedload
