#pragma once
// The command line.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bedload {

/// Options of `bedload bench`.
struct BenchOptions {
  std::vector<std::string> cases;       ///< built-in benchmarks or case files
  std::vector<double> widths;           ///< of dam breaks, m
  std::vector<std::string> precisions;  ///< empty: that of the case
  std::vector<int> devices, ranks;      ///< into how many parts of GPUs or of the CPU to divide; empty: one
  std::vector<int> thread_counts;       ///< of the CPU, one after another; empty: that of all commands
  double at = 0;                        ///< simulated time at which timing starts, s
  int warm_up = 20, steps = 200, repeats = 3;
  bool default_settings = false;
  int frame_every = 0;  ///< steps; 0: no frames
  std::filesystem::path json;
};

/// Options of `bedload drag`.
struct DragOptions {
  std::vector<double> fractions{0.1, 0.2, 0.3};  ///< of the volume, in grains
  std::vector<double> reynolds{0.1, 1, 10};      ///< of the diameter and the mean velocity over all space
  std::string array = "random";                  ///< or simple: simple cubic
  int spheres = 54;                              ///< of a random array
  double nodes = 10;                             ///< across a sphere
  int draws = 1;                                 ///< random arrays of which the mean is taken
};

/// Options of `bedload gui`.
struct WindowOptions {
  int port = -1;  ///< 0: any that is free; -1: the default
  bool no_browser = false;
};

struct Options {
  std::string command;                 ///< run, check, list, ...; empty: print `text`
  std::filesystem::path file;          ///< case, also the one to write, or the file that info shows
  std::string case_template;           ///< of new and demo; with new empty: list them
  std::filesystem::path out;           ///< results folder
  std::filesystem::path preview;       ///< of check: folder for the initial particles
  std::filesystem::path restart;       ///< checkpoint to restart from, or "latest"
  std::string backend = "auto";        ///< auto, cpu, cuda
  std::vector<std::string> overrides;  ///< key=value, in order; shorthands such as --precision last
  std::optional<double> until;         ///< s, overrides time.end
  int threads = 0;                     ///< 0: all
  int ranks = 1;                       ///< parts of the CPU that divide a run
  std::string devices;                 ///< GPUs that do: a number, a list, all; empty: one
  bool mpi = false;                    ///< this is one of several processes, of which each is a rank
  std::string mpi_data = "auto";       ///< between their GPUs: auto, nccl, host
  bool quiet = false, overwrite = false;
  bool allow_changes = false;  ///< restart with a modified case
  std::optional<int> live;     ///< of run: port of the live view, 0 for any; none: no live view
  bool relative = false;       ///< of viscometer: also runs the case without its grains
  BenchOptions bench;
  DragOptions drag;
  WindowOptions window;
  std::string to;      ///< of convert: format of frames; empty: the default
  std::string family;  ///< of list
  bool json = false;   ///< with list
  std::string text;    ///< printed by help, --version, schema, completion and man
  std::string repeat;  ///< the command line without --restart and --overwrite
};

/// Throws CaseError with one sentence for a wrong command line.
Options parse_options(int argc, const char* const* argv);

/// The version of this program, "0.1.0".
std::string version();
/// The commit it was built from, "67966b7", with "-dirty" if sources differed; or "unknown".
std::string commit();

/// The name of a case: "dam" for cases/dam/case.toml and for dam.toml.
std::string case_name(const std::filesystem::path& file);

}  // namespace bedload
