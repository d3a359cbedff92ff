#include "bedload/case/read.hpp"

#include <filesystem>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "reader.hpp"
#include "resolve.hpp"

namespace bedload {
namespace {

/// Preset, fluid model and variable h are read before all else, since they set what stands where a key is
/// absent.
Config defaults(const Value& root) {
  const auto text = [](const Value* table, const char* key, const char* fallback) {
    const Value* value = table ? table->find(key) : nullptr;
    const auto* name = value ? value->get<std::string>() : nullptr;
    return name ? *name : std::string(fallback);
  };
  const std::string model = text(root.find("fluid"), "model", "");
  std::optional<FluidModel> chosen;  // the reader tells of a name that is none
  for (const auto& row : kNames<FluidModel>)
    if (row.name == model) chosen = row.value;
  std::optional<bool> variable_h;
  if (const Value* fluid = root.find("fluid"))
    if (const Value* given = fluid->find("variable_h"))
      if (const auto* yes = given->get<bool>()) variable_h = *yes;
  return preset_defaults(text(&root, "preset", "default"), chosen, variable_h);
}

std::string text_of(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) throw FileError(path.string() + ": is a folder, not a case file");
  if (!std::filesystem::exists(path))
    throw FileError(path.string() + ": cannot read this case file: no such file");
  const std::string text = read_text(path);
  if (text.find_first_not_of(" \t\r\n") == text.npos) throw CaseError(path.string() + ": is empty");
  return text;
}

Value tree_of(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
              std::vector<std::string>& warnings) {
  Value root = parse_toml(text, name);
  rename_keys(root, warnings);
  for (const std::string& assignment : overrides) {
    apply_override(root, assignment);
    rename_keys(root, warnings);
  }
  return root;
}

}  // namespace

Config read_case_text(const std::string& text, const std::string& name,
                      const std::vector<std::string>& overrides, std::vector<std::string>& warnings,
                      const std::filesystem::path& checkpoint) {
  return read_case_tree(tree_of(text, name, overrides, warnings), name, warnings, checkpoint);
}

Config read_case_tree(Value root, const std::string& name, std::vector<std::string>& warnings,
                      const std::filesystem::path& checkpoint) {
  rename_keys(root, warnings);
  reject_unknown(root);

  Config config = defaults(root);
  config.file = name;
  config.fluid.present = root.find("fluid") != nullptr;
  config.grain.present = root.find("grain") != nullptr;
  Reader reader(root);
  describe(reader, config);
  try {
    reader.reject_unread();
  } catch (const CaseError&) {
    check_shape_names(config, root);  // what a misspelt shape leaves unread
    throw;
  }
  resolve(config, root, checkpoint);
  cross_check(config, root, warnings);
  return config;
}

Config read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                 std::vector<std::string>& warnings, const std::filesystem::path& checkpoint) {
  return read_case_text(text_of(path), path.string(), overrides, warnings, checkpoint);
}

std::string place_in_case(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          std::string_view key) {
  std::vector<std::string> known;  // from when the case was read
  return nearest_value(tree_of(text_of(path), path.string(), overrides, known), key).place();
}

}  // namespace bedload
