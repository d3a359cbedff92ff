#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "bedload/case/contact_laws.hpp"
#include "bedload/case/limits.hpp"
#include "bedload/case/particle_order.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/setup.hpp"
#include "bedload/output/intervals.hpp"
#include "src/viewer/preview.hpp"
#include "commands.hpp"
#include "prepare.hpp"
#include "progress.hpp"
#include "rehearsal.hpp"
#include "remarks.hpp"

namespace bedload {
namespace {

/// Rough pace of each backend, for what is not there to be timed.
struct Pace {
  double fluid;   ///< fluid particle-steps/s
  double grains;  ///< grain-substeps/s
};

Pace pace_of(const Device& device, const std::string& precision) {
  const double slower = precision == "double" ? 2 : 1;
  if (device.backend == "cuda") return {3e8 / slower, 1e9 / slower};
  return {3e5, 3e6};
}

/// What steps of the case as it begins took.
struct Trial {
  double step = 0;      ///< wall time of one, s
  double substep = 0;   ///< of that, a substep of the grains, s
  double dt = 0;        ///< s
  double substeps = 0;  ///< in a step
  Limit by = Limit::fixed, substeps_by = Limit::fixed;
};

/// Takes steps for some two seconds.
Trial timed_steps(Simulation& simulation) {
  constexpr double kLongest = 2;  // s
  constexpr int kMost = 200;
  const auto grains = [&] {
    for (const Quantity& part : simulation.time_spent())
      if (part.name == "grains") return part.value;
    return 0.0;
  };
  const double grains_before = grains(), begin = simulation.time();
  const auto from = std::chrono::steady_clock::now();
  double seconds = 0;
  int steps = 0;
  std::int64_t substeps = 0;
  Limit by = Limit::fixed, substeps_by = Limit::fixed;
  while (steps < kMost && seconds < kLongest) {
    const StepInfo info = simulation.step();
    substeps += info.substeps;
    if (info.limit != Limit::growth) by = info.limit;
    substeps_by = info.substep_limit;
    ++steps;
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  }
  const double of_grains = substeps > 0 ? (grains() - grains_before) / double(substeps) : 0;
  return {seconds / steps,          of_grains, (simulation.time() - begin) / steps,
          double(substeps) / steps, by,        substeps_by};
}

/// A line each; the one that binds has its key.
std::string limits_text(const char* title, const std::vector<StepLimit>& limits) {
  std::string out;
  for (const StepLimit& limit : limits) {
    if (!std::isfinite(limit.seconds)) continue;  // drag before any grain is wet
    const std::string_view key = key_of(limit.limit);
    out += fmt::format("{:<10} {:<12} {}{}{}\n", out.empty() ? title : "", name_of(limit.limit),
                       std::isfinite(limit.seconds) ? fmt::format("{:.4g} s", limit.seconds) : "none",
                       limit.binds ? "  <- binds" : "",
                       limit.binds && !key.empty() ? fmt::format(", by {}", key) : "");
  }
  return out;
}

/// The other value of a key, and what it comes to; a line, empty where there is none to be had.
std::string fewer_steps_text(const Config& c, const Trial& trial, double count) {
  constexpr double least = 5;  // of fluid.c_factor
  if (trial.by != Limit::cfl || c.eos.type != EosType::tait || c.fluid.c_factor < 1.2 * least) return "";
  return fmt::format("           about {} with fluid.c_factor = {:g}, density then off by up to {:g} %\n",
                     grouped(std::llround(count * least / c.fluid.c_factor)), least, 100 / (least * least));
}

/// The same of substeps: a larger least gap of films, or grains as soft as their bed allows.
std::string fewer_substeps_text(const Config& c, const Trial& trial) {
  if (trial.substeps < 2) return "";
  Config other = c;
  std::string turned;
  if (trial.substeps_by == Limit::lubrication) {
    other.lubrication.least_gap = std::min(10 * c.lubrication.least_gap, 0.5 * c.lubrication.cut_off);
    turned = fmt::format("lubrication.least_gap = {:g}", other.lubrication.least_gap);
  } else if ((trial.substeps_by == Limit::contact || trial.substeps_by == Limit::rayleigh) &&
             takes_moduli(c.contact.normal)) {
    const double softest = c.grain.E * std::pow(bed_overlap(c) / kSoftBed, 1.5);  // by Hertz' law
    other.grain.E = std::max(c.grain.E / 10, 1.1 * softest);
    for (GrainMaterial& m : other.grain.materials)
      if (m.E == c.grain.E) m.E = other.grain.E;
    turned = fmt::format("grain.E = {:.2g} Pa", other.grain.E);
  }
  const double now = least_of(grain_limits(c)).seconds, then = least_of(grain_limits(other)).seconds;
  if (turned.empty() || !(then > 1.3 * now)) return "";
  return fmt::format("           each with {:.0f} with {}\n", std::ceil(trial.substeps * now / then), turned);
}

/// By how much more than the first steps later ones take, at most. Water that splashes has its lists renewed
/// more often, and they reach farther: dam breaks took 1.3 to 2.3 times as long (CPU, busy otherwise). Grains
/// that have just been placed touch no others: a heap in its bed took 3.3 times as long.
constexpr double kSplash = 2.5, kBed = 5;

/// Gravity can throw it about, and it is not so viscous that it only flows.
bool may_splash(const Config& c) {
  constexpr double viscous = 100;
  return norm(c.gravity) > 0 && cell_reynolds_number(c.fluid.vmax, c.fluid) > viscous;
}

std::string run_time_text(double seconds, const Trial& trial, bool splashes, bool settles) {
  const double grains = std::min(trial.substep * trial.substeps, trial.step);
  const double longest = seconds / trial.step *
                         ((splashes ? kSplash : 1) * (trial.step - grains) + (settles ? kBed : 1) * grains);
  const char* if_what = splashes && settles ? "as fluid splashes and grains lie in their bed"
                        : splashes          ? "if fluid splashes"
                                            : "once grains lie in their bed";
  return fmt::format(
      "run time   about {} by the pace of the first steps{}, output apart\n", duration_text(seconds),
      splashes || settles ? fmt::format(", up to {} {}", duration_text(longest), if_what) : "");
}

}  // namespace

int check_case(const Options& options) {
  Prepared p = prepare(options);
  const Config& c = p.config;
  const Counts& n = p.counts;
  fmt::print("{}{}", summary_text(p), notes_text(p));
  if (!options.preview.empty()) {
    write_preview(options.preview, c, p.setup);
    fmt::print("preview    {}\n", (options.preview / "preview.png").string());
  }

  const Counts later = with_arrivals(p);
  const std::size_t estimate = estimate_bytes(c, n, p.device.cuda()),
                    more = estimate_bytes(c, later, p.device.cuda()) - estimate;
  const auto print_memory = [&](const char* about, std::size_t bytes, const std::string& of_it = "") {
    fmt::print("memory     {}{}{}{}; {} free\n", about, bytes_text(bytes), of_it,
               more > 0 ? fmt::format(", up to {} with what comes in", bytes_text(bytes + more)) : "",
               bytes_text(p.device.memory));
  };
  if (estimate > p.device.memory) {
    print_memory("about ", estimate);
    p.warnings.push_back(
        "the case needs more memory than the device has free, so its step limits were not evaluated");
  } else {
    Rehearsal rehearsal(p);
    Simulation& simulation = rehearsal.simulation();
    const std::vector<StepLimit> steps = simulation.limits(), substeps = simulation.substep_limits();
    const bool free_surface = c.fluid.present && (!options.restart.empty() || has_free_surface(c, p.setup));
    fmt::print("{}", remarks_text(c, simulation.numerical_viscosity(), free_surface));
    fmt::print("{}{}", limits_text("step", steps), limits_text("substep", substeps));
    check_fixed_steps(p, simulation);

    simulation.step();  // makes what steps take
    MemoryNeed memory = rehearsal.memory();
    const Trial trial = timed_steps(simulation);
    if (rehearsal.lies_as_a_run()) memory = rehearsal.memory();  // else grains have been falling
    print_memory("", memory.all,
                 100 * memory.by_speed > memory.all
                     ? fmt::format(", {} of it only if fluid flows fast", bytes_text(memory.by_speed))
                     : "");
    for (std::string& warning : OutputIntervals(c.out).newly_below(trial.dt))
      p.warnings.push_back(std::move(warning));
    const double count = std::ceil((c.time.end - p.begin) / trial.dt);
    const Pace pace = pace_of(p.device, c.precision);  // of what comes in; the rest is measured
    const double fluid = 0.5 * double(later.fluid - n.fluid), grains = 0.5 * double(later.grains - n.grains);
    const double seconds =
        count * (trial.step + fluid / pace.fluid + std::max(trial.substeps, 1.0) * grains / pace.grains);
    fmt::print("steps      about {} of {:.3g} s{}\n", grouped(std::llround(count)), trial.dt,
               trial.substeps == 0  ? ""
               : trial.substeps > 1 ? fmt::format(", each with {:.0f} substeps by {}", trial.substeps,
                                                  with_key(trial.substeps_by))
                                    : ", each with 1 substep");
    fmt::print("{}{}", fewer_steps_text(c, trial, count), fewer_substeps_text(c, trial));
    fmt::print("{}",
               run_time_text(seconds, trial, free_surface && may_splash(c), !rehearsal.lies_as_a_run()));
    if (c.grain.present && c.grain.settle) {
      const double many = std::ceil(c.grain.settle_time / least_of(grain_limits(c)).seconds);
      fmt::print("settling   before that, at most {} substeps, {}, unless the bed is kept from before\n",
                 grouped(std::llround(many)), duration_text(many * trial.substep));
    }
  }
  for (const std::string& warning : p.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("the case is in order\n");
  return 0;
}

}  // namespace bedload
