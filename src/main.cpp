// bedload: dispatches commands. Errors become one sentence and an exit code.

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "cli/commands.hpp"
#include "cli/list.hpp"
#include "cli/stop.hpp"

namespace {

int dispatch(const bedload::Options& options) {
  try {
    if (options.command == "run") return bedload::run_case(options);
    if (options.command == "viscometer") return bedload::viscometer(options);
    if (options.command == "check") return bedload::check_case(options);
    if (options.command == "bench") return bedload::bench(options);
  } catch (const bedload::KeyError& error) {
    throw bedload::CaseError(bedload::place_in_case(options.file, options.overrides, error.key) + ": " +
                             error.what());
  }
  if (options.command == "info") return bedload::show_file(options.file);
  if (options.command == "list")
    fmt::print("{}", options.json ? bedload::list_json(options.family) : bedload::list_text(options.family));
  else
    fmt::print("{}", options.text);
  return 0;
}

/// OpenMP's waiting threads spin for longer than most loops here take: beside another busy program that makes
/// a run several times slower than threads that sleep, and alone it gains nothing. The runtime reads its
/// settings as it is loaded, so the program starts anew with them.
void let_waiting_threads_sleep(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  std::error_code none;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", none);
  if (none || self.filename() != std::filesystem::path(argv[0]).filename()) return;  // run by a loader
  setenv("OMP_WAIT_POLICY", "passive", 1);
  execv(self.c_str(), argv);
}

int complain(const std::exception& error, int code) {
  fmt::print(stderr, "{}\n", error.what());
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  let_waiting_threads_sleep(argv);
  try {
    return dispatch(bedload::parse_options(argc, argv));
  } catch (const bedload::SimulationFault& error) {
    return complain(error, bedload::kExitFault);
  } catch (const bedload::CaseError& error) {
    return complain(error, bedload::kExitBadInput);
  } catch (const bedload::FileError& error) {
    return complain(error, bedload::kExitBadInput);
  } catch (const bedload::DeviceError& error) {
    return complain(error, bedload::kExitBadInput);
  } catch (const bedload::Stopped&) {
    fmt::print("stopped before t = 0; there is nothing to continue from\n");
    return bedload::kExitStopped;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "out of memory; `bedload check` tells how much a case needs\n");
    return bedload::kExitBadInput;
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string path = error.path1().string();
    fmt::print(stderr, "{}: {}\n", path.empty() ? "working directory" : path, error.code().message());
    return bedload::kExitBadInput;
  } catch (const std::system_error& error) {  // such as a standard output that takes no more
    std::fputs((std::string(error.what()) + "\n").c_str(), stderr);
    return bedload::kExitBadInput;
  }
}
