#pragma once
// The interface of the solver, independent of precision and device, for the
// command line, the writers and Python.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bedload/case/choices.hpp"
#include "bedload/case/config/output.hpp"
#include "bedload/host_data.hpp"
#include "bedload/step_limits.hpp"

namespace bedload {

struct Config;

/// What one step did.
struct StepInfo {
  std::int64_t step = 0;               ///< steps done
  double time = 0;                     ///< s, at the end of the step
  double dt = 0;                       ///< s
  int substeps = 0;                    ///< DEM substeps in it
  Limit limit = Limit::fixed;          ///< active limit of dt
  Limit substep_limit = Limit::fixed;  ///< active limit of substeps, if there are several
  double vmax = 0;                     ///< m/s, fastest fluid particle
  bool rebuilt = false;                ///< neighbour lists were rebuilt
};

struct Counts {
  std::int64_t fluid = 0, walls = 0, grains = 0;
};

/// What one of several ranks has, and what it has done so far.
struct RankReport {
  Counts own;                  ///< particles
  std::int64_t ghosts = 0;     ///< copies of particles of others
  std::size_t bytes = 0;       ///< of memory that it holds
  std::int64_t exchanges = 0;  ///< of values with other ranks
  std::int64_t migrated = 0;   ///< particles that others own since
  double sent = 0;             ///< bytes to others
  double waited = 0;           ///< for others, s
};

/// Losses through one side of the domain.
struct Loss {
  std::string phase;           ///< fluid, grains
  std::string side;            ///< "x-" .. "z+"
  double count = 0, mass = 0;  ///< -, kg
  double first = 0;            ///< time of the first loss, s
};

/// What will be there: the function waits for it, and is called once, by any thread.
template <class T>
using Later = std::function<T()>;

class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Advances fluid and grains by one step. Throws SimulationFault.
  virtual StepInfo step() = 0;
  /// Settles the grains without fluid until they rest or for at most `longest` s; the
  /// clock does not advance. Calls `progress` with the settling time so far (s) now and then.
  virtual void settle(double longest, const std::function<void(double)>& progress) = 0;
  /// Initialises the fluid around the grains (its mass by the porosity) and evaluates
  /// everything once. Called once, before the first step, not after load().
  virtual void start() = 0;

  virtual double time() const = 0;  ///< s
  virtual std::int64_t steps() const = 0;
  virtual Counts counts() const = 0;
  virtual std::vector<StepLimit> limits() = 0;
  /// Limits on a substep of grains and free bodies.
  virtual std::vector<StepLimit> substep_limits() const = 0;
  /// Numerical viscosities as multiples of the physical one: "artificial_bulk" and "artificial_bed", of
  /// visc.alpha; "local_slip_bed", of drag that follows the slip of each particle, in a bed of porosity 0.4.
  /// Zero where there is none; empty without viscous fluid. Density diffusion is not included: it smooths
  /// density, not velocity.
  virtual std::vector<Quantity> numerical_viscosity() const = 0;
  /// Current memory on the device (or of the host), bytes.
  virtual std::size_t bytes() const = 0;
  /// Memory of the fields, by particle; known before there are particles.
  virtual ParticleBytes field_bytes() const = 0;
  /// And of what solvers have beside them: for each particle, and each entry in the lists of near grains.
  virtual ParticleBytes scratch_bytes() const = 0;
  /// Estimated growth of bytes() in fast flow, where neighbour lists reach farther, bytes.
  virtual std::size_t growth() = 0;
  /// Wall time by part over all steps, s: "lists", "fluid", "grains", "coupling", "checks", as far as the
  /// case has them.
  virtual std::vector<Quantity> time_spent() const = 0;
  /// Of each rank; empty where there is one.
  virtual std::vector<RankReport> ranks() { return {}; }

