#include "bedload/case/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "bedload/case/parameters.hpp"

namespace bedload {
namespace {

/// Letters and digits alone, in lower case.
std::string plain(std::string_view name) {
  std::string out;
  for (const unsigned char c : name)
    if (std::isalnum(c)) out += char(std::tolower(c));
  return out;
}

const std::vector<ParameterRow>& rows() {
  static const std::vector<ParameterRow> all = parameter_table();
  return all;
}

bool is_key(const std::string& key) {
  return std::any_of(rows().begin(), rows().end(), [&](const ParameterRow& row) { return row.key == key; });
}

bool is_table(const std::string& key) {
  return std::any_of(rows().begin(), rows().end(),
                     [&](const ParameterRow& row) { return row.key.starts_with(key + "."); });
}

/// The key of a table, "wall.body.", that ends as one of the word's does: wall.body.E for youngsModulus.
std::string key_within(const Word& word, std::string_view table) {
  for (const std::string& key : keys_of(word)) {
    const std::string own = fmt::format("{}{}", table, key.substr(key.rfind('.') + 1));
    if (!table.empty() && is_key(own)) return own;
  }
  return "";
}

/// As the end of a sentence; `table` is where it was found.
std::string meaning(const Word& word, std::string_view table) {
  if (word.keys.empty()) return std::string(word.note);
  const std::string within = key_within(word, table);
  const auto known = keys_of(word);
  const bool as_listed = within.empty() || std::count(known.begin(), known.end(), within);
  const std::string note = word.note.empty() || !as_listed ? "" : fmt::format(" ({})", word.note);
  const std::string key = within.empty() ? std::string(word.keys) : within;
  if (word.program.empty()) return fmt::format("{} is {} here{}", word.name, key, note);
  return fmt::format("what {} calls {} is {} here{}", word.program, word.name, key, note);
}

/// "inlet, outlet"
std::vector<std::string> listed(std::string_view rest) {
  std::vector<std::string> all;
  while (!rest.empty()) {
    const auto comma = rest.find(", ");
    all.emplace_back(rest.substr(0, comma));
    rest = comma == rest.npos ? std::string_view() : rest.substr(comma + 2);
  }
  return all;
}

/// The words of that name which mean something in `table`, "wall.body.".
std::vector<Word> words_in(std::string_view table, std::string_view name) {
  std::vector<Word> found = words_named(name);
  std::erase_if(found, [&](const Word& word) {
    const auto tables = tables_of(word);
    return !tables.empty() && !std::count(tables.begin(), tables.end(), table.substr(0, table.rfind('.')));
  });
  return found;
}

}  // namespace

std::vector<Word> words_named(std::string_view name) {
  const std::string sought = plain(name);
  std::vector<Word> found;
  for (const Word& word : words())
    if (!sought.empty() && plain(word.name) == sought) found.push_back(word);
  return found;
}

std::vector<std::string> keys_of(const Word& word) { return listed(word.keys); }
std::vector<std::string> tables_of(const Word& word) { return listed(word.within); }

std::string meaning_of(std::string_view key) {
  struct Part {
    std::string_view name, table;
  };
  std::vector<Part> parts;  // from the first that is no table of a case
  for (std::size_t from = 0; from <= key.size();) {
    const auto dot = std::min(key.find('.', from), key.size());
    if (!is_table(std::string(key.substr(0, dot))))
      parts.push_back({key.substr(from, dot - from), key.substr(0, from)});
    from = dot + 1;
  }
  for (const Part& part : parts)  // a word without a key here explains all that is below it
    for (const Word& word : words_in(part.table, part.name))
      if (word.keys.empty()) return meaning(word, part.table);
  std::reverse(parts.begin(), parts.end());
  for (const Part& part : parts) {
    const std::vector<Word> found = words_in(part.table, part.name);
    for (const Word& word : found)
      if (!key_within(word, part.table).empty()) return meaning(word, part.table);
    for (const Word& word : found)
      if (word.name == part.name) return meaning(word, part.table);
    if (!found.empty()) return meaning(found.front(), part.table);
  }
  return "";
}

}  // namespace bedload
