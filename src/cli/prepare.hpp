#pragma once
// The part that all commands with a case share: read it, find the device, place the particles.

#include <optional>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "bedload/simulation.hpp"
#include "options.hpp"

namespace bedload {

/// A case ready to start, from the beginning or from a checkpoint.
struct Prepared {
  Config config;
  Device device;
  Setup setup;                   ///< empty for a restart
  SavedState restart;            ///< empty without a restart
  double begin = 0;              ///< start time, s
  double last_dt = 0;            ///< last step before a restart, s
  std::optional<Config> former;  ///< case of the checkpoint, if that lies in the results folder
  Counts counts;
  MemoryEstimate memory;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;  ///< valid, but may surprise
};

/// Reads the case, finds the device, prints both, then places the particles or reads the checkpoint. Throws
/// CaseError, before any particle is placed, if they would not fit the memory of the device.
Prepared prepare(const Options& options);
/// The same for a case that has been read: `prepared` has its config. Prints nothing.
void initialise(const Options& options, Prepared& prepared);

/// Throws KeyError if time.dt exceeds a step limit, or time.dt_dem one of free bodies; with time.force_dt it
/// warns instead. Call after start().
void check_fixed_steps(Prepared& prepared, Simulation& simulation);

/// Counts at the end of the run including inflow, at most as many as fit into the domain.
Counts with_inflow(const Prepared& prepared);

/// "12 345 678".
std::string grouped(std::int64_t number);
/// "1.2 GB".
std::string bytes_text(std::size_t bytes);

/// Case, device and size of meshes, known before particles are placed; a line each.
std::string heading_text(const Prepared& prepared);
/// Particle counts, sound speed, artificial viscosity, inlets, coupling; a line each.
std::string summary_text(const Prepared& prepared);
/// The notes, a line each.
std::string notes_text(const Prepared& prepared);

}  // namespace bedload
