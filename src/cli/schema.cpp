// The JSON schema of case files, from the one description of all parameters.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bedload/case/parameters.hpp"
#include "case/units.hpp"
#include "list.hpp"

namespace bedload {
namespace {

using Json = nlohmann::ordered_json;

Json array_of(Json items, std::size_t least, std::size_t most = 0) {
  Json schema{{"type", "array"}, {"items", std::move(items)}};
  if (least) schema["minItems"] = least;
  if (most) schema["maxItems"] = most;
  return schema;
}

/// A number within the bounds of a parameter, or a quoted one with a unit, whose bounds only the program
/// checks.
Json number(const ParameterRow& row, const char* type = "number") {
  Json bare{{"type", type}};
  const Interval& range = row.range;
  if (std::isfinite(range.lo)) bare[range.lo_open ? "exclusiveMinimum" : "minimum"] = range.lo;
  if (std::isfinite(range.hi)) bare[range.hi_open ? "exclusiveMaximum" : "maximum"] = range.hi;
  if (!takes_units(row.unit)) return bare;
  const Json with_unit{{"type", "string"}, {"pattern", "^ *[+-]?[.]?[0-9].*[A-Za-z\u00b5]"}};
  return {{"anyOf", {bare, with_unit}}};
}

Json text(const ParameterRow& row) {
  const Json any{{"type", "string"}, {"minLength", row.required ? 1 : 0}};
  if (row.choices.empty()) return any;
  Json names = Json::array();
  for (const Choice& choice : row.choices) names.push_back(choice.name);
  const Json one{{"enum", names}};
  return row.or_else.empty() ? one : Json{{"anyOf", {one, any}}};
}

Json value(const ParameterRow& row) {
  const Json flag{{"enum", {true, false, 0, 1}}};
  switch (row.kind) {
    case ValueKind::boolean:
      return flag;
    case ValueKind::integer:
      return number(row, "integer");
    case ValueKind::number:
      return number(row);
    case ValueKind::text:
      return text(row);
    case ValueKind::vector:
      return array_of(number(row), 3, 3);
    case ValueKind::formulas:
      return array_of({{"type", {"number", "string"}}}, 3, 3);
    case ValueKind::booleans:
      return array_of({{"type", "boolean"}}, 3, 3);
    case ValueKind::faces:
      return array_of({{"enum", kFaces}}, 1);
    case ValueKind::numbers:
      return array_of(number(row), 0);
    case ValueKind::vectors:
      return array_of(array_of(number(row), 3, 3), 0);
    case ValueKind::texts:
      return array_of({{"type", "string"}, {"minLength", 1}}, 1);
    case ValueKind::rows:
      return array_of({{"anyOf", {array_of(number(row), 4, 4), array_of(number(row), 7, 7)}}}, 0);
    case ValueKind::spheres:
      return array_of(array_of(number(row), 4, 4), 1);
  }
  return {};
}

std::string description(const ParameterRow& row) {
  std::string out = row.meaning;
  if (row.unit != "-") out += fmt::format(" [{}]", row.unit);
  if (row.fallback != "required") out += fmt::format("; default {}", row.fallback);
  for (const Choice& choice : row.choices)
    if (!choice.meaning.empty()) out += fmt::format("\n{}: {}", choice.name, choice.meaning);
  return out;
}

Json table() { return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}}; }

/// The table of the last part of `path`, created if needed; `path` is cut to that part.
Json& table_of(Json& root, std::string& path) {
  Json* at = &root;
  for (auto dot = path.find('.'); dot != path.npos; dot = path.find('.')) {
    std::string name = path.substr(0, dot);
    path.erase(0, dot + 1);
    const bool list = name.ends_with("[]");
    if (list) name.resize(name.size() - 2);
    Json& next = (*at)["properties"][name];
    if (next.is_null()) next = list ? array_of(table(), 0) : table();
    at = list ? &next["items"] : &next;
  }
  return *at;
}

void require(Json& table, const std::string& name) {
  Json& names = table["required"];
  if (names.is_null()) names = Json::array();
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

std::string schema_text() {
  Json root = table();
  for (const ParameterRow& row : parameter_table()) {
    std::string name = row.path;
    Json& at = table_of(root, name);
    Json schema = value(row);
    schema["description"] = description(row);
    // Defaults such as "none" and inf are not JSON.
    const Json fallback = row.fixed_default ? Json::parse(row.fallback, nullptr, false) : Json();
    if (!fallback.is_null() && !fallback.is_discarded()) schema["default"] = fallback;
    at["properties"][name] = std::move(schema);
    if (row.required) require(at, name);
  }
  for (const std::string& key : required_keys()) require(root, key.substr(0, key.find('.')));
  Json out{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Bedload case"}};
  out.update(root);
  return out.dump(1) + '\n';
}

}  // namespace bedload
