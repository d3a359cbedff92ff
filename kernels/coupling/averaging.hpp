#pragma once
// Lengths over which fluid is averaged around grains, as passes over pairs see them: the kernel's own for all
// grains, which costs nothing, or one of each.

#include "bedload/neighbours/for_each_pair.hpp"

namespace BL_SOLVER {

/// How far the fluid is that is averaged around a grain, m.
struct AveragingRange {
  double least = 0, per_radius = 0;  ///< m; -, 0 where all have the least
  BL_HD double operator()(double radius) const { return max_of(least, per_radius * radius); }
};

/// All grains have the kernel's own length.
struct OneAverage {
  /// Of a grain, as the sum of its row holds it.
  template <class N = Real>
  using Own = Unread;
  BL_HD Unread own(Index) const { return {}; }
  BL_HD Unread field() const { return {}; }  ///< what fluid reads of a grain
  template <class Kernel, class N>
  BL_HD N W(const Kernel& w, Unread, N r) const {
    return w.W(r);
  }
};

/// Each has its own: W(r; h) = (h0/h)^3 W0(r h0/h), W0 being the kernel with its length h0.
struct OwnAverages {
  Span<const Real> shrink;  ///< h0 / h of each grain
  template <class N = Real>
  using Own = N;
  BL_HD Real own(Index j) const { return shrink[j]; }
  BL_HD Span<const Real> field() const { return shrink; }
  template <class Kernel, class N>
  BL_HD N W(const Kernel& w, const N& own, N r) const {
    return cube(own) * w.W(r * own);
  }
};

}  // namespace BL_SOLVER
