#pragma once
// Smoothing lengths as passes over pairs see them: that of the kernel for all particles, which costs nothing,
// or one of each particle.

#include "bedload/neighbours/for_each_pair.hpp"

namespace BL_SOLVER {

/// F of a pair of particles with variable smoothing lengths.
template <class N>
struct PairFactors {
  N a, b;    ///< at h_a and at h_b, 1/m5
  N length;  ///< mean of h_a and h_b over the kernel's own length
};

/// What terms take that have no side: F, or the mean of both [harting14] Eqs. 8, 9.
template <class N>
BL_HD N mean_factor(N F) {
  return F;
}
template <class N>
BL_HD N mean_factor(const PairFactors<N>& F) {
  return Real(0.5) * (F.a + F.b);
}
/// F of the row's particle.
template <class N>
BL_HD N own_factor(N F) {
  return F;
}
template <class N>
BL_HD N own_factor(const PairFactors<N>& F) {
  return F.a;
}
/// Smoothing length of the pair over the kernel's own.
template <class N>
BL_HD Real pair_length(N) {
  return 1;
}
template <class N>
BL_HD N pair_length(const PairFactors<N>& F) {
  return F.length;
}

/// All particles have the kernel's own smoothing length.
struct OneLength {
  static constexpr bool vary = false;
  /// Of a particle, as a row's sum holds it.
  template <class N = Real>
  struct Own {};

  template <class N>
  BL_HD Own<N> own(Index) const {
    return {};
  }
  template <class N>
  BL_HD Own<N> own_of() const {
    return {};
  }
  BL_HD Real ratio(Index) const { return 1; }  ///< h_a over the kernel's own
  BL_HD Real corrected(Index, Real x) const { return x; }
  BL_HD Unread corrections() const { return {}; }
  BL_HD Real corrected_by(Unread, Real x) const { return x; }
  template <class... Field>
  BL_HD auto sources(Field... fields) const {
    return sources_of(fields...);
  }
  template <class Kernel, class N>
  BL_HD N W(const Kernel& w, const Own<N>&, N r) const {
    return w.W(r);
  }
  template <class Kernel, class N>
  BL_HD N F(const Kernel& w, const Own<N>&, N r) const {
    return w.F(r);
  }
};

/// Each has its own: W(r; h) = (h0/h)^d W0(r h0/h) in d dimensions, W0 being the kernel with its length h0,
/// and F(r; h) = (h0/h)^(d+2) F0(r h0/h). Walls have that of the fluid that they meet.
struct OwnLengths {
  static constexpr bool vary = true;
  Span<const Real> h, omega;  ///< m; that of OmegaPass
  Real h0;                    ///< m
  bool plane;                 ///< two dimensions

  template <class N = Real>
  struct Own {
    N shrink;  ///< h0 / h_a
  };

  template <class N>
  BL_HD Own<N> own(Index a) const {
    return own_of<N>(h[a]);
  }
  /// Of a neighbour, by what `sources` adds to its fields.
  template <class N>
  BL_HD Own<N> own_of(const N& h_b) const {
    return {quotient(N(h0), h_b)};
  }
  BL_HD Real ratio(Index a) const { return h[a] / h0; }
  BL_HD Real corrected(Index a, Real x) const { return corrected_by(omega[a], x); }
  /// What a pass reads to correct something of a neighbour.
  BL_HD Span<const Real> corrections() const { return omega; }
  BL_HD Real corrected_by(Real omega_b, Real x) const { return x / omega_b; }
  template <class... Field>
  BL_HD auto sources(Field... fields) const {
    return sources_of(fields..., h);
  }
  template <class Kernel, class N>
  BL_HD N W(const Kernel& w, const Own<N>& own, N r) const {
    return volume(own.shrink) * w.W(r * own.shrink);
  }
  /// With b of the same length.
  template <class Kernel, class N>
  BL_HD PairFactors<N> F(const Kernel& w, const Own<N>& own, N r) const {
    const N F = factor(w, own.shrink, r);
    return {F, F, quotient(N(1), own.shrink)};
  }
  template <class Kernel, class N>
  BL_HD PairFactors<N> F(const Kernel& w, const Own<N>& own, N r, N h_b) const {
    const N shrink = quotient(N(h0), h_b);
    return {factor(w, own.shrink, r), factor(w, shrink, r),
            Real(0.5) * (quotient(N(1), own.shrink) + h_b / h0)};
  }

 private:
  template <class N>
  BL_HD N volume(N shrink) const {
    const N square = shrink * shrink;
    return plane ? square : square * shrink;
  }
  template <class Kernel, class N>
  BL_HD N factor(const Kernel& w, N shrink, N r) const {
    return volume(shrink) * shrink * shrink * w.F(r * shrink);
  }
};

}  // namespace BL_SOLVER
