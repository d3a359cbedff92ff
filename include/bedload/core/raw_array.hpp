#pragma once
#include <type_traits>

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// An array of which nothing is set before it is assigned: on a GPU setting it is work of every thread.
template <class T, int N>
class RawArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_aggregate_v<T>);

 public:
  BL_HD T& operator[](int k) { return reinterpret_cast<T*>(bytes_)[k]; }
  BL_HD const T& operator[](int k) const { return reinterpret_cast<const T*>(bytes_)[k]; }

 private:
  alignas(T) unsigned char bytes_[N * sizeof(T)];
};

}  // namespace BL_SOLVER
