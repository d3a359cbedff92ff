#include "case_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

namespace bedload {

std::string number_text(double value) { return fmt::format("{:.10g}", value == 0 ? 0.0 : value); }

std::string vector_text(const Vec3d& v) {
  return fmt::format("[{}, {}, {}]", number_text(v.x), number_text(v.y), number_text(v.z));
}

std::string quoted_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= ' ') out += c;
  }
  return out + '"';
}

std::string list_text(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back(quoted_text(word));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

Section& Section::raw(std::string_view key, std::string_view value, std::string_view comment) {
  lines_.emplace_back(fmt::format("{} = {}", key, value), comment);
  return *this;
}

std::string Section::text() const {
  std::size_t width = 0;
  for (const auto& [line, comment] : lines_)
    if (!comment.empty()) width = std::max(width, line.size());
  std::string out = header_.empty() ? "" : header_ + '\n';
  for (const auto& [line, comment] : lines_)
    out += comment.empty() ? line + '\n' : fmt::format("{:{}}  # {}\n", line, width, comment);
  return out;
}

std::string comment_text(std::string_view text, std::string_view first) {
  constexpr std::size_t kWidth = 110;
  std::istringstream words{std::string(text)};
  std::string out, line = fmt::format("# {}", first);
  bool begun = false;
  for (std::string word; words >> word;) {
    if (begun && line.size() + 1 + word.size() > kWidth) {
      out += line + '\n';
      line = fmt::format("# {:{}}", "", first.size());
      begun = false;
    }
    line += (begun ? " " : "") + word;
    begun = true;
  }
  return out + line + '\n';
}

}  // namespace bedload
