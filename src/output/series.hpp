#pragma once
// The files of a run that grow with its time: frames and tables, and when each is written.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/output/csv.hpp"
#include "bedload/output/vtkhdf.hpp"

namespace bedload {

/// When something is written: at the first step end at or after every multiple of
/// `every`. Everything follows from the times written so far, so a restarted run
/// continues the series where the unbroken one would.
class Schedule {
 public:
  explicit Schedule(double every) : every_(every) {}

  bool due(double time) const { return multiple(time) > last_multiple_; }
  bool begun() const { return last_time_ >= 0; }
  bool written_at(double time) const { return time == last_time_; }
  void written(double time);
  /// Of an earlier run's times, how many stay when going on from `now`: none after it, and if `steps_follow`
  /// not an extra last one with which that run ended off schedule.
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

  /// The side-car is written anew each time, so ever more rarely: its cost a frame stays the same.
  void refresh_xdmf(bool last);
};

struct Table {
  std::optional<ProbeConfig> probe;  ///< none: a body, or diagnostics
  std::optional<int> body;           ///< a wall body or rigid group, as Simulation counts them
  CsvTable csv;
  Schedule schedule;
};

struct Series {
  std::vector<Frames> frames;
  std::vector<Table> tables;
};

/// What the run of a case writes in its folder.
Series series_of(const Config& config, const std::filesystem::path& folder);

/// What lies in a folder where runs have their frames and tables, beside the series of this run: a former run
/// had other stores, probes or bodies.
struct Leftovers {
  std::vector<FrameFile> frames;
  std::vector<CsvTable> tables;
};
Leftovers leftovers(const Series& series, const std::filesystem::path& folder);

/// What the folder lacks of the rows and frames that a run of the case `former` has written when it comes to
/// `now`, as far as `series` goes on with them; a clause each.
std::vector<std::string> gaps(const Series& series, const Config& former, const std::filesystem::path& folder,
                              double now);

}  // namespace bedload
