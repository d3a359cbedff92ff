#pragma once
// Small cases for the tests of case files.

#include <string>
#include <vector>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"

namespace bedload::test {

/// A dam break with grains that is right; tests spoil one line of it.
inline const std::string kCase = R"(title = "dam"
[domain]
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
[fluid]
dx = 0.004
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.1, 0.1]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
[grain]
d = 0.002
[[grain.fill]]
min = [0, 0, 0]
max = [0.05, 0.1, 0.1]
count = 500
[time]
end = 0.3
[out]
every = 0.01
)";

/// kCase with `from` replaced by `to`; `from` must occur.
inline std::string changed(const std::string& from, const std::string& to) {
  std::string text = kCase;
  const auto at = text.find(from);
  if (at == text.npos) throw std::logic_error("no '" + from + "' in the case");
  return text.replace(at, from.size(), to);
}

inline Config read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> warnings;
  return read_case_text(text, "dam.toml", overrides, warnings);
}

inline std::vector<std::string> warnings_of(const std::string& text) {
  std::vector<std::string> warnings;
  read_case_text(text, "dam.toml", {}, warnings);
  return warnings;
}

/// The message with which a case is refused; empty if it is taken.
inline std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const CaseError& error) {
    return error.what();
  }
  return "";
}

}  // namespace bedload::test
