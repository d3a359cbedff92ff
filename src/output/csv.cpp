#include "bedload/output/csv.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"

namespace bedload {
namespace {

std::string header_of(const std::vector<Quantity>& row) {
  std::string header = "time [s]";
  for (const auto& q : row) header += fmt::format(",{} [{}]", q.name, q.unit);
  return header;
}

/// Whole lines of a table; what has no end of line was never finished.
std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  const std::string text = read_file(path);
  for (std::size_t start = 0, end; (end = text.find('\n', start)) != std::string::npos; start = end + 1)
    lines.push_back(text.substr(start, end - start));
  return lines;
}

}  // namespace

void CsvTable::append(double time, const std::vector<Quantity>& row, bool begun) const {
  std::string text, found;
  const std::string header = header_of(row);
  if (std::filesystem::is_regular_file(path_)) {
    std::ifstream in(path_);
    std::getline(in, found);
  }
  if (!found.empty()) {
    if (found != header)
      throw FileError(
          fmt::format("{}: has the columns '{}', this run writes '{}'", path_.string(), found, header));
  } else {
    if (begun) must_be_there(path_);
    text = header + '\n';
  }
  text += fmt::format("{}", time);
  for (const auto& q : row) text += fmt::format(",{}", q.value);
  text += '\n';

  std::error_code none;
  const auto before = std::filesystem::file_size(path_, none);
  std::FILE* file = std::fopen(path_.c_str(), begun ? "r+b" : "ab");  // r+ makes no file
  if (file && begun) std::fseek(file, 0, SEEK_END);
  bool written = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (file) written = (std::fclose(file) == 0) && written;
  if (written) return;
  const FileError error(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
  if (!none) std::filesystem::resize_file(path_, before, none);  // no half a row
  throw error;
}

std::vector<double> CsvTable::times() const {
  if (!std::filesystem::exists(path_)) return {};
  const auto lines = lines_of(path_);
  std::vector<double> times;
  for (std::size_t k = 1; k < lines.size(); ++k) times.push_back(std::strtod(lines[k].c_str(), nullptr));
  return times;
}

void CsvTable::keep(std::size_t count) const {
  if (!std::filesystem::exists(path_)) return;
  const auto lines = lines_of(path_);
  std::string text;
  for (std::size_t k = 0; k < lines.size() && k <= count && count > 0; ++k) text += lines[k] + '\n';
  write_file(path_, text);
}

}  // namespace bedload
