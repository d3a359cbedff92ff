#include "templates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "template_files.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

std::string stem(const TemplateFile& file) { return fs::path(file.name).stem().string(); }
bool is_case(const TemplateFile& file) { return file.name.ends_with(".toml"); }

/// The first line of the comment that the case begins with.
std::string_view summary(const TemplateFile& file) {
  std::string_view line = file.text.substr(0, file.text.find('\n'));
  line.remove_prefix(line.find_first_not_of("# "));
  return line;
}

}  // namespace

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const TemplateFile& file : kTemplateFiles)
    if (is_case(file)) names.push_back(stem(file));
  return names;
}

std::string templates_text() {
  std::size_t longest = 0;
  for (const std::string& name : template_names()) longest = std::max(longest, name.size());
  std::string out;
  for (const TemplateFile& file : kTemplateFiles)
    if (is_case(file)) out += fmt::format("{:<{}}  {}\n", stem(file), longest, summary(file));
  return out;
}

std::vector<fs::path> write_template(const std::string& name, const fs::path& file, bool overwrite) {
  std::vector<std::pair<fs::path, std::string_view>> files;
  for (const TemplateFile& each : kTemplateFiles)
    if (stem(each) == name)
      files.emplace_back(is_case(each) ? file : file.parent_path() / each.name, each.text);
  for (const auto& [path, text] : files)  // before anything is written
    if (!overwrite && fs::exists(path))
      throw FileError(path.string() + ": exists already; choose another name for the new case");
  std::vector<fs::path> written;
  for (const auto& [path, text] : files) {
    write_file(path, std::string(text));
    written.push_back(path);
  }
  return written;
}

}  // namespace bedload
