#pragma once
// Memory of the host for what leaves the solver.

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace bedload {

/// Takes and gives back large blocks, which are kept for the next frame or checkpoint, up to most_kept()
/// bytes in all. For a GPU they are page-locked, which makes copies to them several times as fast, and lets
/// the host go on meanwhile. For all threads.
class HostMemory {
 public:
  using Allocate = void* (*)(std::size_t);  ///< null where there is no more
  using Free = void (*)(void*);
  /// Where blocks are taken from from now on, std::malloc by default, and how many bytes of them are kept.
  static void use(Allocate allocate, Free free, std::size_t most = std::size_t(2) << 30);
  static std::size_t most_kept();
  /// Throws std::bad_alloc. Aligned to 64 bytes.
  static void* take(std::size_t bytes);
  static void give_back(void* block) noexcept;
  /// Bytes that wait to be taken again.
  static std::size_t kept();
};

/// Of HostMemory. What a vector adds without a value is not set to zero.
template <class T>
struct HostAllocator {
  using value_type = T;
  HostAllocator() = default;
  template <class U>
  HostAllocator(const HostAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(HostMemory::take(n * sizeof(T))); }
  void deallocate(T* block, std::size_t) noexcept { HostMemory::give_back(block); }
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... A>
  void construct(U* at, A&&... with) {
    ::new (static_cast<void*>(at)) U(std::forward<A>(with)...);
  }
  friend bool operator==(const HostAllocator&, const HostAllocator&) { return true; }
};

using HostBytes = std::vector<std::byte, HostAllocator<std::byte>>;

}  // namespace bedload
