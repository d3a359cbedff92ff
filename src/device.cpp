// Finds the device and selects the build of the solver for it and the precision.

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/grain_sizes.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/parallel/link.hpp"
#include "bedload/simulation.hpp"
#include "src/device.hpp"
#include "src/team/divisible.hpp"
#include "src/team/process_team.hpp"
#include "src/team/team_simulation.hpp"

#if BL_HAS_CUDA
#include <cuda_runtime_api.h>
#endif

// One factory per variant; CMake lists those of this build: BL_USE(single, cpu) BL_USE(single, cuda) and so
// on.
#define BL_USE(which, where)                                                                        \
  namespace bedload::which##_##where {                                                              \
    std::unique_ptr<Simulation> make_coupled(const Config& config, const Setup& setup, Link* link); \
  }
BL_VARIANTS
#undef BL_USE

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

/// Whether to use the AVX2 build of the solver.
bool wants_avx2(Simd simd) {
#if BL_HAS_AVX2
  const bool can = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const std::string why = "this processor has no AVX2";
#else
  const bool can = false;
  const std::string why = "this program was built without AVX2 code";
#endif
  if (simd == Simd::avx2 && !can) throw KeyError("run.simd", "run.simd = avx2: " + why);
  return can && simd != Simd::baseline;
}

Device cpu(int threads, Simd simd) {
  if (threads > 0) omp_set_num_threads(threads);
  const bool avx2 = wants_avx2(simd);
  return {"cpu",
          processor_name() + (avx2 ? ", AVX2, " : ", ") + std::to_string(omp_get_max_threads()) + " threads",
          free_memory(),
          avx2,
          1,
          {}};
}

/// Why there is no GPU, or an empty string.
std::string find_gpu(Device& device) {
#if BL_HAS_CUDA
  int count = 0;
  if (const auto status = cudaGetDeviceCount(&count); status != cudaSuccess) {
    (void)cudaGetLastError();
    int of_driver = 0, needed = 0;
    cudaDriverGetVersion(&of_driver);
    cudaRuntimeGetVersion(&needed);
    const auto text = [](int version) {
      return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
    };
    if (of_driver == 0) return "no usable GPU: there is no NVIDIA driver";
    if (status == cudaErrorInsufficientDriver)
      return "no usable GPU: the NVIDIA driver is for CUDA " + text(of_driver) + ", this program for CUDA " +
             text(needed);
    return std::string("no usable GPU: ") + cudaGetErrorString(status);
  }
  if (count == 0) return "no usable GPU: none was found";
  cudaDeviceProp properties;
  int own = 0;
  cudaGetDevice(&own);
  cudaGetDeviceProperties(&properties, own);
  std::size_t free = 0, total = 0;
  if (const auto status = cudaMemGetInfo(&free, &total); status != cudaSuccess)
    return std::string("the GPU does not respond: ") + cudaGetErrorString(status);
  device = {"cuda", properties.name, free, false, 1, {}};
  return "";
#else
  (void)device;
  return "this build has no CUDA; build with the `cuda` preset";
#endif
}

}  // namespace

Device find_device(const std::string& backend, int threads, Simd simd) {
  if (backend == "cpu") return cpu(threads, simd);
  Device device;
  const std::string why = find_gpu(device);
  if (why.empty()) {
    cpu(threads, Simd::automatic);
    return device;
  }
  if (backend == "cuda") throw DeviceError("--backend = cuda: " + why);
  return cpu(threads, simd);
}

std::string why_no_gpu(const std::string& backend) {
  Device device;
  return BL_HAS_CUDA && backend == "auto" ? find_gpu(device) : "";
}

