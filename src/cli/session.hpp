#pragma once
// A run under way, for the program and for Python.

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

/// Throws FileError if options.out holds a run, unless it is restarted from or overwritten.
void refuse_other_run(const Options& options);

/// A simulation with its results folder, if it has one, from before its first step to its end.
class Session {
 public:
  using Say = std::function<void(const std::string&)>;

  /// The simulation at its first step: from a checkpoint, over settled grains, or as initialised. Results go
  /// to options.out, if it is not empty. `say` is told what is going on, a line each. Throws as what it
  /// calls.
  Session(const Options& options, Prepared prepared, const Say& say);

  /// Writes the first frames, unless the run goes on from a checkpoint.
  void begin();
  /// One step, and what of it is due to be written. May add to the warnings.
  StepInfo step();
  /// Ends the results; status as in RunOutput::finish.
  void finish(const std::string& status);

  Simulation& simulation() { return *simulation_; }
  RunOutput* output() { return output_ ? &*output_ : nullptr; }
  const Prepared& prepared() const { return p_; }
  /// What has been done so far, up to now.
  Effort effort() const;

 private:
  void build(const Options& options, const Say& say);
  void warn(const std::string& text);
  void tell_gaps(const Options& options);
  SavedState settled(const Options& options, const Say& say);

  Prepared p_;
  std::unique_ptr<Simulation> simulation_;
  std::optional<RunOutput> output_;
  OutputIntervals intervals_;
  SpeedWatch speed_watch_;
  bool continues_;
  Effort effort_;
  std::chrono::steady_clock::time_point from_ = std::chrono::steady_clock::now();
};

}  // namespace bedload
