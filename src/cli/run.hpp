#pragma once
// One run from its beginning to its end, for the commands that make one.

#include <string>
#include <vector>

#include "commands.hpp"
#include "prepare.hpp"

namespace bedload {

/// What a watcher has to say in summary.json.
struct RunFindings {
  std::string name;
  std::vector<Quantity> quantities;
  std::vector<std::string> warnings;
  std::string note;  ///< what must be known of the quantities; empty: nothing
};

/// Looks on while a case runs.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  /// Once, before anything is written; end: of the run, s. Throws KeyError where it cannot use the case.
  virtual void begin(const Config& config, double end) = 0;
  virtual void after_step(Simulation& simulation, const StepInfo& info) = 0;
  /// At the end of a run that was not stopped.
  virtual RunFindings findings() = 0;
};

class LiveView;

/// Runs a case that is read and whose particles are placed; returns the exit code, as run_case.
int run_prepared(const Options& options, Prepared prepared, RunWatcher* watcher = nullptr,
                 LiveView* live = nullptr);

}  // namespace bedload
