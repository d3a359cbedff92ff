#pragma once
// Text files of meshes and height maps, word by word and line by line.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "bedload/core/error.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

inline std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return out;
}

/// A text, word by word and line by line.
class Text {
 public:
  Text(const std::string& name, std::string_view rest) : name_(name), rest_(rest) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(fmt::format("{}: line {}: {}", name_, line_, what));
  }
  /// Goes to the next line; false if there is none. A backslash at its end joins the next one.
  bool next_line() {
    if (rest_.empty()) return false;
    line_ = next_;
    words_.clear();
    for (bool more = true; more && !rest_.empty(); ++next_) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      more = !line.empty() && line.back() == '\\';
      if (more) line.remove_suffix(1);
      split(line.substr(0, line.find('#')));
    }
    at_ = 0;
    return true;
  }
  /// The next word of the line; empty at its end.
  std::string_view word() { return at_ < words_.size() ? words_[at_++] : std::string_view(); }
  std::string_view rest() const { return rest_; }  ///< behind the line

  /// A number that `word` is, or what it begins with up to a slash.
  template <class T>
  T number(std::string_view word) const {
    std::string_view digits = word.substr(0, word.find('/'));
    if (digits.starts_with('+')) digits.remove_prefix(1);
    T value{};
    const auto [end, wrong] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    bool good = wrong == std::errc() && end == digits.data() + digits.size();
    if constexpr (std::is_floating_point_v<T>) good = good && std::isfinite(value);
    if (!good) fail(fmt::format("\"{}\" must be a number", printable(word)));
    return value;
  }
  Vec3d place() {
    Vec3d x;
    for (int k = 0; k < 3; ++k) {
      const std::string_view w = word();
      if (w.empty()) fail("a vertex must have three coordinates");
      x[k] = number<double>(w);
    }
    return x;
  }

 private:
  void split(std::string_view line) {
    constexpr std::string_view blank = " \t\v\f\r";
    for (std::size_t end; !line.empty(); line.remove_prefix(end)) {
      line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
      end = std::min(line.find_first_of(blank), line.size());
      if (end > 0) words_.push_back(line.substr(0, end));
    }
  }
  static std::string printable(std::string_view word) {
    std::string out(word.substr(0, 40));
    std::replace_if(
        out.begin(), out.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return out;
  }

  const std::string& name_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t at_ = 0;
  long line_ = 1, next_ = 1;
};

}  // namespace bedload
