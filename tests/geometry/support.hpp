#pragma once
// What the geometry tests share.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/setup.hpp"
#include "tests/support/walls.hpp"

namespace bedload::test {

/// A closed box of `size` m, with nothing in it.
inline Config empty_case(const Vec3d& size) {
  Config config;
  config.domain.max = size;
  config.fluid.dx = 0.01;
  config.wall.dx = 0.01;
  config.grain.d = config.grain.d_max = config.grain.d_min = 0.01;
  return config;
}

inline void add_fill(Config& config, const Vec3d& min, const Vec3d& max) {
  config.fluid.present = true;
  config.fluid.fills.push_back({min, max});
}

inline Setup setup_of(const Config& config) {
  std::vector<std::string> warnings;
  return build_setup(config, warnings);
}

/// The text of the CaseError that the case raises; empty if it raises none.
inline std::string error_of(const Config& config) {
  try {
    setup_of(config);
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

inline double nearest(const std::vector<Vec3d>& points, const Vec3d& x) {
  double least = INFINITY;
  for (const Vec3d& y : points) least = std::min(least, norm(x - y));
  return least;
}

/// Distance of the closest two points, periods as in `domain`.
inline double closest_pair(const std::vector<Vec3d>& points, const DomainConfig& domain) {
  double least = INFINITY;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Vec3d r = points[i] - points[j];
      for (int k = 0; k < 3; ++k) {
        const double period = domain.max[k] - domain.min[k];
        if (domain.periodic[k]) r[k] -= period * std::round(r[k] / period);
      }
      least = std::min(least, norm(r));
    }
  return least;
}

}  // namespace bedload::test
