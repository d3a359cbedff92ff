#pragma once
#include "bedload/parallel/sort.hpp"

namespace BL_SOLVER {

namespace detail {

template <class Keep>
struct KeepFlagPass {
  Keep keep;
  Span<Index> flag;
  BL_HD void operator()(Index i) const { flag[i] = keep(i) ? 1 : 0; }
};

struct KeptPlacePass {
  Span<const Index> flag, before;
  Span<Index> kept;
  BL_HD void operator()(Index i) const {
    if (flag[i]) kept[before[i]] = i;
  }
};

}  // namespace detail

/// kept: i of 0..n for which keep(i) holds, ascending. Waits for the device.
template <class Keep>
void find_all(Index n, const Keep& keep, Buffer<Index>& kept) {
  Buffer<Index>&flag = Context::current().scratch<Index>(1), &before = Context::current().scratch<Index>(2);
  flag.reserve_and_resize(n), before.reserve_and_resize(n + 1);
  for_each({0, n}, detail::KeepFlagPass<Keep>{keep, flag});
  kept.resize(exclusive_scan(flag, before));
  for_each({0, n}, detail::KeptPlacePass{flag, before, kept});
}

}  // namespace BL_SOLVER
