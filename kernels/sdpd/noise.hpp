#pragma once
// Random numbers of pairs: standard normal, the same for both partners, whatever asks for them.

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "bedload/core/pack.hpp"
#include "kernels/sdpd/philox.hpp"

namespace BL_SOLVER {

// Sums of products are rounded once, and nothing else is left to the compiler, so that every build and device
// makes the same bits.
BL_HD float fused(float a, float b, float c) {
#if defined(__CUDA_ARCH__)
  return __fmaf_rn(a, b, c);
#else
  return __builtin_fmaf(a, b, c);
#endif
}
BL_HD float exact_root(float a) {
#if defined(__CUDA_ARCH__)
  return __fsqrt_rn(a);
#else
  return __builtin_sqrtf(a);
#endif
}
BL_HD float product(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fmul_rn(a, b);
#else
  return a * b;
#endif
}

/// ln u for u in (0, 1], to 2 ulp [moshier89].
BL_HD float logarithm(float u) {
  const std::int32_t bits = std::bit_cast<std::int32_t>(u) - 0x3f3504f3;  // against sqrt(1/2)
  const float e = float(bits >> 23), f = std::bit_cast<float>((bits & 0x7fffff) + 0x3f3504f3) - 1.0f;
  const float z = product(f, f);
  float p = fused(7.0376836292e-2f, f, -1.1514610310e-1f);
  p = fused(p, f, 1.1676998740e-1f);
  p = fused(p, f, -1.2420140846e-1f);
  p = fused(p, f, 1.4249322787e-1f);
  p = fused(p, f, -1.6668057665e-1f);
  p = fused(p, f, 2.0000714765e-1f);
  p = fused(p, f, -2.4999993993e-1f);
  p = fused(p, f, 3.3333331174e-1f);
  float y = fused(product(p, f), z, product(e, -2.12194440e-4f));
  y = fused(-0.5f, z, y);
  return fused(e, 0.693359375f, f + y);
}

struct Normals {
  float a, b;
};

/// Two independent standard normal deviates of two random words, by Box and Muller's transformation; none
/// exceeds 6.8.
BL_HD Normals normals(std::uint32_t radial, std::uint32_t angular) {
  const float u = fused(float(radial), 0x1p-32f, 0x1p-33f);
  const float radius = exact_root(-2 * logarithm(u));
  const std::uint32_t quarter = (angular + 0x20000000u) >> 30;
  const float x = product(float(std::int32_t(angular - (quarter << 30))), 0x1.921fb6p-30f);  // -pi/4..pi/4
  const float z = product(x, x);
  float s = fused(-1.9515295891e-4f, z, 8.3321608736e-3f);
  s = fused(s, z, -1.6666654611e-1f);
  s = fused(product(s, z), x, x);
  float c = fused(2.443315711809948e-5f, z, -1.388731625493765e-3f);
  c = fused(c, z, 4.166664568298827e-2f);
  c = fused(c, product(z, z), fused(-0.5f, z, 1.0f));
  const float turned_c = quarter & 1 ? s : c, turned_s = quarter & 1 ? c : s;
  return {product(radius, (quarter + 1) & 2 ? -turned_c : turned_c),
          product(radius, quarter & 2 ? -turned_s : turned_s)};
}

/// What the noise of one step depends on besides the ids of a pair.
struct NoiseKey {
  std::uint64_t seed = 0, step = 0;

  BL_HD Words words(Id a, Id b, std::uint32_t draw) const {
    const Words counter{a < b ? a : b, a < b ? b : a, std::uint32_t(step),
                        std::uint32_t(step >> 32) ^ draw << 24};
    return philox(counter, std::uint32_t(seed), std::uint32_t(seed >> 32));
  }
};

/// Three normal deviates of a pair; odd: what one partner has is minus what the other has.
BL_HD Vec3f odd_normals(const NoiseKey& key, Id a, Id b) {
  const Words w = key.words(a, b, 0);
  const Normals xy = normals(w.x, w.y), z = normals(w.z, w.w);
  return a < b ? Vec3f{xy.a, xy.b, z.a} : Vec3f{-xy.a, -xy.b, -z.a};
}

/// Symmetric matrix of a pair.
template <class N>
struct Symmetric {
  N xx, yy, zz, xy, yz, zx;
};
/// Symmetric part of a matrix of nine normal deviates; the same for both partners.
BL_HD Symmetric<float> even_normals(const NoiseKey& key, Id a, Id b) {
  const Words v = key.words(a, b, 0), w = key.words(a, b, 1), u = key.words(a, b, 2);
  const Normals one = normals(v.x, v.y), two = normals(v.z, v.w), three = normals(w.x, w.y),
                four = normals(w.z, w.w), five = normals(u.x, u.y);
  return {one.a, one.b, two.a, 0.5f * (two.b + three.a), 0.5f * (three.b + four.a), 0.5f * (four.b + five.a)};
}

/// An id as a number that pair loops carry like any other, and back.
template <class N = Real>
BL_HD N as_label(Id id) {
  if constexpr (sizeof(N) == sizeof(Id))
    return std::bit_cast<N>(id);
  else
    return N(id);
}
template <class N>
BL_HD Id as_id(N label) {
  if constexpr (sizeof(N) == sizeof(Id))
    return std::bit_cast<Id>(label);
  else
    return Id(label);
}

/// The id of a row in two halves, each exact in any Real: sums of rows are copied as numbers, which bits of
/// an id may not survive.
template <class N>
struct RowId {
  N low, high;
};
BL_HD RowId<Real> row_id(Id id) { return {Real(id & 0xffff), Real(id >> 16)}; }
BL_HD Id as_id(const RowId<Real>& row) { return Id(row.low) | Id(row.high) << 16; }

BL_HD Real3 odd_normals(const NoiseKey& key, const RowId<Real>& a, Real b) {
  const Vec3f chi = odd_normals(key, as_id(a), as_id(b));
  return {chi.x, chi.y, chi.z};
}
BL_HD Symmetric<Real> even_normals(const NoiseKey& key, const RowId<Real>& a, Real b) {
  const Symmetric<float> s = even_normals(key, as_id(a), as_id(b));
  return {s.xx, s.yy, s.zz, s.xy, s.yz, s.zx};
}
#if !BL_CUDA
/// The same for the neighbours of a pack.
inline Vec3<Pack> odd_normals(const NoiseKey& key, const RowId<Pack>& a, Pack b) {
  const Id row = as_id(RowId<Real>{a.low.v[0], a.high.v[0]});
  Real label[kLanes], out[3][kLanes];
  std::memcpy(label, &b, sizeof label);
  for (int l = 0; l < kLanes; ++l) {
    const Vec3f chi = odd_normals(key, row, as_id(label[l]));
    out[0][l] = chi.x, out[1][l] = chi.y, out[2][l] = chi.z;
  }
  Vec3<Pack> chi;
  std::memcpy(&chi, out, sizeof out);
  return chi;
}
inline Symmetric<Pack> even_normals(const NoiseKey& key, const RowId<Pack>& a, Pack b) {
  const Id row = as_id(RowId<Real>{a.low.v[0], a.high.v[0]});
  Symmetric<Pack> out;
  for (int l = 0; l < kLanes; ++l) {
    const Symmetric<float> s = even_normals(key, row, as_id(b.v[l]));
    out.xx.v[l] = s.xx, out.yy.v[l] = s.yy, out.zz.v[l] = s.zz;
    out.xy.v[l] = s.xy, out.yz.v[l] = s.yz, out.zx.v[l] = s.zx;
  }
  return out;
}
#endif

}  // namespace BL_SOLVER
