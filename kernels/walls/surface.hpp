#pragma once
// Wall surfaces as grains and fluid meet them. Geometry is that at t = 0; a pose moves it.
//
// What a surface shows to a place are its closest points: where its distance from there is least in their
// neighbourhood. A face has one, a convex edge or corner one, a groove one on each side, so that a sphere
// touches each feature once, however finely the surface is cut.
//
// Each kind is a model in its own header: `closest_point`, if it has one alone (`kOne`), or
// `closest_points`, `beyond`, whether a place is surely farther away, and `within`, whether it is near what
// is not hollow; `kTracked`, whether a place behind it may belong to it only if it came through it, and
// `kShell`, whether it may be a wall around the shape. A pass names the kinds that it meets, so that it has
// no code for others.

#include <algorithm>
#include <type_traits>

#include "kernels/walls/box.hpp"
#include "kernels/walls/capsule.hpp"
#include "kernels/walls/mesh.hpp"
#include "kernels/walls/plane.hpp"
#include "kernels/walls/rectangle.hpp"
#include "kernels/walls/revolution.hpp"

namespace BL_SOLVER {

template <class... Kinds>
struct SurfaceKinds {
  static constexpr bool kOne = (Kinds::kOne && ...), kTracked = (Kinds::kTracked || ...),
                        kShell = (Kinds::kShell || ...);
  template <class Surfaces>
  static bool hold(const Surfaces& surfaces) {
    return std::all_of(surfaces.begin(), surfaces.end(),
                       [](const Surface& s) { return ((s.kind == Kinds::kind) || ...); });
  }

  /// f(model) of a surface's kind, which must be one of these.
  template <class F>
  BL_HD static auto with(SurfaceKind kind, F&& f) {
    return first<Kinds...>(kind, f);
  }
  BL_HD static bool tracked(const Surface& s) {
    if constexpr (kTracked)
      return s.tracked();
    else
      return false;
  }
  /// As Surface::reach.
  BL_HD static double reach(const Surface& s, double R) { return tracked(s) ? R : 2 * R; }

 private:
  template <class Kind, class... Rest, class F>
  BL_HD static auto first(SurfaceKind kind, F& f) {
    if constexpr (sizeof...(Rest) == 0)
      return f(Kind{});
    else
      return kind == Kind::kind ? f(Kind{}) : first<Rest...>(kind, f);
  }
};

using FlatKinds = SurfaceKinds<RectangleKind, PlaneKind>;
using SmoothKinds = SurfaceKinds<RectangleKind, PlaneKind, BoxKind, CapsuleKind, RevolutionKind>;
using AllKinds = SurfaceKinds<RectangleKind, PlaneKind, BoxKind, CapsuleKind, RevolutionKind, MeshKind>;

/// f(std::type_identity<Kinds>) with the fewest kinds among which all surfaces are: the choice is made here,
/// on the host.
template <class Surfaces, class F>
void with_surface_kinds(const Surfaces& surfaces, F&& f) {
  if (FlatKinds::hold(surfaces)) return f(std::type_identity<FlatKinds>{});
  if (SmoothKinds::hold(surfaces)) return f(std::type_identity<SmoothKinds>{});
  f(std::type_identity<AllKinds>{});
}

/// All surfaces of a case.
struct SurfaceSet : SurfaceData {
  /// Whether r is surely farther than `distance` (m) from surface s; cheaper than its closest points.
  BL_HD bool beyond(const Surface& s, const Vec3d& r, double distance) const {
    return s.kind == SurfaceKind::plane ? PlaneKind::beyond(s, r, distance)
                                        : BoundedKind::beyond(s, r, distance);
  }
  /// Whether s may be within `distance` (m) of r. Sees into hollows: slower than `beyond`.
  BL_HD bool within(const Surface& s, const Vec3d& r, double distance) const {
    if (beyond(s, r, distance)) return false;
    return AllKinds::with(s.kind,
                          [&](const auto& kind) { return kind.within(*this, s, r, distance + s.shell); });
  }

