#include "src/viewer/progress_meter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bedload {

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

ProgressMeter::ProgressMeter(double begin, double end, std::int64_t steps)
    : begin_(begin), end_(end), time_(begin), steps_(steps) {}

double ProgressMeter::waited() const {
  return std::chrono::duration<double>(Clock::now() - read_at_).count();
}

double ProgressMeter::fraction(double time) const {
  return end_ > begin_ ? std::clamp((time - begin_) / (end_ - begin_), 0.0, 1.0) : 1;
}

ProgressLine ProgressMeter::read(const StepInfo& info, std::int64_t particle_steps) {
  const auto now = Clock::now();
  const double passed = std::chrono::duration<double>(now - read_at_).count();
  ProgressLine line{.time = info.time, .end = end_, .dt = info.dt, .limit = name_of(info.limit)};
  line.fraction = fraction(info.time);
  if (passed > 0) {
    line.steps_per_second = double(info.step - steps_) / passed;
    line.particle_steps_per_second = double(particle_steps - particle_steps_) / passed;
    const double speed = (info.time - time_) / passed;
    speed_ = speed_ == 0 ? speed : 0.9 * speed_ + 0.1 * speed;
  }
  if (speed_ > 0) line.seconds_left = std::max(0.0, end_ - info.time) / speed_;
  read_at_ = now;
  time_ = info.time;
  steps_ = info.step;
  particle_steps_ = particle_steps;
  return line;
}

}  // namespace bedload
