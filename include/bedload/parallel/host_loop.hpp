#pragma once
// Threads for host code that knows no variant.

#include <cstddef>

namespace bedload {

/// Calls f(i) for i < n in any order, on several threads; each call may write only what belongs to its i.
template <class F>
void host_for_each(std::size_t n, const F& f) {
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t i = 0; i < n; ++i) f(i);
}

}  // namespace bedload
