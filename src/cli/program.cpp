// Runs the command of the command line. Errors become one sentence and an exit code.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "bedload/core/error.hpp"
#include "commands.hpp"
#include "list.hpp"
#include "src/case/shortened.hpp"
#include "src/team/processes.hpp"
#include "stop.hpp"

namespace bedload {
namespace {

int dispatch(const Options& options) {
  if (options.command == "run") return run_case(options);
  if (options.command == "viscometer") return viscometer(options);
  if (options.command == "check") return check_case(options);
  if (options.command == "new") return new_case(options);
  if (options.command == "demo") return demo(options);
  if (options.command == "bench") return bench(options);
  if (options.command == "drag") return drag(options);
  if (options.command == "gui") return open_window(options);
  if (options.command == "convert") return convert(options);
  if (options.command == "info") return show_file(options.file);
  if (options.command == "list")
    fmt::print("{}", options.json ? list_json(options.family) : list_text(options.family));
  else
    fmt::print("{}", options.text);
  return 0;
}

int report(const std::exception& error, int code) {
  constexpr std::size_t kMost = 1200;  // a quoted value may be as long as its file
  fmt::print(stderr, "{}\n", shortened(error.what(), kMost));
  return code;
}

int run(int argc, const char* const* argv) {
  try {
    return dispatch(parse_options(argc, argv));
  } catch (const SimulationFault& error) {
    return report(error, kExitFault);
  } catch (const CaseError& error) {
    return report(error, kExitBadInput);
  } catch (const FileError& error) {
    return report(error, kExitBadInput);
  } catch (const DeviceError& error) {
    return report(error, kExitBadInput);
  } catch (const Stopped&) {
    fmt::print("stopped before t = 0; no checkpoint was written\n");
    return kExitStopped;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "out of memory; run `bedload check` for the memory estimate\n");
    return kExitBadInput;
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string path = error.path1().string();
    fmt::print(stderr, "{}: {}\n", path.empty() ? "working directory" : shortened(path),
               error.code().message());
    return kExitBadInput;
  } catch (const std::system_error& error) {  // such as a closed standard output
    std::fputs((std::string(error.what()) + "\n").c_str(), stderr);
    return kExitBadInput;
  }
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  const int code = run(argc, argv);
  std::fflush(stdout);
  Processes::leave(code);
  return code;
}

}  // namespace bedload
