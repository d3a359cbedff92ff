#pragma once
// Wall bodies set up in code.

#include <string>
#include <string_view>

#include "bedload/case/config.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload::test {

/// Of one of the shapes that are told by two corners.
inline WallBody body(const std::string& shape, const Vec3d& min, const Vec3d& max) {
  WallBody b;
  b.name = shape, b.shape = shape;
  b.min = min, b.max = max;
  return b;
}

/// A body of that shape.
inline WallBody shaped(const std::string& name, ShapePtr shape) {
  WallBody b = body(name, shape->bounds().min, shape->bounds().max);
  b.solid.shape = shape;
  return b;
}

/// A box seen from inside, with the faces named, as "x-x+z-".
inline WallBody tank(const Vec3d& min, const Vec3d& max, std::string_view faces = "x-x+y-y+z-z+") {
  WallBody b = body("tank", min, max);
  for (int k = 0; k < 6; ++k) {
    const char name[] = {"xyz"[k / 2], "-+"[k % 2], 0};
    b.faces[std::size_t(k)] = faces.find(name) != faces.npos;
  }
  return b;
}

}  // namespace bedload::test
