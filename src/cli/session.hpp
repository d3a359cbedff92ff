#pragma once
// A run, for the program and for Python.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "bedload/output/intervals.hpp"
#include "bedload/output/output.hpp"
#include "options.hpp"
#include "prepare.hpp"
#include "speed_watch.hpp"

namespace bedload {

/// Throws FileError if options.out holds a run, unless it is restarted or overwritten.
void refuse_other_run(const Options& options);

/// A simulation and its results folder, if it has one, from start to end.
class Session {
 public:
  using Print = std::function<void(const std::string&)>;

  /// Starts the simulation: from a checkpoint, from settled grains, or as initialised. Results go to
  /// options.out, if it is not empty. `print` gets one line per stage of the start.
  Session(const Options& options, Prepared prepared, const Print& print);

  /// Writes the first frames, unless the run is a restart.
  void begin();
  /// One step and the output that is due. May add warnings.
  StepInfo step();
  /// Writes the last results; status as in RunOutput::finish.
  void finish(const std::string& status);

  Simulation& simulation() { return *simulation_; }
  RunOutput* output() { return output_ ? &*output_ : nullptr; }
  const Prepared& prepared() const { return p_; }
  /// Steps and wall time so far.
  RunTotals totals() const;

 private:
  void build(const Options& options, const Print& print);
  void warn(const std::string& text);
  void report_gaps(const Options& options);
  SavedState settled(const Options& options, const Print& print);

  Prepared p_;
  std::unique_ptr<Simulation> simulation_;
  std::optional<RunOutput> output_;
  OutputIntervals intervals_;
  SpeedWatch speed_watch_;
  bool restarted_;
  RunTotals totals_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace bedload
