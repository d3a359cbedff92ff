#pragma once
#include "kernels/bodies/rigid_body.hpp"
#include "kernels/walls/surface.hpp"

namespace bedload::inline BL_VARIANT {

/// Repulsion between fluid and a wall (Monaghan 1994), r: distance from the surface. Extrapolated pressure
/// alone leaves it to the history of the density where a particle comes to rest beside a wall; this says
/// where.
struct Repulsion {
  Real D = 0, r0 = 0, cap = 0;  ///< m2/s2, m, m/s2
  /// Acceleration away from the wall, m/s2.
  BL_HD Real operator()(Real r) const {
    if (r >= r0) return 0;
    r = max_of(r, Real(1e-3) * r0);
    const Real q2 = square(r0 / r);
    return min_of(D * (square(q2) - q2) / r, cap);
  }
};

/// The same from all bodies that ask for it. A lattice that begins half a spacing from a wall feels nothing
/// at the default reach.
struct WallRepulsion {
  Repulsion law;
  Frame frame;
  SurfaceSet walls;
  Span<const BodyPose> pose;

  /// f(body, acceleration) for each foot of a surface within reach of x.
  template <class F>
  BL_HD void each(const Vec3d& x, F&& f) const {
    const double reach = double(law.r0);
    for (Index k = 0; k < walls.surfaces.size; ++k) {
      const Surface& surface = walls.surfaces[k];
      const BodyPose& at = pose[surface.body];
      if (!at.present || !at.repulsion) continue;
      const SurfaceView view(surface, at, frame, x);
      if (view.beyond(walls, reach)) continue;
      view.each_foot(walls, reach, 1e-4 * reach, [&](const Foot& foot) {
        const Real push = law(Real(foot.distance));
        if (push > 0) f(surface.body, push * Real3(foot.normal));
      });
    }
  }
};

struct RepelPass {
  WallRepulsion walls;
  Span<const FluidPosition> x;
  Span<Real3> acc;
  BL_HD void operator()(Index a) const {
    walls.each(coordinates(walls.frame, x[a]), [&](std::uint32_t, const Real3& push) { acc[a] += push; });
  }
};

/// Force and moment about a point of the repulsion on one body, N and N m: for sum_over<6>.
struct RepulsionLoad {
  WallRepulsion walls;
  std::uint32_t body;
  Vec3d about;
  Span<const FluidPosition> x;
  Span<const Real> mass;
  BL_HD void operator()(Index a, double* out) const {
    const Vec3d at = coordinates(walls.frame, x[a]);
    walls.each(at, [&](std::uint32_t b, const Real3& push) {
      if (b != body) return;
      const Vec3d force = -double(mass[a]) * Vec3d(push), moment = cross(at - about, force);
      for (int k = 0; k < 3; ++k) out[k] += force[k], out[3 + k] += moment[k];
    });
  }
};

/// The same on one body, about its own centre where its pose has taken it.
struct BodyRepulsion {
  using Value = LoadSum;
  WallRepulsion walls;
  std::uint32_t body;
  Span<const FluidPosition> x;
  Span<const Real> mass;
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index a) const {
    Value sum = Value::zero();
    const BodyPose& pose = walls.pose[body];
    const Vec3d at = coordinates(walls.frame, x[a]);
    walls.each(at, [&](std::uint32_t b, const Real3& push) {
      if (b != body) return;
      const Vec3d force = -double(mass[a]) * Vec3d(push);
      sum.add(force, cross(walls.frame.nearest_image(at - pose.centre - pose.translation), force));
    });
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

}  // namespace bedload::inline BL_VARIANT
