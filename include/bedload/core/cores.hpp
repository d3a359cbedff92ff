#pragma once

#include <cstddef>
#include <functional>

namespace bedload {

/// Lets the calling thread run on every core that the process was given. OpenMP, set to bind its threads
/// (OMP_PROC_BIND, OMP_PLACES, GOMP_CPU_AFFINITY), binds the first one to a single core as it is loaded,
/// which threads and programs that this one starts would inherit.
void use_all_cores();

/// Calls f(begin, end) for stretches of 0..n, on all threads, also from code whose compiler has no OpenMP;
/// each may write only what belongs to its stretch. Of several that throw, rethrows what the first stretch
/// threw.
void in_stretches(std::size_t n, const std::function<void(std::size_t, std::size_t)>& f);

}  // namespace bedload