void divide_among(Device& device, int ranks, const std::string& gpus) {
  if (ranks > 1) {
    if (device.cuda())
      throw DeviceError("--ranks " + std::to_string(ranks) +
                        ": divides the CPU, so add --backend cpu; GPUs are given by --devices");
    device.ranks = ranks;
    device.memory /= std::size_t(ranks);
  }
  if (gpus.empty()) return;
  if (!device.cuda())
    throw DeviceError("--devices " + gpus + ": there is no GPU to use, or --backend is cpu");
  int there = 0;
#if BL_HAS_CUDA
  cudaGetDeviceCount(&there);
#endif
  const auto refuse = [&](const std::string& why) {
    throw DeviceError("--devices " + gpus + ": " + why + "; there are " + std::to_string(there) + " GPUs");
  };
  const bool several = gpus.find(',') != std::string::npos;
  if (gpus == "all") {
    for (int k = 0; k < there; ++k) device.gpus.push_back(k);
  } else {
    std::istringstream list(gpus);
    for (std::string word; std::getline(list, word, ',');) {
      if (word.empty() || word.size() > 4 || word.find_first_not_of("0123456789") != std::string::npos)
        refuse("must be a number of GPUs, a list such as 0,2,3, or all");
      const int number = std::stoi(word);
      if (!several) {
        if (number < 1 || number > there) refuse("must be within 1.." + std::to_string(there));
        for (int k = 0; k < number; ++k) device.gpus.push_back(k);
      } else {
        if (number >= there) refuse("no GPU has the number " + word);
        device.gpus.push_back(number);
      }
    }
  }
  device.ranks = int(device.gpus.size());
#if BL_HAS_CUDA
  std::size_t least = std::numeric_limits<std::size_t>::max();
  int major = 0, minor = 0;
  for (std::size_t k = 0; k < device.gpus.size(); ++k) {
    const int gpu = device.gpus[k];
    cudaDeviceProp properties;
    cudaGetDeviceProperties(&properties, gpu);
    if (k > 0 && (properties.major != major || properties.minor != minor))
      refuse("GPU " + std::to_string(gpu) + ", " + properties.name +
             ", is of another compute capability, whose results would differ");
    major = properties.major, minor = properties.minor;
    std::size_t free = 0, total = 0;
    cudaSetDevice(gpu);
    cudaMemGetInfo(&free, &total);
    least = std::min(least, free / std::size_t(std::ranges::count(device.gpus, gpu)));
  }
  cudaSetDevice(device.gpus[0]);
  device.memory = least;
#endif
}

std::vector<std::size_t> free_of_gpus() {
  std::vector<std::size_t> out;
#if BL_HAS_CUDA
  int count = 0, current = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess || cudaGetDevice(&current) != cudaSuccess) count = 0;
  for (int gpu = 0; gpu < count; ++gpu) {
    std::size_t free = 0, total = 0;
    if (cudaSetDevice(gpu) == cudaSuccess) cudaMemGetInfo(&free, &total);
    out.push_back(free);
  }
  if (count > 0) cudaSetDevice(current);
  (void)cudaGetLastError();
#endif
  return out;
}

