#include "bedload/geometry/body.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh_layout.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/geometry/shape.hpp"
#include "bedload/parallel/host_loop.hpp"

namespace bedload {
namespace {

using std::numbers::pi;

constexpr int kPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

void add_second(SolidMoments& m, double weight, const Vec3d& a, const Vec3d& b) {
  for (int k = 0; k < 6; ++k) m.second[k] += weight * a[kPairs[k][0]] * b[kPairs[k][1]];
}

/// A piece of volume, about its own centre along unit axes, put where it is: second moments along them.
void add_piece(SolidMoments& all, double volume, const Vec3d& centre, const Quat<double>& turn,
               const Vec3d& second) {
  all.add(volume, centre);
  for (int k = 0; k < 3; ++k) {
    Vec3d e;
    e[k] = 1;
    e = turn.rotate(e);
    add_second(all, second[k], e, e);
  }
}

/// What r^2(z) sweeps about the z axis, by slices; exact for polynomials of the fifth degree.
struct SweptMoments {
  double volume = 0, first = 0, axial = 0, across = 0;  ///< of 1, z, z z, x x
  template <class Square>
  void add(double from, double to, const Square& r2) {
    const double middle = (from + to) / 2, half = (to - from) / 2;
    for (const auto& [at, weight] :
         {std::pair{-std::sqrt(0.6), 5.0 / 9}, {0.0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}}) {
      const double z = middle + half * at, s = r2(z), area = weight * half * pi * s;
      volume += area, first += area * z, axial += area * z * z, across += area * s / 4;
    }
  }
};

void add_swept(SolidMoments& all, const SweptMoments& swept, const SurfacePart& part) {
  const double z = swept.first / swept.volume;  // of its centre
  const double axial = swept.axial - swept.volume * z * z;
  add_piece(all, swept.volume, part.centre + part.rotation.rotate({0, 0, z}), part.rotation,
            {swept.across, swept.across, axial});
}

void add_revolution(SolidMoments& all, const SurfacePart& part) {
  SweptMoments swept;
  for (std::size_t n = 0; n < part.profile.size(); ++n) {
    const auto &p = part.profile[n], &q = part.profile[(n + 1) % part.profile.size()];
    if (p.z == q.z) continue;
    swept.add(p.z, q.z, [&](double z) {
      const double r = p.r + (z - p.z) / (q.z - p.z) * (q.r - p.r);
      return r * r;
    });
  }
  add_swept(all, swept, part);
}

void add_capsule(SolidMoments& all, const SurfacePart& part) {
  const double R = part.radius, L = part.half.z;
  SweptMoments swept;
  swept.add(-L - R, -L, [&](double z) { return R * R - (z + L) * (z + L); });
  swept.add(-L, L, [&](double) { return R * R; });
  swept.add(L, L + R, [&](double z) { return R * R - (z - L) * (z - L); });
  add_swept(all, swept, part);
}

/// Tetrahedra from the mesh's centre to its triangles.
void add_mesh(SolidMoments& all, const SurfacePart& part) {
  SolidMoments own;
  for (const MeshTriangle& t : part.mesh->triangles) {
    const Vec3d &a = part.mesh->vertices[t.corner[0]], &b = part.mesh->vertices[t.corner[1]],
                &c = part.mesh->vertices[t.corner[2]];
    const double six = dot(a, cross(b, c));
    const Vec3d sum = a + b + c;
    own.volume += six / 6;
    own.first += six / 24 * sum;
    for (const Vec3d* x : {&a, &b, &c, &sum}) add_second(own, six / 120, *x, *x);
  }
  all.volume += own.volume;
  all.first += own.first + own.volume * part.centre;
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = kPairs[k];
    all.second[k] += own.second[k] + own.first[i] * part.centre[j] + own.first[j] * part.centre[i] +
                     own.volume * part.centre[i] * part.centre[j];
  }
}

SolidMoments raster_moments(const Shape& shape, const DomainConfig& domain) {
  const Bounds bounds = shape.bounds();
  const Vec3d side = bounds.max - bounds.min;
  const double step =
      domain.two_d ? std::sqrt(side.x * side.z / 1e6) : std::cbrt(side.x * side.y * side.z / 1e6);
  int n[3];
  for (int k = 0; k < 3; ++k) n[k] = domain.flat(k) ? 1 : std::max(1, int(std::ceil(side[k] / step)));
  const double cell = domain.cell_volume(step);
  std::vector<SolidMoments> slabs(n[2]);
  host_for_each(slabs.size(), [&](std::size_t l) {
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        Vec3d x = bounds.min + step * Vec3d{i + 0.5, j + 0.5, double(l) + 0.5};
        if (domain.two_d) x.y = domain.middle();
        slabs[l].add(cell * std::clamp(0.5 - shape.distance(x) / step, 0.0, 1.0), x);
      }
  });
  SolidMoments all;
  for (const SolidMoments& slab : slabs) {
    all.volume += slab.volume;
    all.first += slab.first;
    for (int k = 0; k < 6; ++k) all.second[k] += slab.second[k];
  }
  all.second[1] += all.volume * domain.thickness() * domain.thickness() / 12;
  return all;
}

