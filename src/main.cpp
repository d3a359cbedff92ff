// bedload: the program.

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "bedload/core/cores.hpp"
#include "cli/commands.hpp"

namespace {

/// OpenMP's waiting threads spin for longer than most loops here take: beside another busy program that makes
/// a run several times slower than threads that sleep, and alone it gains nothing. The runtime reads its
/// settings as it is loaded, so the program starts anew with them.
void let_waiting_threads_sleep(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  std::error_code none;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", none);
  if (none || self.filename() != std::filesystem::path(argv[0]).filename()) return;  // run by a loader
  setenv("OMP_WAIT_POLICY", "passive", 1);
  bedload::use_all_cores();
  execv(self.c_str(), argv);
}

}  // namespace

int main(int argc, char** argv) {
  let_waiting_threads_sleep(argv);
  return bedload::run_program(argc, argv);
}
