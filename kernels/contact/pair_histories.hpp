#pragma once
// Histories of the pairs of a list, by slot, as one array for each part: only those that the laws of a case
// need exist.

#include "kernels/contact/history.hpp"

namespace BL_SOLVER {

/// By slot; null: no law needs the part.
template <class Part>
struct PartArray {
  Part* values = nullptr;
};

template <class... Parts>
struct PairHistoriesOf : PartArray<Parts>... {
  std::uint8_t* touching = nullptr;  ///< 1: in contact at the last evaluation; else there is no history

  BL_HD ContactHistory operator[](std::uint64_t slot) const {
    ContactHistory h;
    (read<Parts>(slot, h), ...);
    return h;
  }
  BL_HD void store(std::uint64_t slot, const ContactHistory& h) const { (write<Parts>(slot, h), ...); }

 private:
  template <class Part>
  BL_HD void read(std::uint64_t slot, ContactHistory& h) const {
    const Part* const values = PartArray<Part>::values;
    if (!Part::kOptional || values) values[slot].to(h);
  }
  template <class Part>
  BL_HD void write(std::uint64_t slot, const ContactHistory& h) const {
    Part* const values = PartArray<Part>::values;
    if (!Part::kOptional || values) values[slot].from(h);
  }
};
using PairHistories = HistoryParts::Apply<PairHistoriesOf>;

}  // namespace BL_SOLVER
