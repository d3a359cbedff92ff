#pragma once
#include "kernels/bodies/rigid_body.hpp"
#include "kernels/boundaries/orifice.hpp"
#include "kernels/fluid/shifting.hpp"
#include "kernels/walls/surface.hpp"

namespace BL_SOLVER {

/// Lennard-Jones-like wall repulsion [monaghan94]: D ((r0/r)^4 - (r0/r)^2) / r for r < r0, at most `cap`; r:
/// distance from the surface. It sets the distance at which particles rest, which extrapolated pressure
/// leaves to the history of their density.
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

/// Limits the velocity u towards a wall of particles that its pressure may not stop: isolated or fast ones.
/// Within `reach` of the surface, at distance r, the acceleration away from it is
///   max(0, u - `rate` (r - r_stop)) / step,
/// which dissipates. r_stop = dx / 20 and reach = dx / 4, half of where fluid rests; for a sheet one particle
/// thick (`sheet` 1; 0 where fluid covers the particle), r_stop = 0.4 dx, about the rest distance of the
/// first layer of deeper fluid, and reach = dx / 2. Nearer than r_stop, particles return by dx / 400 per
/// 1 / `rate` at most.
struct PenetrationLimit {
  Real spacing = 0, rate = 0, per_step = 0;  ///< m; 1/s, below one over the step; one over the step, 1/s
  BL_HD Real reach(Real sheet) const { return Real(0.25) * (1 + sheet) * spacing; }
  /// Acceleration away from the wall of fluid at r that would near it at `approach` (m/s), m/s2.
  BL_HD Real operator()(Real r, Real approach, Real sheet) const {
    if (r >= reach(sheet)) return 0;
    const Real stop = (Real(0.05) + Real(0.35) * sheet) * spacing, ahead = r - stop;
    const Real pace = ahead > 0 ? ahead : Real(0.0025) * spacing / stop * ahead;
    return max_of(approach - rate * pace, Real(0)) * per_step;
  }
};

/// What a surface does to fluid near it.
struct SurfacePush {
  std::uint32_t body;
  Real3 acceleration;    ///< m/s2
  Vec3d point;           ///< of the surface, closest to the fluid, m
  bool stopped, capped;  ///< by the penetration limit; its repulsion is the largest allowed
};

/// Repulsion and penetration limit of the surfaces of all bodies.
struct WallRepulsion {
  Repulsion law;
  PenetrationLimit limit;
  Frame frame;
  SurfaceSet walls;
  Span<const BodyPose> pose;
  Span<const Real> exposure = {};  ///< of fluid to free surfaces (Shifting); empty: not known

  BL_HD double reach() const { return double(max_of(law.r0, limit.reach(exposure ? 1 : 0))); }
  /// Of particle a, as PenetrationLimit takes it.
  BL_HD Real sheet(Index a) const { return exposure ? 1 - Shifting::inside(exposure[a]) : Real(0); }
  /// Calls f(SurfacePush) for each closest point of a surface that acts on fluid at x (m), of all bodies or
  /// one. `heading`: velocity without these forces, m/s; each surface acts on what the former
  /// ones left of it. Removes from `drift` (m/s, shifting and XSPH) the component towards a surface.
  template <class F>
  BL_HD void each(const Vec3d& x, Real3 heading, Real sheet, F&& f, std::uint32_t only = kNone,
                  Real3* drift = nullptr) const {
    for (Index k = 0; k < walls.surfaces.size; ++k) {
      const Surface& surface = walls.surfaces[k];
      const BodyPose& at = pose[surface.body];
      if (!at.present || !(at.repulsion || at.no_penetration)) continue;
      const SurfaceView view(surface, at, frame, x);
      if (view.beyond(walls, reach())) continue;
      view.each_closest_point(walls, reach(), 1e-4 * reach(), [&](const ClosestPoint& closest) {
        const Real3 normal(closest.normal);
        const Vec3d point = view.point(closest);
        Real push = 0, repelled = 0;
        if (at.no_penetration && limit.per_step > 0) {
          push = limit(Real(closest.distance), dot(Real3(at.velocity(point)) - heading, normal), sheet);
          heading += push / limit.per_step * normal;
          if (drift && closest.distance < limit.reach(sheet))
            *drift -= min_of(dot(*drift, normal), Real(0)) * normal;
        }
        const bool stopped = push > 0;
        if (at.repulsion) push += repelled = law(Real(closest.distance));
        if (push > 0 && (only == kNone || surface.body == only))
          f(SurfacePush{surface.body, push * normal, point, stopped, repelled > 0 && repelled >= law.cap});
      });
    }
  }
};

/// Keeps fluid from flowing back between the buffer particles of an inlet: the same repulsion from the plane
/// of their foremost layer. Fluid that has just entered, a spacing ahead, is not pushed. Fluid that falls in
/// from the side moves against the layers at `gentle` at most.
struct OrificeRepulsion {
  Repulsion law;
  Real gentle, rate;  ///< m/s; 1 / step, 1/s
  Frame frame;
  Span<const Orifice> orifices;
  Span<const BodyPose> pose;

  /// Acceleration at x of what moves at v, m/s2.
  BL_HD Real3 operator()(const Vec3d& x, const Real3& v) const {
    Real3 sum;
    for (Index k = 0; k < orifices.size; ++k) {
      const Orifice& o = orifices[k];
      const BodyPose& layers = pose[o.body];
      const Vec3d r = frame.separation(x, layers.place(o.centre));
      const double ahead = o.along(r) + o.behind;
      if (ahead >= double(law.r0) || ahead < -2 * o.behind || o.beside(r) > 0) continue;
      const Real leaving = Real(o.along(Vec3d(v) - layers.v));
      sum += min_of(law(Real(ahead)), max_of((gentle - leaving) * rate, Real(0))) * Real3(o.direction);
    }
    return sum;
  }
};

struct RepelPass {
  WallRepulsion walls;
  OrificeRepulsion orifices;
  Real kick, dt;  ///< by which v is ahead of the middle of the step; the step, s
  Span<const Index> beside_walls;
  Span<const FluidPosition> x;
  Span<const VelocityDensity<>> v_rho;
  Span<const Real3> acc_before;
  Span<Real3> acc, heading, drift;  ///< drift: empty where nothing drifts
  BL_HD void operator()(Index k) const {
    const Index a = beside_walls[k];
    const Vec3d at = coordinates(walls.frame, x[a]);
    const Real3 v = v_rho[a].v, next = v + dt * acc[a] - kick * acc_before[a];
    heading[a] = next;
    const auto take = [&](const SurfacePush& push) { acc[a] += push.acceleration; };
    walls.each(at, next, walls.sheet(a), take, kNone, drift ? &drift[a] : nullptr);
    acc[a] += orifices(at, v);
  }
};

/// Force of the surfaces' push on one body, and its torque about the centre of the body.
struct BodyRepulsion {
  using Value = LoadSum;
  WallRepulsion walls;
  std::uint32_t body;
  Span<const FluidPosition> x;
  Span<const Real> mass;
  Span<const Real3> heading;  ///< as RepelPass found it, m/s
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index a) const {
    Value sum = Value::zero();
    const Vec3d at = coordinates(walls.frame, x[a]);
    const auto take = [&](const SurfacePush& push) {
      const Vec3d force = -double(mass[a]) * Vec3d(push.acceleration);
      sum.add(force, cross(walls.frame.nearest_image(at - walls.pose[body].origin()), force));
    };
    walls.each(at, heading[a], walls.sheet(a), take, body);
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

}  // namespace BL_SOLVER
