#pragma once
// From a case file to a Config and back.

#include <filesystem>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/section.hpp"

namespace bedload {

/// Reads, checks and resolves a case. `overrides` are "key=value" texts that win
/// over the file; an item of a list is reached by its place, "grain.fill.0.count=5".
/// Warnings are appended, a sentence each. Throws CaseError (one sentence with file
/// and line) and FileError. A case that restarts from `checkpoint` needs no files of initial particles.
Config read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                 std::vector<std::string>& warnings, const std::filesystem::path& checkpoint = {});

/// The same from text; `name` replaces the file in messages.
Config read_case_text(const std::string& text, const std::string& name,
                      const std::vector<std::string>& overrides, std::vector<std::string>& warnings,
                      const std::filesystem::path& checkpoint = {});

/// The same from a tree, which remembers where each of its values was given.
Config read_case_tree(Value root, const std::string& name, std::vector<std::string>& warnings,
                      const std::filesystem::path& checkpoint = {});

/// The case with every default filled in, as TOML that read_case takes back to an equal Config.
std::string resolved_toml(const Config& config);

/// Where the resolved case `now` would compute otherwise than `then`: "fluid.mu = 0.002 (0.001 then)".
std::vector<std::string> changes_between(const std::string& then, const std::string& now);

/// What the settling of the grains before t = 0 depends on, and nothing else: a
/// dry case of grains and walls.
Config settling_case(const Config& config);

}  // namespace bedload
