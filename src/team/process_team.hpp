#pragma once
// One simulation on the processes of an MPI job, which looks like one on process 0.

#include <functional>
#include <memory>
#include <string>

#include "bedload/case/config.hpp"
#include "bedload/simulation.hpp"
#include "src/team/processes.hpp"

namespace bedload {

/// Makes the part of a process.
using MakePart =
    std::function<std::unique_ptr<Simulation>(const Config&, const Setup&, const Device&, Link&)>;

/// What each process has read; it must be the same.
struct OwnCase {
  Config config;
  Setup setup;
  Device device;
  std::string code;  ///< that computes: "cpu", "cpu_avx2", "cuda 9.0"
  OwnGpu gpu;
};

/// On process 0, once all have read the case: connects their GPUs.
void connect(Processes& all, const OwnGpu& gpu, GpuData wanted);
/// On process 0: the whole.
std::unique_ptr<Simulation> make_process_team(Processes& all, const Config& config, const Setup& setup,
                                              const Device& device, const std::string& code,
                                              const MakePart& make);
/// On the others: answers with what read() throws, then does what process 0 says, until it says that all is
/// done.
void serve(Processes& all, const std::function<OwnCase()>& read, const MakePart& make);

}  // namespace bedload