SolidMoments box_moments(const Vec3d& min, const Vec3d& max) {
  const Vec3d side = max - min;
  const double volume = side.x * side.y * side.z;
  SolidMoments all;
  add_piece(all, volume, (min + max) / 2, {},
            {volume * side.x * side.x / 12, volume * side.y * side.y / 12, volume * side.z * side.z / 12});
  return all;
}

/// Elementary parts of a shape; none where it has no such description.
std::vector<SurfacePart> parts_of(const Shape& shape) {
  std::vector<SurfacePart> parts;
  try {
    shape.add_parts(parts, {});
  } catch (const CaseError&) {
    parts.clear();
  }
  return parts;
}

}  // namespace

void SolidMoments::add(double piece, const Vec3d& at) {
  volume += piece;
  first += piece * at;
  add_second(*this, piece, at, at);
}

bool is_closed(const WallBody& body) { return body.solid.shape || body.shape == WallShape::box; }

SolidMoments solid_moments(const WallBody& body, const DomainConfig& domain) {
  return body.solid.shape ? solid_moments(*body.solid.shape, domain) : box_moments(body.min, body.max);
}

SolidMoments solid_moments(const Shape& shape, const DomainConfig& domain) {
  const auto parts = parts_of(shape);
  if (domain.two_d || parts.size() != 1 || parts[0].shell > 0) return raster_moments(shape, domain);
  const SurfacePart& part = parts[0];
  SolidMoments all;
  switch (part.kind) {
    case SurfacePart::Kind::box: {
      const Vec3d h = part.half;
      const double volume = 8 * h.x * h.y * h.z;
      add_piece(all, volume, part.centre, part.rotation,
                {volume * h.x * h.x / 3, volume * h.y * h.y / 3, volume * h.z * h.z / 3});
      break;
    }
    case SurfacePart::Kind::capsule:
      add_capsule(all, part);
      break;
    case SurfacePart::Kind::revolution:
      add_revolution(all, part);
      break;
    case SurfacePart::Kind::mesh:
      add_mesh(all, part);
      break;
  }
  return all;
}

MassProperties mass_properties(const WallBody& body, const DomainConfig& domain) {
  const FreeConfig& f = body.free;
  MassProperties out;
  out.mass = f.mass;
  if (f.centre_of_mass.size() == 3)
    out.centre = {f.centre_of_mass[0], domain.two_d ? domain.middle() : f.centre_of_mass[1],
                  f.centre_of_mass[2]};
  if (f.inertia.size() == 6) std::copy(f.inertia.begin(), f.inertia.end(), out.inertia.begin());
  if (!is_closed(body)) {
    if (f.mass > 0 && !f.centre_of_mass.empty() && !f.inertia.empty()) return out;
    throw CaseError("needs mass, centre_of_mass and inertia; shape = \"" + body.shape.name() +
                    "\" is not closed, so they do not follow from it");
  }
  const SolidMoments m = solid_moments(body, domain);
  if (domain.two_d && m.volume == 0)
    throw CaseError(fmt::format("needs a shape that the plane y = {:g} m cuts", domain.middle()));
  if (out.mass == 0) out.mass = f.density * m.volume;
  const double density = out.mass / m.volume;
  Vec3d middle = m.middle();
  if (domain.two_d) middle.y = domain.middle();  // whatever the round-off
  if (m.volume > 0) out.volume = m.volume, out.middle = middle;
  if (f.centre_of_mass.empty()) out.centre = middle;
  if (!f.inertia.empty()) return out;
  std::array<double, 6> s{};  // second moments about the shape's own centre
  for (int k = 0; k < 6; ++k)
    s[k] = density * (m.second[k] - m.volume * middle[kPairs[k][0]] * middle[kPairs[k][1]]);
  out.inertia = {s[1] + s[2], s[0] + s[2], s[0] + s[1], -s[3], -s[4], -s[5]};
  return out;
}

