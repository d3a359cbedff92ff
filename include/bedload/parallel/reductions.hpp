#pragma once
// Sums and maxima over a range, and over the ranges of all ranks. They do not depend on how particles are
// divided among ranks, nor on their order, to the last bit: sums are made of whole multiples of a unit far
// below the largest summand.

#include <array>
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

/// The unit by which summands up to `most` are whole numbers below 2^31, and its inverse: powers of two.
struct SumUnit {
  double scale, unit;
  explicit SumUnit(double most) {
    int exponent = 0;
    std::frexp(most, &exponent);           // most < 2^exponent
    exponent = max_of(exponent, -900);     // the scale stays finite
    const bool none = !(most > 0), infinite = most >= 1e300;
    scale = none || infinite ? 0 : std::ldexp(1.0, 31 - exponent);
    unit = none ? 0 : infinite ? std::nan("") : std::ldexp(1.0, exponent - 31);
  }
};

/// What the parts of a sum come to.
template <class F>
struct WholeValue {
  using Parts = typename WholeParts<F>::Value;
  double unit[kDoubles<F>];
  BL_HD typename F::Value operator()(const Parts& sum, typename F::Value value) const {
    for (int k = 0; k < kDoubles<F>; ++k) {
      const double v = (double(sum.low[k]) / WholeParts<F>::kPart + double(sum.high[k])) * unit[k];
      memcpy(reinterpret_cast<char*>(&value) + k * sizeof(double), &v, sizeof v);
    }
    return value;
  }
};

template <class F>
struct WholeValuePass {
  WholeValue<F> value;
  F f;
  const typename WholeParts<F>::Value* sum;
  typename F::Value* out;
  BL_HD void operator()(Index) const { *out = value(*sum, f.identity()); }
};

}  // namespace detail

/// As `total`, into device memory, with a bound for each of the summands; what is below 2^-62 of that is lost.
/// Waits for the device only where there are other ranks.
template <class F>
void total_into(typename F::Value* out, Range range, const F& f,
                const std::array<double, std::size_t(detail::kDoubles<F>)>& largest) {
  using Parts = detail::WholeParts<F>;
  Parts parts{f, {}};
  detail::WholeValue<F> value;
  for (int k = 0; k < detail::kDoubles<F>; ++k) {
    const detail::SumUnit unit(largest[std::size_t(k)]);
    parts.scale[k] = unit.scale, value.unit[k] = unit.unit;
  }
  if (Context::current().several()) {
    const auto sum = all_reduce(reduce(range, parts),
                                [](auto& into, const auto& from) { Parts::add(into, from); });
    const typename F::Value all = value(sum, f.identity());
    copy_to_device(out, &all, sizeof all);
  } else if (range.size() == 0) {
    const typename F::Value none = f.identity();
    copy_to_device(out, &none, sizeof none);
  } else {
    for_each({0, 1}, detail::WholeValuePass<F>{value, f, detail::reduce_there(range, parts), out});
  }
}

/// Sum of f(i) over the range on all ranks: the Value of F is an array of doubles, which combine() adds. Waits
/// for the device. Not a number where a summand is not finite.
template <class F>
typename F::Value total(Range range, const F& f) {
  using Largest = detail::LargestOf<F>;
  using Parts = detail::WholeParts<F>;
  const auto largest = all_reduce(reduce(range, Largest{f}), [](auto& into, const auto& from) { Largest::larger(into, from); });
  Parts parts{f, {}};
  detail::WholeValue<F> value;
  for (int k = 0; k < detail::kDoubles<F>; ++k) {
    const detail::SumUnit unit(largest.v[k]);
    parts.scale[k] = unit.scale, value.unit[k] = unit.unit;
  }
  const auto sum =
      all_reduce(reduce(range, parts), [](auto& into, const auto& from) { Parts::add(into, from); });
  return value(sum, f.identity());
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
