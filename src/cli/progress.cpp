#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bedload {
namespace {

constexpr double kLiveInterval = 0.25, kPlainInterval = 10;  // s

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds >= 0) || !std::isfinite(seconds)) return "?";
  const auto s = std::llround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  if (s < 86400) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  return fmt::format("{} d {:02} h", s / 86400, s % 86400 / 3600);
}

std::string ProgressLine::text() const {
  return fmt::format(
      "t = {:.5g} of {:.5g} s  {:3.0f} %  {:.3g} steps/s  {:.3g} particle-steps/s  dt {:.3g} s ({})  {} left",
      time, end, 100 * fraction, steps_per_second, particle_steps_per_second, dt, limit,
      duration_text(seconds_left));
}

Progress::Progress(bool quiet, double begin, double end)
    : quiet_(quiet),
      terminal_(isatty(STDOUT_FILENO)),
      begin_(begin),
      end_(end),
      shown_(Clock::now()),
      shown_time_(begin) {}

void Progress::update(const StepInfo& info, std::int64_t particle_steps) {
  if (quiet_) return;
  if (shown_steps_ < 0) shown_steps_ = info.step - 1;
  const auto now = Clock::now();
  const double passed = std::chrono::duration<double>(now - shown_).count();
  if (passed < (terminal_ ? kLiveInterval : kPlainInterval) && info.time < end_) return;

  ProgressLine line{.time = info.time, .end = end_, .dt = info.dt, .limit = info.limit};
  line.fraction = end_ > begin_ ? std::clamp((info.time - begin_) / (end_ - begin_), 0.0, 1.0) : 1;
  if (passed > 0) {
    line.steps_per_second = double(info.step - shown_steps_) / passed;
    line.particle_steps_per_second = double(particle_steps - shown_particle_steps_) / passed;
    const double speed = (info.time - shown_time_) / passed;
    speed_ = speed_ == 0 ? speed : 0.9 * speed_ + 0.1 * speed;
  }
  if (speed_ > 0) line.seconds_left = std::max(0.0, end_ - info.time) / speed_;
  show(line.text());
  shown_ = now;
  shown_time_ = info.time;
  shown_steps_ = info.step;
  shown_particle_steps_ = particle_steps;
}

void Progress::note(const std::string& text) {
  if (quiet_) return;
  const auto now = Clock::now();
  if (std::chrono::duration<double>(now - shown_).count() < (terminal_ ? kLiveInterval : kPlainInterval))
    return;
  shown_ = now;
  show(text);
}

void Progress::close() {
  if (open_line_) std::fputc('\n', stdout);
  open_line_ = false;
  std::fflush(stdout);
}

void Progress::show(const std::string& line) {
  if (terminal_)
    fmt::print("\r{}\033[K", line);
  else
    fmt::print("{}\n", line);
  open_line_ = terminal_;
  std::fflush(stdout);
}

}  // namespace bedload
