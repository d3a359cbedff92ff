#pragma once
// Where things are. Positions are kept in double precision, in `single` packed: the domain is cut into 1024 x
// 1024 x 1024 frame cells, and a packed position is an fp32 offset from the corner of such a cell. Pair loops
// of fp32 read a copy in fixed point.

#include <bit>
#include <type_traits>

#include "bedload/core/pack.hpp"

namespace BL_SOLVER {

struct alignas(16) PackedPosition {
  float x = 0, y = 0, z = 0;
  std::uint32_t cell = 0;  ///< 10 bits an axis
};

/// Of a packed position, less than this part of the domain's length.
constexpr double kPackedRounding = 0x1p-33;

/// In quanta of the frame from the middle of the domain. The difference of two wraps as its integers do: on a
/// periodic axis, whose period is 2^32 quanta, it is that of the nearest images.
struct alignas(16) FixedPosition {
  std::int32_t x = 0, y = 0, z = 0;
  float weight = 0;  ///< what most pair loops read with it; of fluid M = mass / porosity, kg
};
struct alignas(16) PlainPosition {
  double x = 0, y = 0, z = 0, weight = 0;
};

/// Positions as pair loops read them.
using PairPosition = std::conditional_t<std::is_same_v<Real, double>, PlainPosition, FixedPosition>;

#if !BL_CUDA
struct FixedPositions {
  PackInt x, y, z;
  Pack weight;
};
template <class J>
[[gnu::always_inline]] inline FixedPositions gather(const FixedPosition* p, J j) {
  const auto rows = gather(reinterpret_cast<const Real4*>(p), j);  // integers travel as floats
  const auto integers = [](const auto& of) { return PackInt(std::bit_cast<PackInt::Native>(of.v)); };
  return {integers(rows.x), integers(rows.y), integers(rows.z), rows.w};
}
struct PlainPositions {
  Pack x, y, z, weight;
};
template <class J>
[[gnu::always_inline]] inline PlainPositions gather(const PlainPosition* p, J j) {
  const auto rows = gather(reinterpret_cast<const Real4*>(p), j);
  return {rows.x, rows.y, rows.z, rows.w};
}
#endif

struct Frame {
  Vec3d origin, length;  ///< m; length is the period on periodic axes
  Vec3d cell;            ///< length / 1024
  Vec3f quantum;         ///< of fixed positions, m
  Vec3d quanta;          ///< 1/m
  bool periodic[3] = {false, false, false};

  Frame() = default;
  /// Places are distinguished up to `beyond` (m; 0: the longest side) outside sides that are not periodic, in
  /// pair loops of fp32: any farther ones count as there. The closer, the finer is the quantum, 2^-31 of the
  /// length with what is beyond at either end.
  Frame(const Vec3d& min, const Vec3d& max, bool px, bool py, bool pz, double beyond = 0)
      : origin(min), length(max - min), cell((max - min) * (1.0 / 1024)), periodic{px, py, pz} {
    if (beyond == 0) beyond = max_of(length.x, max_of(length.y, length.z));
    for (int k = 0; k < 3; ++k) {
      quanta[k] = 4294967296.0 / (periodic[k] ? length[k] : 2 * (length[k] + 2 * beyond));
      quantum[k] = float(1 / quanta[k]);
    }
  }

  BL_HD PackedPosition pack(const Vec3d& x) const {
    PackedPosition p;
    const Vec3d r = x - origin;
    const int ix = clamp(int(floor(r.x / cell.x)), 0, 1023);
    const int iy = clamp(int(floor(r.y / cell.y)), 0, 1023);
    const int iz = clamp(int(floor(r.z / cell.z)), 0, 1023);
    p.x = float(r.x - ix * cell.x);
    p.y = float(r.y - iy * cell.y);
    p.z = float(r.z - iz * cell.z);
    p.cell = std::uint32_t(ix) | std::uint32_t(iy) << 10 | std::uint32_t(iz) << 20;
    return p;
  }
  BL_HD Vec3d unpack(const PackedPosition& p) const {
    return {origin.x + (p.cell & 1023) * cell.x + p.x, origin.y + (p.cell >> 10 & 1023) * cell.y + p.y,
            origin.z + (p.cell >> 20 & 1023) * cell.z + p.z};
  }
  BL_HD FixedPosition fixed(const Vec3d& x) const {
    const Vec3d u = x - origin - 0.5 * length;
    return {fixed(u.x * quanta.x, periodic[0]), fixed(u.y * quanta.y, periodic[1]),
            fixed(u.z * quanta.z, periodic[2]), 0};
  }

