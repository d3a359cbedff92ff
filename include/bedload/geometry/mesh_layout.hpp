#pragma once
// Memory layout of a mesh for searches of its surface: the same on host and device.

#include <array>
#include <cstdint>
#include <vector>

#include "bedload/core/vec.hpp"

namespace bedload {

constexpr int kMeshDepth = 48;  ///< nodes due at once on the way through a tree; bounds its depth

/// Box of a tree over triangles. The first child of an inner node follows it.
struct MeshNode {
  float lo[3], hi[3];       ///< m, rounded outwards
  std::uint32_t next = 0;   ///< second child, or first triangle of a leaf
  std::uint32_t count = 0;  ///< triangles of a leaf; 0: inner node

  /// Of x from the box, squared, m2.
  BL_HD double distance2(const Vec3d& x) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double below = double(lo[k]) - x[k], above = x[k] - double(hi[k]);
      const double beyond = below > above ? below : above;
      if (beyond > 0) sum += beyond * beyond;
    }
    return sum;
  }
  /// Farthest place of the box along n, m.
  BL_HD double extent(const Vec3d& n) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += n[k] * (n[k] > 0 ? hi[k] : lo[k]);
    return sum;
  }
};

struct MeshTriangle {
  std::uint32_t corner[3];  ///< vertices, counter-clockwise seen from outside
  std::uint32_t across[3];  ///< triangle beyond the edge from corner k to the next
};

/// A watertight mesh with its tree; see MeshView.
struct MeshLayout {
  std::vector<MeshNode> nodes;
  std::vector<Vec3d> vertices;  ///< m
  std::vector<MeshTriangle> triangles;
  std::vector<std::uint32_t> ring_start, ring;
  double edge = 0;  ///< mean length, m
};

}  // namespace bedload
