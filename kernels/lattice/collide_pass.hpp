#pragma once
#include <cstdint>

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

/// Density and velocity of a node, in units of the lattice.
struct NodeState {
  Real excess;  ///< density less 1
  Real3 u;
  BL_HD Real rho() const { return 1 + excess; }
};

/// Even part of the equilibrium of velocity i, less its weight; the odd part is 3 w_i rho c_i u.
BL_HD Real even_equilibrium(Real weight, const NodeState& s, Real cu) {
  return weight * (s.excess + s.rho() * (Real(4.5) * cu * cu - Real(1.5) * norm2(s.u)));
}

/// One step of all fluid nodes: populations arrive, relax towards equilibrium with two rates, under a force
/// per volume by [guo02], and leave.
struct CollidePass {
  Populations f;
  Relaxation rate;
  Real3 force;  ///< per volume, in units of the lattice
  Span<const std::uint32_t> solid;

  BL_HD void operator()(Index node) const {
    if (solid[node] != 0) return;
    const NodeGrid::Place here = f.grid.place(node);
    Index beyond[kPairs];
    Real a[kPairs], b[kPairs], rest = f.at(0, node);  // odd and even velocity of each pair
    NodeState s{rest, Real(0.5) * force};
    each_pair([&](auto p) {
      beyond[p] = f.grid.neighbour(here, p);
      a[p] = f.near(p, node);
      b[p] = f.far(p, beyond[p]);
      s.excess += a[p] + b[p];
      s.u += (a[p] - b[p]) * along(p);
    });
    s.u *= 1 / s.rho();

    const Real push = dot(s.u, force), even_source = 1 - Real(0.5) * rate.even,
               odd_source = 3 * (1 - Real(0.5) * rate.odd);
    const Real w0 = Real(weight(0));
    f.at(0, node) = rest - rate.even * (rest - even_equilibrium(w0, s, 0)) - even_source * w0 * 3 * push;
    each_pair([&](auto p) {
      const Real w = Real(weight(2 * p + 1)), cu = dot(along(p), s.u), cf = dot(along(p), force);
      const Real even = Real(0.5) * (a[p] + b[p]), odd = Real(0.5) * (a[p] - b[p]);
      const Real to_even =
          even_source * w * (9 * cu * cf - 3 * push) - rate.even * (even - even_equilibrium(w, s, cu));
      const Real to_odd = odd_source * w * cf - rate.odd * (odd - 3 * w * s.rho() * cu);
      f.far(p, beyond[p]) = a[p] + to_even + to_odd;
      f.near(p, node) = b[p] + to_even - to_odd;
    });
  }

 private:
  BL_HD static constexpr Real3 along(int pair) { return velocity_of<Real>(2 * pair + 1); }
};

}  // namespace BL_SOLVER::lattice
