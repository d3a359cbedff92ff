#pragma once
#include <string>
#include <vector>

namespace bedload {

/// What `bedload list` can show: laws, models, shapes, outputs, parameters, presets.
std::vector<std::string> families();

/// One family as text, or all for an empty name.
std::string list_text(const std::string& family);

}  // namespace bedload
