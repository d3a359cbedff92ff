#pragma once
// The command line.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bedload {

struct Options {
  std::string command;                 ///< run, check, list, info; empty: `text` is all
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
  std::string family;  ///< of list
  std::string text;    ///< help or version asked for
  std::string repeat;  ///< the command without what begins or continues a run
};

/// Throws CaseError with one sentence for a wrong command line.
Options parse_options(int argc, const char* const* argv);

/// The version of this program, "0.1.0".
std::string version();

}  // namespace bedload
