#include "bedload/core/cores.hpp"

#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
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

void in_stretches(std::size_t n, const std::function<void(std::size_t, std::size_t)>& f) {
  constexpr std::size_t length = 1 << 14;
  const auto stretches = std::int64_t((n + length - 1) / length);
  std::int64_t failed = stretches;
  std::exception_ptr error;
#pragma omp parallel for schedule(static) if (stretches > 1)
  for (std::int64_t s = 0; s < stretches; ++s) {
    const std::size_t begin = std::size_t(s) * length;
    try {
      f(begin, std::min(begin + length, n));
    } catch (...) {
#pragma omp critical(bedload_in_stretches)
      if (s < failed) failed = s, error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace bedload
