#pragma once
#include "kernels/smoothing/lengths.hpp"

namespace BL_SOLVER {

constexpr Real kLengthGrowth = Real(1.04);  ///< of a smoothing length, before lists must be renewed

/// h_a = sigma (M_a / rho_a)^(1/d), the d-th root of the particle's volume, within bounds; [harting14]
/// section 3.1, where M_a / rho_a = m_a / (eps_a rho_a).
struct LengthPass {
  Real sigma, least, most;  ///< -, m, m
  Real thickness;           ///< of a plane flow, m; 0: three dimensions
  Real rho0;                ///< kg/m3
  bool first;               ///< particles have a mass alone
  bool renew;               ///< lists are to be made; else they bound how far lengths may grow
  Span<const Real> mass;
  Span<const EosState<>> eos_state;
  Span<const Real> listed;
  Span<Real> h, omega;

  BL_HD void operator()(Index a) const {
    const EosState<> m = eos_state[a];
    const Real volume = first ? mass[a] / rho0 : m.mass_over_eps / m.rho;
    const Real root = thickness > 0 ? std::sqrt(volume / thickness) : std::cbrt(volume);
    const Real length = clamp(sigma * root, least, most);
    if (!renew) {
      h[a] = min_of(length, kLengthGrowth * listed[a]);
      return;
    }
    h[a] = length;
    if (first || !(omega[a] > 0)) omega[a] = 1;  // until forces are next evaluated
  }
};

/// What the change of h with density adds to its rate [harting14] Eq. 7, [price12],
///   Omega_a = 1 + h_a / (d rho_a) sum_b M_b dW_ab/dh_a,    dW/dh = (r^2 F - d W) / h,
/// with b = a, and walls at rho0. One where h_a stands at a bound and does not change. Leaves P / (Omega
/// rho^2) for pairs.
template <class Kernel>
struct OmegaPass {
  Kernel w;
  OwnLengths lengths;
  Real least, most;  ///< of h, m
  Real rho0;
  Span<const EosState<>> eos_state;
  Span<const WallState<>> wall_state;
  Span<Real> omega, p_rho2;

  template <class N = Real>
  struct Sum {
    OwnLengths::Own<N> own;
    N change;  ///< sum of M h dW/dh, kg/m3
  };
  BL_HD Sum<> start(Index a) const { return {lengths.template own<Real>(a), 0}; }
  BL_HD auto sources() const { return sources_of(); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N M) const {
    const N r = root(r2);
    sum.change += M * (r2 * own_factor(lengths.F(w, sum.own, r)) - dimensions() * lengths.W(w, sum.own, r));
  }
  BL_HD auto wall_sources() const { return sources_of(wall_state); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const WallState<N>& m) const {
    pair(sum, r, r2, rho0 * quotient(m.mass, m.rho));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.change += other.change; }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const EosState<> m = eos_state[a];
    const Real h = lengths.h[a], self = dimensions() * m.mass_over_eps * lengths.W(w, sum.own, Real(0));
    const bool follows = h > least && h < most;
    omega[a] = follows ? 1 + (sum.change - self) / (dimensions() * m.rho) : Real(1);
    p_rho2[a] = m.p_over_rho2 / omega[a];
  }

 private:
  BL_HD Real dimensions() const { return lengths.plane ? Real(2) : Real(3); }
};

}  // namespace BL_SOLVER
