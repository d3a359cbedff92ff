#pragma once
// What begins while something else is still waited for: loops, and what is read later.

#include "bedload/parallel/loops.hpp"

namespace BL_SOLVER {

/// Has something brought near that is read later, so that it need not be waited for then.
template <class T>
BL_HD void read_ahead([[maybe_unused]] const T& there) {
#if defined(__CUDA_ARCH__)
  asm volatile("prefetch.L1 [%0];" ::"l"(&there));
#endif
}

/// As for_each, but f begins while loops before it may still work, and waits for them where it needs what they
/// write.
template <class F>
void for_each_early(Range range, const F& f) {
#if BL_CUDA
  if (range.size() == 0) return;
  const Index block = block_size(range);
  launch(for_each_kernel<true, F>, (range.size() + block - 1) / block, block, 0, range.begin, range.end, f);
#else
  for_each(range, f);
#endif
}

}  // namespace BL_SOLVER
