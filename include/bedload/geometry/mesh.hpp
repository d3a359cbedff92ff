#pragma once
// Solids bounded by triangles, such as CAD exports.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bedload/geometry/shape.hpp"

namespace bedload {

/// Corners counter-clockwise seen from outside, as indices of vertices.
using Triangle = std::array<std::uint32_t, 3>;

/// Vertices, m, and the triangles between them.
struct TriangleSoup {
  std::vector<Vec3d> vertices;
  std::vector<Triangle> triangles;
};

struct MeshOptions {
  Placement placement;  ///< of the vertices as given; includes the length of their unit
  bool repair = false;  ///< welds, drops degenerate triangles and turns the rest outward
  double weld = 0;      ///< repair makes vertices nearer than this one, m; 0: 1e-6 of the mesh's diagonal
};

namespace detail {
class AabbTree;
}

/// The solid inside closed surfaces of triangles; a surface within another bounds a cavity. Its distance is
/// exact; the sign follows the angle-weighted pseudonormal of the nearest feature [baerentzen05].
class TriangleMesh : public Shape {
 public:
  /// Equal vertices are welded. `name` begins each error. Throws CaseError, naming a place, unless the
  /// surface is a watertight, consistently outward manifold without degenerate triangles that nowhere passes
  /// through itself by more than 1e-9 of the mesh's diagonal. Triangles lower than that are degenerate. What
  /// `options.repair` does is done before; what it does not cover is still an error.
  TriangleMesh(TriangleSoup soup, const std::string& name, const MeshOptions& options = {});
  ~TriangleMesh() override;

  SurfacePoint nearest(const Vec3d& x) const override;
  Bounds bounds() const override { return bounds_; }
  ShapePtr in_frame(const Vec3d& origin, double spacing) const override;
  void add_parts(std::vector<SurfacePart>& parts, const Placement& placement) const override;

  /// Index of the triangle nearest to x; of those equally near any one, always the same.
  std::uint32_t nearest_triangle(const Vec3d& x) const;

  /// Of the solid, m3.
  double volume() const;

  const std::vector<Vec3d>& vertices() const { return soup_.vertices; }
  const std::vector<Triangle>& triangles() const { return soup_.triangles; }

 private:
  struct Hit;
  Hit find_nearest(const Vec3d& x) const;
  Vec3d pseudonormal(const Hit& hit) const;

  TriangleSoup soup_;
  Bounds bounds_;
  std::vector<std::uint32_t>
      across_;  // [3 n] the same edge in the triangle beyond it, as 3 * triangle + edge
  std::vector<Vec3d> vertex_normals_;  // angle-weighted sums
  std::unique_ptr<const detail::AabbTree> tree_;
};

/// Triangles of an STL (binary or ASCII), OBJ or PLY file, numbers taken as m. Polygons are split. Throws
/// FileError if it cannot be read, CaseError if it holds no triangles or is of another kind.
TriangleSoup read_triangles(const std::filesystem::path& file);

/// The solid in such a file. Throws FileError and, where it bounds no solid, CaseError.
std::shared_ptr<const TriangleMesh> read_mesh(const std::filesystem::path& file,
                                              const MeshOptions& options = {});

/// Surface through the heights of an ESRI ASCII grid, at the centres of its cells, which are split into two
/// triangles each; numbers taken as m. Throws FileError, also where a cell has no height.
TriangleSoup read_heights(const std::filesystem::path& file);

/// How far a floor reaches below its surface.
struct FloorDepth {
  double thickness = 0;  ///< along the vertical, m; 0: down to one level
  double below = 0;      ///< of that level below the lowest point, m; 0: 1/50 of the diagonal
};

/// The solid below a surface that has one height at each place, from read_heights (.asc) or read_triangles,
/// with vertical sides along its outline. Throws FileError, and CaseError where the surface overhangs, has
/// holes or consists of several pieces.
std::shared_ptr<const TriangleMesh> read_terrain(const std::filesystem::path& file, const FloorDepth& depth,
                                                 const MeshOptions& options = {});

}  // namespace bedload
