#include "bedload/case/read.hpp"

#include <filesystem>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "reader.hpp"
#include "resolve.hpp"

namespace bedload {
namespace {

std::string text_of(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) throw FileError(path.string() + ": is a folder, not a case file");
  if (!std::filesystem::exists(path))
    throw FileError(path.string() + ": cannot read this case file: no such file");
  const std::string text = read_text(path);
  if (text.find_first_not_of(" \t\r\n") == text.npos) throw CaseError(path.string() + ": is empty");
  return text;
}

}  // namespace

Config read_case_text(const std::string& text, const std::string& name,
                      const std::vector<std::string>& overrides, std::vector<std::string>& warnings,
                      const std::filesystem::path& checkpoint) {
  Value root = parse_toml(text, name);
  for (const std::string& assignment : overrides) apply_override(root, assignment);
  return read_case_tree(std::move(root), name, warnings, checkpoint);
}

Config read_case_tree(Value root, const std::string& name, std::vector<std::string>& warnings,
                      const std::filesystem::path& checkpoint) {
  rename_keys(root, warnings);
  reject_unknown(root);

  Config config = defaults_of(root);
  config.file = name;
  config.places = Places(root);
  config.fluid.present = root.find("fluid") != nullptr;
  config.grain.present = root.find("grain") != nullptr;
  Reader reader(root);
  describe(reader, config);
  try {
    reader.reject_unread(config.fluid.lattice() ? "with fluid.model = \"lattice\"" : "by the chosen options");
  } catch (const CaseError&) {
    check_shape_names(config, root);  // what a misspelt shape leaves unread
    throw;
  }
  placed(config.places, [&] {
    resolve(config, root, checkpoint);
    cross_check(config, root, warnings);
  });
  return config;
}

Config read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                 std::vector<std::string>& warnings, const std::filesystem::path& checkpoint) {
  return read_case_text(text_of(path), path.string(), overrides, warnings, checkpoint);
}

}  // namespace bedload
