#pragma once
#include <string>
#include <vector>

namespace bedload {

/// What `bedload list` can show: laws, models, shapes, outputs, parameters, presets, words.
std::vector<std::string> families();

/// Sections of a case: "domain", "fluid", "grain".
std::vector<std::string> sections();

/// Empty if `name` is a family, a section, a key or the beginning of keys, or a word of another program; else
/// a sentence.
std::string not_listed(const std::string& name);

/// What has that name as text, or all for an empty one.
std::string list_text(const std::string& name);

/// The same parameters for programs: a JSON list of {key, path, kind, unit, default, allowed, meaning,
/// family, required, choices}. `path` has [] behind lists of tables. Of words {program, name, keys, note}.
std::string list_json(const std::string& name);

/// A JSON schema (draft 7) of case files, by which editors complete and check them.
std::string schema_text();

}  // namespace bedload
