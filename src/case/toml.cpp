#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "bedload/case/parameters.hpp"
#include "bedload/case/section.hpp"
#include "bedload/core/error.hpp"
#include "shortened.hpp"

namespace bedload {
namespace {

Value convert(const toml::node& node, const std::string& source, bool lines) {
  Value v{.source = source, .line = lines ? int(node.source().begin.line) : 0};
  if (const auto* t = node.as_table()) {
    Value::Table table;
    for (const auto& [key, item] : *t) {
      Value member = convert(item, source, lines);
      if (lines && key.source().begin.line) member.line = int(key.source().begin.line);
      table.emplace(std::string(key.str()), std::move(member));
    }
    v.data = std::move(table);
  } else if (const auto* a = node.as_array()) {
    Value::Array array;
    for (const auto& item : *a) array.push_back(convert(item, source, lines));
    v.data = std::move(array);
  } else if (const auto* b = node.as_boolean()) {
    v.data = b->get();
  } else if (const auto* i = node.as_integer()) {
    v.data = i->get();
  } else if (const auto* f = node.as_floating_point()) {
    v.data = f->get();
  } else if (const auto* s = node.as_string()) {
    v.data = s->get();
  }
  return v;
}

/// What is wrong with the text, as the rest of a sentence.
std::string reason(const toml::parse_error& error) {
  std::string text(error.description());
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  if (text.find("cannot redefine existing") != text.npos)
    if (const auto quote = text.find('\''); quote != text.npos)
      return text.substr(quote + 1, text.find('\'', quote + 1) - quote - 1) + " is given twice";
  const std::string preamble = "Error while parsing ";
  return "is not TOML: " + (text.starts_with(preamble) ? text.substr(preamble.size()) : text);
}

/// Or the name of a file.
bool is_bare_word(std::string_view text) {
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isalnum(c) || std::string_view("_-+./").find(char(c)) != std::string_view::npos;
         });
}

std::string trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t"), to = text.find_last_not_of(" \t");
  return from == text.npos ? std::string() : std::string(text.substr(from, to - from + 1));
}

/// A number with a unit behind it: 3mm, 50 ml/min.
bool is_quantity(std::string_view text) {
  const std::string_view marks = " .*/^+-";
  return !text.empty() &&
         (std::isdigit(static_cast<unsigned char>(text[0])) || marks.find(text[0]) != marks.npos) &&
         std::all_of(text.begin(), text.end(), [&](unsigned char c) {
           return std::isalnum(c) || c >= 0x80 || marks.find(char(c)) != marks.npos;
         });
}

constexpr int kMostParts = 1000;

/// The line of a key of more parts than that, whose tables would nest too deep for the stack; 0: no such key.
int line_of_deep_key(const std::string& text) {
  int parts = 1, line = 1;
  bool named = false;  // something since the last dot
  for (const char c : text) {
    line += c == '\n';
    if (c == '.') {
      parts = named ? parts + 1 : 1;
      named = false;
    } else if (std::isalnum(static_cast<unsigned char>(c)) ||
               std::string_view("_-\"'").find(c) != std::string_view::npos) {
      named = true;
    } else if (c != ' ' && c != '\t') {
      parts = 1, named = false;
    }
    if (parts > kMostParts) return line;
  }
  return 0;
}

/// As the place of an entry in a list.
bool is_number(const std::string& part) {
  return part.size() < 9 && part.find_first_not_of("0123456789") == part.npos;
}

/// Whether `path` names a list of tables: "wall.body", "grain.fill.0.sizes".
bool is_list(const std::string& path) {
  const std::string key = key_of(path);
  for (const ParameterRow& row : parameter_table()) {
    std::string list;  // a list on the way to the row's key, without marks of lists
    for (std::size_t from = 0, to; (to = row.path.find("[]", from)) != row.path.npos; from = to + 2)
      if ((list += row.path.substr(from, to - from)) == key) return true;
  }
  return false;
}

/// Message for an override that names an entry of a list which has only `count`.
std::string no_such_item(const std::string& path, std::size_t count) {
  if (count == 0)
    return "this case has no " + key_of(path) + "; write a [[" + key_of(path) + "]] in its file first";
  if (count == 1) return path + " is a list of 1, so name it by " + path + ".0";
  return path + " is a list of " + std::to_string(count) + ", so name one of " + path + ".0 to " + path +
         "." + std::to_string(count - 1);
}

/// The right side of an override: TOML, or a bare word or quantity taken as a string.
Value override_value(const std::string& text, const std::string& source) {
  try {
    const toml::table parsed = toml::parse("value = " + text);
    if (parsed.size() == 1) return convert(*parsed.get("value"), source, false);
  } catch (const toml::parse_error& error) {
    if (!is_bare_word(text) && !is_quantity(text)) throw CaseError(source + ": " + reason(error));
  }
  return {.data = text, .source = source};
}

}  // namespace

Value parse_toml(const std::string& text, const std::string& name) {
  if (const int line = line_of_deep_key(text))
    throw CaseError(name + ":" + std::to_string(line) + ": holds a key of more than " +
                    std::to_string(kMostParts) + " parts");
  try {
    Value root = convert(toml::parse(text), name, true);
    root.line = 0;
    return root;
  } catch (const toml::parse_error& error) {
    throw CaseError(name + ":" + std::to_string(error.source().begin.line) + ": " + reason(error));
  }
}

void apply_override(Value& root, const std::string& assignment) {
  const std::string source = "--set " + shortened(assignment);
  if (line_of_deep_key(assignment))
    throw CaseError(source + ": holds a key of more than " + std::to_string(kMostParts) + " parts");
  const auto equals = assignment.find('=');
  const std::string path = trimmed(std::string_view(assignment).substr(0, equals));
  if (equals == assignment.npos || path.empty()) throw CaseError(source + ": must have the form key=value");
  Value value = override_value(trimmed(std::string_view(assignment).substr(equals + 1)), source);

  Value* at = &root;
  std::size_t from = 0;
  while (true) {
    const auto dot = path.find('.', from);
    const std::string part = path.substr(from, dot == path.npos ? dot : dot - from);
    if (part.empty()) throw CaseError(source + ": must have the form key=value");
    if (auto* table = std::get_if<Value::Table>(&at->data)) {
      if (from > 0 && table->empty() && is_number(part) && is_list(path.substr(0, from - 1)))
        throw CaseError(source + ": " + no_such_item(path.substr(0, from - 1), 0));
      at = &table->try_emplace(part, Value{.data = Value::Table{}, .source = source}).first->second;
    } else if (auto* array = std::get_if<Value::Array>(&at->data)) {
      if (!is_number(part) || std::stoul(part) >= array->size())
        throw CaseError(source + ": " + no_such_item(path.substr(0, from - 1), array->size()));
      at = &(*array)[std::stoul(part)];
    } else {
      throw CaseError(source + ": " + path.substr(0, from - 1) + " holds no keys");
    }
    if (dot == path.npos) break;
    from = dot + 1;
  }
  *at = std::move(value);
}

}  // namespace bedload
