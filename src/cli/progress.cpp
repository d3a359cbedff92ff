#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace bedload {
namespace {

constexpr double kLiveInterval = 0.25, kPlainInterval = 10;  // s

}  // namespace

Progress::Progress(bool quiet, double begin, double end, std::int64_t steps)
    : quiet_(quiet), terminal_(isatty(STDOUT_FILENO)), meter_(begin, end, steps), noted_(Clock::now()) {}

void Progress::update(const StepInfo& info, std::int64_t particle_steps) {
  if (quiet_) return;
  if (meter_.waited() < (terminal_ ? kLiveInterval : kPlainInterval) && info.time < meter_.end()) return;
  show(meter_.read(info, particle_steps).text());
}

void Progress::note(const std::string& text) {
  if (quiet_) return;
  const auto now = Clock::now();
  if (std::chrono::duration<double>(now - noted_).count() < (terminal_ ? kLiveInterval : kPlainInterval))
    return;
  noted_ = now;
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
