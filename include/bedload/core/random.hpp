#pragma once
#include <cstddef>
#include <cstdint>

namespace bedload {

/// Pure function of seed, stream and counter, so that the n-th draw is the same however
/// many came before it (SplitMix64 finaliser).
class CounterRandom {
 public:
  CounterRandom(std::uint64_t seed, std::uint64_t stream) : key_(mix(seed + mix(stream + 1))) {}

  std::uint64_t bits() { return mix(key_ + 0x9e3779b97f4a7c15u * ++counter_); }
  double uniform() { return double(bits() >> 11) * 0x1p-53; }  // [0, 1)
  std::size_t below(std::size_t n) { return std::size_t(uniform() * double(n)); }

 private:
  static std::uint64_t mix(std::uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
    return v ^ (v >> 31);
  }
  std::uint64_t key_, counter_ = 0;
};

}  // namespace bedload
