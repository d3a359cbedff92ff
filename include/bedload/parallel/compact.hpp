#pragma once
#include "bedload/parallel/sort.hpp"

namespace bedload::inline BL_VARIANT {

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

/// Finds what is to stay, where the particles are.
class Compaction {
 public:
  /// i of 0..n for which keep(i) holds, ascending. Waits for the device.
  template <class Keep>
  void find(Index n, const Keep& keep, Buffer<Index>& kept) {
    flag_.resize(n);
    for_each({0, n}, detail::KeepFlagPass<Keep>{keep, flag_});
    kept.resize(sorter_.exclusive_scan(flag_, before_));
    for_each({0, n}, detail::KeptPlacePass{flag_, before_, kept});
  }

 private:
  Buffer<Index> flag_, before_;
  Sorter sorter_;
};

}  // namespace bedload::inline BL_VARIANT
