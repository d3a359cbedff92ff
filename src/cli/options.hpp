#pragma once
// The command line.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bedload {

/// Of bench.
struct BenchOptions {
  std::vector<std::string> cases;       ///< rows built in, or case files
  std::vector<double> widths;           ///< of dam breaks, m
  std::vector<std::string> precisions;  ///< none: as the case says
  double at = 0;                        ///< time at which measuring begins, s
  int warm = 20, steps = 200, spans = 3;
  bool default_settings = false;
  std::filesystem::path json;
};

struct Options {
  std::string command;                 ///< run, check, list, ...; empty: `text` is all
  std::filesystem::path file;          ///< case, or what info shows
  std::filesystem::path out;           ///< results folder
  std::filesystem::path preview;       ///< folder for a look at the start, with check
  std::filesystem::path restart;       ///< checkpoint to go on from, or "latest"
  std::string backend = "auto";        ///< auto, cpu, cuda
  std::vector<std::string> overrides;  ///< key=value, in order; shorthands such as --precision last
  std::optional<double> until;         ///< s, in place of time.end
  int threads = 0;                     ///< 0: all
  bool quiet = false, overwrite = false;
  bool allow_changes = false;  ///< goes on from a checkpoint of a case that computes otherwise
  std::optional<int> live;     ///< of run: port of a live view, 0 for any; none: there is none
  bool relative = false;       ///< of viscometer: runs the case without its grains, too
  BenchOptions bench;
  std::string family;  ///< of list
  bool json = false;   ///< with list
  std::string text;    ///< what help, --version, schema, completion and man print
  std::string repeat;  ///< the command without what begins or continues a run
};

/// Throws CaseError with one sentence for a wrong command line.
Options parse_options(int argc, const char* const* argv);

/// The version of this program, "0.1.0".
std::string version();
/// The commit it was built from, "67966b7", with "-dirty" if sources differed; or "unknown".
std::string commit();

/// What a case is called: "dam" for cases/dam/case.toml and for dam.toml.
std::string case_name(const std::filesystem::path& file);

}  // namespace bedload
