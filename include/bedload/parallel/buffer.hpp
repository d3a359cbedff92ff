#pragma once
// Memory where the solver computes: on the GPU in a CUDA build, else on the host.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bedload/core/span.hpp"
#include "bedload/parallel/context.hpp"

namespace BL_SOLVER {

/// Bytes now held by all buffers of this build.
inline std::atomic<std::size_t>& bytes_held() {
  static std::atomic<std::size_t> held{0};
  return held;
}

/// And by those of this thread: of one of several ranks.
inline std::int64_t& bytes_held_by_thread() {
  static thread_local std::int64_t held = 0;
  return held;
}

inline void* device_allocate(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  void* p = nullptr;
#if BL_CUDA
  if (cudaMalloc(&p, bytes) != cudaSuccess) {
    (void)cudaGetLastError();
    std::size_t free = 0, total = 0;
    cudaMemGetInfo(&free, &total);
    throw DeviceError("out of GPU memory: " + std::to_string(bytes >> 20) + " MiB asked for, " +
                      std::to_string(free >> 20) + " of " + std::to_string(total >> 20) + " MiB free");
  }
#else
  p = std::aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (!p) throw DeviceError("out of memory: " + std::to_string(bytes >> 20) + " MiB asked for");
#endif
  bytes_held() += bytes;
  bytes_held_by_thread() += std::int64_t(bytes);
  return p;
}
inline void device_free(void* p, std::size_t bytes) {
  if (!p) return;
#if BL_CUDA
  cudaFree(p);
#else
  std::free(p);
#endif
  bytes_held() -= bytes;
  bytes_held_by_thread() -= std::int64_t(bytes);
}
/// Copies between host and device have been made when they return.
inline void copy_to_device(void* to, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
#if BL_CUDA
  const Context& context = Context::current();
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, context.stream()), "copy to the GPU");
  context.wait();
#else
  std::memcpy(to, from, bytes);
#endif
}
inline void copy_to_host(void* to, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
#if BL_CUDA
  const Context& context = Context::current();
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, context.stream()), "copy from the GPU");
  context.wait();
#else
  std::memcpy(to, from, bytes);
#endif
}
/// Also from another GPU.
inline void copy_on_device(void* to, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
#if BL_CUDA
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, Context::current().stream()),
             "copy on the GPU");
#else
  std::memcpy(to, from, bytes);
#endif
}
inline void fill_zero(void* p, std::size_t bytes) {
  if (bytes == 0) return;
#if BL_CUDA
  check_cuda(cudaMemsetAsync(p, 0, bytes, Context::current().stream()), "clearing GPU memory");
#else
  // by all threads: the first to write to a page decides where it lies
  constexpr std::size_t page = std::size_t(1) << 20;
  auto* const first = static_cast<std::byte*>(p);
#pragma omp parallel for schedule(static) if (bytes > 8 * page)
  for (std::size_t at = 0; at < bytes; at += page) std::memset(first + at, 0, std::min(page, bytes - at));
#endif
}

/// A growing array of trivially copyable T where the solver computes.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t n) { resize(n); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  Buffer(Buffer&& o) noexcept { swap(o); }
  Buffer& operator=(Buffer&& o) noexcept {
    swap(o);
    return *this;
  }

  /// New length; contents are lost when it must grow. Grown memory is zero.
  void resize(std::size_t n) {
    if (n > capacity_) {
      memory_.reset();
      data_ = nullptr, capacity_ = 0;
      const std::size_t bytes = n * sizeof(T);
      memory_ = {device_allocate(bytes), [bytes](void* p) { device_free(p, bytes); }};
      data_ = static_cast<T*>(memory_.get());
      capacity_ = n;
      fill_zero(data_, n * sizeof(T));
    }
    size_ = n;
  }
  /// New length, keeping what fits; what is added is zero. Keeps capacity to grow.
  void grow(std::size_t n) {
    if (n > capacity_) {
      Buffer larger(n + n / 8 + 64);
      copy_on_device(larger.data_, data_, size_ * sizeof(T));
      larger.size_ = size_;
      swap(larger);
    }
    if (n > size_) fill_zero(data_ + size_, (n - size_) * sizeof(T));
    size_ = n;
  }
  /// As resize, with spare capacity so that it seldom has to.
  void reserve_and_resize(std::size_t n) {
    if (n > capacity_) resize(n + n / 8 + 64);
    size_ = n;
  }
  void zero() { fill_zero(data_, size_ * sizeof(T)); }
  void assign(const std::vector<T>& host) {
    resize(host.size());
    copy_to_device(data_, host.data(), host.size() * sizeof(T));
  }
  std::vector<T> to_host() const {
    std::vector<T> host(size_);
    copy_to_host(host.data(), data_, size_ * sizeof(T));
    return host;
  }
  void swap(Buffer& o) noexcept {
    memory_.swap(o.memory_);
    std::swap(data_, o.data_), std::swap(size_, o.size_), std::swap(capacity_, o.capacity_);
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  /// Keeps the memory, whatever the buffer does, for who looks at it from outside.
  std::shared_ptr<const void> memory() const { return memory_; }
  Span<T> span() { return {data_, Index(size_)}; }
  Span<const T> span() const { return {data_, Index(size_)}; }
  operator Span<T>() { return span(); }
  operator Span<const T>() const { return span(); }

 private:
  std::shared_ptr<void> memory_;
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace BL_SOLVER
