#pragma once
// The device of one of several processes.

#include <memory>
#include <string>

#include "bedload/simulation.hpp"

namespace bedload {

class Link;
class Processes;
struct OwnGpu;

/// Makes this process's part of a simulation on its device.
std::unique_ptr<Simulation> make_own_part(const Config& config, const Setup& setup, const Device& device,
                                          Link& link);
/// What computes on a device: "cpu", "cpu_avx2", "cuda 9.0"; other code gives other last bits.
std::string code_of(const Device& device);
/// Why "auto" took the CPU, in a program that has code for GPUs; else an empty string.
std::string why_no_gpu(const std::string& backend);
/// The GPU, if it is one that computes.
OwnGpu own_gpu(const Device& device);
/// As find_device, for one of several processes: its GPU of those of its host, or its part of the cores,
/// unless it was given its own. With as many ranks as there are processes.
Device find_own_device(const std::string& backend, int threads, Simd simd, const Processes& all);

}  // namespace bedload
