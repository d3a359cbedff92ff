#include "bedload/output/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// Complete lines of a table; an unterminated last line is ignored.
std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  const std::string text = read_file(path);
  if (text.find('\r') != std::string::npos)
    throw FileError(path.string() + ": has CR LF line ends; convert them to LF");
  for (std::size_t start = 0, end; (end = text.find('\n', start)) != std::string::npos; start = end + 1)
    lines.push_back(text.substr(start, end - start));
  return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t start = 0, end; start <= line.size(); start = end + 1) {
    end = std::min(line.find(',', start), line.size());
    cells.push_back(line.substr(start, end - start));
  }
  return cells;
}

void compare(const std::filesystem::path& path, const std::string& found, const std::string& header) {
  if (found != header)
    throw FileError(
        fmt::format("{}: has the columns '{}', but this run writes '{}'; give the restart another --out",
                    path.string(), found, header));
}

}  // namespace

void CsvTable::expect(const std::vector<Quantity>& row) const {
  if (!std::filesystem::exists(path_)) return;
  if (const auto lines = lines_of(path_); !lines.empty()) compare(path_, lines[0], header_of(row));
}

void CsvTable::append_rows(double time, const std::vector<std::vector<Quantity>>& rows, bool begun) const {
  std::string text, found;
  const std::string header = header_of(rows.at(0));
  if (std::filesystem::is_regular_file(path_)) {
    std::ifstream in(path_);
    std::getline(in, found);
  }
  if (!found.empty()) {
    compare(path_, found, header);
  } else {
    if (begun) must_be_there(path_);
    text = header + '\n';
  }
  for (const auto& row : rows) {
    text += fmt::format("{}", time);
    for (const auto& q : row) text += fmt::format(",{}", q.value);
    text += '\n';
  }

  std::error_code none;
  const auto before = std::filesystem::file_size(path_, none);
  std::FILE* file = std::fopen(path_.c_str(), begun ? "r+b" : "ab");  // r+ creates no file
  if (file && begun) std::fseek(file, 0, SEEK_END);
  bool written = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (file) written = (std::fclose(file) == 0) && written;
  if (written) return;
  const FileError error(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
  if (!none) std::filesystem::resize_file(path_, before, none);  // no partial row
  throw error;
}

std::vector<double> CsvTable::times() const {
  if (!std::filesystem::exists(path_)) return {};
  const auto lines = lines_of(path_);
  const auto columns = [](const std::string& line) { return cells_of(line).size(); };
  std::vector<double> times;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    char* end = nullptr;
    const double time = std::strtod(lines[k].c_str(), &end);
    if (times.empty() || time != times.back()) times.push_back(time);
    if (end == lines[k].c_str() || columns(lines[k]) != columns(lines[0]))
      throw FileError(fmt::format("{}:{}: must be a row of {} numbers starting with the time: '{}'",
                                  path_.string(), k + 1, columns(lines[0]), lines[k]));
  }
  return times;
}

std::vector<Quantity> CsvTable::last_row() const {
  const auto lines = lines_of(path_);
  if (lines.size() < 2) return {};
  const auto names = cells_of(lines.front()), values = cells_of(lines.back());
  std::vector<Quantity> row;
  for (std::size_t k = 1; k < std::min(names.size(), values.size()); ++k) {
    const auto unit = names[k].rfind(" [");
    if (unit == std::string::npos)
      throw FileError(path_.string() + ": has a column without a unit: " + names[k]);
    row.push_back({names[k].substr(0, unit), names[k].substr(unit + 2, names[k].size() - unit - 3),
                   std::strtod(values[k].c_str(), nullptr)});
  }
  return row;
}

void CsvTable::keep(std::size_t count) const {
  if (count == 0) return remove_file(path_);
  if (!std::filesystem::exists(path_)) return;
  const auto lines = lines_of(path_);
  std::string text;
  std::string last;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::string time = lines[k].substr(0, lines[k].find(','));
    if (k > 0 && time != last && count-- == 0) break;
    last = time;
    text += lines[k] + '\n';
  }
  write_file(path_, text);
}

}  // namespace bedload
