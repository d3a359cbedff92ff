// Finds the device and hands a case to the build of the solver that fits it.

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "bedload/core/error.hpp"
#include "bedload/simulation.hpp"

#if BL_HAS_CUDA
#include <cuda_runtime_api.h>
#endif

// One factory a variant; a build may leave precisions out (BEDLOAD_PRECISIONS).
#define BL_DECLARE(variant)                                                           \
  namespace bedload::variant {                                                        \
  std::unique_ptr<Simulation> make_coupled(const Config& config, const Setup& setup); \
  }
#if BL_HAS_CUDA
#define BL_DECLARE_BOTH(which) BL_DECLARE(which##_cpu) BL_DECLARE(which##_cuda)
#define BL_TRY(which)                                                           \
  if (config.precision == #which)                                               \
    return device.backend == "cuda" ? which##_cuda::make_coupled(config, setup) \
                                    : which##_cpu::make_coupled(config, setup);
#else
#define BL_DECLARE_BOTH(which) BL_DECLARE(which##_cpu)
#define BL_TRY(which) \
  if (config.precision == #which) return which##_cpu::make_coupled(config, setup);
#endif
#if BL_HAS_SINGLE
BL_DECLARE_BOTH(single)
#endif
#if BL_HAS_MIXED
BL_DECLARE_BOTH(mixed)
#endif
#if BL_HAS_DOUBLE
BL_DECLARE_BOTH(double)
#endif

namespace bedload {
namespace {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "CPU";
}

std::size_t free_memory() {
  std::ifstream info("/proc/meminfo");
  std::string key, unit;
  std::size_t kib = 0;
  while (info >> key >> kib >> unit)
    if (key == "MemAvailable:") return kib * 1024;
  return 0;
}

Device cpu(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
  return {"cpu", processor_name() + ", " + std::to_string(omp_get_max_threads()) + " threads", free_memory()};
}

/// Why there is no GPU, or an empty string.
std::string find_gpu(Device& device) {
#if BL_HAS_CUDA
  int count = 0;
  if (const auto status = cudaGetDeviceCount(&count); status != cudaSuccess) {
    (void)cudaGetLastError();
    return std::string("no usable GPU: ") + cudaGetErrorString(status);
  }
  if (count == 0) return "no usable GPU was found";
  cudaDeviceProp properties;
  cudaGetDeviceProperties(&properties, 0);
  std::size_t free = 0, total = 0;
  if (const auto status = cudaMemGetInfo(&free, &total); status != cudaSuccess)
    return std::string("the GPU does not answer: ") + cudaGetErrorString(status);
  device = {"cuda", properties.name, free};
  return "";
#else
  (void)device;
  return "this build has no CUDA; build with the `cuda` preset";
#endif
}

}  // namespace

Device find_device(const std::string& backend, int threads) {
  if (backend == "cpu") return cpu(threads);
  Device device;
  const std::string why = find_gpu(device);
  if (why.empty()) {
    cpu(threads);
    return device;
  }
  if (backend == "cuda") throw DeviceError("--backend = cuda: " + why);
  return cpu(threads);
}

std::unique_ptr<Simulation> make_simulation(const Config& config, const Setup& setup,
                                            [[maybe_unused]] const Device& device) {
#if BL_HAS_SINGLE
  BL_TRY(single)
#endif
#if BL_HAS_MIXED
  BL_TRY(mixed)
#endif
#if BL_HAS_DOUBLE
  BL_TRY(double)
#endif
  throw KeyError("run.precision",
                 "run.precision = " + config.precision + ": this program was built without it");
}

namespace {

/// Places of a lattice within `reach` spacings.
double around(double reach, bool two_d) { return two_d ? 3.14 * reach * reach : 4.19 * std::pow(reach, 3); }

}  // namespace

std::size_t estimate_bytes(const Config& config, const Counts& counts, bool cuda) {
  const double real = config.precision == "double" ? 8 : 4;
  const double position = config.precision == "single" ? 16 : 24,
               pair_position = config.precision == "double" ? 32 : 16;
  const double h = config.fluid.h(), reach = 2 * h + config.skin_fluid * config.fluid.dx;
  const double neighbours =
      config.fluid.present ? 1.2 * around(reach / config.fluid.dx, config.domain.two_d) : 0;
  const double entry = cuda ? 2.4 : 4;
  const double fluid = 4 + 2 * position + pair_position + real * 35 + entry * neighbours + position;
  const double walls = 8 + 3 * 24 + pair_position + real * 13 + 4 * 32;
  const double contacts = 12;
  const double touches = 60.0 * std::min(config.wall.free_bodies(), 8);  // of each grain with free bodies
  const double grains = 4 + 3 * 24 + real * 36 + contacts * (4 + 56) * 2 + touches;
  const double skin = 0.5 * (config.skin_fluid * config.fluid.dx + config.skin_grain * config.grain.d_min);
  const bool coupled = config.couple.mode != "off" && config.fluid.present && config.grain.present;
  const double records = coupled ? real * 9 : 0;
  const double cross = coupled ? pair_position + real * 78 +
                                     2 * 4 * around((2 * config.couple.hc + skin) / config.fluid.dx, false)
                               : 0;
  return std::size_t(counts.fluid * (fluid + records) + counts.walls * walls +
                     counts.grains * (grains + cross)) +
         (64u << 20);
}

}  // namespace bedload
