#include "bedload/neighbours/cell_grid.hpp"

#include <array>
#include <cmath>

namespace BL_SOLVER {
namespace {

/// Place on the Hilbert curve of each cell of a brick (Skilling 2004: axes to transpose, then interleave).
std::array<std::uint16_t, 512> hilbert_curve() {
  std::array<std::uint16_t, 512> curve{};
  for (std::uint32_t iz = 0; iz < 8; ++iz)
    for (std::uint32_t iy = 0; iy < 8; ++iy)
      for (std::uint32_t ix = 0; ix < 8; ++ix) {
        std::uint32_t x[3] = {ix, iy, iz};
        for (std::uint32_t q = 4; q > 1; q >>= 1)
          for (auto& axis : x)
            if (axis & q)
              x[0] ^= q - 1;
            else {
              const std::uint32_t t = (x[0] ^ axis) & (q - 1);
              x[0] ^= t;
              axis ^= t;
            }
        x[1] ^= x[0];
        x[2] ^= x[1];
        std::uint32_t t = 0;
        for (std::uint32_t q = 4; q > 1; q >>= 1)
          if (x[2] & q) t ^= q - 1;
        for (auto& axis : x) axis ^= t;
        std::uint32_t index = 0;
        for (int bit = 2; bit >= 0; --bit)
          for (auto axis : x) index = index << 1 | (axis >> bit & 1);
        curve[iz * 64 + iy * 8 + ix] = std::uint16_t(index);
      }
  return curve;
}

template <class P>
struct KeyPass {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<std::uint32_t> key;
  BL_HD void operator()(Index i) const { key[i] = grid.key(coordinates(frame, x[i])); }
};

/// The first particle of cell c or a later one: by bisection, since most cells of a domain may be empty.
struct StartPass {
  Span<const std::uint32_t> key;
  Span<Index> start;
  BL_HD void operator()(Index c) const {
    Index lo = 0, hi = key.size;
    while (lo < hi) {
      const Index middle = lo + (hi - lo) / 2;
      if (key[middle] < c)
        lo = middle + 1;
      else
        hi = middle;
    }
    start[c] = lo;
  }
};

/// The first particle of each cell marks it and the adjacent ones.
template <class P>
struct OccupyPass {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<const std::uint32_t> key;
  Span<const Index> order;
  Span<std::uint8_t> occupied_nearby;
  BL_HD void operator()(Index i) const {
    if (i > 0 && key[i - 1] == key[i]) return;
    grid.each_beside(coordinates(frame, x[order[i]]), [&](std::uint32_t c) { occupied_nearby[c] = 1; });
  }
};

}  // namespace

CellGrid::CellGrid(const Frame& frame, const Vec3d& min, const Vec3d& max, double cell) {
  double edge = cell;
  for (;; edge *= 1.26) {  // coarser cells when the domain is vast: still right, only slower
    double total = 512;
    for (int k = 0; k < 3; ++k) {
      const double length = max[k] - min[k];
      shape_.n[k] = std::max(1, int(std::floor(std::min(length / edge, 1e9))));
      shape_.bricks[k] = (shape_.n[k] + 7) / 8;
      shape_.periodic[k] = frame.periodic[k];
      shape_.origin[k] = min[k];
      shape_.inverse[k] = shape_.n[k] / length;
      total *= shape_.bricks[k];
    }
    if (total < double(1u << 28)) break;
  }
  cells_ = 512u * shape_.bricks[0] * shape_.bricks[1] * shape_.bricks[2];
  key_bits_ = 1;
  while (key_bits_ < 32 && (1u << key_bits_) < cells_) ++key_bits_;
  const auto curve = hilbert_curve();
  curve_.assign({curve.begin(), curve.end()});
}

template <class P>
void CellGrid::sort(const Frame& frame, Span<const P> x, Buffer<Index>& order) {
  Buffer<std::uint32_t>& keys = Context::current().scratch<std::uint32_t>();
  keys.reserve_and_resize(x.size);
  for_each({0, x.size}, KeyPass<P>{view(), frame, x, keys});
  sort_keys(keys, order, key_bits_);
  for_each({0, cells_ + 1}, StartPass{keys, start_});
  occupied_nearby_.zero();
  for_each({0, x.size}, OccupyPass<P>{view(), frame, x, keys, order, occupied_nearby_});
}
template void CellGrid::sort(const Frame&, Span<const Vec3d>, Buffer<Index>&);
template void CellGrid::sort(const Frame&, Span<const PackedPosition>, Buffer<Index>&);

CellGridView CellGrid::view() const {
  start_.resize(cells_ + 1);
  occupied_nearby_.resize(cells_);
  CellGridView v = shape_;
  v.curve = curve_.data();
  v.start = start_.data();
  v.occupied_nearby = occupied_nearby_.data();
  return v;
}

}  // namespace BL_SOLVER
