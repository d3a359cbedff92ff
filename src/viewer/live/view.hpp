#pragma once
// The state of a run for its live view. The thread of the run writes copies; server threads read them.

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "frame.hpp"
#include "picture.hpp"
#include "src/viewer/progress_meter.hpp"

namespace bedload {

class LiveView {
 public:
  /// `name`: of the case.
  explicit LiveView(std::string name);

  // --- for the run ---

  /// Before the first step; `end` of the run, s.
  void begin(const Config& config, const Device& device, const Simulation& simulation, double end);
  /// Adds a row of a table.
  void add_row(const std::string& table, double time, const std::vector<Quantity>& row);
  /// Updates the progress and, while there are viewers, takes frames: so rarely that copying takes 1 % of the
  /// wall time and drawing 2 % of one core.
  void after_step(Simulation& simulation, const StepInfo& info, std::int64_t particle_steps);
  /// The last state. `state`: "completed", "stopped" or "failed". Without a simulation there is no last
  /// frame.
  void end(const std::string& state, const std::string& message, Simulation* simulation = nullptr);

  // --- for the server, from any thread ---

  /// State, progress, time and colours of the picture, as JSON. Counts as a viewer.
  std::string status();
  /// Whether anybody has asked for the status since the end.
  bool end_seen() const { return end_seen_; }
  /// Names, columns and lengths of all tables, as JSON.
  std::string tables() const;
  /// One table, with at most kMostRows rows, as JSON; none for an unknown name.
  std::optional<std::string> table(const std::string& name) const;
  /// The last frame as PNG; none before the first frame.
  std::optional<std::string> picture(LiveSide side);

  static constexpr std::size_t kMostRows = 600;

 private:
  using Clock = std::chrono::steady_clock;

  /// Rows of a table: all, or every second, fourth, ..., and the last.
  struct Table {
    std::vector<Quantity> columns;  ///< their names and units
    std::vector<double> times;
    std::vector<std::vector<double>> rows;
    std::int64_t written = 0, every = 1;

    void add(double time, const std::vector<Quantity>& row);
  };

  struct Drawn {
    std::int64_t serial = 0;
    std::string png;
  };

  void take_frame(Simulation& simulation);
  void update_progress(const ProgressLine& line, Simulation& simulation);
  bool has_viewers() const;
  double elapsed() const;

  const std::string name_, id_;
  const Clock::time_point begun_ = Clock::now();
  std::optional<FrameTaker> taker_;  ///< used by the thread of the run, as the next three
  std::optional<ProgressMeter> meter_;
  Clock::time_point next_frame_ = begun_;
  std::int64_t frames_ = 0;

  mutable std::mutex mutex_;  ///< guards what follows
  std::string title_, device_, precision_, state_ = "starting", message_, limit_;
  ProgressLine progress_;
  std::int64_t step_ = 0;
  Counts counts_;
  std::optional<double> wall_seconds_;  ///< after the end
  std::map<std::string, Table> tables_;
  std::shared_ptr<const LiveFrame> frame_;
  std::int64_t serial_ = 0;  ///< of the frame

  std::mutex drawing_;  ///< one picture at a time; guards what follows
  std::optional<LivePicture> picture_;
  std::map<LiveSide, Drawn> drawn_;

  std::atomic<double> draw_seconds_{0};
  std::atomic<Clock::time_point> last_request_{};
  std::atomic<bool> end_seen_{false};
};

}  // namespace bedload
