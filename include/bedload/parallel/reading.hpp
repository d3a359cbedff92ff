#pragma once
// What the host reads of the result of loops without waiting for each.

#include "bedload/parallel/loops.hpp"

namespace BL_SOLVER {

/// A value on its way to the host while other work is queued: several of them are waited for once.
template <class T>
class Reading {
 public:
  Reading() = default;
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

  /// Queues reduce(range, f).
  template <class F>
  void take(Range range, const F& f) {
#if BL_CUDA
    if (!there_) check_cuda(cudaMallocHost(&there_, sizeof(T)), "memory of the host for the GPU");
    if (range.size() > 0) {
      const cudaStream_t stream = Context::current().stream();
      check_cuda(
          cudaMemcpyAsync(there_, detail::reduce_there(range, f), sizeof(T), cudaMemcpyDeviceToHost, stream),
          "copy from the GPU");
      return;
    }
    Context::current().wait();  // nothing is on its way
    *there_ = f.identity();
#else
    value_ = reduce(range, f);
#endif
  }
#if BL_CUDA
  ~Reading() { cudaFreeHost(there_); }
  /// Of the last reduction. Waits for the device.
  T read() const {
    Context::current().wait();
    return *there_;
  }

 private:
  T* there_ = nullptr;  ///< in memory that the GPU can write to
#else
  T read() const { return value_; }

 private:
  T value_{};
#endif
};

}  // namespace BL_SOLVER
