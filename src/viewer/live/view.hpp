#pragma once
// What a live view tells of a run. The run's thread hands over copies; those of the server read them.

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

  // --- called by the run ---

  /// The first step comes next; `end` of the run, s.
  void begin(const Config& config, const Device& device, const Simulation& simulation, double end);
  /// One row of a table that is written.
  void add_row(const std::string& table, double time, const std::vector<Quantity>& row);
  /// Notes progress now and then, and takes a frame where somebody looks: so rarely that the copies take 1 %
  /// of the run and pictures 2 % of one core.
  void after_step(Simulation& simulation, const StepInfo& info, std::int64_t particle_steps);
  /// The last state; nothing is handed over after it. `state`: "completed", "stopped", "failed". Without a
  /// simulation there is no last frame.
  void end(const std::string& state, const std::string& message, Simulation* simulation = nullptr);

  // --- called by the server, from any thread ---

  /// State, progress, the picture's time and colours, as JSON. Whoever asks is somebody who looks.
  std::string status();
  /// Names, columns and lengths of all tables, as JSON.
  std::string tables() const;
  /// One table, at most kMostRows of its rows, as JSON; none of that name: nothing.
  std::optional<std::string> table(const std::string& name) const;
  /// The last frame as a PNG file; nothing while there is none.
  std::optional<std::string> picture(LiveSide side);

  static constexpr std::size_t kMostRows = 600;

 private:
  using Clock = std::chrono::steady_clock;

  /// Rows of a table: all of them, or each second, fourth, ..., and the last.
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
  void note(const ProgressLine& line, Simulation& simulation);
  bool somebody_looks() const;
  double elapsed() const;

  const std::string name_, id_;
  const Clock::time_point begun_ = Clock::now();
  std::optional<FrameTaker> taker_;  ///< of the run's thread, as the next three
  std::optional<ProgressMeter> meter_;
  Clock::time_point next_frame_ = begun_;
  std::int64_t frames_ = 0;

  mutable std::mutex mutex_;  ///< guards what follows
  std::string title_, device_, precision_, state_ = "starting", message_, limit_;
  ProgressLine progress_;
  std::int64_t step_ = 0;
  Counts counts_;
  std::optional<double> wall_seconds_;  ///< of a run that has ended
  std::map<std::string, Table> tables_;
  std::shared_ptr<const LiveFrame> frame_;
  std::int64_t serial_ = 0;  ///< of the frame

  std::mutex drawing_;  ///< one picture at a time; guards what follows
  std::optional<LivePicture> picture_;
  std::map<LiveSide, Drawn> drawn_;

  std::atomic<double> draw_seconds_{0};
  std::atomic<Clock::time_point> looked_{};
};

}  // namespace bedload
