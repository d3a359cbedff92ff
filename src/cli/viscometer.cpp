#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "bedload/core/error.hpp"
#include "run.hpp"
#include "src/viscometer/report.hpp"
#include "stop.hpp"

namespace bedload {
namespace {

constexpr int kLayers = 40, kSamples = 50;  // per block

double value_of(const std::vector<Quantity>& all, const std::string& name) {
  for (const Quantity& q : all)
    if (q.name == name) return q.value;
  return 0;
}

/// Samples the flow once it is steady.
class Viscometer final : public RunWatcher {
 public:
  /// without: viscosity of the case without grains, for the relative viscosity.
  explicit Viscometer(std::optional<Measured> without = {}) : without_(without) {}

  void begin(const Config& config, double end) override {
    config_ = config;
    flow_ = plane_flow_of(config);
    const double nu = config.fluid.mu / config.fluid.rho0;
    const int blocks = blocks_until(flow_, nu, end);
    from_ = kStart * flow_.relaxation(nu);
    interval_ = (end - from_) / blocks / kSamples;
    layers_.emplace(flow_, left_out(config.fluid), kLayers, blocks);
  }

  void after_step(Simulation& simulation, const StepInfo& info) override {
    const double number = std::floor((info.time - from_) / interval_ + 1e-9);
    if (info.time < from_ || number <= last_) return;
    last_ = number;
    const int block = std::min(int(number) / kSamples, int(layers_->blocks().size()) - 1);
    layers_->add(block, simulation.rheology("fluid"), simulation.rheology("grains"), wall_stress(simulation));
  }

  bool may_restart() const override { return false; }  // it averages over the whole run

  RunFindings findings() override {
    result_ = evaluate(*layers_, config_, (resolves() ? 1 : config_.fluid.kappa()) * left_out(config_.fluid));
    quantities_ = quantities_of(*result_, flow_);
    if (const auto ratio = relative()) {
      quantities_.push_back({"relative_viscosity", "-", ratio->mean});
      quantities_.push_back({"relative_viscosity_error", "-", ratio->error});
    }
    RunFindings out{"viscometer", quantities_, {}, caveat()};
    if (!result_->stationary())
      out.warnings.push_back(fmt::format(
          "the flow is not steady: the viscosity of the second half of the blocks differs by {:.2g} % "
          "from that of the first",
          100 * result_->drift));
    if (result_->mach > 0.1 * (1 + 1e-6))
      out.warnings.push_back(
          fmt::format("Mach number {:.3g} is above 0.1: increase fluid.vmax", result_->mach));
    return out;
  }

  /// Caveat about the relative viscosity; empty without one.
  std::string caveat() const {
    if (!relative()) return "";
    if (resolves()) return resolved_viscosities(result_->concentration);
    return relative_caveat(result_->concentration, config_.couple.suspension != SuspensionLaw::none);
  }
  const std::optional<ViscosityResult>& result() const { return result_; }
  const std::vector<Quantity>& quantities() const { return quantities_; }
  const PlaneFlow& flow() const { return flow_; }
  const Config& config() const { return config_; }
  /// Viscosity over that without grains, which for grains that fluid flows around is fluid.mu unless
  /// measured.
  std::optional<Measured> relative() const {
    if (!result_ || !result_->accepted()) return {};
    if (!without_ && !(resolves() && config_.grain.present)) return {};
    const Measured &with = result_->viscosity, bare = without_.value_or(Measured{config_.fluid.mu, 0});
    const double ratio = with.mean / bare.mean;
    return Measured{ratio, ratio * std::hypot(with.error / with.mean, bare.error / bare.mean)};
  }

 private:
  bool resolves() const { return config_.fluid.lattice(); }
  /// Mean shear stress on the walls, Pa.
  double wall_stress(Simulation& simulation) const {
    if (flow_.kind != PlaneFlowKind::couette) return 0;
    const std::string axis(1, "xyz"[flow_.along]);
    const auto force = [&](int body) {
      const auto state = simulation.body_state(body);
      return value_of(state, "force_by_fluid_" + axis) + value_of(state, "force_by_grains_" + axis);
    };
    return (force(flow_.lower) - force(flow_.upper)) / (2 * flow_.area);
  }

  std::optional<Measured> without_;
  Config config_;
  PlaneFlow flow_;
  std::optional<Layers> layers_;
  std::optional<ViscosityResult> result_;
  std::vector<Quantity> quantities_;
  double from_ = 0, interval_ = 0, last_ = -1;
};

/// Runs and reports; the exit code.
int measure(const Options& o, Prepared prepared, Viscometer& viscometer) {
  const int code = run_prepared(o, std::move(prepared), &viscometer);
  if (!viscometer.result()) return code;
  const ViscosityResult& r = *viscometer.result();
  write_report(o.out / "viscometer", r, viscometer.flow(), viscometer.quantities(),
               viscometer.config().title);
  fmt::print("{}", report_text(r, viscometer.flow(), viscometer.config().fluid.mu));
  if (const auto ratio = viscometer.relative())
    fmt::print("relative   {:.4f} +- {:.4f} of the viscosity without grains; {}\n", ratio->mean, ratio->error,
               viscometer.caveat());
  if (r.accepted()) return code;
  fmt::print(stderr, "{}: fit rejected, viscosity not reported: R^2 = {:.3f} of the {} profile is below {}\n",
             (o.out / "viscometer" / "profile.csv").string(), r.r_squared, viscometer.flow().name(),
             ViscosityResult::kLeastR2);
  return code ? code : kExitNoViscosity;
}

Config without_grains(Config c) {
  c.grain.present = false;
  c.grain.fills.clear();
  return c;
}

}  // namespace

int viscometer(const Options& o) {
  watch_signals();
  Prepared prepared = prepare(o);
  const Config& config = prepared.config;
  placed(config.places, [&] {
    Viscometer().begin(config,
                       o.until.value_or(config.time.end));  // fails before the run if the flow is unsuitable
  });
  std::optional<Measured> without;
  if (o.relative) {
    if (!config.grain.present)
      throw CaseError(fmt::format("command line: --relative: {} has no grains", o.file.string()));
    Options bare = o;
    bare.out = o.out / "without_grains";
    Prepared again;
    again.config = without_grains(config);
    initialise(bare, again);
    Viscometer first;
    const int code = measure(bare, std::move(again), first);
    if (code != 0) return code;
    without = first.result()->viscosity;
  }
  Viscometer main(without);
  return measure(o, std::move(prepared), main);
}

}  // namespace bedload
