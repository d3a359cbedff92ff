#pragma once
// A simulation without physics: everything it shows follows from step, time and
// id by formulas that read_vtkhdf.py knows too.

#include <cstdint>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/simulation.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::testing {

template <class T>
HostArray array_of(const std::string& name, const std::string& unit, Scalar type, int components,
                   const std::vector<T>& values) {
  HostArray a{.name = name, .unit = unit, .type = type, .components = components, .bytes = {}};
  const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
  a.bytes.assign(bytes, bytes + values.size() * sizeof(T));
  return a;
}

/// Lines at step k, 3, 0, 5, 5 .. of them; line n goes from (n, k, 0) to (n, k, 1).
inline HostStore line_frame(int k) {
  const std::size_t count = k == 0 ? 3 : k == 1 ? 0 : k < 12 ? 5 : 4;
  std::vector<double> ends;
  std::vector<float> force;
  std::vector<std::uint32_t> id;
  for (std::size_t n = 0; n < count; ++n) {
    for (const double z : {0.0, 1.0}) ends.insert(ends.end(), {double(n), double(k), z});
    force.push_back(float(10 * k) + float(n));
    id.push_back(std::uint32_t(n + 7));
  }
  HostStore store{"contacts",
                  count,
                  {array_of("ends", "m", Scalar::f64, 6, ends), array_of("force", "N", Scalar::f32, 1, force),
                   array_of("id", "-", Scalar::u32, 1, id)}};
  store.lines = true;
  return store;
}

class FakeSimulation : public Simulation {
 public:
  static constexpr double kDt = 0.03;

  StepInfo step() override {
    ++steps_;
    time_ += kDt;
    return info();
  }
  StepInfo info() const {
    return {.step = steps_, .time = time_, .dt = steps_ ? kDt : 0, .limit = Limit::fixed};
  }
  void settle(double, const std::function<void(double)>&) override {}
  void start() override {}
  double time() const override { return time_; }
  std::int64_t steps() const override { return steps_; }
  /// One fluid particle leaves after 10 steps; the walls never move.
  Counts counts() const override { return {.fluid = steps_ < 10 ? 7 : 6, .walls = 4, .grains = 3}; }
  std::vector<StepLimit> limits() override { return {}; }
  std::vector<StepLimit> substep_limits() const override { return {}; }
  std::size_t bytes() const override { return 12345; }
  ParticleBytes field_bytes() const override { return {}; }
  ParticleBytes scratch_bytes() const override { return {}; }
  std::size_t growth() override { return 0; }
  std::vector<Quantity> numerical_viscosity() const override { return {{"artificial_bulk", "-", 12.5}}; }
  std::vector<Quantity> time_spent() const override { return {{"fluid", "s", 0.25 * double(steps_)}}; }

  std::vector<FieldView> fields(const std::string&) override { return {}; }
  HostStore snapshot(const std::string& store) override {
    if (store == "contacts") return line_frame(int(steps_));
    const auto n = std::size_t(store == "fluid"    ? counts().fluid
                               : store == "grains" ? counts().grains
                                                   : counts().walls);
    const double t = store == "walls" ? 0 : time_;
    std::vector<double> x, spin;
    std::vector<float> speed;
    std::vector<std::uint32_t> id;
    for (std::size_t i = 0; i < n; ++i) {
      x.insert(x.end(), {double(i) + t, 2.0 * i, 0.125 - t * i});
      spin.insert(spin.end(), {t, 1e-3 * i, -t});
      speed.push_back(float(10 * i + t));
      id.push_back(std::uint32_t(100 + i));
    }
    return {store,
            n,
            {array_of("position", "m", Scalar::f64, 3, x), array_of("speed", "m/s", Scalar::f32, 1, speed),
             array_of("spin", "rad/s", Scalar::f64, 3, spin), array_of("id", "-", Scalar::u32, 1, id)}};
  }
  HostStore rheology(const std::string& store) override { return {store, 0, {}}; }
  std::vector<Quantity> diagnostics() override {
    return {{"fluid mass", "kg", 0.1 * double(counts().fluid)}, {"kinetic energy", "J", time_ * time_}};
  }
  /// A bin more every ten steps.
  std::vector<std::vector<Quantity>> spectra() override {
    std::vector<std::vector<Quantity>> rows;
    for (int k = 0; k <= steps_ / 10; ++k)
      rows.push_back({{"from", "J", 1e-3 * k}, {"count", "-", double(steps_)}});
    return rows;
  }
  std::vector<std::vector<Quantity>> spectra_peaks() override { return spectra(); }
  std::vector<Quantity> measure(const ProbeConfig& probe) override { return {{probe.name, "m", time_ / 3}}; }
  void begin_interval(const ProbeConfig& probe) override { intervals.push_back({probe.name, time_}); }
  std::vector<Loss> losses() override { return {{"fluid", "z+", 1, 0.125, 0.3}}; }
  std::vector<std::pair<std::string, double>> intervals;  ///< begun, and when
  std::vector<Quantity> body_state(int body) override { return {{"x", "m", time_ + body}}; }

  SavedState save() override {
    const std::vector<double> x{1.0 / 3, time_, -0.0};
    const std::vector<std::uint64_t> word{~std::uint64_t{0}, std::uint64_t(steps_)};
    return {{{"fluid", 1, {array_of("position", "m", Scalar::f64, 3, x)}},
             {"contacts", 2, {array_of("pair", "-", Scalar::u64, 1, word)}},
             {"bodies", 0, {array_of<float>("speed", "m/s", Scalar::f32, 3, {})}}},
            {{"time", "s", time_}, {"steps", "-", double(steps_)}}};
  }
  void load(const SavedState& state) override {
    time_ = state.scalars.at(0).value;
    steps_ = std::int64_t(state.scalars.at(1).value);
  }
  SavedState save_grains() override { return {}; }
  void load_grains(const SavedState&) override {}

 private:
  double time_ = 0;
  std::int64_t steps_ = 0;
};

inline Config fake_config() {
  Config c;
  c.title = "fake";
  c.domain.max = {1, 1, 1};
  c.fluid.present = true;
  c.fluid.dx = 0.01;
  c.fluid.fills.push_back({{0, 0, 0}, {1, 1, 0.5}});
  c.grain.present = true;
  c.wall.bodies.emplace_back().name = "tank";
  c.out.every = 0.1;
  c.out.diagnostics_every = 0.05;
  c.out.contacts = "touching";
  c.out.spectra = true;
  auto& probe = c.out.probes.emplace_back();
  probe.name = "gauge";
  probe.type = "front";
  probe.every = 0.2;
  return c;
}

}  // namespace bedload::testing
