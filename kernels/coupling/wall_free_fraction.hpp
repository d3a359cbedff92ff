#pragma once
#include <cmath>
#include <type_traits>

#include "kernels/smoothing/half_space_fraction.hpp"
#include "kernels/walls/surface.hpp"

namespace BL_SOLVER {

/// Fraction of the kernel around a point that is not cut off by walls. Directions are treated separately:
/// exact for planes, and for tanks up to the kernel's deviation from a product of three factors. Boxes are
/// finite and do not overlap, so the parts that they cut off are added. A curved surface counts as the plane
/// through its closest point; closest points with similar normals cut off the same part, and those seen from
/// behind none. Kinds: those that the surfaces are of.
template <class Kinds = AllKinds>
struct WallFreeFraction {
  static constexpr Real kLeast = Real(0.125);  ///< in a corner

  HalfSpaceFraction half_space;
  Frame frame;
  SurfaceSet walls;
  Span<const BodyPose> pose;

  /// Of a kernel with that support, m.
  BL_HD Real operator()(const Vec3d& x, Real range) const {
    const Cut cut{half_space, range};
    Real fraction = 1, boxes = 0;
    for (Index k = 0; k < walls.surfaces.size; ++k) {
      const Surface& s = walls.surfaces[k];
      const BodyPose& at = pose[s.body];
      if (!at.present) continue;
      const SurfaceView view(s, at, frame, x);
      if (kFlat || s.kind == SurfaceKind::plane || s.kind == SurfaceKind::rectangle)
        fraction *= 1 - behind(cut, s, view.local());
      else if (s.kind == SurfaceKind::box && s.shell == 0)
        boxes += behind(cut, s, view.local());
      else if constexpr (!kFlat)
        fraction *= beside(cut, view);
    }
    return max_of(fraction - boxes, kLeast);
  }
  BL_HD Real operator()(const Vec3d& x) const { return (*this)(x, half_space.range); }
  /// Whether walls, present or not, may cut a kernel of that support (m) around any point within `skin` (m)
  /// of x.
  BL_HD bool may_cut(const Vec3d& x, Real support, double skin) const {
    const double range = 1.001 * double(support);  // rounding within the fraction stays below that
    for (Index k = 0; k < walls.surfaces.size; ++k) {
      const Surface& s = walls.surfaces[k];
      const Vec3d r = SurfaceView(s, pose[s.body], frame, x).local();
      const bool patch = s.kind == SurfaceKind::rectangle;
      if (patch && std::abs(dot(r, s.axis[2])) > range + skin) continue;
      if (walls.within(s, r, (patch ? 2 : 1) * range + skin)) return true;  // a patch reaches past its edges
    }
    return false;
  }

 private:
  static constexpr bool kFlat = std::is_same_v<Kinds, FlatKinds>;
  static constexpr int kCompared = 6;  ///< closest points that the next ones are compared with

  /// Fraction of a kernel of another support on one side of a plane.
  struct Cut {
    const HalfSpaceFraction& half_space;
    Real range;
    BL_HD Real operator()(double z) const { return half_space.within(z, range); }
  };

  BL_HD Real beside(const Cut& cut, const SurfaceView& view) const {
    const double reach = double(cut.range);
    if (view.beyond(walls, reach)) return 1;
    Vec3d normals[kCompared];
    int compared = 0;
    Real fraction = 1;
    double nearest = reach, within = 0;  // depth of a place inside the wall, to its nearest face
    const auto meet = [&](const ClosestPoint& closest) {
      if (std::abs(closest.distance) < nearest) {
        nearest = std::abs(closest.distance);
        within = min_of(closest.distance, 0.0);
      }
      if (closest.distance < 0) return;
      Real fresh = 1;
      for (int k = 0; k < compared; ++k)
        fresh = min_of(fresh, max_of(Real(0), 1 - Real(dot(normals[k], closest.normal))));
      fraction *= 1 - fresh * (1 - cut(closest.distance));
      if (compared < kCompared) normals[compared++] = closest.normal;
    };
    if constexpr (std::is_same_v<Kinds, AllKinds>)
      view.each_exposed_point(walls, reach, 1e-4 * reach, 0.05 * reach, meet);
    else
      view.template each_closest_point<Kinds>(walls, reach, 1e-4 * reach, meet);
    return within < 0 ? fraction * cut(within) : fraction;
  }
  BL_HD static Real behind(const Cut& cut, const Surface& s, const Vec3d& r) {
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    if (s.kind == SurfaceKind::plane) return 1 - cut(max_of(p[2], 0.0));
    if (!kFlat && s.kind == SurfaceKind::box)
      return inside(cut, s, p, 0) * inside(cut, s, p, 1) * inside(cut, s, p, 2);
    // a patch cuts off what lies behind it, also where it joins another patch
    const double reach = cut.range;
    return (1 - cut(std::abs(p[2]))) * cut(s.half[0] + reach - std::abs(p[0])) *
           cut(s.half[1] + reach - std::abs(p[1]));
  }
  BL_HD static Real inside(const Cut& cut, const Surface& s, const double* p, int k) {
    return cut(s.half[k] - p[k]) - cut(-s.half[k] - p[k]);
  }
};

}  // namespace BL_SOLVER