  /// Output fields of a store: "fluid", "grains", "clumps" or "walls", first array "position"; or "contacts",
  /// lines of the grains' contacts, first array "ends".
  virtual HostStore snapshot(const std::string& store) = 0;
  /// The same, of now: steps that follow need not wait for the copy.
  virtual Later<HostStore> snapshot_later(const std::string& store) {
    return [taken = std::make_shared<HostStore>(snapshot(store))] { return std::move(*taken); };
  }
  /// Data for the rheology of "fluid" or "grains", after a step: arrays position (m), velocity (m/s), mass
  /// (kg), volume (m3, of a grain, or the mixture volume of fluid), drive (N, by gravity and drive)
  /// and stress_... (J), one per part of the pair forces: [3 i + j] is half the sum of F_i r_j, so that minus
  /// its sum over a volume, divided by that volume, is a stress.
  virtual HostStore rheology(const std::string& store) = 0;
  /// Views of the fields of a snapshot that the solver stores, and of the fluid mass, in its own order.
  virtual std::vector<FieldView> fields(const std::string& store) = 0;
  /// Masses, momenta, energies, extremes, counters; see output/diagnostics.
  virtual std::vector<Quantity> diagnostics() = 0;
  /// Rows of spectra.csv: the lower edge of a bin, J, and number and energy of the contacts in it, by pair of
  /// materials. Empty if the case does not ask.
  virtual std::vector<std::vector<Quantity>> spectra() { return {}; }
  /// Likewise rows of spectra_peaks.csv, of peak elastic energies and normal forces.
  virtual std::vector<std::vector<Quantity>> spectra_peaks() { return {}; }
  /// Values of a probe: with `sample = "mean"`, for a probe of the case, the mean over its interval so far;
  /// else the current values.
  virtual std::vector<Quantity> measure(const ProbeConfig& probe) = 0;
  /// Begins a new interval for the means of a probe, after its row was written.
  virtual void begin_interval(const ProbeConfig& probe) = 0;
  /// Losses through sides of the domain that are no outlets, by side; only of sides with
  /// losses.
  virtual std::vector<Loss> losses() = 0;
  /// Position, velocity, forces and their power of a wall body, by its index in the case; rigid groups of
  /// grains follow the wall bodies.
  virtual std::vector<Quantity> body_state(int body) = 0;

  /// Saves and restores the state; a restart continues bit for bit.
  virtual SavedState save() = 0;
  virtual void load(const SavedState& state) = 0;

  /// Settled grains with their contacts, for the cache between settle() and start().
  virtual SavedState save_grains() = 0;
  virtual void load_grains(const SavedState& state) = 0;
};

/// The device that a case runs on.
struct Device {
  std::string backend;     ///< cpu, cuda
  std::string name;        ///< "NVIDIA H100 80GB HBM3", "AMD EPYC ..., AVX2, 2 threads"
  std::size_t memory = 0;  ///< free memory, bytes; with several ranks, of the one that has least
  bool avx2 = false;       ///< CPU with the AVX2 build of the solver
  int ranks = 1;  ///< parts into which particles are divided, each with its own GPU or share of the CPU
  std::vector<int> gpus;  ///< of each rank; empty: the first
  bool cuda() const { return backend == "cuda"; }
  /// Its name, and into how many parts it is divided or how many there are.
  std::string text() const {
    if (ranks == 1) return name;
    return cuda() ? std::to_string(ranks) + " x " + name : name + ", " + std::to_string(ranks) + " ranks";
  }
  /// The first GPU, or the whole CPU, for one rank.
  Device undivided() const {
    Device one = *this;
    one.ranks = 1;
    if (cuda())
      one.gpus.resize(std::min<std::size_t>(1, gpus.size()));
    else
      one.memory *= std::size_t(ranks);
    return one;
  }
};

/// backend: auto, cpu, cuda. `auto` uses a GPU if this build has CUDA. simd is run.simd. Throws
/// DeviceError if there is no such device, KeyError if the CPU has no such instructions.
Device find_device(const std::string& backend, int threads, Simd simd = Simd::automatic);

/// Divides a simulation on `device` among ranks: as many parts of the CPU (1: one), or GPUs, "4", "0,2,3" or
/// "all" (empty: one). Throws DeviceError where there are not as many.
void divide_among(Device& device, int ranks, const std::string& gpus);

/// Free memory of each GPU of this machine, bytes; empty without.
std::vector<std::size_t> free_of_gpus();

/// Builds the solver for config.precision on `device`. Throws KeyError for what cannot be divided among
/// ranks.
std::unique_ptr<Simulation> make_simulation(const Config& config, const Setup& setup, const Device& device);
/// A copy of a field of a simulation on `device`. Throws DeviceError.
HostArray host_copy(const FieldView& view, const Device& device);

/// What a case takes of the device's memory, about: bytes of each particle, and of what does not depend on
/// them.
struct MemoryEstimate {
  double fluid = 0, walls = 0, grains = 0;
  double rest = 32 << 20;
  int ranks = 1;

  /// With several ranks, of the one that takes most.
  std::size_t of(const Counts& n) const {
    constexpr double more = 1.2;  // ghosts, and a larger part than others
    const double whole = double(n.fluid) * fluid + double(n.walls) * walls + double(n.grains) * grains;
    return std::size_t((ranks == 1 ? whole : whole * more / ranks) + rest);
  }
};
/// From the fields of its stores and the scratch of its solvers, which are made without particles for it, and
/// lists of usual length. Throws as make_simulation does.
MemoryEstimate estimate_memory(const Config& config, const Device& device);

}  // namespace bedload
