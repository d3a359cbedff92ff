#pragma once
// Tables of numbers over time in CSV files.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "bedload/host_data.hpp"

namespace bedload {

/// One CSV file: a header `time [s],front [m],...` and a row per reading, or several of one time, each
/// number with all its digits.
class CsvTable {
 public:
  explicit CsvTable(std::filesystem::path path) : path_(std::move(path)) {}

  /// Appends a row at `time` s; the first row creates the file and its header, unless it is `begun`.
  /// Throws FileError, also if the columns differ from those in the file.
  void append(double time, const std::vector<Quantity>& row, bool begun = false) const {
    append_rows(time, {row}, begun);
  }
  void append_rows(double time, const std::vector<std::vector<Quantity>>& rows, bool begun = false) const;

  /// Throws FileError if there is a file with other columns.
  void expect(const std::vector<Quantity>& row) const;

  /// Times of the readings, s; empty without a file. A truncated last row is ignored. Throws FileError, also
  /// for rows whose columns do not match the header.
  std::vector<double> times() const;

  /// The last row without its time; empty if there is none. Throws FileError.
  std::vector<Quantity> last_row() const;

  /// Keeps the rows of the first `count` times; removes the file if that is none.
  void keep(std::size_t count) const;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace bedload
