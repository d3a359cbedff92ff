#include "src/time/lattice_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/case/lattice_step.hpp"
#include "bedload/core/error.hpp"
#include "src/time/stage.hpp"

namespace BL_SOLVER {
namespace {

constexpr std::int64_t kLook = 64;  // steps between looks at the extremes, which cost half a step
constexpr double kFastest = 0.2;    // nodes a step
constexpr double kWidest = 0.3;     // of the density

/// The grains of a case alone, in steps of the lattice (s).
std::unique_ptr<CoupledSimulation> grains_of(const Config& config, const Setup& setup, double dt) {
  if (!config.grain.present) return nullptr;
  Config grains = config;
  grains.fluid.present = false;
  grains.time.dt = dt;
  grains.time.force_dt = true;
  grains.out.probes.clear();
  return std::make_unique<CoupledSimulation>(grains, setup);
}

std::unique_ptr<ResolvedGrains> resolved(const Config& config, CoupledSimulation* grains) {
  if (!grains) return nullptr;
  const LatticeParameters p = lattice_parameters(config);
  auto out = std::make_unique<ResolvedGrains>(config.domain, p.units, p.lift, grains->state().grains);
  grains->stepper().solids().flow_around(out->torque());
  return out;
}

}  // namespace

LatticeSimulation::LatticeSimulation(const Config& config, const Setup& setup)
    : config_(config),
      clock_(config.time),
      limits_(lattice_step(config).limits),
      grains_(grains_of(config, setup, lattice_step(config).dt)),
      resolved_(resolved(config, grains_.get())),
      solver_(lattice_parameters(config), resolved_.get()) {
  if (!setup.nodes.solid.empty()) solver_.fill(setup.nodes);
}

void LatticeSimulation::start() {
  if (grains_) grains_->start();
  solver_.begin();
  for (const ProbeConfig& p : config_.out.probes)
    if (p.type == ProbeType::force) begin_interval(p);
}

StepInfo LatticeSimulation::step() {
  const bool fixed = held();
  StepInfo info;
  if (grains_) {
    info = grains_->step();
    if (!fixed) check_grains();
  }
  watch_.start();
  solver_.step(clock_.time, clock_.step + 1, fixed);
  watch_.lap(int(Part::fluid));
  clock_.time += solver_.dt();
  clock_.last_dt = solver_.dt();
  ++clock_.step;
  if (clock_.step % kLook == 0) check_extremes();
  watch_.lap(int(Part::checks));
  watch_.stop();
  info.step = clock_.step;
  info.time = clock_.time;
  info.dt = solver_.dt();
  info.limit = least_of(limits_).limit;
  info.vmax = speed_;
  return info;
}

/// A grain may not pass over nodes.
void LatticeSimulation::check_grains() const {
  const double speed = grains_->stepper().grain_watch().speed, cells = speed / solver_.units().velocity();
  if (cells <= kFastest) return;
  throw SimulationFault("a grain moves at " + std::to_string(speed) + " m/s, " + std::to_string(cells) +
                        " nodes a step, above the " + std::to_string(kFastest) +
                        " that the lattice allows, at t = " + std::to_string(clock_.time) +
                        " s; increase fluid.vmax");
}

void LatticeSimulation::check_extremes() {
  const lattice::NodeExtremes e = solver_.extremes();
  const double speed = std::sqrt(e.speed2);
  speed_ = speed * solver_.units().velocity();
  if (speed <= kFastest && e.least >= -kWidest && e.most <= kWidest) return;
  const Vec3d at = solver_.place(e.fastest);
  const std::string what = speed > 1e100 ? "the fluid has no finite velocity any more"
                           : speed > kFastest
                               ? "the fluid flows at " + std::to_string(speed) + " nodes a step, above the " +
                                     std::to_string(kFastest) + " that the lattice allows,"
                               : "the density of the fluid varies by more than 30 %;"
                                 " it is fastest";
  throw SimulationFault(what + " at (" + std::to_string(at.x) + ", " + std::to_string(at.y) + ", " +
                        std::to_string(at.z) + ") m, t = " + std::to_string(clock_.time) +
                        " s; increase fluid.vmax, or reduce fluid.dx");
}

std::vector<Quantity> LatticeSimulation::time_spent() const {
  std::vector<Quantity> all;
  if (grains_) all = grains_->time_spent();
  for (const Part part : {Part::fluid, Part::checks}) {
    const std::string name(name_of(part));
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Quantity& q) { return q.name == name; });
    if (known == all.end())
      all.push_back({name, "s", watch_.seconds(int(part))});
    else
      known->value += watch_.seconds(int(part));
  }
  return all;
}

SavedState LatticeSimulation::save() {
  SavedState out;
  if (grains_) out = grains_->save();
  solver_.save(out);
  const auto add = [&](const std::string& name, const char* unit, double value) {
    out.scalars.push_back({name, unit, value});
  };
  if (!grains_) {
    add("time", "s", clock_.time);
    add("step", "-", double(clock_.step));
    add("last_dt", "s", clock_.last_dt);
  }
  add("speed", "m/s", speed_);
  for (const auto& [name, interval] : intervals_) {
    add("interval_" + name, "s", interval.time);
    for (int k = 0; k < 3; ++k) {
      add("impulse_" + name + "_" + std::to_string(k), "N s", interval.sums.impulse[k]);
      add("turned_" + name + "_" + std::to_string(k), "N m s", interval.sums.turned[k]);
    }
    add("work_" + name, "J", interval.sums.work);
  }
  return out;
}

void LatticeSimulation::load(const SavedState& saved) {
  const auto found = [&](const std::string& name) -> const Quantity* {
    for (const auto& q : saved.scalars)
      if (q.name == name) return &q;
    return nullptr;
  };
  const auto scalar = [&](const std::string& name) {
    const Quantity* q = found(name);
    if (!q) throw FileError("checkpoint has no " + name);
    return q->value;
  };
  if (grains_) grains_->load(saved);
  clock_.time = scalar("time");
  clock_.step = std::int64_t(scalar("step"));
  clock_.last_dt = scalar("last_dt");
  speed_ = scalar("speed");
  solver_.load(store_of(saved, "fluid"), store_of(saved, "links"), scalar, clock_.time, clock_.step);
  for (const ProbeConfig& p : config_.out.probes) {
    if (p.type != ProbeType::force) continue;
    begin_interval(p);  // of a probe that the checkpoint does not know
    if (!found("interval_" + p.name)) continue;
    Interval& interval = intervals_[p.name];
    interval.time = scalar("interval_" + p.name);
    for (int k = 0; k < 3; ++k) {
      interval.sums.impulse[k] = scalar("impulse_" + p.name + "_" + std::to_string(k));
      interval.sums.turned[k] = scalar("turned_" + p.name + "_" + std::to_string(k));
    }
    interval.sums.work = scalar("work_" + p.name);
  }
}

}  // namespace BL_SOLVER
