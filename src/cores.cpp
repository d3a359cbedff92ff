#include "bedload/core/cores.hpp"

#include <omp.h>
#include <sched.h>

#include <array>
#include <vector>

namespace bedload {

void use_all_cores() {
  std::array<cpu_set_t, 16> cores{};  // 16384
  if (sched_getaffinity(0, sizeof cores, cores.data()) != 0) return;
  // the places of OpenMP (none without binding) are subsets of the cores of the process
  for (int place = 0; place < omp_get_num_places(); ++place) {
    std::vector<int> ids(omp_get_place_num_procs(place));
    omp_get_place_proc_ids(place, ids.data());
    for (const int id : ids) CPU_SET_S(id, sizeof cores, cores.data());
  }
  sched_setaffinity(0, sizeof cores, cores.data());  // a failure changes nothing
}

}  // namespace bedload
