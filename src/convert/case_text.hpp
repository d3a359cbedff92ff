#pragma once
// A case file in the making, section by section.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bedload/core/vec.hpp"

namespace bedload {

/// A number as a person writes it: ten digits at most, so that 0.1 + 0.2 is 0.3.
std::string number_text(double value);
std::string vector_text(const Vec3d& v);
std::string quoted_text(std::string_view text);
/// ["a", "b"].
std::string list_text(const std::vector<std::string>& words);

/// One table of a case file: a header and its keys in order.
class Section {
 public:
  explicit Section(std::string header) : header_(std::move(header)) {}

  Section& set(std::string_view key, double value) { return raw(key, number_text(value)); }
  Section& set(std::string_view key, const Vec3d& value) { return raw(key, vector_text(value)); }
  Section& set(std::string_view key, std::string_view text) { return raw(key, quoted_text(text)); }
  Section& set(std::string_view key, const char* text) { return raw(key, quoted_text(text)); }
  Section& set(std::string_view key, const std::vector<std::string>& words) {
    return raw(key, list_text(words));
  }
  /// `value` as TOML, a comment behind it.
  Section& raw(std::string_view key, std::string_view value, std::string_view comment = "");

  bool empty() const { return lines_.empty(); }
  std::string text() const;

 private:
  std::string header_;
  std::vector<std::pair<std::string, std::string>> lines_;  ///< line, comment
};

/// Lines of a comment, wrapped at 110 columns; the first begins with `first`, the others with spaces.
std::string comment_text(std::string_view text, std::string_view first = "");

}  // namespace bedload
