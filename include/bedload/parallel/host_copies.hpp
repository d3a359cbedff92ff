#pragma once
// Copies of arrays to the host while the solver goes on: loops leave them in memory of their own on the
// device, and a second queue takes them from there.

#include <memory>
#include <utility>
#include <vector>

#include "bedload/parallel/buffer.hpp"

namespace BL_SOLVER {

#if BL_CUDA
/// A moment in a queue, for which any thread can wait.
class Moment {
 public:
  explicit Moment(cudaStream_t queue) {
    check_cuda(cudaGetDevice(&device_), "device");
    check_cuda(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming | cudaEventBlockingSync), "event");
    check_cuda(cudaEventRecord(event_, queue), "event");
  }
  ~Moment() { cudaEventDestroy(event_); }
  Moment(const Moment&) = delete;
  Moment& operator=(const Moment&) = delete;

  void hold_up(cudaStream_t queue) const { check_cuda(cudaStreamWaitEvent(queue, event_, 0), "event"); }
  void wait() const {
    check_cuda(cudaSetDevice(device_), "device");
    check_cuda(cudaEventSynchronize(event_), "copy from the GPU");
  }

 private:
  int device_ = 0;
  cudaEvent_t event_ = nullptr;
};

/// Of the arrays of one store; those of one frame after the other.
class HostCopies {
 public:
  HostCopies() { check_cuda(cudaStreamCreateWithFlags(&queue_, cudaStreamNonBlocking), "queue of the GPU"); }
  ~HostCopies() {
    cudaStreamSynchronize(queue_);
    cudaStreamDestroy(queue_);
  }
  HostCopies(const HostCopies&) = delete;
  HostCopies& operator=(const HostCopies&) = delete;

  /// Loops that are queued from now on may write to memory that the last frame has been copied from.
  void begin() {
    if (last_) last_->hold_up(Context::current().stream());
    made_ = 0;
  }
  /// Memory for the next array, which goes to `to`, page-locked; null where the device has no room to spare.
  template <class T>
  T* room(std::size_t n, void* to) {
    if (made_ == arrays_.size()) arrays_.push_back({});
    auto& [memory, bytes, target] = arrays_[made_];
    bytes = n * sizeof(T), target = to;
    if (memory.size() < bytes) {
      std::size_t free = 0, total = 0;
      check_cuda(cudaMemGetInfo(&free, &total), "memory of the GPU");
      if (free < 2 * bytes + total / 16) return nullptr;
      memory.resize(bytes + bytes / 8);  // numbers of particles vary
    }
    ++made_;
    return reinterpret_cast<T*>(memory.data());
  }
  /// When all have been copied, in a queue that does not hold up the solver.
  std::shared_ptr<const Moment> end() {
    Moment(Context::current().stream()).hold_up(queue_);
    for (std::size_t k = 0; k < made_; ++k)
      check_cuda(cudaMemcpyAsync(arrays_[k].to, arrays_[k].memory.data(), arrays_[k].bytes,
                                 cudaMemcpyDeviceToHost, queue_),
                 "copy from the GPU");
    return last_ = std::make_shared<const Moment>(queue_);
  }

 private:
  struct Array {
    Buffer<std::byte> memory;
    std::size_t bytes = 0;
    void* to = nullptr;
  };
  std::vector<Array> arrays_;
  std::size_t made_ = 0;  ///< of this frame
  std::shared_ptr<const Moment> last_;
  cudaStream_t queue_ = nullptr;
};
#else
/// The host computes in its own memory.
class HostCopies {
 public:
  template <class T>
  T* room(std::size_t, void*) {
    return nullptr;
  }
};
#endif

}  // namespace BL_SOLVER
