#pragma once
// What a run leaves in its folder:
//   case.resolved.toml      every parameter with its default; version, device, seed
//   fluid|grains|walls.vtkhdf  frames as temporal PolyData, an .xdmf side-car beside each
//   probes/<name>.csv       one table per probe
//   diagnostics.csv         masses, momenta, energies, extremes, counters
//   checkpoints/step_*.h5   the kept state
//   summary.json            how the run ended

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

/// What a run has done so far, beside its steps.
struct Effort {
  double wall_seconds = 0;
  std::int64_t particle_steps = 0, substeps = 0, rebuilds = 0;
  std::array<std::int64_t, kLimits.size()> steps_by{}, substeps_by{};  ///< how many each limit bound
};

/// The results folder of one run. Everything is copied to the host when asked
/// for and written by one thread of its own; an error in there (FileError)
/// surfaces in the next call.
class RunOutput {
 public:
  /// Makes the folder, removes what a former run left there and writes case.resolved.toml. With `continued`,
  /// which has the state of a checkpoint, it goes on with the run in the folder instead, and here only
  /// examines what is there; what lies after the checkpoint is removed when a first step has been made.
  /// Throws FileError, with everything as it was.
  RunOutput(const std::filesystem::path& dir, const Config& config, const Device& device, std::string version,
            Simulation* continued = nullptr);
  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// Of a run that goes on: what the folder lacks of that which the run of the case `former` has written
  /// until the checkpoint, a clause each.
  std::vector<std::string> gaps(const Config& former) const;

  /// Writes the frames, diagnostics, probes and checkpoint that fell due by
  /// info.time; call it after start() and after every step.
  void write(Simulation& simulation, const StepInfo& info);

  /// Saves the state as checkpoints/step_<step>.h5 and returns once it is safely on disk.
  std::filesystem::path checkpoint(Simulation& simulation);

  /// Is told of every row that is written from now on: table ("diagnostics", "probes/gauge"), time (s),
  /// values.
  using RowWatcher = std::function<void(const std::string&, double, const std::vector<Quantity>&)>;
  void watch_rows(RowWatcher watcher);

  /// Notes a warning for summary.json.
  void warn(std::string message);

  /// Quantities for summary.json, under that name, and what must be known of them, if anything.
  void add(std::string name, std::vector<Quantity> quantities, std::string note = {});

  /// Ends the output: last frame and rows, checkpoint, summary.json. `status` is
  /// "completed", "stopped" or "failed"; the state of a failed run is shown in a
  /// frame but not kept as a checkpoint. A run that goes on and was stopped before its
  /// first step, or begins at the end of a completed one, leaves everything as it was.
  void finish(Simulation& simulation, const std::string& status, const Effort& effort);

  /// The newest checkpoint on disk, empty if there is none.
  std::filesystem::path last_checkpoint() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The state in a checkpoint made for this case: same precision, same particles.
/// Throws FileError with file and reason.
SavedState read_checkpoint(const std::filesystem::path& path, const Config& config);

/// The numbers by which a checkpoint knows the particles of its case, e.g. "grain.fill.0.count". Throws
/// FileError.
std::map<std::string, double> checkpoint_setup(const std::filesystem::path& path);

/// The resolved case that a checkpoint was made with. Throws FileError.
std::string checkpoint_case(const std::filesystem::path& path);

/// The checkpoint of a results folder with the most steps. Throws FileError if there is none.
std::filesystem::path latest_checkpoint(const std::filesystem::path& dir);

/// Writes a checkpoint: first beside its place, then synced and renamed. The same
/// state gives the same bytes. Throws FileError.
void write_state(const std::filesystem::path& path, const SavedState& state, const Config& config);

}  // namespace bedload
