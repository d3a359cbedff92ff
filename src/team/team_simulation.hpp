#pragma once
// One simulation on several ranks, which looks like one.

#include <functional>
#include <memory>

#include "bedload/parallel/link.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// How ranks are made and how long they wait for one another.
struct TeamOptions {
  int ranks = 1;
  double timeout = 60;                  ///< s
  std::vector<std::string> names = {};  ///< of ranks, for messages; empty: their numbers
  /// Called on the thread of each rank; makes its part.
  std::function<std::unique_ptr<Simulation>(Link&)> make;
};

std::unique_ptr<Simulation> make_team(const TeamOptions& options);

/// The entries of all ranks in the order in which one rank would have them: by the numbers of the array
/// "block", which it drops, and where these are equal as their owner has them. Without such an array, those
/// of the first.
HostStore joined(std::vector<HostStore> parts);
/// The same of all stores; scalars are those of the first.
SavedState joined(std::vector<SavedState> parts);

}  // namespace bedload
