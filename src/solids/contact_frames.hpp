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
  /// The same of lubrication, and walls that are near: see NearWallsPass.
  void record(Range grains, const LubricationPass& films, std::size_t slots) {
    films_.reserve_and_resize(slots);
    for_each(grains, SinglePairFilms{films, films_.data()});
  }
  void record(const WallContacts& walls, const WallRows& rows, double gap, double range) {
    near_walls_.reserve_and_resize(std::size_t(rows.grain.size) * kMostWallContacts);
    near_count_.reserve_and_resize(rows.grain.size);
    for_each({0, rows.grain.size},
             NearWallsPass{walls, rows, gap, range, near_walls_.data(), near_count_.data()});
  }
  /// When the lists change, or a state is loaded.
  void forget() { recorded_ = false; }

  bool recorded() const { return recorded_; }
  std::vector<Real3> of_pairs() const { return of_pairs_.to_host(); }
  std::vector<Real3> at_walls() const { return at_walls_.to_host(); }
  std::vector<Real3> films() const { return films_.to_host(); }
  /// Of all grains, in the order of their rows.
  std::vector<NearWall> near_walls() const {
    const std::vector<NearWall> all = near_walls_.to_host();
    const std::vector<Index> count = near_count_.to_host();
    std::vector<NearWall> out;
    for (std::size_t row = 0; row < count.size(); ++row)
      out.insert(out.end(), all.begin() + std::ptrdiff_t(row * kMostWallContacts),
                 all.begin() + std::ptrdiff_t(row * kMostWallContacts + count[row]));
    return out;
  }

 private:
  bool recorded_ = false;
  Buffer<Real3> of_pairs_, at_walls_, films_;
  Buffer<NearWall> near_walls_;
  Buffer<Index> near_count_;
};

}  // namespace BL_SOLVER
