#pragma once
// Loops over groups: the members of each, which have a sum of its own, or the cells of a box of each.

#include <atomic>

#include "bedload/parallel/loops.hpp"

namespace BL_SOLVER {

/// Sets a number that others may set at the same time to the largest of all: their order does not matter.
BL_HD void raise_to(std::uint32_t& number, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
  if (number < value) atomicMax(&number, value);
#else
  std::atomic_ref<std::uint32_t> shared(number);
  std::uint32_t now = shared.load(std::memory_order_relaxed);
  while (now < value && !shared.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
#endif
}

#if BL_CUDA
/// Threads for each group: more where groups are few.
inline bool are_few(Index groups) { return groups < 1024; }

template <int kThreads, class F>
__global__ void __launch_bounds__(kThreads, 896 / kThreads) for_each_group_kernel(F f) {
  begin_loop();
  __shared__ typename F::Value shared[kThreads];
  const auto group = f.group(blockIdx.x);
  const Index members = group.size();
  typename F::Value sum = f.identity();
  for (Index k = threadIdx.x; k < members; k += kThreads) f.combine(sum, group(k));
  shared[threadIdx.x] = sum;
  __syncthreads();
  for (int half = kThreads / 2; half > 0; half /= 2) {
    if (threadIdx.x < half) f.combine(shared[threadIdx.x], shared[threadIdx.x + half]);
    __syncthreads();
  }
  if (threadIdx.x == 0) f.finish(blockIdx.x, shared[0]);
}

template <int kThreads, class F>
__global__ void __launch_bounds__(kThreads, 1024 / kThreads) for_each_box_kernel(F f) {
  begin_loop();
  const auto box = f.box(blockIdx.x);
  int lanes = 8;
  while (lanes < 32 && lanes < box.count[0]) lanes *= 2;
  const int lane = int(threadIdx.x) % lanes, rows = box.count[1] * box.count[2];
  for (int row = int(threadIdx.x) / lanes; row < rows; row += kThreads / lanes) {
    const int z = row / box.count[1], y = row - z * box.count[1];
    const auto cells = box.row(y, z);
    for (int x = lane; x < box.count[0]; x += lanes) f.at(box, cells, x);
  }
}
#endif

/// For each of n groups, f.group(g)(k) of all its members k < f.group(g).size(), which f.combine() sums in a
/// fixed order from f.identity(), then f.finish(g, sum). On a CPU f.group(g).fetch(k), some time before, asks
/// for the memory that a member needs.
template <class F>
void for_each_group(Index n, const F& f) {
  if (n == 0) return;
#if BL_CUDA
  if (are_few(n))
    launch(for_each_group_kernel<512, F>, n, 512, 0, f);
  else
    launch(for_each_group_kernel<128, F>, n, 128, 0, f);
#else
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (Index g = 0; g < n; ++g) {
    const auto group = f.group(g);
    typename F::Value sum = f.identity();
    for (Index k = 0; k < group.size(); ++k) {
      constexpr Index ahead = 16;  // so many loads wait for memory at a time
      if (k + ahead < group.size()) group.fetch(k + ahead);
      f.combine(sum, group(k));
    }
    f.finish(g, sum);
  }
#endif
}

/// For each of n groups, f.at(box, box.row(y, z), x) of all cells of box = f.box(g), which has count[0] along
/// x, ...
template <class F>
void for_each_box(Index n, const F& f) {
  if (n == 0) return;
#if BL_CUDA
  if (are_few(n))
    launch(for_each_box_kernel<512, F>, n, 512, 0, f);
  else
    launch(for_each_box_kernel<128, F>, n, 128, 0, f);
#else
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (Index g = 0; g < n; ++g) {
    const auto box = f.box(g);
    for (int z = 0; z < box.count[2]; ++z)
      for (int y = 0; y < box.count[1]; ++y) {
        const auto cells = box.row(y, z);
        for (int x = 0; x < box.count[0]; ++x) f.at(box, cells, x);
      }
  }
#endif
}

}  // namespace BL_SOLVER
