#pragma once
// Where the loops of a host thread run.

#include <map>
#include <memory>
#include <string>
#include <typeindex>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/core/types.hpp"
#include "bedload/parallel/link.hpp"

namespace BL_SOLVER {

template <class T>
class Buffer;

#if BL_CUDA
inline void check_cuda(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  (void)cudaGetLastError();
  throw DeviceError(std::string(what) + ": " + cudaGetErrorString(status));
}
#endif

/// What loops, sorts and copies of one host thread share: the queue of the device in which they follow one
/// another, memory for what no one keeps, and the link to other ranks where there are several.
class Context {
 public:
  /// That of the thread that asks.
  static Context& current() {
    static thread_local Context context;
    return context;
  }

#if BL_CUDA
  Context() { check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "queue of the GPU"); }
  ~Context() {
    scratch_.clear();
    cudaStreamDestroy(stream_);
  }
  cudaStream_t stream() const { return stream_; }
#else
  Context() = default;
#endif
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// From now on this thread is one of several ranks. `link` must outlive what it does.
  void join(Link* link) { link_ = link; }
  bool several() const { return link_ != nullptr; }
  Link* link() const { return link_; }  ///< null: this is the only rank
  int rank() const { return link_ ? link_->rank() : 0; }
  int ranks() const { return link_ ? link_->size() : 1; }

  /// Waits for all that has been queued.
  void wait() const {
#if BL_CUDA
    check_cuda(cudaStreamSynchronize(stream_), "GPU computation");
#endif
  }
  /// A buffer of T of which nobody relies on what it holds; `which`: of several in use at once.
  template <class T>
  Buffer<T>& scratch(int which = 0) {
    std::shared_ptr<void>& held = scratch_[{typeid(T), which}];
    if (!held) held = std::make_shared<Buffer<T>>();
    return *static_cast<Buffer<T>*>(held.get());
  }

 private:
  std::map<std::pair<std::type_index, int>, std::shared_ptr<void>> scratch_;
  Link* link_ = nullptr;
#if BL_CUDA
  cudaStream_t stream_ = nullptr;
#endif
};

}  // namespace BL_SOLVER
