#pragma once
// Reductions over stores for diagnostics and probes. All sums in fp64.

#include "bedload/parallel/loops.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"

namespace bedload::inline BL_VARIANT {

/// Pressure from the pair-loop record of fluid or walls, Pa.
BL_HD Real pressure_of(const Real4& m_state) { return m_state.y * square(m_state.z); }

/// Sum of N doubles: Body(i, double out[N]) fills one particle's part.
template <int N, class Body>
struct SumSweep {
  struct Value {
    double v[N];
  };
  Body body;
  BL_HD Value identity() const {
    Value z;
    for (int k = 0; k < N; ++k) z.v[k] = 0;
    return z;
  }
  BL_HD Value operator()(Index i) const {
    Value out = identity();
    body(i, out.v);
    return out;
  }
  BL_HD void combine(Value& into, const Value& from) const {
    for (int k = 0; k < N; ++k) into.v[k] += from.v[k];
  }
};

template <int N, class Body>
auto sum_over(Range range, const Body& body) {
  return reduce(range, SumSweep<N, Body>{body});
}

/// Largest Body(i).
template <class Body>
struct MaxSweep {
  using Value = double;
  Body body;
  BL_HD double identity() const { return -1e300; }
  BL_HD double operator()(Index i) const { return body(i); }
  BL_HD void combine(double& into, double from) const { into = max_of(into, from); }
};

template <class Body>
double max_over(Range range, const Body& body) {
  return reduce(range, MaxSweep<Body>{body});
}

/// Coordinate along a direction, m.
template <class P>
struct AlongBody {
  Frame frame;
  Span<const P> x;
  Vec3d direction;
  BL_HD double operator()(Index i) const { return dot(direction, coordinates(frame, x[i])); }
};

}  // namespace bedload::inline BL_VARIANT
