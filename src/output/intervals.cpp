#include "bedload/output/intervals.hpp"

#include <fmt/format.h>

namespace bedload {

OutputIntervals::OutputIntervals(const OutputConfig& out) {
  const auto add = [&](const std::string& key, double every) {
    if (every <= 0) return;  // never, or with the frames
    std::string& keys = keys_[every];
    keys += (keys.empty() ? "" : ", ") + key;
  };
  add("out.every", out.every);
  if (out.diagnostics_every != out.every) add("out.diagnostics_every", out.diagnostics_every);
  for (const ProbeConfig& probe : out.probes)
    if (probe.every != out.every) add(fmt::format("every of probe \"{}\"", probe.name), probe.every);
  add("checkpoint.every", out.checkpoint_every);
}

std::vector<std::string> OutputIntervals::newly_below(double dt) {
  std::vector<std::string> warnings;
  while (!keys_.empty() && keys_.begin()->first < dt * (1 - 1e-9)) {
    const auto& [every, keys] = *keys_.begin();
    warnings.push_back(fmt::format(
        "{} = {} s is below the time step, {:.3g} s: written once per step, {:.3g} times less often", keys,
        every, dt, dt / every));
    keys_.erase(keys_.begin());
  }
  return warnings;
}

}  // namespace bedload
