#pragma once
// Searches through many particles, on all threads.

#include <atomic>
#include <cstddef>

#include "bedload/core/cores.hpp"

namespace bedload {

/// The first n of begin..end for which holds(n); none: end.
template <class F>
std::size_t first_where(std::size_t begin, std::size_t end, const F& holds) {
  std::atomic<std::size_t> least = end;
  in_stretches(end - begin, [&](std::size_t from, std::size_t to) {
    for (std::size_t n = begin + from; n < begin + to && n < least; ++n) {
      if (!holds(n)) continue;
      for (std::size_t so_far = least; n < so_far && !least.compare_exchange_weak(so_far, n);) continue;
      return;
    }
  });
  return least;
}

}  // namespace bedload
