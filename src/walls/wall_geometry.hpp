#pragma once
#include <functional>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/walls.hpp"
#include "bedload/parallel/buffer.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace bedload {
struct SurfacePart;
}

namespace BL_SOLVER {

/// The surfaces of wall bodies, on the device: a rectangle for each face of a tank, one surface for a box or
/// a plane, one for each part of a shape.
class WallGeometry {
 public:
  /// The surfaces of the bodies selected by `wanted`.
  WallGeometry(
      const std::vector<WallBody>& bodies, const DomainConfig& domain,
      const std::function<bool(const WallBody&)>& wanted = [](const WallBody&) { return true; });

  const std::vector<Surface>& surfaces() const { return surfaces_; }
  /// Largest number of contacts of one grain at once, at most kMostWallContacts.
  int contacts() const { return contacts_; }
  /// Valid as long as this object exists and is not moved.
  SurfaceSet view() const;

 private:
  void add(const SurfacePart& part, std::uint32_t body);

  struct MeshBuffers {
    Buffer<MeshNode> nodes;
    Buffer<Vec3d> vertices;
    Buffer<MeshTriangle> triangles;
    Buffer<std::uint32_t> ring_start, ring;
    double edge;  ///< mean length, m
  };
  std::vector<Surface> surfaces_;
  std::vector<ProfileCorner> corners_;
  std::vector<MeshBuffers> meshes_;
  int contacts_ = 0;
  Buffer<Surface> device_surfaces_;
  Buffer<ProfileCorner> device_corners_;
  Buffer<MeshView> device_meshes_;
};

}  // namespace BL_SOLVER
