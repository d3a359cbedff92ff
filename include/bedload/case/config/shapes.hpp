#pragma once
// Solids with a name.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bedload/case/setup_choices.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

class Shape;

/// The solid of a name, built when a case is resolved. No part of what makes two cases equal.
struct Solid {
  std::shared_ptr<const Shape> shape;
  bool operator==(const Solid&) const { return true; }
};

/// Copies of a shape that is made and placed; each is the one before, rotated and then translated.
struct CopiesConfig {
  bool present = false;                        ///< a [shape.copies] is given
  std::int64_t count = 1;                      ///< with the first
  Vec3d about;                                 ///< direction of the axis; zero: they do not turn
  Vec3d centre;                                ///< a point on the axis, m
  double angle = 0;                            ///< from one to the next, deg (resolved)
  Vec3d along;                                 ///< from one to the next, m
  bool operator==(const CopiesConfig&) const = default;
};

/// A solid with a name: walls are made of it, fluid and grains fill it.
struct ShapeConfig {
  std::string name;
  Chosen<ShapeKind> kind = ShapeKind::box;
  Vec3d min, max;                              ///< box: m
  Vec3d centre;                                ///< sphere: m
  Vec3d a, b;                                  ///< ends of the axis of capsule, cylinder, cone, pipe: m
  double radius = 0;                           ///< m; pipe: of the bore
  double radius_a = 0, radius_b = 0;           ///< cone: m
  double thickness = 0;                        ///< wall of pipe and hollow; terrain below its surface; m
  Chosen<PipeEnds> ends = PipeEnds::open;      ///< pipe: those with a plate
  std::string file;                            ///< mesh: STL, OBJ or PLY; terrain: or ASC
  std::string digest;                          ///< of the file, hexadecimal; checked where it is given
  bool repair = false;                         ///< mesh, terrain
  std::vector<std::string> of;                 ///< hollow, union, difference: shapes listed before
  double facet = 0;                            ///< difference: width of its triangles, m; 0: by its size
  double scale = 1;
  Vec3d turn_axis{0, 0, 1};
  double turn_angle = 0;                       ///< deg
  Vec3d translate;                             ///< m
  CopiesConfig copies;
  std::int64_t pieces = 1;                     ///< primitives in it, each as often as it is named (resolved)
  Solid solid;                                 ///< resolved
  bool operator==(const ShapeConfig&) const = default;
};

}  // namespace bedload
