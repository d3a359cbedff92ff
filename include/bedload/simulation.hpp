#pragma once
// The solver behind one door: the program and the writers see this class and
// nothing of precision or device.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

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
  Limit limit = Limit::fixed;          ///< what bound dt
  Limit substep_limit = Limit::fixed;  ///< what bounds substeps, if there are several
  double vmax = 0;                     ///< m/s, fastest fluid particle
  bool rebuilt = false;                ///< neighbour lists were renewed
};

struct Counts {
  std::int64_t fluid = 0, walls = 0, grains = 0;
};

/// What has left the domain through one of its sides.
struct Loss {
  std::string phase;           ///< fluid, grains
  std::string side;            ///< "x-" .. "z+"
  double count = 0, mass = 0;  ///< -, kg
  double first = 0;            ///< s, when the first was found outside
};

class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Advances fluid and grains by one step. Throws SimulationFault.
  virtual StepInfo step() = 0;
  /// Grains alone, without fluid, until they rest or `longest` s are over; the
  /// clock stays. Calls `progress` with the time settled so far (s) now and then.
  virtual void settle(double longest, const std::function<void(double)>& progress) = 0;
  /// Initialises the fluid over the settled grains (its mass by the porosity) and
  /// evaluates everything once. Called once, before the first step, not after load().
  virtual void start() = 0;

  virtual double time() const = 0;  ///< s
  virtual std::int64_t steps() const = 0;
  virtual Counts counts() const = 0;
  virtual std::vector<StepLimit> limits() = 0;
  /// Limits on a substep of grains and free bodies.
  virtual std::vector<StepLimit> substep_limits() const = 0;
  /// How much of the run's viscosity is numerical, each as a multiple of the fluid's own: "artificial_bulk"
  /// and "artificial_bed", of visc.alpha; "local_slip_bed", of drag that follows the slip of each particle,
  /// in a bed of porosity 0.4. Zero where there is none; empty without viscous fluid. Density diffusion is
  /// none of them: it smooths density, not velocity.
  virtual std::vector<Quantity> numerical_viscosity() const = 0;
  /// Bytes held on the device (or in host memory), now.
  virtual std::size_t bytes() const = 0;
  /// By how much that grows, about, if the fluid comes to flow so fast that its lists reach farther.
  virtual std::size_t growth() = 0;
  /// Wall time that the parts of all steps took, s: "lists", "fluid", "grains", "coupling", "checks"; those
  /// that the case has.
  virtual std::vector<Quantity> time_spent() const = 0;

  /// Fields for pictures: store is "fluid", "grains" or "walls". First array: "position".
  virtual HostStore snapshot(const std::string& store) = 0;
  /// What the rheology of "fluid" or "grains" is measured by, after a step: arrays position (m), velocity
  /// (m/s), mass (kg), volume (m3, of a grain, or of the mixture that a fluid particle stands for), drive (N,
  /// by gravity and drive) and stress_... (J), one each part of the pair forces: [3 i + j] is the sum of half
  /// of F_i r_j, so that minus its sum over a volume, divided by it, is a stress.
  virtual HostStore rheology(const std::string& store) = 0;
  /// What of a snapshot is kept as it is, and the mass of fluid, in the solver's memory and order.
  virtual std::vector<FieldView> fields(const std::string& store) = 0;
  /// Masses, momenta, energies, extremes, counters; see output/diagnostics.
  virtual std::vector<Quantity> diagnostics() = 0;
  /// Reading of one probe. With `sample = "mean"`, of a probe of the case: the mean since its interval began;
  /// else what is there now.
  virtual std::vector<Quantity> measure(const ProbeConfig& probe) = 0;
  /// Begins a new interval for the means of that probe: its row has been written.
  virtual void begin_interval(const ProbeConfig& probe) = 0;
  /// What has left the domain where there is no outlet, by the sides through which it went; only those
  /// through which anything did.
  virtual std::vector<Loss> losses() = 0;
  /// Place, velocity, forces and their power of one wall body, by its index in the case; behind them come the
  /// rigid groups of grains.
  virtual std::vector<Quantity> body_state(int body) = 0;

  /// The kept state, and back again; load() continues bit for bit.
  virtual SavedState save() = 0;
  virtual void load(const SavedState& state) = 0;

  /// Settled grains with their contacts, for the cache between settle() and start().
  virtual SavedState save_grains() = 0;
  virtual void load_grains(const SavedState& state) = 0;
};

/// Where a case runs.
struct Device {
  std::string backend;     ///< cpu, cuda
  std::string name;        ///< "NVIDIA H100 80GB HBM3", "AMD EPYC ..., AVX2, 2 threads"
  std::size_t memory = 0;  ///< bytes free
  bool avx2 = false;       ///< a CPU that runs what was compiled for AVX2
  bool cuda() const { return backend == "cuda"; }
};

/// backend: auto, cpu, cuda. `auto` takes a usable GPU if this build has CUDA. simd is run.simd. Throws
/// DeviceError if there is no such device, KeyError if the CPU has no such instructions.
Device find_device(const std::string& backend, int threads, const std::string& simd = "auto");

/// Builds the solver for config.precision on `device`.
std::unique_ptr<Simulation> make_simulation(const Config& config, const Setup& setup, const Device& device);
/// What a field of a simulation on `device` holds now. Raises DeviceError.
HostArray host_copy(const FieldView& view, const Device& device);

/// Estimated bytes for `counts` particles of this case.
std::size_t estimate_bytes(const Config& config, const Counts& counts, bool cuda);

}  // namespace bedload
