#pragma once
// Several neighbours of a particle at a time on the CPU. What a pass does with a pair is written for a
// number type N: Real, or Pack, which holds kLanes of them.

#include <cstring>
#include <type_traits>

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// yes ? a : b, lane by lane for packs; both are evaluated.
template <class N>
BL_HD N select(bool yes, N a, N b) {
  return yes ? a : b;
}
/// The square root, to 2 ulp; in double on a GPU 0 below 1e-146.
template <class N>
BL_HD N root(N x) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<N, double>) {  // without the branches for what is tiny or vast
    double y;
    asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));  // to 2^-20; each turn doubles the digits
    y = fma(0.5 * y, fma(-x * y, y, 1.0), y);
    y = fma(0.5 * y, fma(-x * y, y, 1.0), y);
    const double guess = x * y;
    const double found = fma(0.5 * y, fma(-guess, guess, x), guess);
    return fabs(x) < 1e-292 ? 0 : found;
  }
#endif
  using std::sqrt;
  return sqrt(x);
}
/// a / b for b that is neither tiny nor vast, to 2 ulp.
template <class N>
BL_HD N quotient(N a, N b) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<N, float>) return __fdividef(a, b);
  if constexpr (std::is_same_v<N, double>) {
    double y;
    asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(b));  // to 2^-20
    y = fma(y, fma(-b, y, 1.0), y);
    y = fma(y, fma(-b, y, 1.0), y);
    const double guess = a * y;
    return fma(y, fma(-b, guess, a), guess);
  }
#endif
  return a / b;
}
/// x, or 0 where that is negative.
template <class N>
BL_HD N positive_part(N x) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<N, float>) return fmaxf(x, 0.0f);
#endif
  return max_of(N(0), x);
}
BL_HD float as_real(std::int32_t i) { return float(i); }
/// a - b, modulo 2^32.
BL_HD std::int32_t wrapped_difference(std::int32_t a, std::int32_t b) {
  return std::int32_t(std::uint32_t(a) - std::uint32_t(b));
}

#if !BL_CUDA
#if defined(__AVX__)
constexpr int kLanes = 32 / sizeof(Real);
#else
constexpr int kLanes = 16 / sizeof(Real);
#endif

struct PackMask {
  using Native [[gnu::vector_size(kLanes * sizeof(Real))]] =
      std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;
  Native v;
};

struct Pack {
  using Native [[gnu::vector_size(kLanes * sizeof(Real))]] = Real;
  Native v{};

  Pack() = default;
  Pack(Real x) : v(x - Native{}) {}
  explicit Pack(Native x) : v(x) {}

  friend Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
  friend Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
  friend Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
  friend Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
  friend Pack operator-(Pack a) { return Pack(-a.v); }
  Pack& operator+=(Pack b) { return *this = *this + b; }
  Pack& operator-=(Pack b) { return *this = *this - b; }
  Pack& operator*=(Pack b) { return *this = *this * b; }
  friend PackMask operator<(Pack a, Pack b) { return {a.v < b.v}; }
  friend PackMask operator>(Pack a, Pack b) { return {a.v > b.v}; }
  friend Pack select(PackMask yes, Pack a, Pack b) { return Pack(yes.v ? a.v : b.v); }
  friend Pack max_of(Pack a, Pack b) { return Pack(a.v > b.v ? a.v : b.v); }
  friend Pack sqrt(Pack a) {
    for (int l = 0; l < kLanes; ++l) a.v[l] = std::sqrt(a.v[l]);
    return a;
  }
  friend Pack rint(Pack a) {
    for (int l = 0; l < kLanes; ++l) a.v[l] = std::rint(a.v[l]);
    return a;
  }
};

/// Coordinates in fixed point.
struct PackInt {
  using Native [[gnu::vector_size(kLanes * sizeof(std::int32_t))]] = std::int32_t;
  using Unsigned [[gnu::vector_size(kLanes * sizeof(std::int32_t))]] = std::uint32_t;
  Native v{};

  PackInt() = default;
  PackInt(std::int32_t x) : v(x - Native{}) {}
  explicit PackInt(Native x) : v(x) {}
  friend PackInt wrapped_difference(PackInt a, PackInt b) {
    return PackInt(Native(Unsigned(a.v) - Unsigned(b.v)));
  }
  friend Pack as_real(PackInt a) { return Pack(__builtin_convertvector(a.v, Pack::Native)); }
};

/// kLanes entries of a list; as an index of a Span it gathers.
struct PackIndex {
  const Index* at;
  Index operator[](int l) const { return at[l]; }
};

/// kLanes entries in a row.
struct PackRun {
  Index first;
  Index operator[](int l) const { return first + Index(l); }
};

template <class J>
[[gnu::always_inline]] inline Pack gather(const Real* p, J j) {
  Pack out;
  for (int l = 0; l < kLanes; ++l) out.v[l] = p[j[l]];
  return out;
}
template <class J>
[[gnu::always_inline]] inline Vec3<Pack> gather(const Real3* p, J j) {
  Vec3<Pack> out;
  for (int l = 0; l < kLanes; ++l) {
    const Real3& a = p[j[l]];
    out.x.v[l] = a.x, out.y.v[l] = a.y, out.z.v[l] = a.z;
  }
  return out;
}
template <class J>
[[gnu::always_inline]] inline Vec4<Pack> gather(const Real4* p, J j) {
  Vec4<Pack> out;
  if constexpr (sizeof(Real) == 4 && kLanes == 8) {
    // rows of four, two to a register, transposed
    using Row [[gnu::vector_size(16)]] = float;
    using Rows = Pack::Native;
    const auto row = [&](int l) {
      Row out;
      std::memcpy(&out, p + j[l], sizeof(Row));
      return out;
    };
    const auto rows = [&](int l) -> Rows {
      return __builtin_shufflevector(row(l), row(l + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    };
    const auto a = rows(0), b = rows(1), c = rows(2), d = rows(3);
    const auto ab_low = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const auto ab_high = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const auto cd_low = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const auto cd_high = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    out.x.v = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
    out.y.v = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
    out.z.v = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
    out.w.v = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
  } else {
    for (int l = 0; l < kLanes; ++l) {
      Real4 a;
      std::memcpy(static_cast<void*>(&a), p + j[l], sizeof(Real4));
      out.x.v[l] = a.x, out.y.v[l] = a.y, out.z.v[l] = a.z, out.w.v[l] = a.w;
    }
  }
  return out;
}
#endif

}  // namespace BL_SOLVER
