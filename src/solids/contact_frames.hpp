#pragma once
// Single contacts as frames: lines between centres of grains, and from centres to walls.

#include "bedload/host_data.hpp"
#include "bedload/parallel/loops.hpp"
#include "kernels/contact/single_forces.hpp"

namespace BL_SOLVER {

/// Forces of the contacts at the end of an advance, until lists are built anew.
class SingleForces {
 public:
  void record(Range grains, const ContactPass& pairs, std::size_t slots) {
    of_pairs_.reserve_and_resize(slots);
    for_each(grains, SinglePairForces{pairs, of_pairs_.data()});
    recorded_ = true;
  }
  void record(const WallContacts& walls, const WallRows& rows, std::size_t memories) {
    at_walls_.reserve_and_resize(memories);
    for_each({0, rows.grain.size}, SingleWallForces{walls, rows, at_walls_.data()});
  }
  /// When the lists change, or a state is loaded.
  void forget() { recorded_ = false; }

  bool recorded() const { return recorded_; }
  std::vector<Real3> of_pairs() const { return of_pairs_.to_host(); }
  std::vector<Real3> at_walls() const { return at_walls_.to_host(); }

 private:
  bool recorded_ = false;
  Buffer<Real3> of_pairs_, at_walls_;
};

}  // namespace BL_SOLVER
