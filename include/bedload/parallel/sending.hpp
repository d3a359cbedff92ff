#pragma once
// What the host sends to loops without waiting for those before.

#include <array>
#include <cstring>

#include "bedload/parallel/buffer.hpp"

namespace BL_SOLVER {

/// Copies that are queued among loops.
template <class T>
class Sending {
 public:
  Sending() = default;
  Sending(const Sending&) = delete;
  Sending& operator=(const Sending&) = delete;

  /// Queues a copy of n values; `from` may change afterwards.
  void copy(T* to, const T* from, std::size_t n) {
#if BL_CUDA
    Slot& slot = slots_[next_];
    next_ = (next_ + 1) % slots_.size();
    if (!slot.sent) check_cuda(cudaEventCreateWithFlags(&slot.sent, cudaEventDisableTiming), "GPU");
    check_cuda(cudaEventSynchronize(slot.sent), "copy to the GPU");  // it was sent some copies ago
    if (slot.room < n) {
      cudaFreeHost(slot.memory);
      slot.memory = nullptr, slot.room = 0;
      check_cuda(cudaMallocHost(&slot.memory, 2 * n * sizeof(T)), "memory of the host for the GPU");
      slot.room = 2 * n;
    }
    std::memcpy(static_cast<void*>(slot.memory), from, n * sizeof(T));
    const cudaStream_t stream = Context::current().stream();
    check_cuda(cudaMemcpyAsync(to, slot.memory, n * sizeof(T), cudaMemcpyHostToDevice, stream),
               "copy to the GPU");
    check_cuda(cudaEventRecord(slot.sent, stream), "copy to the GPU");
#else
    std::memcpy(static_cast<void*>(to), from, n * sizeof(T));
#endif
  }

#if BL_CUDA
  ~Sending() {
    for (Slot& slot : slots_) {
      if (slot.sent) cudaEventSynchronize(slot.sent), cudaEventDestroy(slot.sent);
      cudaFreeHost(slot.memory);
    }
  }

 private:
  /// Memory of the host from which the GPU can read.
  struct Slot {
    T* memory = nullptr;
    std::size_t room = 0;
    cudaEvent_t sent = nullptr;
  };
  std::array<Slot, 4> slots_;
  std::size_t next_ = 0;
#endif
};

}  // namespace BL_SOLVER
