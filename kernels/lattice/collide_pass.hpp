#pragma once
#include <cstdint>

#include "bedload/core/pack.hpp"
#include "bedload/core/span.hpp"
#include "bedload/lattice/populations.hpp"

namespace BL_SOLVER::lattice {

/// Rates at which the even and odd parts of the populations relax, per step. The even one sets the viscosity,
/// nu = c_s^2 (1 / even - 1/2); the product of (1 / rate - 1/2) of both, the magic number, where walls lie
/// [ginzburg08].
struct Relaxation {
  Real even = 1, odd = 1;

  static Relaxation of(double tau, double magic) {
    return {Real(1 / tau), Real(1 / (0.5 + magic / (tau - 0.5)))};
  }
};

/// Density and velocity of a node, or of several in a row, in units of the lattice.
template <class N>
struct NodeStateOf {
  N excess;  ///< density less 1
  Vec3<N> u;
  BL_HD N rho() const { return 1 + excess; }
};
using NodeState = NodeStateOf<Real>;

/// Even part of the equilibrium of velocity i, less its weight; the odd part is 3 w_i rho c_i u.
template <class N>
BL_HD N even_equilibrium(Real weight, const NodeStateOf<N>& s, N cu) {
  return weight * (s.excess + s.rho() * (Real(4.5) * cu * cu - Real(1.5) * norm2(s.u)));
}

/// Of a vector, along the odd velocity of a pair: its sums and differences alone.
template <int pair, class N>
BL_HD N along(const Vec3<N>& v) {
  constexpr int x = step(pair, 0), y = step(pair, 1), z = step(pair, 2);
  static_assert(x >= 0 && (x > 0 || y >= 0));
  if constexpr (x == 0 && y == 0) return v.z;
  if constexpr (x == 0 && z == 0) return v.y;
  if constexpr (y == 0 && z == 0) return v.x;
  if constexpr (z == 0) return y > 0 ? v.x + v.y : v.x - v.y;
  if constexpr (y == 0) return z > 0 ? v.x + v.z : v.x - v.z;
  if constexpr (x == 0) return z > 0 ? v.y + v.z : v.y - v.z;
}
/// Adds a multiple of that velocity.
template <int pair, class N>
BL_HD void add_along(Vec3<N>& v, N times) {
  if constexpr (step(pair, 0) > 0) v.x += times;
  if constexpr (step(pair, 1) > 0) v.y += times;
  if constexpr (step(pair, 1) < 0) v.y -= times;
  if constexpr (step(pair, 2) > 0) v.z += times;
  if constexpr (step(pair, 2) < 0) v.z -= times;
}

/// From here on a GPU finds addresses from i anew, rather than keep them: registers decide how many threads
/// wait for memory at a time.
BL_HD void find_anew([[maybe_unused]] Index& i) {
#if defined(__CUDA_ARCH__)
  asm volatile("" : "+r"(i));
#endif
}

/// One step of all fluid nodes: populations arrive, relax towards equilibrium with two rates, under a force
/// per volume by [guo02], and leave.
struct CollidePass {
  Populations f;
  Relaxation rate;
  Real3 force;  ///< per volume, in units of the lattice
  Span<const std::uint32_t> solid;
  Populations::Arrays arrays = f.arrays();

  BL_HD void operator()(Index node) const {
    if (solid[node] != 0) return;
    Index beyond[kPairs];
    const NodeGrid::Place here = f.grid.place(node);
    each_pair([&](auto p) { beyond[p] = f.grid.neighbour(here, p); });
    collide<Real>(node, beyond);
  }
#if !BL_CUDA
  /// Of all nodes with one y and z: several at a time where all of them are fluid, but for the last of the
  /// row, which may have a neighbour at its begin.
  void row(Index number) const {
    const Index n = f.grid.n[0], begin = number * n;
    const NodeGrid::Place first{{0, number % f.grid.n[1], number / f.grid.n[1]}};
    Index beyond_first[kPairs], beyond[kPairs];
    each_pair([&](auto p) { beyond_first[p] = f.grid.neighbour(first, p); });
    for (Index x = 0; x < n;) {
      const std::uint32_t* const here = &solid[begin + x];
      const bool inside = x + kLanes < n;
      std::uint32_t any = here[0];
      for (int l = 1; l < kLanes && inside; ++l) any |= here[l];
      if (inside && any == 0) {
        each_pair([&](auto p) { beyond[p] = beyond_first[p] + x; });
        collide<Pack>(begin + x, beyond);
        x += kLanes;
      } else {
        (*this)(begin + x);
        ++x;
      }
    }
  }
#endif

 private:
  /// A node, or as many in a row as N has numbers; beyond: what the odd velocity of each pair reaches.
  template <class N>
  BL_HD void collide(Index node, Index (&beyond)[kPairs]) const {
    N a[kPairs], b[kPairs];  // odd and even velocity of each pair
    const N rest = from<N>(arrays.rest + node);
    NodeStateOf<N> s{rest, Vec3<N>(N(Real(0.5) * force.x), N(Real(0.5) * force.y), N(Real(0.5) * force.z))};
    each_pair([&](auto p) {
      a[p] = from<N>(arrays.near[p] + node);
      b[p] = from<N>(arrays.far[p] + beyond[p]);
      s.excess += a[p] + b[p];
      add_along<p>(s.u, a[p] - b[p]);
    });
    s.u *= 1 / s.rho();

    find_anew(node);
    each_pair([&](auto p) { find_anew(beyond[p]); });
    const Real even_source = 1 - Real(0.5) * rate.even, odd_source = 3 * (1 - Real(0.5) * rate.odd);
    const N rho = s.rho(), push = s.u.x * N(force.x) + s.u.y * N(force.y) + s.u.z * N(force.z);
    // The even equilibrium of even_equilibrium(), over the weight, where c u = 0.
    const N across = s.excess - Real(1.5) * rho * norm2(s.u), source = 3 * even_source * push;
    const Real w0 = Real(weight(0));
    to(arrays.rest + node, rest - rate.even * (rest - w0 * across) - w0 * source);
    each_pair([&](auto p) {
      constexpr Real w = Real(weight(2 * p + 1));
      const N cu = along<p>(s.u);
      const Real cf = along<p>(force);
      const N even = Real(0.5) * (a[p] + b[p]), odd = Real(0.5) * (a[p] - b[p]);
      const N to_even = w * (9 * even_source * cf * cu - source) -
                        rate.even * (even - w * (across + Real(4.5) * rho * cu * cu));
      const N to_odd = w * odd_source * cf - rate.odd * (odd - 3 * w * rho * cu);
      to(arrays.far[p] + beyond[p], a[p] + to_even + to_odd);
      to(arrays.near[p] + node, b[p] + to_even - to_odd);
    });
  }
  template <class N>
  BL_HD static N from(const Real* place) {
    if constexpr (std::is_same_v<N, Real>) {
      return *place;
    } else {
      N value;
      std::memcpy(&value.v, place, sizeof value.v);
      return value;
    }
  }
  template <class N>
  BL_HD static void to(Real* place, const N& value) {
    if constexpr (std::is_same_v<N, Real>)
      *place = value;
    else
      std::memcpy(place, &value.v, sizeof value.v);
  }
};

}  // namespace BL_SOLVER::lattice
