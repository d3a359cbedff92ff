#include "bedload/neighbours/cell_grid.hpp"

#include <cmath>

namespace BL_SOLVER {
namespace {

/// Place on the Hilbert curve of each cell of a brick (Skilling 2004: axes to transpose, then interleave).
std::array<std::uint16_t, 512> make_curve() {
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

/// Numbers in the tables of the cells of particles.
template <class P>
struct KeyPass {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<const Index> order;  ///< of the particles; empty: as they are
  Index first;
  Span<std::uint32_t> key;
  BL_HD void operator()(Index i) const {
    key[first + i] = grid.key(coordinates(frame, x[order ? order[i] : first + i]));
  }
};

/// Marks the blocks of the cells in and next to which particles are.
template <class P>
struct MarkBlocksPass {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<Index> marked;
  BL_HD void operator()(Index i) const {
    const Vec3d at = coordinates(frame, x[i]);
    const unsigned shift = grid.block_bits / 3;
    int cell[3][3], cells[3];
    for (int k = 0; k < 3; ++k) {
      const int c = cell[k][0] = grid.coordinate(at[k], k);
      cells[k] = 1;
      for (int side = -1; side <= 1; side += 2) {
        const int beside = grid.periodic[k] ? grid.wrapped(c + side, k) : clamp(c + side, 0, grid.n[k] - 1);
        if (beside >> shift != c >> shift) cell[k][cells[k]++] = beside;
      }
    }
    for (int iz = 0; iz < cells[2]; ++iz)
      for (int iy = 0; iy < cells[1]; ++iy)
        for (int ix = 0; ix < cells[0]; ++ix) {
          Index& mark = marked[grid.number(cell[0][ix], cell[1][iy], cell[2][iz]) >> grid.block_bits];
          if (mark == 0) mark = 1;
        }
  }
};

/// The blocks that are numbered among a rank's own.
struct OwnBlocksPass {
  Span<const Index> ghost_place, beside;
  Span<Index> marked;
  BL_HD void operator()(Index b) const {
    if (ghost_place[b] != kNone)
      marked[b] = 0;
    else if (beside[b])
      marked[b] = 1;
  }
};

/// Those first, then the blocks of other ranks; all the rest are one block that is empty.
struct DirectoryPass {
  Index blocks, ghost_blocks;
  Span<const Index> marked, place, ghost_place;  ///< ghost_place: may be empty
  Span<Index> directory;
  BL_HD void operator()(Index b) const {
    const Index ghost = ghost_place ? ghost_place[b] : kNone;
    directory[b] = ghost != kNone ? blocks + ghost : marked[b] ? place[b] : blocks + ghost_blocks;
  }
};

struct ComposePass {
  Span<const Index> first, then;
  Span<Index> both;
  BL_HD void operator()(Index i) const { both[i] = first[then[i]]; }
};

/// The first particle of cell c or a later one: by bisection, since most cells of a domain may be empty.
struct StartPass {
  Span<const std::uint32_t> key;
  Span<Index> start;
  BL_HD void operator()(Index c) const { start[c] = first_not_below(key, c); }
};

/// The first particle of each cell marks it and the adjacent ones.
template <class P>
struct OccupyPass {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<const std::uint32_t> key;
  Span<const Index> order;  ///< of the particles; empty: as they are
  Span<std::uint8_t> occupied_nearby;
  BL_HD void operator()(Index i) const {
    if (i > 0 && key[i - 1] == key[i]) return;
    grid.each_beside(coordinates(frame, x[order ? order[i] : i]),
                     [&](std::uint32_t c) { occupied_nearby[c] = 1; });
  }
};

int bits_of(std::uint64_t numbers) {
  int bits = 1;
  while (bits < 32 && (std::uint64_t(1) << bits) < numbers) ++bits;
  return bits;
}

}  // namespace

const std::array<std::uint16_t, 512>& hilbert_curve() {
  static const auto curve = make_curve();
  return curve;
}

CellGrid::CellGrid(const Frame& frame, const Vec3d& min, const Vec3d& max, double cell, int block) {
  shape_.block_bits = block >= 8 ? 9 : block >= 4 ? 6 : block >= 2 ? 3 : 0;
  const double most = std::min(double(1u << 31), double(1u << 22) * double(1u << shape_.block_bits));
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
    if (total < most) break;
  }
  const auto& curve = hilbert_curve();
  curve_.assign({curve.begin(), curve.end()});
}

template <class P>
void CellGrid::number_blocks(const Frame& frame, Span<const P> x) {
  Buffer<Index>&marked = Context::current().scratch<Index>(0), &place = Context::current().scratch<Index>(3);
  const Range blocks{0, blocks_of_domain()};
  marked.reserve_and_resize(blocks.end);
  marked.zero();
  for_each({0, x.size}, MarkBlocksPass<P>{view(), frame, x, marked});
  if (ownership_) for_each(blocks, OwnBlocksPass{ownership_->ghost_place, ownership_->beside, marked});
  place.reserve_and_resize(blocks.end + 1);
  blocks_ = exclusive_scan(marked, place);
  for_each(blocks, DirectoryPass{blocks_, ghost_blocks(), marked, place,
                                 ownership_ ? ownership_->ghost_place.span() : Span<const Index>(),
                                 directory_});
}

template <class P>
void CellGrid::fill_tables(const Frame& frame, Span<const P> x, Span<const Index> order) {
  const Index of_a_block = 1u << shape_.block_bits;
  start_.reserve_and_resize(cells() + of_a_block + 1);  // an empty block at the end
  occupied_nearby_.reserve_and_resize(cells() + of_a_block);
  for_each({0, Index(start_.size())}, StartPass{keys_, start_});
  occupied_nearby_.zero();
  for_each({0, x.size}, OccupyPass<P>{view(), frame, x, keys_, order, occupied_nearby_});
}

template <class P>
void CellGrid::sort(const Frame& frame, Span<const P> x, Buffer<Index>& order, Span<const Id> id) {
  number_blocks(frame, x);
  const int bits = bits_of(std::uint64_t(cells()));
  keys_.reserve_and_resize(x.size);
  if (id) {
    Buffer<std::uint32_t>& ids = Context::current().scratch<std::uint32_t>(0);
    Buffer<Index>&by_id = Context::current().scratch<Index>(3), &by_key = Context::current().scratch<Index>(4);
    ids.reserve_and_resize(x.size);
    copy_on_device(ids.data(), id.data, x.size * sizeof(Id));
    sort_keys(ids, by_id, 32);
    for_each({0, x.size}, KeyPass<P>{view(), frame, x, by_id, 0, keys_});
    sort_keys(keys_, by_key, bits);
    order.resize(x.size);
    for_each({0, x.size}, ComposePass{by_id, by_key, order});
  } else {
    for_each({0, x.size}, KeyPass<P>{view(), frame, x, {}, 0, keys_});
    sort_keys(keys_, order, bits);
  }
  fill_tables(frame, x, order);
}
template void CellGrid::sort(const Frame&, Span<const Vec3d>, Buffer<Index>&, Span<const Id>);
template void CellGrid::sort(const Frame&, Span<const PackedPosition>, Buffer<Index>&, Span<const Id>);

template <class P>
void CellGrid::add_ghosts(const Frame& frame, Span<const P> x) {
  const Index own = Index(keys_.size());
  keys_.grow(x.size);
  for_each({0, x.size - own}, KeyPass<P>{view(), frame, x, {}, own, keys_});
  fill_tables(frame, x, {});
}
template void CellGrid::add_ghosts(const Frame&, Span<const Vec3d>);
template void CellGrid::add_ghosts(const Frame&, Span<const PackedPosition>);

CellGridView CellGrid::view() const {
  if (directory_.size() == 0) {  // nothing was sorted: all blocks are the empty one
    directory_.resize(blocks_of_domain());
    start_.resize((1u << shape_.block_bits) + 1);
    occupied_nearby_.resize(1u << shape_.block_bits);
  }
  CellGridView v = shape_;
  v.curve = curve_.data();
  v.directory = directory_.data();
  v.start = start_.data();
  v.occupied_nearby = occupied_nearby_.data();
  return v;
}

}  // namespace BL_SOLVER
