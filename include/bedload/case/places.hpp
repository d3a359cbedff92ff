#pragma once
// Where a case gives its keys, for errors that come up after reading.

#include <map>
#include <string>
#include <string_view>

#include "bedload/core/error.hpp"

namespace bedload {

struct Value;

/// "dam.toml:14" or "--set grain.e=2" by the path of a key, "wall.body.0.min". No part of what makes two
/// cases equal.
class Places {
 public:
  Places() = default;
  explicit Places(const Value& root);
  /// Of `path`, or of the deepest table that holds it; the file alone for a key in none.
  std::string of(std::string_view path) const;
  bool operator==(const Places&) const { return true; }

 private:
  void add(const Value& value, const std::string& path);

  std::map<std::string, std::string, std::less<>> all_;
};

/// f(); a KeyError from it becomes a CaseError that begins with the place of its key.
template <class F>
auto placed(const Places& places, F&& f) {
  try {
    return f();
  } catch (const KeyError& error) {
    throw CaseError(places.of(error.key) + ": " + error.what());
  }
}

}  // namespace bedload
