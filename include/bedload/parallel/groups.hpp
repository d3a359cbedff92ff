#pragma once
// A loop over groups of members, each of which has a sum of its own.

#include <atomic>

#include "bedload/parallel/loops.hpp"

namespace BL_SOLVER {

/// Sets a number that others may set at the same time to the largest of all: their order does not matter.
BL_HD void raise_to(std::uint32_t& number, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
  atomicMax(&number, value);
#else
  std::atomic_ref<std::uint32_t> shared(number);
  std::uint32_t now = shared.load(std::memory_order_relaxed);
  while (now < value && !shared.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
#endif
}

#if BL_CUDA
template <class F>
__global__ void __launch_bounds__(128) for_each_group_kernel(F f) {
  begin_loop();
  __shared__ typename F::Value shared[128];
  const auto group = f.group(blockIdx.x);
  const Index members = group.size();
  typename F::Value sum = f.identity();
  for (Index k = threadIdx.x; k < members; k += 128) f.combine(sum, group(k));
  shared[threadIdx.x] = sum;
  __syncthreads();
  for (int half = 64; half > 0; half /= 2) {
    if (threadIdx.x < half) f.combine(shared[threadIdx.x], shared[threadIdx.x + half]);
    __syncthreads();
  }
  if (threadIdx.x == 0) f.finish(blockIdx.x, shared[0]);
}
#endif

/// For each of n groups, f.group(g)(k) of all its members k < f.group(g).size(), which f.combine() sums in a
/// fixed order from f.identity(), then f.finish(g, sum).
template <class F>
void for_each_group(Index n, const F& f) {
  if (n == 0) return;
#if BL_CUDA
  launch(for_each_group_kernel<F>, n, 128, 0, f);
#else
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (Index g = 0; g < n; ++g) {
    const auto group = f.group(g);
    typename F::Value sum = f.identity();
    for (Index k = 0; k < group.size(); ++k) f.combine(sum, group(k));
    f.finish(g, sum);
  }
#endif
}

/// What a loop over groups combines that sums nothing.
struct NoSum {
  struct Value {};
  BL_HD Value identity() const { return {}; }
  BL_HD void combine(Value&, const Value&) const {}
  BL_HD void finish(Index, const Value&) const {}
};

}  // namespace BL_SOLVER