  /// f(point) for each closest point of s no farther than `reach` (m) from r, the place as seen from s.centre
  /// in the frame of t = 0.
  template <class Kinds = AllKinds, class F>
  BL_HD void each_closest_point(const Surface& s, const Vec3d& r, double reach, const MeshSearch& search,
                                F&& f) const {
    const auto meet = nearer<Kinds>(s, reach, f);
    if constexpr (Kinds::kOne)
      meet(Kinds::with(s.kind, [&](const auto& kind) { return kind.closest_point(s, r); }));
    else
      Kinds::with(s.kind, [&](const auto& kind) {
        if constexpr (std::decay_t<decltype(kind)>::kOne)
          meet(kind.closest_point(s, r));
        else
          kind.closest_points(*this, s, r, reach, search, meet);
      });
  }
  /// As each_closest_point, but a mesh leaves out what its nearest point hides; see
  /// MeshView::each_exposed_point.
  template <class F>
  BL_HD void each_exposed_point(const Surface& s, const Vec3d& r, double reach, double merge, double flat,
                                F&& f) const {
    if (s.kind != SurfaceKind::mesh) return each_closest_point<SmoothKinds>(s, r, reach, merge, f);
    const auto meet = nearer<AllKinds>(s, reach, f);
    MeshKind::exposed_points(*this, s, r, reach, merge, flat, meet);
  }

 private:
  /// Takes a closest point of a shape to f as one of its wall, if near enough.
  template <class Kinds, class F>
  BL_HD static auto nearer(const Surface& s, double reach, F& f) {
    return [&s, reach, &f](ClosestPoint closest) {
      if (Kinds::kShell && s.shell > 0) {
        const bool inner = closest.distance < 0.5 * s.shell;
        if (inner) closest.normal = -closest.normal;
        closest.distance = inner ? -closest.distance : closest.distance - s.shell;
        closest.feature = 2 * closest.feature + inner;
      }
      if (closest.distance <= reach && (closest.distance >= -reach || !Kinds::tracked(s))) f(closest);
    };
  }
};

/// Where x (m, lab frame) lies as a surface sees it that has been moved and turned.
struct SurfaceView {
  const Surface& surface;
  const BodyPose& pose;
  Vec3d centre;  ///< of the surface, lab frame, m
  Vec3d r;       ///< x from there, lab frame, m
  BL_HD SurfaceView(const Surface& s, const BodyPose& at, const Frame& frame, const Vec3d& x)
      : surface(s), pose(at), centre(at.place(s.centre)), r(frame.nearest_image(x - centre)) {}

  BL_HD Vec3d local() const { return pose.turned() ? pose.rotation.conjugate().rotate(r) : r; }
  BL_HD bool beyond(const SurfaceSet& set, double distance) const {
    return set.beyond(surface, local(), distance);
  }
  /// f(point), its normal in the lab frame; see SurfaceSet::each_closest_point.
  template <class Kinds = AllKinds, class F>
  BL_HD void each_closest_point(const SurfaceSet& set, double reach, const MeshSearch& search, F&& f) const {
    set.each_closest_point<Kinds>(surface, local(), reach, search, [&](ClosestPoint closest) {
      if (pose.turned()) closest.normal = pose.rotation.rotate(closest.normal);
      f(closest);
    });
  }
  template <class F>
  BL_HD void each_exposed_point(const SurfaceSet& set, double reach, double merge, double flat, F&& f) const {
    set.each_exposed_point(surface, local(), reach, merge, flat, [&](ClosestPoint closest) {
      if (pose.turned()) closest.normal = pose.rotation.rotate(closest.normal);
      f(closest);
    });
  }
  /// Of the closest point on the surface, lab frame, m.
  BL_HD Vec3d point(const ClosestPoint& closest) const {
    return centre + r - closest.distance * closest.normal;
  }
};

}  // namespace BL_SOLVER
