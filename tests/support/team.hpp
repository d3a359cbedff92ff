#pragma once
// Simulations of this build on several ranks.

#include <random>

#include "src/team/team_simulation.hpp"
#include "tests/support/run.hpp"

namespace BL_SOLVER {

inline std::unique_ptr<Simulation> make_divided(const Config& config, const Setup& setup, int ranks,
                                                double timeout = 60) {
  if (ranks == 1) return make_coupled(config, setup);
  return make_team({.ranks = ranks, .timeout = timeout, .make = [&](Link& link) {
                      return make_coupled(config, setup, &link);
                    }});
}

}  // namespace BL_SOLVER
