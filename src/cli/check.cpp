#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "bedload/case/contact_laws.hpp"
#include "bedload/case/limits.hpp"
#include "bedload/case/particle_order.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/intervals.hpp"
#include "bedload/output/preview.hpp"
#include "commands.hpp"
#include "prepare.hpp"
#include "progress.hpp"
#include "rehearsal.hpp"

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
  Limit substeps_by = Limit::fixed;
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
  Limit by = Limit::fixed;
  while (steps < kMost && seconds < kLongest) {
    const StepInfo info = simulation.step();
    substeps += info.substeps;
    by = info.substep_limit;
    ++steps;
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  }
  const double of_grains = substeps > 0 ? (grains() - grains_before) / double(substeps) : 0;
  return {seconds / steps, of_grains, (simulation.time() - begin) / steps, double(substeps) / steps, by};
}

/// A line each; the one that binds has its key.
std::string limits_text(const char* title, const std::vector<StepLimit>& limits) {
  std::string out;
  for (const StepLimit& limit : limits) {
    const std::string_view key = key_of(limit.limit);
    out += fmt::format("{:<10} {:<12} {}{}{}\n", out.empty() ? title : "", name_of(limit.limit),
                       std::isfinite(limit.seconds) ? fmt::format("{:.4g} s", limit.seconds) : "none",
                       limit.binds ? "  <- binds" : "",
                       limit.binds && !key.empty() ? fmt::format(", by {}", key) : "");
  }
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

/// The stress by which particles not in order resist shear under pressure, and whether that is taken off.
std::string arrangement_text(const Config& c) {
  if (!c.fluid.present || c.fluid.mu == 0 || c.fluid.variable_h || c.fluid.sdpd()) return "";
  const double pressure = c.fluid.rho0 * norm(c.gravity) * c.fluid.depth + c.eos.background;
  if (pressure == 0) return "";
  const double stress = 5e-3 * pressure;  // 2e-3 to 1e-2 on lattices, h = 1.5 dx
  const std::string out = fmt::format(
      "lattice    under {:.3g} Pa an arrangement of particles resists shear by up to about {:.2g} Pa, as "
      "viscosity does at {:.2g} 1/s; ",
      pressure, stress, stress / c.fluid.mu);
  if (const ParticleOrder order = particle_order(c); !order.linear_exact)
    return out + "that stays: " + order.not_exact + "\n";
  const double cell = cell_reynolds_number(std::sqrt(pressure / c.fluid.rho0), c.fluid);
  const char* what = cell < kExactPressure ? "pressure.linear_exact removes that"
                     : cell < kExactPressure * kExactPressureEnds
                         ? "pressure.linear_exact removes part of that"
                         : "that stays, flow slower than that is held by it";
  return out +
         fmt::format("{} (cell Reynolds number {:.3g}, removed below {:g})\n", what, cell, kExactPressure);
}

/// Why particles do not shift, where a case asks for it.
std::string shifting_text(const Config& c) {
  if (!c.fluid.present || c.shift == 0 || c.fluid.sdpd()) return "";
  const ParticleOrder order = particle_order(c);
  return order.shifts ? "" : "shifting   none: " + order.no_shifting + "\n";
}

/// What defaults do that not every case may want.
std::string defaults_text(const Config& c) {
  std::string out;
  const auto say = [&](const char* about, const std::string& what) {
    out += fmt::format("{:<10} {}\n", about, what);
  };
  const bool grains = c.grain.present && c.fluid.present && c.couple.mode != CouplingMode::off;
  if (c.fluid.present && !c.fluid.sdpd() && c.density.cavitation_limit < 1)
    say("tension",
        fmt::format("fluid cavitates below {:.3g} Pa (density.cavitation_limit; diagnostics.csv counts "
                    "the particles){}",
                    c.eos.background - c.density.cavitation_limit * c.fluid.rho0 * c.fluid.c * c.fluid.c,
                    c.wall.suction ? "; until then it hangs from lids and roofs" : ""));
  if (c.fluid.present && !c.fluid.sdpd() && c.fluid.mu > 0 && c.visc.model == ViscosityModel::morris &&
      norm(c.gravity) > 0)
    say("waves",
        "visc.model = \"morris\" damps waves at a free surface half as fast as fluid.mu should; "
        "\"monaghan\" is right there");
  if (grains && c.couple.mode == CouplingMode::two_way && !c.couple.undisturbed && !c.domain.two_d)
    say("wake",
        fmt::format("the fluid that a lone grain feels moves along with it by up to {:.2g} % of its speed; "
                    "couple.undisturbed takes that off",
                    100 * 0.537 * c.grain.d_max / c.couple.hc));
  if (c.grain.present && takes_moduli(c.contact.normal) && c.grain.E < 1e9)
    say("contacts",
        fmt::format(
            "grain.E = {:.3g} Pa is softer than stone, glass or steel: impacts last longer and overlap "
            "more, which also changes spins",
            c.grain.E));
  return out;
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
    fmt::print("{}", viscosity_text(c, simulation.numerical_viscosity()));
    fmt::print("{}{}{}", arrangement_text(c), shifting_text(c), defaults_text(c));
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
    fmt::print("run time   about {} by the pace of the first steps, output apart\n", duration_text(seconds));
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
