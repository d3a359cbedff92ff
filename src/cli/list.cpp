#include "list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "bedload/case/parameters.hpp"
#include "bedload/case/section.hpp"

namespace bedload {
namespace {

std::string table_of(const std::string& key) { return key.substr(0, key.rfind('.') + 1); }

std::string parameters_text(std::vector<ParameterRow> rows);

/// The choices of a family, then the parameters of the tables that hold them.
std::string choices_text(const std::string& family) {
  std::string out;
  std::set<std::string> tables;
  if (family == "outputs") tables.insert("out.");
  for (const ParameterRow& row : parameter_table()) {
    if (row.family != family) continue;
    tables.insert(table_of(row.key));
    out += fmt::format("{}  ({})\n", row.key, row.meaning);
    for (const Choice& choice : row.choices)
      out += fmt::format("  {:<20} {}{}\n", choice.name, choice.meaning,
                         choice.name == row.fallback.substr(1, row.fallback.size() - 2) ? " (default)" : "");
  }
  tables.erase("");  // what stands outside all tables belongs to no family
  if (tables.empty()) return out;
  std::vector<ParameterRow> rows;
  for (const ParameterRow& row : parameter_table())
    if (tables.contains(table_of(row.key))) rows.push_back(row);
  return out + '\n' + parameters_text(rows);
}

bool is_section(const std::string& name) {
  const auto known = families();
  return !name.empty() && std::find(known.begin(), known.end(), name) == known.end();
}

/// Those of a section, a key or a family; all for "parameters" and an empty name.
std::vector<ParameterRow> rows_of(const std::string& name) {
  std::vector<ParameterRow> rows = parameter_table();
  if (!name.empty() && name != "parameters")
    std::erase_if(rows, [&](const ParameterRow& row) {
      return is_section(name) ? row.key != name && !row.key.starts_with(name + ".") : row.family != name;
    });
  return rows;
}

std::string parameters_text(std::vector<ParameterRow> rows) {
  rows.insert(rows.begin(), {"key", "unit", "default", "allowed", "meaning", "", {}});
  std::size_t key = 0, unit = 0, fallback = 0;
  for (const ParameterRow& row : rows) {
    key = std::max(key, row.key.size());
    unit = std::max(unit, row.unit.size());
    fallback = std::max(fallback, std::min<std::size_t>(row.fallback.size(), 24));
  }
  std::string out;
  for (const ParameterRow& row : rows)
    out += fmt::format("{:<{}}  {:<{}}  {:<{}}  {}{}\n", row.key, key, row.unit, unit, row.fallback, fallback,
                       row.meaning, row.allowed.empty() || &row == &rows[0] ? "" : " [" + row.allowed + "]");
  return out;
}

}  // namespace

std::vector<std::string> sections() {
  std::vector<std::string> all;
  for (const ParameterRow& row : parameter_table()) {
    const std::string section = row.key.substr(0, row.key.find('.'));
    if (row.key.find('.') != row.key.npos && std::find(all.begin(), all.end(), section) == all.end())
      all.push_back(section);
  }
  return all;
}

std::vector<std::string> families() {
  return {"laws", "models", "shapes", "outputs", "parameters", "presets"};
}

std::string not_listed(const std::string& name) {
  if (!is_section(name) || !rows_of(name).empty()) return "";
  std::vector<std::string> known;
  for (const ParameterRow& row : parameter_table()) known.push_back(row.key);
  return fmt::format("{} is none of {}, no section of a case and no key; did you mean {}?", name,
                     fmt::join(families(), ", "), nearest_key(name, known));
}

std::string list_text(const std::string& name) {
  if (name == "parameters") return parameters_text(parameter_table());
  if (is_section(name)) return parameters_text(rows_of(name));
  if (!name.empty()) return choices_text(name);
  std::string out;
  for (const std::string& family : families())
    out += fmt::format("{}{}\n\n{}", out.empty() ? "" : "\n", family, list_text(family));
  return out;
}

std::string list_json(const std::string& name) {
  static constexpr std::array kinds{"boolean",  "integer", "number",  "text",    "vector", "formulas",
                                    "booleans", "faces",   "numbers", "vectors", "texts",  "rows"};
  auto out = nlohmann::ordered_json::array();
  for (const ParameterRow& row : rows_of(name)) {
    auto choices = nlohmann::ordered_json::array();
    for (const Choice& choice : row.choices)
      choices.push_back({{"name", choice.name}, {"meaning", choice.meaning}});
    out.push_back({{"key", row.key},
                   {"path", row.path},
                   {"kind", kinds[std::size_t(row.kind)]},
                   {"unit", row.unit},
                   {"default", row.fallback},
                   {"allowed", row.allowed},
                   {"meaning", row.meaning},
                   {"family", row.family},
                   {"required", row.required},
                   {"choices", choices}});
  }
  return out.dump(1) + '\n';
}

}  // namespace bedload
