#include "list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "bedload/case/parameters.hpp"
#include "bedload/case/section.hpp"
#include "bedload/case/words.hpp"

namespace bedload {
namespace {

std::string table_of(const std::string& key) { return key.substr(0, key.rfind('.') + 1); }

std::string parameters_text(std::vector<ParameterRow> rows);

/// The choices of a family, then the parameters of their tables.
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
  tables.erase("");  // keys outside all tables belong to no family
  if (tables.empty()) return out;
  std::vector<ParameterRow> rows;
  for (const ParameterRow& row : parameter_table())
    if (tables.contains(table_of(row.key))) rows.push_back(row);
  return out + '\n' + parameters_text(rows);
}

/// Terms of other programs and their equivalents here.
std::string words_text(std::span<const Word> words) {
  std::size_t program = 1, name = 0;
  for (const Word& word : words) {
    program = std::max(program, word.program.size());
    name = std::max(name, word.name.size());
  }
  std::string out;
  for (const Word& word : words) {
    const std::string where = word.within.empty() ? "" : fmt::format("in {}: ", word.within);
    const std::string note =
        word.keys.empty() ? where + std::string(word.note) : fmt::format("  ({}{})", where, word.note);
    out += fmt::format("{:<{}}  {:<{}}  {}{}\n", word.program.empty() ? "-" : word.program, program,
                       word.name, name, word.keys, word.note.empty() ? "" : note);
  }
  return out;
}

bool is_section(const std::string& name) {
  const auto known = families();
  return !name.empty() && std::find(known.begin(), known.end(), name) == known.end();
}

/// Parameters of a section, a key or a family; all for "parameters" and an empty name.
std::vector<ParameterRow> rows_of(const std::string& name) {
  std::vector<ParameterRow> rows = parameter_table();
  if (!name.empty() && name != "parameters")
    std::erase_if(rows, [&](const ParameterRow& row) {
      return is_section(name) ? row.key != name && !row.key.starts_with(name + ".") : row.family != name;
    });
  return rows;
}

/// Terms, then their equivalent parameters.
std::string word_text(const std::vector<Word>& words) {
  std::vector<ParameterRow> rows;
  std::set<std::string> shown;
  for (const Word& word : words)
    for (const std::string& key : keys_of(word))
      for (const ParameterRow& row : rows_of(key))
        if (shown.insert(row.key).second) rows.push_back(row);
  return words_text(words) + (rows.empty() ? "" : '\n' + parameters_text(rows));
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
  return {"laws", "models", "shapes", "outputs", "parameters", "presets", "words"};
}

std::string not_listed(const std::string& name) {
  if (!is_section(name) || !rows_of(name).empty() || !words_named(name).empty()) return "";
  std::vector<std::string> known = families();
  for (const ParameterRow& row : parameter_table()) known.push_back(row.key);
  const std::string near = nearest_key(name, known);
  return fmt::format("{} is not one of {}, nor a section, a key or a known term of another program{}", name,
                     fmt::join(families(), ", "),
                     near.empty() ? "" : fmt::format("; did you mean {}?", near));
}

std::string list_text(const std::string& name) {
  if (name == "parameters") return parameters_text(parameter_table());
  if (name == "words") return words_text(words());
  if (is_section(name) && rows_of(name).empty()) return word_text(words_named(name));
  if (is_section(name)) return parameters_text(rows_of(name));
  if (!name.empty()) return choices_text(name);
  std::string out;
  for (const std::string& family : families())
    out += fmt::format("{}{}\n\n{}", out.empty() ? "" : "\n", family, list_text(family));
  return out;
}

std::string list_json(const std::string& name) {
  static constexpr std::array kinds{"boolean",  "integer",  "number", "text",    "vector",
                                    "formulas", "booleans", "faces",  "numbers", "vectors",
                                    "texts",    "rows",     "spheres"};
  auto out = nlohmann::ordered_json::array();
  const auto add_words = [&](std::span<const Word> words) {
    for (const Word& word : words)
      out.push_back({{"program", word.program},
                     {"name", word.name},
                     {"within", tables_of(word)},
                     {"keys", keys_of(word)},
                     {"note", word.note}});
    return out.dump(1) + '\n';
  };
  if (name == "words") return add_words(words());
  if (is_section(name) && rows_of(name).empty()) return add_words(words_named(name));
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
