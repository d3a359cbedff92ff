#pragma once
// What run and check have in common.

#include <optional>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "bedload/simulation.hpp"
#include "options.hpp"

namespace bedload {

/// A case about to be computed, from its beginning or from a checkpoint.
struct Prepared {
  Config config;
  Device device;
  Setup setup;                   ///< none with a checkpoint
  SavedState restart;            ///< none without
  double begin = 0;              ///< time that it goes on from, s
  double last_dt = 0;            ///< the step that ended there, s
  std::optional<Config> former;  ///< of the checkpoint, if it is one of the results folder and can be read
  Counts counts;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;  ///< what is as it should be, but may surprise
};

/// Reads the case, finds the device and says so, places the particles or reads the checkpoint. Throws
/// KeyError for more particles than the device has memory for before any is placed.
Prepared prepare(const Options& options);
/// The same without reading the case: `prepared` has its config.
void initialise(const Options& options, Prepared& prepared);

/// Throws KeyError if time.dt is above a limit, or time.dt_dem above one of free bodies; with time.force_dt
/// it warns. Call after start().
void check_fixed_steps(Prepared& prepared, Simulation& simulation);

/// Counts with all particles that come in until the end, as far as the domain has space for them.
Counts with_arrivals(const Prepared& prepared);

/// "12 345 678".
std::string grouped(std::int64_t number);
/// "1.2 GB".
std::string bytes_text(std::size_t bytes);

/// What is known before particles are placed: case, device, how large meshes are; a line each.
std::string heading_text(const Prepared& prepared);
/// What the numbers mean: particles, sound speed, artificial viscosity; a line each.
std::string summary_text(const Prepared& prepared);
/// What was done as it should be, but may surprise; a line each.
std::string notes_text(const Prepared& prepared);

}  // namespace bedload