namespace {

/// The part of one rank.
std::unique_ptr<Simulation> make_part(const Config& config, [[maybe_unused]] const Setup& setup,
                                      [[maybe_unused]] const Device& device,
                                      [[maybe_unused]] Link* link = nullptr) {
  const std::string precision = config.precision.name();
#define BL_USE(which, where)                                                          \
  if (precision == #which && device.backend + (device.avx2 ? "_avx2" : "") == #where) \
    return which##_##where::make_coupled(config, setup, link);
  BL_VARIANTS
#undef BL_USE
  throw KeyError("run.precision",
                 "run.precision = \"" + precision +
                     "\": this program was built without it (-DBEDLOAD_PRECISIONS=... of CMake adds it)");
}

/// Binds the thread of a rank to its GPU and gives it its part of the CPU threads.
void take_device(const Device& device, int rank, int threads) {
#if BL_HAS_CUDA
  if (device.cuda()) {
    const int own = device.gpus[std::size_t(rank)];
    if (const auto status = cudaSetDevice(own); status != cudaSuccess)
      throw DeviceError("GPU " + std::to_string(own) + ": " + cudaGetErrorString(status));
    for (const int other : device.gpus) {  // without access copies go through the host
      int able = 0;
      if (other != own && cudaDeviceCanAccessPeer(&able, own, other) == cudaSuccess && able)
        cudaDeviceEnablePeerAccess(other, 0);
    }
    (void)cudaGetLastError();
  }
#endif
  (void)rank;
  omp_set_num_threads(std::max(1, threads / device.ranks));
}

/// Memory of the host from which copies to a device are fast. 15 million particles have frames of a gigabyte,
/// of which two are kept.
void use_host_memory([[maybe_unused]] const Device& device) {
#if BL_HAS_CUDA
  if (device.cuda())
    HostMemory::use(
        [](std::size_t bytes) {
          void* block = nullptr;
          if (cudaMallocHost(&block, bytes) == cudaSuccess) return block;
          (void)cudaGetLastError();
          return static_cast<void*>(nullptr);
        },
        [](void* block) { cudaFreeHost(block); }, std::max(std::size_t(2) << 30, free_memory() / 8));
#endif
}

#if BL_HAS_CUDA
/// OwnGpu::try_out.
bool goes_around(const ExchangeThere& exchange, int rank, int ranks) {
  constexpr std::size_t kBytes = 1 << 20;
  const int before = (rank + ranks - 1) % ranks;
  const auto bytes_of = [](int sender) {
    std::vector<unsigned char> bytes(kBytes);
    for (std::size_t k = 0; k < kBytes; ++k) bytes[k] = (unsigned char)(k / 256 + k + std::size_t(sender));
    return bytes;
  };
  std::vector<unsigned char> came(kBytes);
  void *from = nullptr, *to = nullptr;
  bool good = cudaMalloc(&from, kBytes) == cudaSuccess && cudaMalloc(&to, kBytes) == cudaSuccess &&
              cudaMemcpy(from, bytes_of(rank).data(), kBytes, cudaMemcpyHostToDevice) == cudaSuccess;
  const Piece out{(rank + 1) % ranks, from, kBytes}, in{before, to, kBytes};
  good = good && exchange({&out, 1}, {&in, 1}, nullptr, [](void* queue) {
           return int(cudaStreamQuery(static_cast<cudaStream_t>(queue)) != cudaErrorNotReady);
         });
  good = good && cudaMemcpy(came.data(), to, kBytes, cudaMemcpyDeviceToHost) == cudaSuccess;
  cudaFree(from), cudaFree(to);
  (void)cudaGetLastError();
  return good && came == bytes_of(before);
}
#endif

}  // namespace

std::string code_of(const Device& device) {
  std::string code = device.backend + (device.avx2 ? "_avx2" : "");
#if BL_HAS_CUDA
  cudaDeviceProp properties;
  int gpu = 0;
  if (device.cuda() && cudaGetDevice(&gpu) == cudaSuccess &&
      cudaGetDeviceProperties(&properties, gpu) == cudaSuccess)
    code += " " + std::to_string(properties.major) + "." + std::to_string(properties.minor);
#endif
  return code;
}

OwnGpu own_gpu([[maybe_unused]] const Device& device) {
  OwnGpu gpu;
#if BL_HAS_CUDA
  cudaDeviceProp properties;
  int own = 0;
  if (device.cuda() && cudaGetDevice(&own) == cudaSuccess &&
      cudaGetDeviceProperties(&properties, own) == cudaSuccess) {
    gpu.number = own;
    std::memcpy(gpu.id.data(), &properties.uuid, gpu.id.size());
    gpu.bind = [](int number) { cudaSetDevice(number); };
    gpu.try_out = goes_around;
  }
#endif
  return gpu;
}

Device find_own_device(const std::string& backend, int threads, Simd simd, const Processes& all) {
  int share = all.size_here();  // processes that share its memory
#if BL_HAS_CUDA
  int count = 0;
  if (backend != "cpu" && cudaGetDeviceCount(&count) == cudaSuccess && count > 0) {
    const int own = all.rank_here() % count;
    if (count > 1) cudaSetDevice(own);
    share = count > 1 ? (share - own + count - 1) / count : 1;  // one alone was given to this process
  }
  (void)cudaGetLastError();
#endif
  if (threads == 0 && !std::getenv("OMP_NUM_THREADS") && omp_get_num_procs() == sysconf(_SC_NPROCESSORS_ONLN))
    threads = std::max(1, omp_get_num_procs() / all.size_here());
  Device device = find_device(backend, threads, simd);
  device.ranks = all.size();
  device.memory /= std::size_t(share);
  return device;
}

std::unique_ptr<Simulation> make_own_part(const Config& config, const Setup& setup, const Device& device,
                                          Link& link) {
  use_host_memory(device);
  refuse_undivided(config);
  return make_part(config, setup, device, &link);
}

std::unique_ptr<Simulation> make_simulation(const Config& config, const Setup& setup, const Device& device) {
  if (Processes* const all = Processes::joined(); all && all->size() > 1)
    return make_process_team(*all, config, setup, device, code_of(device), make_own_part);
  use_host_memory(device);
  if (device.ranks == 1 && device.gpus.empty()) return make_part(config, setup, device);
  refuse_undivided(config);
  std::vector<std::string> names;
  for (const int gpu : device.gpus) names.push_back("GPU " + std::to_string(gpu) + " (" + device.name + ")");
  return make_team(
      {.ranks = device.ranks, .names = names, .make = [&, threads = omp_get_max_threads()](Link& link) {
         take_device(device, link.rank(), threads);
         return make_part(config, setup, device, &link);
       }});
}

HostArray host_copy(const FieldView& view, [[maybe_unused]] const Device& device) {
  const std::size_t row = view.components * size_of(view.type);
  HostArray out{view.name, view.unit, view.type, view.components, HostBytes(view.count * row)};
#if BL_HAS_CUDA
  if (device.cuda()) {
    const auto status =
        cudaMemcpy2D(out.bytes.data(), row, view.data, view.stride, row, view.count, cudaMemcpyDeviceToHost);
    if (status != cudaSuccess)
      throw DeviceError(std::string("copy from the GPU: ") + cudaGetErrorString(status));
    return out;
  }
#endif
  for (std::size_t k = 0; k < view.count; ++k)
    std::memcpy(out.bytes.data() + k * row, static_cast<const std::byte*>(view.data) + k * view.stride, row);
  return out;
}

namespace {

/// Number of lattice points within `reach` spacings.
double around(double reach, bool two_d) { return two_d ? 3.14 * reach * reach : 4.19 * std::pow(reach, 3); }

/// Spheres of a fill, by number and volume (m3).
struct Filled {
  double number = 0, volume = 0;
};
Filled spheres_of(const GrainFill& fill, const GrainConfig& grain) {
  if (fill.sizes.empty()) return {};
  const Vec3d side = fill.max - fill.min;
  const double each = mean_volume(fill.sizes, 1000),
               all = fill.packing_fraction > 0 ? fill.packing_fraction * side.x * side.y * side.z
                     : fill.mass > 0           ? fill.mass / grain.density(fill)
                                               : double(fill.count) * each;
  const ClumpConfig* const clump = grain.clump_of(fill);
  return {all / each * (clump ? double(clump->shape.spheres.size()) : 1.0), all};
}

/// Of the grains of all fills, m3; those of a clump are one.
double mean_grain_volume(const GrainConfig& grain) {
  double volume = 0, number = 0;
  for (const GrainFill& fill : grain.fills) {
    if (fill.sizes.empty()) continue;
    const double all = spheres_of(fill, grain).volume;
    volume += all, number += all / mean_volume(fill.sizes, 1000);
  }
  return number > 0 ? volume / number : 0;
}

/// The fraction of the grains that a layer along all walls can hold, 1.5 diameters thick; 1 where the case
/// does not say how many there are.
double fraction_near_walls(const Config& config) {
  Filled all;
  for (const GrainFill& fill : config.grain.fills) {
    Filled of = spheres_of(fill, config.grain);
    if (!fill.file.empty() || (fill.solid.shape && fill.packing_fraction > 0)) return 1;
    if (!(of.number > 0)) return 1;
    all.number += of.number, all.volume += of.volume;
  }
  if (all.number == 0) return 1;
  const double d = std::cbrt(6 / M_PI * all.volume / all.number);
  double near = 0;
  for (const WallBody& body : config.wall.bodies)
    if (body.stops_grains()) near += expected_places(body, d, 1.5 * d, config.domain);
  return std::min(1.0, near / all.number);
}

}  // namespace

MemoryEstimate estimate_memory(const Config& config, const Device& device) {
  const auto empty = make_part(config, {}, device);
  ParticleBytes each = empty->field_bytes();
  each += empty->scratch_bytes();
  const bool cuda = device.cuda(), coupled = config.couple.mode != CouplingMode::off &&
                                             config.fluid.present && config.grain.present;
  const double real = config.precision == Precision::fp64 ? 8 : 4, index = sizeof(std::uint32_t);
  MemoryEstimate out{.fluid = double(each.fluid),
                     .walls = double(each.walls),
                     .grains = double(each.grains),
                     .ranks = device.ranks};
  if (each.near_walls > 0) out.grains += fraction_near_walls(config) * double(each.near_walls);
  if (config.fluid.lattice()) return out;

  const double reach = config.fluid.kappa() * config.fluid.h() + config.skin_fluid * config.fluid.dx;
  const double neighbours = config.fluid.present ? around(reach / config.fluid.dx, config.domain.two_d) : 0;
  const double sorting = 4 * real + (cuda ? 34 : 20);
  out.fluid += (cuda ? 2.25 * neighbours + 26 : 4.8 * neighbours) + sorting;
  out.walls += 128;  // their lists
  constexpr double near_grains = 12;
  out.grains += 2 * near_grains * double(each.near_grains);  // the lists, and those before
  if (!coupled) return out;

  const double skin = 0.5 * (config.skin_fluid * config.fluid.dx + config.skin_grain * config.grain.d_min);
  double near_grain = around((2 * config.couple.hc + skin) / config.fluid.dx, false);
  double lists = 2;  // of both phases
  if (config.own_lengths()) {
    near_grain += 512 * mean_grain_volume(config.grain) / std::pow(config.fluid.dx, 3);  // within 4 d
    lists = 3;  // and those of each level
  }
  out.grains += lists * index * near_grain;
  return out;
}

}  // namespace bedload
