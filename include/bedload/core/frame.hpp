#pragma once
// Where things are. The domain is cut into 1024 x 1024 x 1024 frame cells; a
// packed position is an fp32 offset from the corner of such a cell, so a pair
// separation is as accurate as fp32 allows wherever the pair lies. Packed positions
// are the state in `single` and a derived copy for pair loops in `mixed`;
// `double` uses plain coordinates throughout. Periodic images: nearest image.

#include <bit>

#include "bedload/core/pack.hpp"

namespace bedload::inline BL_VARIANT {

struct alignas(16) PackedPosition {
  float x = 0, y = 0, z = 0;
  std::uint32_t cell = 0;  ///< 10 bits an axis
};

/// Positions as pair loops read them.
template <class R>
struct PairPositionOf {
  using type = PackedPosition;
};
template <>
struct PairPositionOf<double> {
  using type = Vec3d;
};
using PairPosition = PairPositionOf<Real>::type;

#if !BL_CUDA
struct PackedPositions {
  Pack x, y, z;
  PackInt cell;
};
template <class J>
[[gnu::always_inline]] inline PackedPositions gather(const PackedPosition* p, J j) {
  const auto rows = gather(reinterpret_cast<const Real4*>(p), j);  // cells travel as a fourth float
  return PackedPositions{rows.x, rows.y, rows.z, PackInt(std::bit_cast<PackInt::Native>(rows.w.v))};
}
#endif

struct Frame {
  Vec3d origin, length;  ///< m; length is the period on periodic axes
  Vec3d cell;            ///< length / 1024
  bool periodic[3] = {false, false, false};

  Frame() = default;
  Frame(const Vec3d& min, const Vec3d& max, bool px, bool py, bool pz)
      : origin(min), length(max - min), cell((max - min) * (1.0 / 1024)), periodic{px, py, pz} {}

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

  /// a - b, nearest image.
  BL_HD Vec3f separation(const PackedPosition& a, const PackedPosition& b) const {
    return separation<float>(a, b, int(b.cell));
  }
  BL_HD Vec3d separation(const Vec3d& a, const Vec3d& b) const { return nearest_image(a - b); }

  template <class N>
  BL_HD Vec3<N> nearest_image(Vec3<N> d) const {
    using std::rint;
    if (periodic[0]) d.x -= length.x * rint(d.x / length.x);
    if (periodic[1]) d.y -= length.y * rint(d.y / length.y);
    if (periodic[2]) d.z -= length.z * rint(d.z / length.z);
    return d;
  }
#if !BL_CUDA
  Vec3<Pack> separation(const PackedPosition& a, const PackedPositions& b) const {
    return separation<Pack>(a, b, b.cell);
  }
  template <class N>
    requires std::is_same_v<N, Pack>
  Vec3<N> separation(const Vec3<Real>& a, const Vec3<N>& b) const {
    return nearest_image(Vec3<N>(a) - b);
  }
#endif

  /// The image of x inside the domain on periodic axes.
  BL_HD Vec3d wrap(Vec3d x) const {
    if (periodic[0]) x.x -= length.x * floor((x.x - origin.x) / length.x);
    if (periodic[1]) x.y -= length.y * floor((x.y - origin.y) / length.y);
    if (periodic[2]) x.z -= length.z * floor((x.z - origin.z) / length.z);
    return x;
  }

 private:
  template <class N, class B, class I>
  BL_HD Vec3<N> separation(const PackedPosition& a, const B& b, I b_cell) const {
    I ix = int(a.cell & 1023) - (b_cell & 1023);
    I iy = int(a.cell >> 10 & 1023) - (b_cell >> 10 & 1023);
    I iz = int(a.cell >> 20 & 1023) - (b_cell >> 20 & 1023);
    if (periodic[0]) ix = ((ix + 512) & 1023) - 512;
    if (periodic[1]) iy = ((iy + 512) & 1023) - 512;
    if (periodic[2]) iz = ((iz + 512) & 1023) - 512;
    return {(N(a.x) - b.x) + as_real(ix) * float(cell.x), (N(a.y) - b.y) + as_real(iy) * float(cell.y),
            (N(a.z) - b.z) + as_real(iz) * float(cell.z)};
  }
};

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
  if constexpr (sizeof(P) == sizeof(PackedPosition) && alignof(P) == 16)
    return f.pack(x);
  else
    return x;
}

}  // namespace bedload::inline BL_VARIANT
