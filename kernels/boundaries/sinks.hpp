#pragma once
// Which particles leave a simulation, and through which side or outlet.

#include "bedload/core/frame.hpp"
#include "kernels/contact/grain_mass.hpp"
#include "kernels/walls/surface.hpp"

namespace BL_SOLVER {

constexpr std::uint32_t kSides = 6;  ///< of the domain, in the order of kFaces
/// A particle stays, leaves through side k of the domain, or through outlet k.
constexpr std::uint32_t kStays = 0, kLeftDomain = 1, kOutlet = kLeftDomain + kSides;

/// 1 + the side of the domain beyond which x lies, on a non-periodic axis and by more than the rounding of
/// packed positions; of several sides the one with the largest distance. 0 inside.
BL_HD std::uint32_t beyond_side(const Frame& f, const Vec3d& x) {
  std::uint32_t side = 0;
  double farthest = 0;
  for (int k = 0; k < 3; ++k) {
    if (f.periodic[k]) continue;
    const double rounding = f.length[k] * kPackedRounding;
    const double below = f.origin[k] - rounding - x[k], above = x[k] - (f.origin[k] + f.length[k] + rounding);
    const double beyond = below > 0 ? below : above;
    if (beyond <= 0 || beyond <= farthest) continue;  // neither is true of NaN, which lies outside
    side = 1 + 2 * k + (below > 0 ? 0 : 1), farthest = beyond;
  }
  return side;
}
BL_HD bool outside(const Frame& f, const Vec3d& x) { return beyond_side(f, x) != 0; }

/// Whether x lies in the solid behind a surface in its pose of t = 0.
BL_HD bool inside(const SurfaceSet& set, const Surface& s, const Frame& frame, const Vec3d& x) {
  const BodyPose still;
  const SurfaceView view(s, still, frame, x);
  if (view.beyond(set, 0)) return false;
  // tolerance for a mesh, where round-off could assign an edge to neither of its triangles
  const double size = s.kind == SurfaceKind::mesh ? 2 * (s.half[0] + s.half[1] + s.half[2]) : 0;
  double nearest = 1e300, distance = 1e300;
  view.each_closest_point(set, size > 0 ? size : nearest, 1e-9 * size, [&](const ClosestPoint& closest) {
    const double away = std::abs(closest.distance);
    if (away >= nearest) return;
    nearest = away, distance = closest.distance;
  });
  return distance < 0;
}

/// Marks each particle with the side or outlet through which it leaves; `domain`: sides count.
template <class P>
struct SinkPass {
  Frame frame;
  SurfaceSet outlets;
  bool domain;
  Span<const P> x;
  Span<std::uint32_t> sink;

  BL_HD void operator()(Index i) const {
    const Vec3d at = coordinates(frame, x[i]);
    const std::uint32_t side = domain ? beyond_side(frame, at) : 0;
    sink[i] = side ? kLeftDomain + side - 1 : kStays;
    for (Index s = 0; s < outlets.surfaces.size; ++s)
      if (inside(outlets, outlets.surfaces[s], frame, at)) {
        sink[i] = kOutlet + outlets.surfaces[s].body;
        return;
      }
  }
};

/// Places that are not wrapped.
struct WrappedCentres {
  Frame frame;
  Span<const Vec3d> x;
  Span<Vec3d> out;
  BL_HD void operator()(Index c) const { out[c] = frame.wrap(x[c]); }
};
/// Grains of a clump leave where its centre does.
struct LeaveTogetherPass {
  Span<const std::uint32_t> clump, of_clumps;  ///< of each grain 1 + its clump, 0: none; sinks of clumps
  Span<std::uint32_t> sink;
  BL_HD void operator()(Index i) const {
    if (clump[i] > 0) sink[i] = of_clumps[clump[i] - 1];
  }
};

struct StaysTest {
  Span<const std::uint32_t> sink;
  BL_HD bool operator()(Index i) const { return sink[i] == kStays; }
};

/// Counts particles that leave.
struct LeavingBody {
  Span<const std::uint32_t> sink;
  BL_HD void operator()(Index i, double* out) const { out[0] = sink[i] == kStays ? 0 : 1; }
};

/// {count, mass} of particles that leave through one side or outlet; Mass(i): kg. A clump counts as one.
template <class Mass>
struct SinkTally {
  Span<const std::uint32_t> sink;
  std::uint32_t way;
  Mass mass;
  Span<const std::uint32_t> member;  ///< which sphere of its clump; empty: none
  BL_HD void operator()(Index i, double* out) const {
    if (sink[i] != way) return;
    out[0] = member && member[i] > 0 ? 0 : 1;
    out[1] = mass(i);
  }
};

/// {count, mass} of particles that leave through each side; Mass(i): kg.
template <class Mass>
struct SideTally {
  Span<const std::uint32_t> sink;
  Mass mass;
  BL_HD void operator()(Index i, double* out) const {
    if (sink[i] < kLeftDomain || sink[i] >= kOutlet) return;
    out[2 * (sink[i] - kLeftDomain)] = 1;
    out[2 * (sink[i] - kLeftDomain) + 1] = mass(i);
  }
};

/// 1 + the side through which a grain outside the domain has left; constant while it is outside. 0 inside.
struct LeftThrough {
  Frame frame;
  Span<const Vec3d> x;
  Span<const std::uint32_t> known;
  BL_HD std::uint32_t operator()(Index i) const {
    const std::uint32_t side = beyond_side(frame, x[i]);
    return side && known[i] ? known[i] : side;
  }
};
struct NoteSidePass {
  LeftThrough side;
  Span<std::uint32_t> left_through;
  BL_HD void operator()(Index i) const { left_through[i] = side(i); }
};
/// {count, mass} of grains that have left through each side; Mass(i): kg.
template <class Mass>
struct GrainSideTally {
  LeftThrough side;
  Mass mass;
  BL_HD void operator()(Index i, double* out) const {
    const std::uint32_t s = side(i);
    if (s == 0) return;
    out[2 * (s - 1)] = 1;
    out[2 * (s - 1) + 1] = mass(i);
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

}  // namespace BL_SOLVER
