#pragma once
// What lists of neighbours hold beyond the range of pairs, so that they last while particles move.

#include "bedload/core/pack.hpp"
#include "bedload/core/span.hpp"

namespace BL_SOLVER {

/// How far each particle may go while lists hold, m: beyond the range of its pairs, they have what both may
/// go.
struct HalfSkins {
  Span<const Real> own;  ///< empty where all may go as far
  Real all = 0, most = 0;

  HalfSkins() = default;
  HalfSkins(double all) : all(Real(all)), most(Real(all)) {}
  HalfSkins(Span<const Real> own, double most) : own(own), most(Real(most)) {}
  BL_HD Real operator[](Index i) const { return own ? own[i] : all; }
#if !BL_CUDA
  Pack operator[](PackRun j) const { return own ? Pack(own[j]) : Pack(all); }
#endif
};

}  // namespace BL_SOLVER
