#pragma once
// Lists of cells that are found from rows of bits: of each group in the box around it.

#include "bedload/parallel/loops.hpp"

namespace BL_SOLVER {

/// Part of a box, with the cells next to it: a row of these along x is the bits of one word.
struct Brick {
  static constexpr int kLongest = 30, kRows = (kLongest + 2) * (kLongest + 2);
  int low[3], count[3];  ///< its own cells in the box

  template <class Box>
  BL_HD static int number(const Box& box) {
    int n = 1;
    for (int a = 0; a < 3; ++a) n *= (box.count[a] + kLongest - 1) / kLongest;
    return n;
  }
  template <class Box>
  BL_HD Brick(const Box& box, int which) {
    for (int a = 0; a < 3; ++a) {
      const int along = (box.count[a] + kLongest - 1) / kLongest;
      low[a] = which % along * kLongest;
      count[a] = min_of(kLongest, box.count[a] - low[a]);
      which /= along;
    }
  }
  BL_HD int pitch() const { return count[1] + 2; }
  BL_HD int rows() const { return pitch() * (count[2] + 2); }
  BL_HD int own_rows() const { return count[1] * count[2]; }
  BL_HD std::uint32_t own_cells() const { return ((1u << count[0]) - 1) << 1; }
};

/// Two marks of each cell of a brick: cell x of its own is bit x + 1 of a word.
struct BrickRows {
  const std::uint32_t *first, *second;
};

namespace detail {

BL_HD int bits_in(std::uint32_t word) {
#if defined(__CUDA_ARCH__)
  return __popc(word);
#else
  return __builtin_popcount(word);
#endif
}
BL_HD int lowest_bit(std::uint32_t word) {
#if defined(__CUDA_ARCH__)
  return __ffs(int(word)) - 1;
#else
  return __builtin_ctz(word);
#endif
}

/// Rows of all kinds in their order, from one on.
struct BrickRow {
  int kind, y, z;
  BL_HD BrickRow(const Brick& brick, int number) {
    kind = number / brick.own_rows();
    const int row = number - kind * brick.own_rows();
    z = row / brick.count[1];
    y = row - z * brick.count[1];
  }
  BL_HD void next(const Brick& brick) {
    if (++y < brick.count[1]) return;
    y = 0;
    if (++z < brick.count[2]) return;
    z = 0, ++kind;
  }
  BL_HD int place(const Brick& brick) const { return (z + 1) * brick.pitch() + y + 1; }
};

BL_HD Index bits_with_both(const BrickRows& bits, const Brick& brick, const BrickRow& row) {
  const int place = row.place(brick);
  return Index(bits_in(bits.first[place] & bits.second[place] & brick.own_cells()));
}

/// Lists the chosen cells of a row; `place`: in the list of the group, where the next is to go.
template <class F, class Box>
BL_HD void list_row(const F& f, const Box& box, const Brick& brick, const BrickRow& row,
                    const BrickRows& bits, Index& place) {
  std::uint32_t word = f.chosen(brick, bits, row.kind, row.place(brick)) & brick.own_cells();
  for (; word != 0; word &= word - 1) {
    const int bit = lowest_bit(word);
    f.list(box, place++, row.kind, brick.low[0] + bit - 1, brick.low[1] + row.y, brick.low[2] + row.z,
           f.marked(brick, bits, row.kind, row.place(brick)) >> bit & 1u);
  }
}

#if BL_CUDA
template <class F>
__global__ void __launch_bounds__(256, 4) list_boxes_kernel(F f) {
  begin_loop();
  __shared__ std::uint32_t first[Brick::kRows], second[Brick::kRows];
  __shared__ Index of_warp[8];
  __shared__ Index both;
  const BrickRows bits{first, second};
  const int thread = int(threadIdx.x), in_warp = thread % 32;
  const auto box = f.box(blockIdx.x);
  Index listed = 0;
  if (thread == 0) both = 0;
  for (int b = 0; b < Brick::number(box); ++b) {
    const Brick brick(box, b);
    const int lanes = brick.count[0] + 2 > 16 ? 32 : 16, lane = thread % lanes, rows = brick.rows();
    for (int begin = 0; begin < rows; begin += 256 / lanes) {
      const int row = begin + thread / lanes, z = row / brick.pitch(), y = row - z * brick.pitch();
      unsigned marks = 0;
      if (row < rows && lane < brick.count[0] + 2)
        marks = f.marks(box, box.row(brick.low[1] + y - 1, brick.low[2] + z - 1), brick.low[0] + lane - 1);
      const unsigned shift = unsigned(in_warp - lane), kept = lanes == 32 ? ~0u : 0xffffu;
      const unsigned one = __ballot_sync(~0u, marks & 1u), two = __ballot_sync(~0u, marks & 2u);
      if (lane == 0 && row < rows) first[row] = one >> shift & kept, second[row] = two >> shift & kept;
    }
    __syncthreads();

    const int all = F::kKinds * brick.own_rows(), each = (all + 255) / 256 | 1;  // odd: for all banks
    const int begin = min_of(all, thread * each), end = min_of(all, begin + each);
    Index found = 0, of_both = 0;
    BrickRow row(brick, begin);
    for (int k = begin; k < end; ++k, row.next(brick)) {
      found += bits_in(f.chosen(brick, bits, row.kind, row.place(brick)) & brick.own_cells());
      if (row.kind == 0) of_both += bits_with_both(bits, brick, row);
    }
    if (of_both > 0) atomicAdd(&both, of_both);
    Index until = found;  // in the warp, up to this thread
    for (int by = 1; by < 32; by *= 2) {
      const Index before = __shfl_up_sync(~0u, until, by);
      if (in_warp >= by) until += before;
    }
    if (in_warp == 31) of_warp[thread / 32] = until;
    __syncthreads();
    Index place = listed + until - found;
    for (int w = 0; w < 8; ++w) {
      if (w < thread / 32) place += of_warp[w];
      listed += of_warp[w];
    }
    row = BrickRow(brick, begin);
    for (int k = begin; k < end; ++k, row.next(brick)) list_row(f, box, brick, row, bits, place);
    __syncthreads();
  }
  if (thread == 0) f.finish(blockIdx.x, listed, both);
}
#endif

}  // namespace detail

/// For each of n groups, whose cells are those of box = f.box(g) with count[0] along x, ..., and for each of
/// F::kKinds: f.list(box, place, kind, x, y, z, marked) of the cells that f.chosen() has in its word for a
/// row, each with its place in the list of the group and its bit of f.marked(). These get the rows of two
/// marks (bits 1 and 2) that f.marks(box, box.row(y, z), x) gives cells in the box and next to it. At last
/// f.finish(g, places, cells in the box with both marks).
template <class F>
void list_boxes(Index n, const F& f) {
  if (n == 0) return;
#if BL_CUDA
  launch(detail::list_boxes_kernel<F>, n, 256, 0, f);
#else
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (Index g = 0; g < n; ++g) {
    std::uint32_t first[Brick::kRows], second[Brick::kRows];
    const BrickRows bits{first, second};
    const auto box = f.box(g);
    Index listed = 0, both = 0;
    for (int b = 0; b < Brick::number(box); ++b) {
      const Brick brick(box, b);
      for (int row = 0; row < brick.rows(); ++row) {
        first[row] = second[row] = 0;
        const auto cells =
            box.row(brick.low[1] + row % brick.pitch() - 1, brick.low[2] + row / brick.pitch() - 1);
        for (int x = 0; x < brick.count[0] + 2; ++x) {
          const unsigned marks = f.marks(box, cells, brick.low[0] + x - 1);
          first[row] |= (marks & 1u) << x, second[row] |= (marks >> 1 & 1u) << x;
        }
      }
      detail::BrickRow row(brick, 0);
      for (; row.kind < F::kKinds; row.next(brick)) {
        if (row.kind == 0) both += detail::bits_with_both(bits, brick, row);
        detail::list_row(f, box, brick, row, bits, listed);
      }
    }
    f.finish(g, listed, both);
  }
#endif
}

}  // namespace BL_SOLVER
