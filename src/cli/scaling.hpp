#pragma once
// How the time of a step depends on the number of ranks, for `bedload bench`.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bedload/simulation.hpp"

namespace bedload {

/// One case on so many ranks.
struct ScalingRow {
  std::string name, precision;
  std::string
      kind;  ///< "strong": one case; "weak": one that grows with the ranks; empty: there is no other row
  int ranks = 1;
  double rate = 0;  ///< particle-steps/s
  double ms = 0;    ///< a step
  // How ranks share the work; 0 for one rank.
  double wait_percent = 0;   ///< of the time, for others; mean of ranks
  double ghost_percent = 0;  ///< copies of particles of others over all particles
  double imbalance = 1;      ///< most particles of a rank over the mean
  double exchanges = 0;      ///< a step
  double sent_mb = 0;        ///< a step, by the rank that sends most, MB
  double migrated = 0;       ///< particles a step, from all ranks

  /// From what ranks report before and after so many steps in so many seconds.
  void share(const std::vector<RankReport>& from, const std::vector<RankReport>& to, int steps,
             double seconds);
};

/// Rate over that of the row with the fewest ranks among those of the same case, precision and kind.
double speed_up(const ScalingRow& row, const std::vector<ScalingRow>& rows);
/// And over what as many times the ranks could do at best, %.
double efficiency_percent(const ScalingRow& row, const std::vector<ScalingRow>& rows);

/// Rows of a kind, below a header.
std::vector<std::vector<std::string>> scaling_table(const std::string& kind,
                                                    const std::vector<ScalingRow>& rows);
/// Adds a row's values.
void add_scaling(const ScalingRow& row, const std::vector<ScalingRow>& rows, nlohmann::ordered_json& to);

}  // namespace bedload
