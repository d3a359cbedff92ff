#pragma once
// Which particles leave a simulation, and by which way.

#include "bedload/core/frame.hpp"
#include "kernels/contact/grain_mass.hpp"
#include "kernels/walls/surface.hpp"

namespace bedload::inline BL_VARIANT {

/// Ways out: none, through an open side of the domain, or outlet k.
constexpr std::uint32_t kStays = 0, kLeftDomain = 1, kOutlet = 2;

/// Outside the domain on an axis that is not periodic, by more than packed positions are rounded.
BL_HD bool outside(const Frame& f, const Vec3d& x) {
  for (int k = 0; k < 3; ++k) {
    const double rounding = f.length[k] * kPackedRounding;
    if (!f.periodic[k] && !(x[k] >= f.origin[k] - rounding && x[k] <= f.origin[k] + f.length[k] + rounding))
      return true;
  }
  return false;
}

/// Whether x lies in the solid behind a surface that stands where it was at t = 0.
BL_HD bool inside(const SurfaceSet& set, const Surface& s, const Frame& frame, const Vec3d& x) {
  const BodyPose still;
  const SurfaceView view(s, still, frame, x);
  if (view.beyond(set, 0)) return false;
  // of a mesh, whose edges would belong to none of their triangles by round-off; others have no need of it
  const double size = s.kind == SurfaceKind::mesh ? 2 * (s.half[0] + s.half[1] + s.half[2]) : 0;
  double nearest = 1e300, distance = 1e300;
  view.each_closest_point(set, size > 0 ? size : nearest, 1e-9 * size, [&](const ClosestPoint& closest) {
    const double away = std::abs(closest.distance);
    if (away >= nearest) return;
    nearest = away, distance = closest.distance;
  });
  return distance < 0;
}

/// Marks each particle with its way out; `domain`: leaving that is one.
template <class P>
struct SinkPass {
  Frame frame;
  SurfaceSet outlets;
  bool domain;
  Span<const P> x;
  Span<std::uint32_t> sink;

  BL_HD void operator()(Index i) const {
    const Vec3d at = coordinates(frame, x[i]);
    sink[i] = domain && outside(frame, at) ? kLeftDomain : kStays;
    for (Index s = 0; s < outlets.surfaces.size; ++s)
      if (inside(outlets, outlets.surfaces[s], frame, at)) {
        sink[i] = kOutlet + outlets.surfaces[s].body;
        return;
      }
  }
};

struct StaysTest {
  Span<const std::uint32_t> sink;
  BL_HD bool operator()(Index i) const { return sink[i] == kStays; }
};

/// How many leave.
struct LeavingBody {
  Span<const std::uint32_t> sink;
  BL_HD void operator()(Index i, double* out) const { out[0] = sink[i] == kStays ? 0 : 1; }
};

/// {count, mass} of what leaves by one way; Mass(i): kg.
template <class Mass>
struct SinkTally {
  Span<const std::uint32_t> sink;
  std::uint32_t way;
  Mass mass;
  BL_HD void operator()(Index i, double* out) const {
    if (sink[i] != way) return;
    out[0] = 1;
    out[1] = mass(i);
  }
};

struct FluidMass {
  Span<const Real> mass;
  BL_HD double operator()(Index a) const { return mass[a]; }
};
struct GrainMass {
  MassPerR3 per_r3;
  Span<const Real> radius;
  BL_HD double operator()(Index i) const { return per_r3(i) * cube(double(radius[i])); }
};

}  // namespace bedload::inline BL_VARIANT
