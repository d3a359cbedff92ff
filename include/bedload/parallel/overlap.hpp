#pragma once
// What begins while something else is still waited for: loops, and what is read later.

#include "bedload/parallel/loops.hpp"

namespace bedload::inline BL_VARIANT {

/// In a loop of for_each_early: returns when the loop before it has ended, so that what that wrote can be
/// read.
BL_HD void wait_for_loop_before() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}
/// In a loop that another of for_each_early follows: that may begin once all threads have come here.
BL_HD void let_next_loop_begin() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.launch_dependents;" ::: "memory");
#endif
}

/// Has something brought near that is read later, so that it need not be waited for then.
template <class T>
BL_HD void read_ahead([[maybe_unused]] const T& there) {
#if defined(__CUDA_ARCH__)
  asm volatile("prefetch.L1 [%0];" ::"l"(&there));
#endif
}

/// As for_each, but f may be called before the loop queued last has ended, if that lets it: f waits where it
/// needs what that loop or an earlier one writes.
template <class F>
void for_each_early(Range range, const F& f) {
#if BL_CUDA
  static const bool able = [] {
    int device = 0, major = 0;
    check_cuda(cudaGetDevice(&device), "device");
    check_cuda(cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device), "device");
    return major >= 9;
  }();
  if (range.size() == 0) return;
  cudaLaunchAttribute early{};
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t launch{};
  const Index block = block_size(range);
  launch.gridDim = {(range.size() + block - 1) / block, 1, 1};
  launch.blockDim = {block, 1, 1};
  launch.stream = Context::current().stream();
  launch.attrs = &early;
  launch.numAttrs = able ? 1 : 0;
  check_cuda(cudaLaunchKernelEx(&launch, for_each_kernel<F>, range.begin, range.end, f), "kernel launch");
#else
  for_each(range, f);
#endif
}

}  // namespace bedload::inline BL_VARIANT
