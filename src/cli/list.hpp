#pragma once
#include <string>
#include <vector>

namespace bedload {

/// The families of `bedload list`: laws, models, shapes, outputs, parameters, presets, words.
std::vector<std::string> families();

/// Sections of a case: "domain", "fluid", "grain".
std::vector<std::string> sections();

/// Empty if `name` is a family, a section, a key or the beginning of keys, or a term of another program; else
/// an error message.
std::string not_listed(const std::string& name);

/// The entries of that name as text; all for an empty name.
std::string list_text(const std::string& name);

/// The same parameters as JSON: a list of {key, path, kind, unit, default, allowed, meaning,
/// family, required, choices}. `path` has [] behind lists of tables. Of words {program, name, keys, note}.
std::string list_json(const std::string& name);

/// A JSON schema (draft 7) of case files, for completion and validation in editors.
std::string schema_text();

}  // namespace bedload
