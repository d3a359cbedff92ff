#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "bedload/case/contact_laws.hpp"
#include "bedload/case/limits.hpp"
#include "bedload/case/particle_order.hpp"
#include "bedload/core/error.hpp"
#include "commands.hpp"
#include "first_step.hpp"
#include "progress.hpp"
#include "src/viewer/preview.hpp"

namespace bedload {
namespace {

/// Rough throughput of a backend, for particles that enter later and cannot be timed yet.
struct Throughput {
  double fluid;   ///< fluid particle-steps/s
  double grains;  ///< grain-substeps/s
};

Throughput throughput_of(const Device& device, Precision precision) {
  const double slower = precision == Precision::fp64 ? 2 : 1;
  if (device.backend == "cuda") return {3e8 / slower, 1e9 / slower};
  return {3e5, 3e6};
}

/// Means over the first steps.
struct StepTiming {
  int steps = 0;
  double step = 0;      ///< wall time of a step, s
  double substep = 0;   ///< wall time of a grain substep, s
  double dt = 0;        ///< s
  double substeps = 0;  ///< per step
  Limit limit = Limit::fixed, substep_limit = Limit::fixed;
};

/// Steps for about two seconds.
StepTiming time_steps(Simulation& simulation) {
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
  Limit step_limit = Limit::fixed, substep_limit = Limit::fixed;
  while (steps < kMost && seconds < kLongest) {
    const StepInfo info = simulation.step();
    substeps += info.substeps;
    if (info.limit != Limit::growth) step_limit = info.limit;
    substep_limit = info.substep_limit;
    ++steps;
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  }
  return {.steps = steps,
          .step = seconds / steps,
          .substep = substeps > 0 ? (grains() - grains_before) / double(substeps) : 0,
          .dt = (simulation.time() - begin) / steps,
          .substeps = double(substeps) / steps,
          .limit = step_limit,
          .substep_limit = substep_limit};
}

/// A line per limit; the active one is marked and names its key.
std::string limits_text(const char* title, const std::vector<StepLimit>& limits) {
  std::string out;
  for (const StepLimit& limit : limits) {
    if (!std::isfinite(limit.seconds)) continue;  // drag before any grain is wet
    const std::string_view key = key_of(limit.limit);
    out += fmt::format("{:<10} {:<12} {:.4g} s{}{}\n", out.empty() ? title : "", name_of(limit.limit),
                       limit.seconds, limit.binds ? "  (active)" : "",
                       limit.binds && !key.empty() ? fmt::format(", set by {}", key) : "");
  }
  return out;
}

/// How many steps a lower fluid.c_factor would take; empty where it would not help.
std::string fewer_steps_text(const Config& c, const StepTiming& timing, double count) {
  constexpr double least = 5;  // lowest fluid.c_factor of a weakly compressible fluid
  if (timing.limit != Limit::cfl || c.eos.type != EosType::tait || c.fluid.c_factor < 1.2 * least) return "";
  return fmt::format(
      "           about {} with fluid.c_factor = {:g}, at density variations of up to {:g} %\n",
      grouped(std::llround(count * least / c.fluid.c_factor)), least, 100 / (least * least));
}

/// How many substeps a larger lubrication.least_gap, or the softest grains that the bed allows, would take.
std::string fewer_substeps_text(const Config& c, const StepTiming& timing) {
  if (timing.substeps < 2) return "";
  Config other = c;
  std::string change;
  if (timing.substep_limit == Limit::lubrication) {
    other.lubrication.least_gap = std::min(10 * c.lubrication.least_gap, 0.5 * c.lubrication.cut_off);
    change = fmt::format("lubrication.least_gap = {:g}", other.lubrication.least_gap);
  } else if ((timing.substep_limit == Limit::contact || timing.substep_limit == Limit::rayleigh) &&
             takes_moduli(c.contact.normal)) {
    const double softest = c.grain.E * std::pow(bed_overlap(c) / kSoftBed, 1.5);  // by Hertz' law
    other.grain.E = std::max(c.grain.E / 10, 1.1 * softest);
    for (GrainMaterial& m : other.grain.materials)
      if (m.E == c.grain.E) m.E = other.grain.E;
    change = fmt::format("grain.E = {:.2g} Pa", other.grain.E);
  }
  const double now = least_of(grain_limits(c)).seconds, then = least_of(grain_limits(other)).seconds;
  if (change.empty() || !(then > 1.3 * now)) return "";
  return fmt::format("           {:.0f} substeps with {}\n", std::ceil(timing.substeps * now / then), change);
}

/// Upper bounds for the cost of later steps relative to the first ones. Splashing water needs more frequent
/// and longer neighbour lists: dam breaks took 1.3 to 2.3 times as long (CPU under other load). Grains that
/// have just been placed have no contacts yet: a settled heap took 3.3 times as long.
constexpr double kSplash = 2.5, kBed = 5;

/// There is gravity, and the fluid is not so viscous that it only creeps.
bool may_splash(const Config& c) {
  constexpr double viscous = 100;
  return norm(c.gravity) > 0 && cell_reynolds_number(c.fluid.vmax, c.fluid) > viscous;
}

std::string run_time_text(double seconds, const StepTiming& timing, bool splashes, bool settles) {
  const double grains = std::min(timing.substep * timing.substeps, timing.step);
  const double longest = seconds / timing.step *
                         ((splashes ? kSplash : 1) * (timing.step - grains) + (settles ? kBed : 1) * grains);
  const char* cause = splashes && settles ? "splashing and a settled bed"
                      : splashes          ? "splashing"
                                          : "a settled bed";
  return fmt::format(
      "run time   about {}{}; extrapolated from the first steps, without I/O\n", duration_text(seconds),
      splashes || settles ? fmt::format(", up to {} with {}", duration_text(longest), cause) : "");
}

/// Wall time of a step on one rank, s; 0 where the case does not fit there.
double step_undivided(Prepared& p) {
  const Device several = std::exchange(p.device, p.device.undivided());
  p.memory.ranks = 1;
  double step = 0;
  if (p.memory.of(p.counts) <= p.device.memory) step = time_steps(TrialSimulation(p).simulation()).step;
  p.device = several;
  p.memory.ranks = several.ranks;
  return step;
}

/// What each rank has, what they exchange, and what dividing gains. `from`: before the steps of `timing`;
/// fast_flow: that lists of all may grow by, bytes.
std::string ranks_text(Prepared& p, const StepTiming& timing, const std::vector<RankReport>& from,
                       const std::vector<RankReport>& to, std::size_t fast_flow) {
  std::string out;
  double most = 0, all = 0, sent = 0;
  for (std::size_t r = 0; r < to.size(); ++r) {
    const RankReport& now = to[r];
    const Counts& n = now.own;
    const std::string name = p.device.cuda() ? fmt::format("GPU {}", p.device.gpus[r]) : fmt::format("{}", r);
    out += fmt::format("{:<10} {}: fluid {}, walls {}, grains {}, ghosts {}; {} of {} free\n",
                       r == 0 ? "ranks" : "", name, grouped(n.fluid), grouped(n.walls), grouped(n.grains),
                       grouped(now.ghosts), bytes_text(now.bytes + fast_flow / to.size()),
                       bytes_text(p.device.memory));
    const auto own = double(n.fluid + n.walls + n.grains);
    most = std::max(most, own), all += own;
    sent = std::max(sent, now.sent - from[r].sent);
  }
  const auto ranks = double(to.size());
  out += fmt::format("imbalance  {:.3g}: most particles of a rank over the mean\n", most * ranks / all);
  out += fmt::format("exchanges  {:.3g} a step, at most {} a step from a rank\n",
                     double(to[0].exchanges - from[0].exchanges) / timing.steps,
                     bytes_text(std::size_t(sent / timing.steps)));
  const double alone = step_undivided(p);
  out += alone > 0 ? fmt::format("speed-up   {:.3g} over one rank, by the first steps\n", alone / timing.step)
                   : "speed-up   unknown: the case is too large for one rank\n";
  return out;
}

void check(const Options& options, Prepared& p) {
  const Config& c = p.config;
  const Counts& n = p.counts;
  fmt::print("{}{}", summary_text(p), notes_text(p));
  if (!options.preview.empty()) {
    write_preview(options.preview, c, p.setup);
    fmt::print("preview    {}\n", (options.preview / "preview.png").string());
  }

  const Counts later = with_inflow(p);
  const std::size_t estimate = p.memory.of(n), more = p.memory.of(later) - estimate;
  const auto print_memory = [&](const char* about, std::size_t bytes, const std::string& part = "") {
    fmt::print("memory     {}{}{}{}; {} free\n", about, bytes_text(bytes), part,
               more > 0 ? fmt::format(", up to {} incl. inflow", bytes_text(bytes + more)) : "",
               bytes_text(p.device.memory));
  };
  FirstStep first(p, !options.restart.empty());
  if (!first.trial) {
    print_memory("about ", estimate);
  } else {
    for (const Remark& remark : first.remarks) fmt::print("{:<10} {}\n", remark.about, remark.text);
    fmt::print("{}{}", limits_text("step", first.steps), limits_text("substep", first.substeps));
    first.take();

    TrialSimulation& trial = *first.trial;
    MemoryNeed memory = first.memory;
    const std::vector<RankReport> from = trial.simulation().ranks();
    const StepTiming timing = time_steps(trial.simulation());
    const std::vector<RankReport> to = trial.simulation().ranks();
    const bool settled = trial.starts_from_settled_bed();
    if (settled) memory = trial.memory();  // else grains have been falling
    const std::string fast_flow =
        100 * memory.fast_flow_bytes > memory.all
            ? fmt::format(", of which {} only in fast flow", bytes_text(memory.fast_flow_bytes))
            : "";
    if (to.empty()) {
      print_memory("", memory.all, fast_flow);
    } else {
      first.trial.reset();
      fmt::print("memory     {} on all ranks{}\n", bytes_text(memory.all), fast_flow);
      fmt::print("{}", ranks_text(p, timing, from, to, memory.fast_flow_bytes));
    }
    const double count = std::ceil((c.time.end - p.begin) / timing.dt);
    const Throughput rate = throughput_of(p.device, c.precision);  // for inflow; the rest is measured
    const double fluid = 0.5 * double(later.fluid - n.fluid), grains = 0.5 * double(later.grains - n.grains);
    const double seconds =
        count * (timing.step + fluid / rate.fluid + std::max(timing.substeps, 1.0) * grains / rate.grains);
    fmt::print("steps      about {} of {:.3g} s{}\n", grouped(std::llround(count)), timing.dt,
               timing.substeps == 0  ? ""
               : timing.substeps > 1 ? fmt::format(", {:.0f} substeps per step, limited by {}",
                                                   timing.substeps, with_key(timing.substep_limit))
                                     : ", 1 substep per step");
    fmt::print("{}{}", fewer_steps_text(c, timing, count), fewer_substeps_text(c, timing));
    fmt::print("{}", run_time_text(seconds, timing, first.free_surface && may_splash(c), !settled));
    if (c.grain.present && c.grain.settle) {
      const double many = std::ceil(c.grain.settle_time / least_of(grain_limits(c)).seconds);
      fmt::print("settling   at most {} substeps, {}, before t = 0; none if the settled bed is cached\n",
                 grouped(std::llround(many)), duration_text(many * timing.substep));
    }
  }
  for (const std::string& warning : p.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("case OK\n");
}

}  // namespace

int check_case(const Options& options) {
  Prepared p = prepare(options);
  placed(p.config.places, [&] { check(options, p); });
  return 0;
}

}  // namespace bedload
