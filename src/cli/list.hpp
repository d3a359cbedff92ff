#pragma once
#include <string>
#include <vector>

namespace bedload {

/// What `bedload list` can show: laws, models, shapes, outputs, parameters, presets.
std::vector<std::string> families();

/// Sections of a case: "domain", "fluid", "grain".
std::vector<std::string> sections();

/// One family as text, or all for an empty name.
std::string list_text(const std::string& family);

}  // namespace bedload
