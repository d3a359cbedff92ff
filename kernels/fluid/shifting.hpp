#pragma once
// Particles that drift in addition to their velocity, so that they stay evenly spaced.

#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"

namespace BL_SOLVER {

/// Symmetric part of a gradient, 1/s.
template <class N>
struct Strain {
  N xx, yy, zz, xy, yz, zx;
  BL_HD void add(const N& w, const Vec3<N>& v, const Vec3<N>& r) {
    xx += w * v.x * r.x, yy += w * v.y * r.y, zz += w * v.z * r.z;
    xy += w * (v.x * r.y + v.y * r.x), yz += w * (v.y * r.z + v.z * r.y), zx += w * (v.z * r.x + v.x * r.z);
  }
  BL_HD void merge(const Strain& o) {
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, yz += o.yz, zx += o.zx;
  }
  BL_HD N magnitude() const {
    return root(square(xx) + square(yy) + square(zz) + Real(0.5) * (square(xy) + square(yz) + square(zx)));
  }
};

/// Particle shifting [lind12], proportional to the strain rate:
///   u = -min(A h^2 |S|, h^2 / (2 dt)) grad C,    grad C = sum_b V_b grad W_ab,    |u| <= 0.1 dx / dt,
///   S = symmetric part of sum_b V_b F_ab (q_a - q_b) r_ab.
/// Fluid at rest or in rigid rotation is not shifted (noise averages out in S). Without shifting a lattice
/// persists and resists shear by its pressure, at any resolution. Velocities stay, so momentum is conserved;
/// the transport error is of order h^2 |S|, that of angular momentum too.
///
/// Free surface [marrone10]: exposure = 1 - least eigenvalue of the second moment sum_b V_b F_ab r_ab r_ab,
/// 0.4 and more in the outermost layer, below 0.2 in disordered fluid. The outermost layer is not shifted;
/// within a kernel's reach of it u is projected on the surface, since grad C along the normal is not zero
/// there and would make fluid swell. Normal: gradient of the exposure of the former step.
struct Shifting {
  static constexpr bool acts = true;
  Real area;                  ///< A h^2 [m2]
  Real stiffest;              ///< h^2 / (2 dt) [m2/s]; beyond it places would overshoot
  Real fastest;               ///< 0.1 dx / dt [m/s]
  Real plane;                 ///< 1 in two dimensions, else 0
  Span<const Real> exposure;  ///< of the step before
  Span<Real> exposure_new;

  template <class N>
  struct Sum {
    SymmetricMatrix<N> moment;
    Strain<N> strain;
    Vec3<N> outward;  ///< sum of V F (e_b - e_a) (x_b - x_a)
    N own, greatest;  ///< exposure: that of a; the greatest around
    /// b: V_b F_ab; q = q_a - q_b; e: exposure of b.
    BL_HD void add(const N& b, const Vec3<N>& q, const Vec3<N>& r, const N& e) {
      add_wall(b, r);
      strain.add(b, q, r);
      outward += (b * (own - e)) * r;
      greatest = max_of(greatest, select(b > N(0), e, N(0)));
    }
    BL_HD void add_wall(const N& b, const Vec3<N>& r) { moment.add_outer(b, r); }
    BL_HD void merge(const Sum& o) {
      moment += o.moment;
      strain.merge(o.strain);
      outward += o.outward;
      greatest = max_of(greatest, o.greatest);
    }
  };
  template <class N>
  BL_HD Sum<N> start(Index a) const {
    return {{}, {}, {}, exposure[a], exposure[a]};
  }
  BL_HD auto sources() const { return exposure; }
  /// The second moment; in two dimensions that across them is 1.
  BL_HD SymmetricMatrix<Real> moment(const Sum<Real>& sum) const {
    SymmetricMatrix<Real> m = sum.moment;
    m.yy += plane;
    return m;
  }
  /// 1 within fluid, 0 in the outermost layer.
  BL_HD static Real inside(Real exposure) { return clamp(10 * (Real(0.3) - exposure), Real(0), Real(1)); }
  struct Drift {
    Real3 velocity;  ///< m/s
    bool limited;    ///< by `stiffest` or `fastest`
  };
  /// gradient: -grad C.
  BL_HD Drift drift(const Sum<Real>& sum, Real exposed, const Real3& gradient) const {
    Real3 along = gradient;
    const Real normal2 = norm2(sum.outward), beside = 1 - inside(sum.greatest);
    if (beside > 0 && normal2 > 0) along -= (beside * dot(gradient, sum.outward) / normal2) * sum.outward;
    const Real part = inside(exposed), pace = area * sum.strain.magnitude();
    const Real3 u = part * min_of(pace, stiffest) * along;
    const Real u2 = norm2(u);
    const bool far = u2 > square(fastest);
    return {far ? fastest / std::sqrt(u2) * u : u, far || (part > 0 && pace > stiffest)};
  }
};

/// Particles move with their velocity.
struct NoShifting {
  static constexpr bool acts = false;
  template <class N>
  struct Sum {
    BL_HD void add(const N&, const Vec3<N>&, const Vec3<N>&, Unread) {}
    BL_HD void add_wall(const N&, const Vec3<N>&) {}
    BL_HD void merge(const Sum&) {}
  };
  template <class N>
  BL_HD Sum<N> start(Index) const {
    return {};
  }
  BL_HD Unread sources() const { return {}; }
};

}  // namespace BL_SOLVER
