#pragma once
// Several GPU threads for one row, where rows are too few to fill the device. The number of lanes
// follows from the number of rows alone, so results stay the same from run to run.

#include <cstring>

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// log2 of the lanes for each of `rows` rows; 0 on the CPU. threads: what keeps every multiprocessor busy.
inline unsigned lane_bits(Index rows, [[maybe_unused]] std::uint64_t threads = 1u << 18) {
  unsigned bits = 0;
#if BL_CUDA
  while (bits < 5 && (std::uint64_t(rows) << (bits + 1)) <= threads) ++bits;
#else
  (void)rows;
#endif
  return bits;
}

/// One lane of a team that works on one row; all of a team are in one warp and stay together.
struct Lane {
  Index row, index, count;

  BL_HD Lane(Index thread, unsigned bits)
      : row(thread >> bits), index(thread & ((1u << bits) - 1)), count(1u << bits) {}

  /// Returns when all lanes of the team have come here; they see what each has written.
  BL_HD void wait() const {
#if defined(__CUDA_ARCH__)
    if (count > 1) __syncwarp(mask());
#endif
  }
  /// Leaves on every lane what merge(into, other) makes of all lanes' sums.
  template <class Sum, class Merge>
  BL_HD void combine(Sum& sum, const Merge& merge) const {
    for (Index step = 1; step < count; step *= 2) merge(sum, from(sum, step));
  }

 private:
#if defined(__CUDA_ARCH__)
  BL_HD unsigned first() const { return (threadIdx.x & 31u) - index; }
  BL_HD unsigned mask() const { return (count == 32 ? 0xffffffffu : (1u << count) - 1) << first(); }
#endif
  template <class T>
  BL_HD T from(const T& own, [[maybe_unused]] Index step) const {
#if defined(__CUDA_ARCH__)
    static_assert(sizeof(T) % sizeof(unsigned) == 0);
    unsigned word[sizeof(T) / sizeof(unsigned)];
    memcpy(word, &own, sizeof(T));
    for (unsigned& w : word) w = __shfl_xor_sync(mask(), w, step);
    T other = own;
    memcpy(&other, word, sizeof(T));
    return other;
#else
    return own;
#endif
  }
};

}  // namespace BL_SOLVER
