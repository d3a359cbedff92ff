#pragma once
// Commented cases to begin with, the files of src/cli/templates, which the program carries.

#include <filesystem>
#include <string>
#include <vector>

namespace bedload {

/// The one that `bedload demo` runs.
inline constexpr const char* kDemoTemplate = "two_phase_dam_break";

/// Names of the templates, in alphabetical order.
std::vector<std::string> template_names();

/// Every template and what it is; a line each.
std::string templates_text();

/// Writes the template `name` to `file`, and the meshes it reads beside it; returns the paths. Throws
/// FileError, also for a file that exists, unless `overwrite`.
std::vector<std::filesystem::path> write_template(const std::string& name, const std::filesystem::path& file,
                                                  bool overwrite);

}  // namespace bedload
