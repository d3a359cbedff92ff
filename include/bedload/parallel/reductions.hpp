#pragma once
// Sums and maxima over a range. All sums in fp64.

#include "bedload/parallel/loops.hpp"

namespace BL_SOLVER {

/// Sum of N doubles: Body(i, double out[N]) fills one particle's part.
template <int N, class Body>
struct SumReduction {
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
  return reduce(range, SumReduction<N, Body>{body});
}

/// Largest Body(i).
template <class Body>
struct MaxReduction {
  using Value = double;
  Body body;
  BL_HD double identity() const { return -1e300; }
  BL_HD double operator()(Index i) const { return body(i); }
  BL_HD void combine(double& into, double from) const { into = max_of(into, from); }
};

template <class Body>
double max_over(Range range, const Body& body) {
  return reduce(range, MaxReduction<Body>{body});
}

}  // namespace BL_SOLVER
