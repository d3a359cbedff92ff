#pragma once
// Pairs of fluid particles with a surface between them.

#include "bedload/neighbours/for_each_pair.hpp"
#include "bedload/particles/fluid.hpp"
#include "kernels/walls/surface.hpp"

namespace BL_SOLVER {

/// Point nearest to a place, on any of the surfaces.
struct NearestPoint {
  Vec3d normal;
  double distance = 0;    ///< m
  Index surface = kNone;  ///< none within reach
};

struct NearestPointPass {
  Frame frame;
  SurfaceSet walls;
  Span<const BodyPose> pose;
  double reach;  ///< m
  Span<const FluidPosition> x;
  Span<NearestPoint> points;

  BL_HD void operator()(Index a) const { points[a] = nearest(coordinates(frame, x[a])); }
  BL_HD NearestPoint nearest(const Vec3d& at) const {
    NearestPoint best;
    for (Index k = 0; k < walls.surfaces.size; ++k) look(k, at, best);
    return best;
  }
  BL_HD void look(Index k, const Vec3d& at, NearestPoint& best) const {
    const Surface& surface = walls.surfaces[k];
    if (!pose[surface.body].present) return;
    const SurfaceView view(surface, pose[surface.body], frame, at);
    if (view.beyond(walls, reach)) return;
    view.each_closest_point(walls, reach, 1e-4 * reach, [&](const ClosestPoint& closest) {
      const bool nearer = best.surface == kNone || std::abs(closest.distance) < std::abs(best.distance);
      if (nearer && std::abs(closest.distance) < reach) best = {closest.normal, closest.distance, k};
    });
  }
};

/// Counts for each particle a the partners b that its nearest surface keeps out of sight: each lies behind
/// the plane through the other's closest point, and the line between them meets the surface where it meets
/// a's plane, which distinguishes a shell from its rim.
struct CrossingPass {
  NearestPointPass near;
  double tolerance;  ///< m
  Span<std::uint32_t> count;

  struct Sum {
    Vec3d x;  ///< m
    NearestPoint at;
    std::uint32_t count;
  };
  BL_HD Sum start(Index a) const { return {coordinates(near.frame, near.x[a]), near.points[a], 0}; }
  BL_HD auto sources() const { return sources_of(near.points); }
  BL_HD void pair(Sum& sum, const Real3& r_ab, Real, Real, const NearestPoint& other) const {
    const NearestPoint& at = sum.at;
    if (at.surface == kNone || other.surface == kNone) return;
    const Vec3d r(r_ab);
    const double towards = dot(r, at.normal);
    if (!(towards > at.distance && -dot(r, other.normal) > other.distance)) return;
    NearestPoint there;
    near.look(at.surface, sum.x - (at.distance / towards) * r, there);
    if (there.surface != kNone && std::abs(there.distance) < tolerance) ++sum.count;
  }
  BL_HD void finish(Index a, const Sum& sum) const { count[a] = sum.count; }
};

}  // namespace BL_SOLVER