Vec3d turning_centre(const FreeConfig& free) {
  const bool held = free.move == BodyMove::none && free.point.size() == 3;
  return held ? Vec3d{free.point[0], free.point[1], free.point[2]} : free.solid.centre;
}

PrincipalInertia principal_inertia(const std::array<double, 6>& j) {
  Eigen::Matrix3d m;
  m << j[0], j[3], j[4], j[3], j[1], j[5], j[4], j[5], j[2];
  const bool diagonal = j[3] == 0 && j[4] == 0 && j[5] == 0;
  if (diagonal) return {{j[0], j[1], j[2]}, {}};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) *= -1;
  Eigen::Quaterniond q(axes);
  q.normalize();
  const Eigen::Vector3d& d = solver.eigenvalues();
  return {{d[0], d[1], d[2]}, {q.w(), q.x(), q.y(), q.z()}};
}

std::array<double, 6> shifted_inertia(const std::array<double, 6>& j, double mass, const Vec3d& d) {
  return {j[0] + mass * (d.y * d.y + d.z * d.z),
          j[1] + mass * (d.x * d.x + d.z * d.z),
          j[2] + mass * (d.x * d.x + d.y * d.y),
          j[3] - mass * d.x * d.y,
          j[4] - mass * d.x * d.z,
          j[5] - mass * d.y * d.z};
}

std::vector<BodyBall> contact_balls(const WallBody& body, const DomainConfig& domain) {
  const FreeConfig& f = body.free;
  if (!f.contacts) return {};
  if (!f.balls.empty()) return f.balls;
  const double spacing = f.contact_spacing;
  std::vector<BodyBall> balls;
  const auto parts = body.solid.shape ? parts_of(*body.solid.shape) : std::vector<SurfacePart>{};
  if (!domain.two_d && parts.size() == 1 && parts[0].kind == SurfacePart::Kind::capsule &&
      parts[0].shell == 0) {
    const SurfacePart& part = parts[0];
    const int n = std::max(0, int(std::ceil(2 * part.half.z / part.radius - 1e-9)));
    for (int k = 0; k <= n; ++k) {
      const double z = n > 0 ? part.half.z * (2.0 * k / n - 1) : 0;
      balls.push_back({part.centre + part.rotation.rotate({0, 0, z}), part.radius});
    }
    return balls;
  }
  if (!is_closed(body)) return {};
  for (Vec3d x : sample_body(body, spacing, 0.9 * spacing, domain)) {
    if (domain.two_d) x.y = domain.middle();
    const double depth = -wall_distance(body, x, spacing, domain);
    if (depth > 0) balls.push_back({x, depth});
  }
  return balls;
}

double particles_beyond(const WallBody& body, const FluidConfig& fluid) {
  const bool outside = body.shape == WallShape::tank || body.type->kind == WallKind::mirrored;
  return fluid.present && outside ? fluid.reach() : 0;
}

std::vector<Vec3d> corners(const WallBody& body, const DomainConfig& domain, double beyond) {
  const bool bounded = body.shape != WallShape::plane;
  const Vec3d out{beyond, beyond, beyond};
  Vec3d lo = (bounded ? body.min : domain.min) - out, hi = (bounded ? body.max : domain.max) + out;
  if (domain.two_d) lo.y = hi.y = domain.middle();
  std::vector<Vec3d> all;
  for (int corner = 0; corner < 8; ++corner)
    all.push_back({corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z});
  return all;
}

}  // namespace bedload
