#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bedload/case/limits.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/preview.hpp"
#include "commands.hpp"
#include "prepare.hpp"
#include "progress.hpp"

namespace bedload {
namespace {

/// Rough pace of each backend, for an order of magnitude.
struct Pace {
  double fluid;    ///< fluid particle-steps/s
  double grains;   ///< grain-substeps/s
  double step;     ///< s, floor of a step
  double substep;  ///< s, floor of a substep
};

Pace pace_of(const Device& device, const std::string& precision) {
  const double slower = precision == "double" ? 2 : 1;
  if (device.backend == "cuda") return {1e9 / slower, 1e9 / slower, 1e-4, 2e-5};
  return {1e6, 3e6, 1e-5, 1e-6};
}

double least(const std::vector<StepLimit>& limits) {
  double seconds = INFINITY;
  for (const StepLimit& limit : limits) seconds = std::min(seconds, limit.seconds);
  return seconds;
}

std::string limits_text(const char* title, const std::vector<StepLimit>& limits) {
  std::string out;
  for (const StepLimit& limit : limits)
    out += fmt::format("{:<10} {:<9} {:.4g} s{}\n", out.empty() ? title : "", limit.name, limit.seconds,
                       limit.binds ? "  <- binds" : "");
  return out;
}

}  // namespace

/// What numerical viscosities there are, as multiples of the fluid's own.
std::string viscosity_text(const Config& c, const std::vector<Quantity>& numerical) {
  if (numerical.empty()) return "";
  std::string out = fmt::format("viscosity  {:.3g} m2/s", c.fluid.mu / c.fluid.rho0);
  bool any = false;
  for (const Quantity& q : numerical) {
    if (!(q.value > 0)) continue;
    std::string name = q.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    out += fmt::format("{} {} {:.3g} times that", any ? "," : "; numerical:", name, q.value);
    any = true;
  }
  return out + (any ? "\n" : ", none of it numerical\n");
}

int check_case(const Options& options) {
  Prepared p = prepare(options);
  const Config& c = p.config;
  const Counts& n = p.counts;
  fmt::print("{}", summary_text(p));
  if (!options.preview.empty()) {
    write_preview(options.preview, c, p.setup);
    fmt::print("preview    {}\n", (options.preview / "preview.png").string());
  }

  const Counts later = with_arrivals(p);
  const std::size_t bytes = estimate_bytes(c, n), most = estimate_bytes(c, later);
  fmt::print("memory     about {}{}; {} free\n", bytes_text(bytes),
             most > bytes ? fmt::format(", up to {} with what comes in", bytes_text(most)) : "",
             bytes_text(p.device.memory));
  if (bytes > p.device.memory) {
    p.warnings.push_back(
        "the case needs more memory than the device has free, so its step limits were not evaluated");
  } else {
    const auto simulation = make_simulation(c, p.setup, p.device);
    simulation->start();
    const std::vector<StepLimit> steps = simulation->limits();
    std::vector<StepLimit> substeps = grain_limits(c);
    for (const StepLimit& limit : simulation->body_limits()) substeps.push_back(limit);
    fmt::print("{}", viscosity_text(c, simulation->numerical_viscosity()));
    fmt::print("{}{}", limits_text("step", steps), limits_text("substep", substeps));
    check_fixed_steps(p, options, *simulation);

    const double dt = c.time.dt > 0 ? c.time.dt : least(steps);
    const double dt_dem = c.time.dt_dem > 0 ? c.time.dt_dem : least(substeps);
    const double per_step =
        std::isfinite(dt_dem) && later.grains > 0 ? std::max(1.0, std::ceil(dt / dt_dem)) : 0;
    const double count = std::ceil((c.time.end - p.begin) / dt);
    const Pace pace = pace_of(p.device, c.precision);
    const double fluid = 0.5 * double(n.fluid + later.fluid), grains = 0.5 * double(n.grains + later.grains);
    const double seconds =
        count * (pace.step + fluid / pace.fluid + per_step * (pace.substep + grains / pace.grains));
    fmt::print("steps      about {} of {:.3g} s{}\n", grouped(std::llround(count)), dt,
               per_step > 0 ? fmt::format(", each with {:.0f} substeps", per_step) : "");
    fmt::print("run time   about {}, within a factor of three\n", duration_text(seconds));
  }
  for (const std::string& warning : p.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("the case is in order\n");
  return 0;
}

}  // namespace bedload
