#include "src/time/lattice_simulation.hpp"

#include <cmath>

#include "bedload/case/lattice_step.hpp"
#include "bedload/core/error.hpp"
#include "src/time/stage.hpp"

namespace BL_SOLVER {
namespace {

constexpr std::int64_t kLook = 64;  // steps between looks at the extremes, which cost half a step
constexpr double kFastest = 0.2;    // nodes a step
constexpr double kWidest = 0.3;     // of the density

const HostStore& store_in(const SavedState& saved, const std::string& name) {
  for (const auto& s : saved.stores)
    if (s.name == name) return s;
  throw FileError("checkpoint has no " + name);
}

}  // namespace

LatticeSimulation::LatticeSimulation(const Config& config, const Setup& setup)
    : config_(config),
      clock_(config.time),
      limits_(lattice_step(config).limits),
      solver_(lattice_parameters(config)) {
  if (!setup.nodes.solid.empty()) solver_.fill(setup.nodes);
}

void LatticeSimulation::start() {
  solver_.begin();
  for (const ProbeConfig& p : config_.out.probes)
    if (p.type == ProbeType::force) begin_interval(p);
}

StepInfo LatticeSimulation::step() {
  watch_.start();
  solver_.step(clock_.time, clock_.step + 1);
  watch_.lap(int(Part::fluid));
  clock_.time += solver_.dt();
  clock_.last_dt = solver_.dt();
  ++clock_.step;
  if (clock_.step % kLook == 0) check_extremes();
  watch_.lap(int(Part::checks));
  watch_.stop();
  return {.step = clock_.step,
          .time = clock_.time,
          .dt = solver_.dt(),
          .limit = least_of(limits_).limit,
          .vmax = speed_};
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
  for (const Part part : {Part::fluid, Part::checks})
    all.push_back({std::string(name_of(part)), "s", watch_.seconds(int(part))});
  return all;
}

SavedState LatticeSimulation::save() {
  SavedState out;
  solver_.save(out);
  const auto add = [&](const std::string& name, const char* unit, double value) {
    out.scalars.push_back({name, unit, value});
  };
  add("time", "s", clock_.time);
  add("step", "-", double(clock_.step));
  add("last_dt", "s", clock_.last_dt);
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
  clock_.time = scalar("time");
  clock_.step = std::int64_t(scalar("step"));
  clock_.last_dt = scalar("last_dt");
  speed_ = scalar("speed");
  solver_.load(store_in(saved, "fluid"), store_in(saved, "links"), scalar, clock_.time, clock_.step);
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
