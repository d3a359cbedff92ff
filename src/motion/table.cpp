#include "src/motion/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"

namespace bedload {
namespace {

struct Column {
  std::string_view name, unit;
};
constexpr Column kColumns[] = {{"t", "s"},    {"x", "m"},    {"y", "m"},   {"z", "m"},
                               {"rx", "deg"}, {"ry", "deg"}, {"rz", "deg"}};

std::string_view trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r\"");
  if (from == text.npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r\"") - from + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path) : path_(path.string()) {
    if (!std::filesystem::exists(path) || std::filesystem::is_directory(path))
      throw FileError(path_ + ": cannot read this table");
    std::istringstream in(read_text(path));
    for (std::string line; std::getline(in, line);) {
      ++line_;
      const std::string_view text = trimmed(line);
      if (text.empty() || text[0] == '#') continue;
      if (column_.empty())
        header(cells_of(text));
      else
        row(cells_of(text));
    }
    if (column_.empty()) throw CaseError(path_ + ": must begin with a header that names its columns");
    check_rows(rows_, path_, [&](std::size_t i) { return fmt::format("{}:{}", path_, lines_[i]); });
  }
  std::vector<MotionRow> take() { return std::move(rows_); }

 private:
  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    throw CaseError(fmt::format("{}:{}: column {}: {}", path_, line_, column + 1, what));
  }

  void header(const std::vector<std::string_view>& cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const auto bracket = std::min(cells[k].find('['), cells[k].size());
      std::string_view name = trimmed(cells[k].substr(0, bracket)), unit = cells[k].substr(bracket);
      if (name == "time") name = "t";
      const auto* known = std::find_if(std::begin(kColumns), std::end(kColumns),
                                       [&](const Column& c) { return c.name == name; });
      if (known == std::end(kColumns))
        fail(k, fmt::format("\"{}\" must be one of t, x, y, z, rx, ry, rz", cells[k]));
      if (!unit.empty() && unit != fmt::format("[{}]", known->unit))
        fail(k, fmt::format("{} must be in {}, not {}", known->name, known->unit, unit));
      const int place = int(known - std::begin(kColumns));
      if (std::count(column_.begin(), column_.end(), place) > 0)
        fail(k, fmt::format("{} is given twice", known->name));
      column_.push_back(place);
    }
    if (std::count(column_.begin(), column_.end(), 0) == 0)
      throw CaseError(fmt::format("{}:{}: the header must name a column t", path_, line_));
  }

  void row(const std::vector<std::string_view>& cells) {
    if (cells.size() != column_.size())
      throw CaseError(
          fmt::format("{}:{}: has {} columns, the header {}", path_, line_, cells.size(), column_.size()));
    MotionRow row{};
    for (std::size_t k = 0; k < cells.size(); ++k) {
      double& value = row[column_[k]];
      const char *from = cells[k].data(), *to = from + cells[k].size();
      if (from != to && *from == '+') ++from;
      const auto [end, error] = std::from_chars(from, to, value);
      if (from == to || end != to || error != std::errc() || !std::isfinite(value))
        fail(k, fmt::format("{} = \"{}\" must be a finite number", kColumns[column_[k]].name, cells[k]));
    }
    rows_.push_back(row);
    lines_.push_back(line_);
  }

  std::string path_;
  int line_ = 0;
  std::vector<int> column_;  ///< place in MotionRow of each column of the file
  std::vector<MotionRow> rows_;
  std::vector<int> lines_;
};

}  // namespace

std::vector<MotionRow> read_motion_table(const std::filesystem::path& path) {
  return TableReader(path).take();
}

void check_rows(const std::vector<MotionRow>& rows, const std::string& table,
                const std::function<std::string(std::size_t)>& place) {
  if (rows.size() < 2)
    throw CaseError(fmt::format("{}: must have two rows or more, not {}", table, rows.size()));
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (!(rows[i][0] > rows[i - 1][0]))
      throw CaseError(fmt::format("{}: t = {} must exceed {}, the t of the row before", place(i), rows[i][0],
                                  rows[i - 1][0]));
}

}  // namespace bedload