  /// a - b, nearest image.
  BL_HD Vec3f separation(const FixedPosition& a, const FixedPosition& b) const {
    return {as_real(wrapped_difference(a.x, b.x)) * quantum.x,
            as_real(wrapped_difference(a.y, b.y)) * quantum.y,
            as_real(wrapped_difference(a.z, b.z)) * quantum.z};
  }
  BL_HD Vec3d separation(const Vec3d& a, const Vec3d& b) const { return nearest_image(a - b); }
  BL_HD Vec3d separation(const PlainPosition& a, const PlainPosition& b) const {
    return nearest_image(Vec3d{a.x - b.x, a.y - b.y, a.z - b.z});
  }
#if !BL_CUDA
  Vec3<Pack> separation(const FixedPosition& a, const FixedPositions& b) const {
    return {as_real(wrapped_difference(PackInt(a.x), b.x)) * quantum.x,
            as_real(wrapped_difference(PackInt(a.y), b.y)) * quantum.y,
            as_real(wrapped_difference(PackInt(a.z), b.z)) * quantum.z};
  }
  Vec3<Pack> separation(const PlainPosition& a, const PlainPositions& b) const {
    return nearest_image(Vec3<Pack>{Pack(Real(a.x)) - b.x, Pack(Real(a.y)) - b.y, Pack(Real(a.z)) - b.z});
  }
#endif

  template <class N>
  BL_HD Vec3<N> nearest_image(Vec3<N> d) const {
    using std::rint;
    if (periodic[0]) d.x -= length.x * rint(d.x / length.x);
    if (periodic[1]) d.y -= length.y * rint(d.y / length.y);
    if (periodic[2]) d.z -= length.z * rint(d.z / length.z);
    return d;
  }

  /// The image of x inside the domain on periodic axes.
  BL_HD Vec3d wrap(Vec3d x) const {
    if (periodic[0]) x.x -= length.x * floor((x.x - origin.x) / length.x);
    if (periodic[1]) x.y -= length.y * floor((x.y - origin.y) / length.y);
    if (periodic[2]) x.z -= length.z * floor((x.z - origin.z) / length.z);
    return x;
  }

 private:
  BL_HD static std::int32_t fixed(double u, bool wraps) {
    constexpr double last = 1073741823;  // 2^30 - 1: no difference wraps
    if (!wraps) u = clamp(u, -last, last);
    return std::int32_t(std::uint32_t(std::int64_t(floor(u + 0.5))));
  }
};

/// A place as pair loops read it.
template <class P = PairPosition>
BL_HD P pair_position(const Frame& f, const Vec3d& x, Real weight = 0) {
  if constexpr (std::is_same_v<P, FixedPosition>) {
    P p = f.fixed(x);
    p.weight = float(weight);
    return p;
  } else {
    return P{x.x, x.y, x.z, weight};
  }
}

/// Fluid positions as they are kept.
#if BL_PACKED_POSITIONS
using FluidPosition = PackedPosition;
#else
using FluidPosition = Vec3d;
#endif

BL_HD Vec3d coordinates(const Frame& f, const PackedPosition& p) { return f.unpack(p); }
BL_HD Vec3d coordinates(const Frame&, const Vec3d& x) { return x; }

template <class P>
BL_HD P as_position(const Frame& f, const Vec3d& x) {
  if constexpr (std::is_same_v<P, PackedPosition>)
    return f.pack(x);
  else
    return x;
}

}  // namespace BL_SOLVER
