#pragma once
// A case file as a tree that remembers where each value stood.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace bedload {

/// One value of a case file: scalar, array or table.
struct Value {
  using Array = std::vector<Value>;
  using Table = std::map<std::string, Value, std::less<>>;
  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table> data = {};
  std::string source = {};  ///< file, or "--set key=value"
  int line = 0;             ///< 0: from --set, which has no lines

  template <class T>
  const T* get() const {
    return std::get_if<T>(&data);
  }
  /// Member `key` of a table; null if there is no such member.
  const Value* find(std::string_view key) const;
  /// "dam.toml:14" or "--set grain.e=2".
  std::string place() const;
  /// As it would be written in TOML.
  std::string text() const;
};

/// Text to tree. Throws CaseError with file and line for syntax errors and keys given twice.
Value parse_toml(const std::string& text, const std::string& name);

/// Replaces or adds the value named by "key=value". Throws CaseError.
void apply_override(Value& root, const std::string& assignment);

/// The deepest value on `path` ("wall.body.0.min") that the file holds.
const Value& nearest_value(const Value& root, std::string_view path);

/// Throws CaseError "<place>: <key> = <value> <rest>"; `value` stands in where the file does not hold the
/// key.
[[noreturn]] void reject(const Value& root, std::string_view path, const std::string& value,
                         const std::string& rest);

/// `path` as the user knows it: without places in lists.
std::string key_of(std::string_view path);

/// Of `known`, the key most like `key`: few changed letters, preferably in the same table. Empty if none is
/// near.
std::string nearest_key(const std::string& key, const std::vector<std::string>& known);

}  // namespace bedload
