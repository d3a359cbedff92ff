#include "src/walls/wall_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bedload/geometry/shape.hpp"

namespace BL_SOLVER {
namespace {

Vec3d unit(int k, double sign = 1) {
  Vec3d e;
  e[k] = sign;
  return e;
}

/// Half the extent of a body along axis k; without end where it spans a period.
double half_extent(const DomainConfig& domain, const WallBody& body, int k) {
  const double length = body.max[k] - body.min[k], period = domain.max[k] - domain.min[k];
  if (domain.periodic[k] && length > period * (1 - 2e-6)) return std::numeric_limits<double>::infinity();
  return 0.5 * length;
}

Surface make_box(const DomainConfig& domain, const WallBody& body, std::uint32_t index) {
  Surface s{SurfaceKind::box, index, 0.5 * (body.min + body.max), {}, {}};
  for (int k = 0; k < 3; ++k) {
    s.axis[k] = unit(k);
    s.half[k] = half_extent(domain, body, k);
  }
  return s;
}

Surface make_face(const DomainConfig& domain, const WallBody& body, std::uint32_t index, int face) {
  const int k = face / 2, u = (k + 1) % 3, w = (k + 2) % 3;
  Surface s{SurfaceKind::rectangle, index, 0.5 * (body.min + body.max), {}, {}};
  const bool upper = face % 2;
  s.centre[k] = upper ? body.max[k] : body.min[k];
  s.axis[2] = unit(k, upper ? -1 : 1);  // into the tank
  s.axis[0] = unit(upper ? w : u);
  s.axis[1] = unit(upper ? u : w);
  s.half[0] = half_extent(domain, body, upper ? w : u);
  s.half[1] = half_extent(domain, body, upper ? u : w);
  return s;
}

/// Largest number of contacts of a grain with one surface at once.
int most_contacts(const Surface& s) {
  switch (s.kind) {
    case SurfaceKind::mesh:
      return kMostWallContacts;
    case SurfaceKind::revolution:
      return int(s.count);
    case SurfaceKind::box:
      return s.shell > 0 ? 6 : 1;
    default:
      return 1;
  }
}

}  // namespace

WallGeometry::WallGeometry(const std::vector<WallBody>& bodies, const DomainConfig& domain,
                           const std::function<bool(const WallBody&)>& wanted) {
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    const WallBody& body = bodies[b];
    if (!wanted(body)) continue;
    if (body.solid.shape) {
      std::vector<SurfacePart> parts;
      body.solid.shape->add_parts(parts, {});
      for (const SurfacePart& part : parts) add(part, b);
      continue;
    }
    switch (body.shape.value()) {
      case WallShape::plane: {
        Surface s{SurfaceKind::plane, b, body.point, {}, {}};
        s.axis[2] = body.normal * (1 / norm(body.normal));
        surfaces_.push_back(s);
        break;
      }
      case WallShape::box:
        surfaces_.push_back(make_box(domain, body, b));
        break;
      case WallShape::tank:
        for (int face = 0; face < 6; ++face)
          if (body.faces[face]) surfaces_.push_back(make_face(domain, body, b, face));
        break;
    }
  }
  for (const Surface& s : surfaces_) contacts_ = std::min(contacts_ + most_contacts(s), kMostWallContacts);
  device_surfaces_.assign(surfaces_);
  device_corners_.assign(corners_);
  std::vector<MeshView> views;
  for (const MeshBuffers& m : meshes_)
    views.push_back({m.nodes.data(), m.vertices.data(), m.triangles.data(), m.ring_start.data(),
                     m.ring.data(), std::uint32_t(m.triangles.size()), m.edge});
  device_meshes_.assign(views);
}

SurfaceSet WallGeometry::view() const {
  return {{device_surfaces_, device_corners_.data(), device_meshes_.data()}};
}

void WallGeometry::add(const SurfacePart& part, std::uint32_t body) {
  Surface s{SurfaceKind::box, body, part.centre, {}, {}};
  s.radius = part.radius;
  s.shell = part.shell;
  for (int k = 0; k < 3; ++k) {
    s.axis[k] = part.rotation.rotate(unit(k));
    s.half[k] = part.half[k];
  }
  using Kind = SurfacePart::Kind;
  if (part.kind == Kind::capsule) {
    s.kind = SurfaceKind::capsule;
  } else if (part.kind == Kind::revolution) {
    s.kind = SurfaceKind::revolution;
    s.first = std::uint32_t(corners_.size());
    s.count = std::uint32_t(part.profile.size());
    for (const auto& c : part.profile) corners_.push_back({c.z, c.r});
  } else if (part.kind == Kind::mesh) {
    s.kind = SurfaceKind::mesh;
    s.first = std::uint32_t(meshes_.size());
    meshes_.emplace_back();
    meshes_.back().nodes.assign(part.mesh->nodes);
    meshes_.back().vertices.assign(part.mesh->vertices);
    meshes_.back().triangles.assign(part.mesh->triangles);
    meshes_.back().ring_start.assign(part.mesh->ring_start);
    meshes_.back().ring.assign(part.mesh->ring);
    meshes_.back().edge = part.mesh->edge;
  }
  surfaces_.push_back(s);
}

}  // namespace BL_SOLVER
