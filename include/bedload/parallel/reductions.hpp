#pragma once
// Sums and maxima over a range, and over the ranges of all ranks. They do not depend on how particles are
// divided among ranks, nor on their order, to the last bit: sums are made of whole multiples of a unit far
// below the largest summand.

#include <cmath>
#include <cstdint>
#include <cstring>

#include "bedload/parallel/loops.hpp"
#include "bedload/parallel/ranks.hpp"

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

namespace detail {

/// How many doubles the Value of a reduction is.
template <class F>
constexpr int kDoubles = int(sizeof(typename F::Value) / sizeof(double));

template <class F>
BL_HD double double_of(const typename F::Value& value, int k) {
  static_assert(sizeof(typename F::Value) == kDoubles<F> * sizeof(double));
  double v;
  memcpy(&v, reinterpret_cast<const char*>(&value) + k * sizeof(double), sizeof v);
  return v;
}

/// The largest magnitude of each of the summands of F. What is not a number counts as infinite.
template <class F>
struct LargestOf {
  struct Value {
    double v[kDoubles<F>];
  };
  F f;
  BL_HD Value identity() const {
    Value z;
    for (double& v : z.v) v = 0;
    return z;
  }
  BL_HD Value operator()(Index i) const {
    const typename F::Value value = f(i);
    Value out;
    for (int k = 0; k < kDoubles<F>; ++k) {
      const double v = std::fabs(double_of<F>(value, k));
      out.v[k] = v < 1e300 ? v : 1e300;
    }
    return out;
  }
  BL_HD void combine(Value& into, const Value& from) const { larger(into, from); }
  BL_HD static void larger(Value& into, const Value& from) {
    for (int k = 0; k < kDoubles<F>; ++k) into.v[k] = max_of(into.v[k], from.v[k]);
  }
};

/// Summands of F as whole multiples of a unit, in two parts of 31 bits each, so that no sum of as many as there
/// are particles overflows.
template <class F>
struct WholeParts {
  struct Value {
    std::int64_t high[kDoubles<F>], low[kDoubles<F>];
  };
  static constexpr double kPart = 2147483648.0;  // 2^31
  F f;
  double scale[kDoubles<F>];  ///< a power of two by which summands come below 2^31
  BL_HD Value identity() const {
    Value z;
    for (int k = 0; k < kDoubles<F>; ++k) z.high[k] = z.low[k] = 0;
    return z;
  }
  BL_HD Value operator()(Index i) const {
    const typename F::Value value = f(i);
    Value out;
    for (int k = 0; k < kDoubles<F>; ++k) {
      const double v = double_of<F>(value, k) * scale[k];
      out.high[k] = std::int64_t(v);
      out.low[k] = std::int64_t((v - double(out.high[k])) * kPart);
    }
    return out;
  }
  BL_HD void combine(Value& into, const Value& from) const { add(into, from); }
  BL_HD static void add(Value& into, const Value& from) {
    for (int k = 0; k < kDoubles<F>; ++k) into.high[k] += from.high[k], into.low[k] += from.low[k];
  }
};

}  // namespace detail

/// Sum of f(i) over the range on all ranks: the Value of F is an array of doubles, which combine() adds. Waits
/// for the device. Not a number where a summand is not finite.
template <class F>
typename F::Value total(Range range, const F& f) {
  using Largest = detail::LargestOf<F>;
  using Parts = detail::WholeParts<F>;
  constexpr int n = detail::kDoubles<F>;
  const auto largest = all_reduce(reduce(range, Largest{f}), [](auto& into, const auto& from) { Largest::larger(into, from); });
  Parts parts{f, {}};
  double unit[n];
  for (int k = 0; k < n; ++k) {
    int exponent = 0;
    std::frexp(largest.v[k], &exponent);  // largest < 2^exponent
    exponent = max_of(exponent, -900);    // the scale stays finite
    const bool none = !(largest.v[k] > 0), infinite = largest.v[k] >= 1e300;
    parts.scale[k] = none || infinite ? 0 : std::ldexp(1.0, 31 - exponent);
    unit[k] = none ? 0 : infinite ? std::nan("") : std::ldexp(1.0, exponent - 31);
  }
  const auto sum = all_reduce(reduce(range, parts), [](auto& into, const auto& from) { Parts::add(into, from); });
  double out[n];
  for (int k = 0; k < n; ++k)
    out[k] = (double(sum.low[k]) / Parts::kPart + double(sum.high[k])) * unit[k];
  typename F::Value value = f.identity();
  std::memcpy(static_cast<void*>(&value), out, sizeof value);
  return value;
}

template <int N, class Body>
auto sum_over(Range range, const Body& body) {
  return total(range, SumReduction<N, Body>{body});
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

/// On all ranks; -1e300 where all ranges are empty.
template <class Body>
double max_over(Range range, const Body& body) {
  return all_reduce(reduce(range, MaxReduction<Body>{body}),
                    [](double& into, double from) { into = max_of(into, from); });
}

}  // namespace BL_SOLVER
