#pragma once

namespace bedload {

/// Lets the calling thread run on every core that the process was given. OpenMP, set to bind its threads
/// (OMP_PROC_BIND, OMP_PLACES, GOMP_CPU_AFFINITY), binds the first one to a single core as it is loaded,
/// which threads and programs that this one starts would inherit.
void use_all_cores();

}  // namespace bedload
