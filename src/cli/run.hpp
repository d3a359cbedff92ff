#pragma once
// One run from start to end, for the commands `run` and `viscometer`.

#include <string>
#include <vector>

#include "commands.hpp"
#include "prepare.hpp"

namespace bedload {

/// Results of a watcher, for summary.json.
struct RunFindings {
  std::string name;
  std::vector<Quantity> quantities;
  std::vector<std::string> warnings;
  std::string note;  ///< caveat about the quantities; may be empty
};

/// Observes a run.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  /// Once, before anything is written; end: of the run, s. Throws KeyError if the case is unsuitable.
  virtual void begin(const Config& config, double end) = 0;
  virtual void after_step(Simulation& simulation, const StepInfo& info) = 0;
  /// Whether a run that was stopped can continue from its checkpoint.
  virtual bool may_restart() const = 0;
  /// At the end of a run that was not stopped; without a name there are none.
  virtual RunFindings findings() { return {}; }
};

class LiveView;

/// Runs a case whose particles are placed; returns the exit code, as run_case.
int run_prepared(const Options& options, Prepared prepared, RunWatcher* watcher = nullptr,
                 LiveView* live = nullptr);

}  // namespace bedload
