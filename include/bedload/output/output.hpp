#pragma once
// The results folder of a run:
//   case.resolved.toml      every parameter with its default; version, device, seed
//   fluid|grains|walls.vtkhdf  frames as temporal PolyData, each with an .xdmf file
//   probes/<name>.csv       one table per probe
//   diagnostics.csv         masses, momenta, energies, extremes, counters
//   checkpoints/step_*.h5   state for a restart
//   summary.json            status, counts, timing, last values

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// Throws KeyError unless some store of the simulation has each field that out.fields names.
void check_fields(Simulation& simulation, const Config& config);

/// Totals of a run so far.
struct RunTotals {
  double wall_seconds = 0;
  std::int64_t particle_steps = 0, substeps = 0, rebuilds = 0;
  std::array<std::int64_t, kLimits.size()> steps_by{}, substeps_by{};  ///< counts by the active limit
};

/// Of output so far, s: how long steps waited for the thread that writes, and how long that was at work.
struct OutputTimes {
  double waited = 0, writing = 0;
};

/// The results folder of one run. A separate thread writes it; its errors (FileError) surface in the next
/// call.
class RunOutput {
 public:
  /// Creates the folder, removes the files of an earlier run and writes case.resolved.toml. With `restarted`,
  /// a simulation loaded from a checkpoint, it continues the run in the folder instead: here it only examines
  /// the files; data after the checkpoint are removed after the first step. Throws FileError without changing
  /// anything.
  RunOutput(const std::filesystem::path& dir, const Config& config, const Device& device, std::string version,
            Simulation* restarted = nullptr);
  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// For a restart: data missing from the folder that the run of the case `former` has written up to the
  /// checkpoint, a clause each.
  std::vector<std::string> gaps(const Config& former) const;

  /// Writes the frames, diagnostics, probes and checkpoint that are due at info.time; call after start() and
  /// after every step.
  void write(Simulation& simulation, const StepInfo& info);

  /// Saves the state as checkpoints/step_<step>.h5 and returns once it is safely on disk.
  std::filesystem::path checkpoint(Simulation& simulation);

  /// Called with every row that is written from now on: table ("diagnostics", "probes/gauge"), time (s),
  /// values.
  using RowWatcher = std::function<void(const std::string&, double, const std::vector<Quantity>&)>;
  void watch_rows(RowWatcher watcher);

  /// Adds a warning to summary.json.
  void warn(std::string message);

  /// Adds quantities under that name to summary.json, with a caveat if there is one.
  void add(std::string name, std::vector<Quantity> quantities, std::string note = {});

  /// Ends the output: last frame and rows, checkpoint, summary.json. `status` is "completed", "stopped" or
  /// "failed"; a failed run gets a last frame but no checkpoint. A restart that was stopped before its first
  /// step, or starts at the end of a completed run, changes nothing.
  void finish(Simulation& simulation, const std::string& status, const RunTotals& totals);

  OutputTimes times() const;

  /// The newest checkpoint on disk, empty if there is none.
  std::filesystem::path last_checkpoint() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The state in a checkpoint of this case: same precision, same particles.
/// Throws FileError with file and reason.
SavedState read_checkpoint(const std::filesystem::path& path, const Config& config);

/// The numbers that define the particles of the case of a checkpoint, e.g. "grain.fill.0.count". Throws
/// FileError.
std::map<std::string, double> checkpoint_setup(const std::filesystem::path& path);

/// The resolved case of a checkpoint. Throws FileError.
std::string checkpoint_case(const std::filesystem::path& path);

/// The newest checkpoint of a results folder. Throws FileError if there is none.
std::filesystem::path latest_checkpoint(const std::filesystem::path& dir);

/// Writes a checkpoint to a temporary file, syncs and renames it. The same state gives the same bytes. Throws
/// FileError.
void write_state(const std::filesystem::path& path, const SavedState& state, const Config& config);

}  // namespace bedload
