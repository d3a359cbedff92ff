#pragma once
// Pointer and length: what kernels see of an array.

#include <type_traits>

#include "bedload/core/records.hpp"

namespace BL_SOLVER {

template <class T>
struct Span {
  T* data = nullptr;
  Index size = 0;

  Span() = default;
  BL_HD Span(T* d, Index n) : data(d), size(n) {}
  template <class U>
  requires(std::is_same_v<const U, T>) BL_HD Span(const Span<U>& o) : data(o.data), size(o.size) {}

  BL_HD T& operator[](Index i) const { return data[i]; }
#if !BL_CUDA
  auto operator[](PackIndex j) const { return gather(static_cast<const std::remove_const_t<T>*>(data), j); }
  auto operator[](PackRun j) const { return gather(static_cast<const std::remove_const_t<T>*>(data), j); }
#endif
  BL_HD explicit operator bool() const { return data != nullptr; }
};

/// Owned particles [begin, end) of a store; ghosts, when there are any, follow.
struct Range {
  Index begin = 0, end = 0;
  BL_HD Index size() const { return end - begin; }
};

}  // namespace BL_SOLVER
