#pragma once
// Histories of the pairs of a list, by slot, as separate arrays: only those that the laws of a case need
// exist.

#include "kernels/contact/history.hpp"

namespace bedload::inline BL_VARIANT {

struct PairHistories {
  /// Along the normal. They are not accumulated, so Real is precise enough.
  struct Normal {
    Real overlap, recede;
  };
  std::uint8_t* touching = nullptr;  ///< 1: in contact at the last evaluation; else there is no history
  Normal* normal = nullptr;
  Vec3d* xi = nullptr;      ///< null: no law has a tangential spring
  Vec3d* couple = nullptr;  ///< null: no law has an elastic couple

  BL_HD ContactHistory operator[](std::uint64_t slot) const {
    ContactHistory h;
    const Normal n = normal[slot];
    h.overlap = n.overlap, h.recede = n.recede;
    if (xi) h.xi = xi[slot];
    if (couple) h.couple = couple[slot];
    return h;
  }
  BL_HD void store(std::uint64_t slot, const ContactHistory& h) const {
    normal[slot] = {Real(h.overlap), Real(h.recede)};
    if (xi) xi[slot] = h.xi;
    if (couple) couple[slot] = h.couple;
  }
};

}  // namespace bedload::inline BL_VARIANT
