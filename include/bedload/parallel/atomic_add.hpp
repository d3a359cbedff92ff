#pragma once
// Sums of integers by all threads at once: the same in any order.

#include <cstdint>

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// Adds `value`, modulo 2^64; returns what was there before.
BL_HD std::uint64_t atomic_add(std::uint64_t& to, std::uint64_t value) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(reinterpret_cast<unsigned long long*>(&to), static_cast<unsigned long long>(value));
#else
  return __atomic_fetch_add(&to, value, __ATOMIC_RELAXED);
#endif
}

}  // namespace BL_SOLVER
