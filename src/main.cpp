// bedload: the program.

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "bedload/core/cores.hpp"
#include "cli/commands.hpp"

namespace {

/// Makes idle OpenMP threads sleep. By default they spin for longer than most loops here take, which makes a
/// run several times slower next to another busy program and gains nothing otherwise. The runtime reads the
/// setting when it is loaded, so the program restarts itself with it.
void set_passive_omp_wait(char** argv) {
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
  set_passive_omp_wait(argv);
  return bedload::run_program(argc, argv);
}
