#pragma once
// Tables of numbers over time.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "bedload/host_data.hpp"

namespace bedload {

/// One CSV file: a header `time [s],front [m],...` and a row per reading, each
/// number with all its digits.
class CsvTable {
 public:
  explicit CsvTable(std::filesystem::path path) : path_(std::move(path)) {}

  /// Adds one row at `time` s; the first one makes the file and its header, unless it is `begun`.
  /// Throws FileError, also if the columns differ from those in the file.
  void append(double time, const std::vector<Quantity>& row, bool begun = false) const;

  /// Throws FileError if there is a file with other columns.
  void expect(const std::vector<Quantity>& row) const;

  /// Times of the rows, s; none if there is no file. A row cut short by a kill counts as absent. Throws
  /// FileError, also for rows of other columns than the header has.
  std::vector<double> times() const;

  /// The last row, less its time; nothing if there is none. Throws FileError.
  std::vector<Quantity> last_row() const;

  /// Drops all rows but the first `count`; with none the file goes.
  void keep(std::size_t count) const;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace bedload
