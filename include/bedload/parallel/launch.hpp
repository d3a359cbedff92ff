#pragma once
// How loops follow one another on a GPU: the blocks of one may start on the multiprocessors while those
// before it still work there, and wait for these themselves.

#include <type_traits>

#include "bedload/parallel/context.hpp"

namespace BL_SOLVER {

/// Returns when all loops queued before have ended, so that what they wrote can be read.
BL_HD void wait_for_loops_before() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}
/// The loop queued next may begin once all threads have come here. What begins so must wait before that, so
/// that who waits for one loop waits for all before it.
BL_HD void let_next_loop_begin() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.launch_dependents;" ::: "memory");
#endif
}
/// What a kernel begins with.
BL_HD void begin_loop() {
  wait_for_loops_before();
  let_next_loop_begin();
}

#if BL_CUDA
/// Queues a kernel that begins with begin_loop; memory: shared, of a block, bytes.
template <class... T>
void launch(void (*kernel)(T...), std::size_t blocks, Index threads, std::size_t memory,
            const std::type_identity_t<T>&... arguments) {
  static const bool able = [] {
    int device = 0, major = 0;
    check_cuda(cudaGetDevice(&device), "device");
    check_cuda(cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device), "device");
    return major >= 9;
  }();
  cudaLaunchAttribute early{};
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = {unsigned(blocks), 1, 1};
  config.blockDim = {threads, 1, 1};
  config.dynamicSmemBytes = memory;
  config.stream = Context::current().stream();
  config.attrs = &early;
  config.numAttrs = able ? 1 : 0;
  check_cuda(cudaLaunchKernelEx(&config, kernel, arguments...), "kernel launch");
}
#endif

}  // namespace BL_SOLVER
