#pragma once
// The time series of a run, frames and tables, and when each is written.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/output/csv.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// When a series is written: at the first step at or after every multiple of `every`. This depends only on
/// the times written so far, so a restart continues the series like an uninterrupted run.
class Schedule {
 public:
  explicit Schedule(double every) : every_(every) {}

  bool due(double time) const { return multiple(time) > last_multiple_; }
  bool begun() const { return last_time_ >= 0; }
  bool written_at(double time) const { return time == last_time_; }
  void written(double time);
  /// How many of the times of an earlier run stay when restarting at `now`: none after it and, if
  /// `steps_follow`, not an extra last one written off schedule at the end of that run.
  std::size_t resume(const std::vector<double>& times, double now, bool steps_follow);

 private:
  double multiple(double time) const;
  double every_;
  double last_time_ = -1, last_multiple_ = -1;
};

struct Frames {
  std::string store;
  FrameFile file;
  Schedule schedule;
  std::size_t written = 0, in_xdmf = 0;  ///< frames

  /// Rewrites the whole .xdmf file, so ever more rarely: the cost per frame stays constant.
  void refresh_xdmf(bool last);
};

struct Table {
  std::optional<ProbeConfig> probe;  ///< none: a body, diagnostics or spectra
  std::optional<int> body;           ///< index of a wall body or rigid group in Simulation
  CsvTable csv;
  Schedule schedule;
  std::vector<std::vector<Quantity>> (Simulation::*spectra)() = nullptr;  ///< these or their peaks
};

struct Series {
  std::vector<Frames> frames;
  std::vector<Table> tables;
};

/// The series of a case.
Series series_of(const Config& config, const std::filesystem::path& folder);

/// Frames and tables in the folder that do not belong to this run: an earlier run had other stores, probes or
/// bodies.
struct Leftovers {
  std::vector<FrameFile> frames;
  std::vector<CsvTable> tables;
};
Leftovers leftovers(const Series& series, const std::filesystem::path& folder);

/// Rows and frames missing from the folder that a run of the case `former` has written up to `now` and that
/// `series` continues; a clause each.
std::vector<std::string> gaps(const Series& series, const Config& former, const std::filesystem::path& folder,
                              double now);

}  // namespace bedload
