#pragma once
// What the tests of solids share.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "bedload/core/error.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload::test {

/// Points drawn evenly from a box.
class RandomPoints {
 public:
  explicit RandomPoints(const Bounds& box) : box_(box) {}

  Vec3d operator()() {
    Vec3d x;
    for (int k = 0; k < 3; ++k) x[k] = box_.min[k] + (box_.max[k] - box_.min[k]) * uniform_();
    return x;
  }

 private:
  double uniform_() { return double(engine_()) / 4294967296.0; }

  Bounds box_;
  std::mt19937 engine_{1};
};

/// The text of the error that `f` raises; empty if it raises none.
template <class Error = CaseError, class F>
std::string error_in(F f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

inline void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_LE(norm(a - b), tolerance) << "(" << a.x << ", " << a.y << ", " << a.z << ") is not (" << b.x << ", "
                                    << b.y << ", " << b.z << ")";
}

/// What holds for any solid with an exact distance: its nearest point lies as far off as the distance says
/// and on the surface, the normal is the distance's gradient, and the bounds enclose the solid.
inline void expect_exact(const Shape& shape) {
  const Bounds bounds = shape.bounds();
  const double size = norm(bounds.max - bounds.min), step = 1e-6 * size;
  RandomPoints random(bounds.grown(0.3 * size));
  for (int n = 0; n < 2000; ++n) {
    const Vec3d x = random();
    const SurfacePoint s = shape.nearest(x);
    EXPECT_NEAR(norm(x - s.point), std::abs(s.distance), 1e-12 * size);
    EXPECT_NEAR(shape.distance(s.point), 0, 1e-12 * size);
    EXPECT_NEAR(norm(s.normal), 1, 1e-12);
    // Half way to the surface along the normal, half the distance is left.
    EXPECT_NEAR(shape.distance(x - (s.distance * 0.5) * s.normal), 0.5 * s.distance, 1e-12 * size);
    for (int k = 0; k < 3; ++k) {
      Vec3d e;
      e[k] = step;
      const double up = (shape.distance(x + e) - s.distance) / step;
      const double down = (s.distance - shape.distance(x - e)) / step;
      EXPECT_LE(std::max(std::abs(up), std::abs(down)), 1 + 1e-6);
      if (std::abs(up - down) < 1e-3) {  // else a crease
        EXPECT_NEAR((up + down) / 2, s.normal[k], 2e-3);
      }
    }
    if (s.distance < 0)
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(x[k], bounds.min[k]);
        EXPECT_LE(x[k], bounds.max[k]);
      }
  }
}

}  // namespace bedload::test
