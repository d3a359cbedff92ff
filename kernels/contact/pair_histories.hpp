#pragma once
// Histories of the pairs of a list, by slot, as one array for each part.

#include "kernels/contact/history.hpp"

namespace BL_SOLVER {

template <class Part>
struct PartArray {
  Part* values = nullptr;  ///< by slot
};

template <class... Parts>
struct PairHistoriesOf : PartArray<Parts>... {
  std::uint8_t* touching = nullptr;  ///< 1: in contact at the last evaluation; else there is no history

  BL_HD PairHistory operator[](std::uint64_t slot) const {
    PairHistory h;
    (PartArray<Parts>::values[slot].to(h), ...);
    return h;
  }
  BL_HD void store(std::uint64_t slot, const PairHistory& h) const {
    (PartArray<Parts>::values[slot].from(h), ...);
  }
};
using PairHistories = HistoryParts::Apply<PairHistoriesOf>;

}  // namespace BL_SOLVER
