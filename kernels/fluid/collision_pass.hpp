#pragma once
#include "bedload/neighbours/for_each_pair.hpp"

namespace BL_SOLVER {

/// With how many fluid particles within `range` of it each one approaches.
struct CollisionCountPass {
  Real range2;  ///< m2
  Span<const VelocityDensity<>> v_rho;
  Span<Real> count;

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N count;
  };
  BL_HD Sum<> start(Index a) const { return {v_rho[a].v, 0}; }
  BL_HD auto sources() const { return sources_of(v_rho); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb) const {
    const N near = select(r2 < N(range2), N(1), N(0));
    const N there = select(M > N(0), near, N(0));  // what fills up a list weighs nothing
    sum.count += select(dot(sum.v - vb.v, r) < N(0), there, N(0));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.count += other.count; }
  BL_HD void finish(Index a, const Sum<>& sum) const { count[a] = sum.count; }
};

/// Inelastic collisions of fluid particles within `range` that approach [shakibaeinia12]: along the line of
/// centres e a pair exchanges the impulse (1 + restitution) m_a m_b / (m_a + m_b) |v_ab . e| / n, n being the
/// larger of the numbers of such pairs of a and b, so that simultaneous collisions do not overshoot.
struct CollisionPass {
  Real range2, restitution;  ///< m2, -
  Real guard;                ///< m2, far below the square of any distance
  Span<const VelocityDensity<>> v_rho;
  Span<const Real> mass, count;
  Span<VelocityDensity<>> v_next;

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N mass, count;
    Vec3<N> change;
  };
  BL_HD Sum<> start(Index a) const { return {v_rho[a].v, mass[a], count[a], {}}; }
  BL_HD auto sources() const { return sources_of(v_rho, mass, count); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb, N m, N n) const {
    const N v_r = dot(sum.v - vb.v, r), pairs = max_of(max_of(sum.count, n), N(1));
    const N k = quotient((1 + restitution) * m * v_r, (sum.mass + m) * (r2 + guard) * pairs);
    const N near = select(r2 < N(range2), k, N(0)), there = select(M > N(0), near, N(0));
    sum.change -= select(v_r < N(0), there, N(0)) * r;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.change += other.change; }
  BL_HD void finish(Index a, const Sum<>& sum) const { v_next[a] = {sum.v + sum.change, v_rho[a].rho}; }
};

}  // namespace BL_SOLVER
