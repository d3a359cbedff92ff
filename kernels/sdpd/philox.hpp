#pragma once
#include <cstdint>

#include "bedload/core/types.hpp"
#include "bedload/core/vec.hpp"

namespace BL_SOLVER {

/// Four words of 32 bits.
struct Words {
  std::uint32_t x, y, z, w;
};

/// Philox 4x32 of ten rounds [salmon11]: random words that depend on the counter and the key alone, so that
/// they are the same in any order, on any device and after any restart.
BL_HD Words philox(Words c, std::uint32_t key_low, std::uint32_t key_high) {
#if defined(__CUDACC__)
#pragma unroll
#else
#pragma GCC unroll 10
#endif
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p = std::uint64_t(0xd2511f53u) * c.x, q = std::uint64_t(0xcd9e8d57u) * c.z;
    c = {std::uint32_t(q >> 32) ^ c.y ^ key_low, std::uint32_t(q), std::uint32_t(p >> 32) ^ c.w ^ key_high,
         std::uint32_t(p)};
    key_low += 0x9e3779b9u, key_high += 0xbb67ae85u;
  }
  return c;
}

}  // namespace BL_SOLVER
