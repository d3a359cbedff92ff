#include "src/team/team_simulation.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/parallel/host_loop.hpp"
#include "src/team/workers.hpp"

namespace bedload {
namespace {

class TeamSimulation final : public Simulation {
 public:
  explicit TeamSimulation(const TeamOptions& options)
      : parts_(std::make_shared<Parts>(std::size_t(options.ranks))), workers_(options) {
    try {
      workers_.run([parts = parts_, make = options.make, this](int rank) {
        (*parts)[std::size_t(rank)] = make(workers_.link(rank));
      });
    } catch (...) {
      release();
      throw;
    }
  }
  ~TeamSimulation() override { release(); }

  StepInfo step() override {
    return first_of([](Simulation& s) { return s.step(); });
  }
  void settle(double longest, const std::function<void(double)>& progress) override {
    workers_.run([parts = parts_, longest, progress](int rank) {
      (*parts)[std::size_t(rank)]->settle(
          longest, rank == 0 ? progress : [](double) {});
    });
  }
  void start() override {
    each([](Simulation& s) { s.start(); });
  }
  // known to each rank, without the others
  double time() const override { return first().time(); }
  std::int64_t steps() const override { return first().steps(); }
  Counts counts() const override { return first().counts(); }
  std::vector<StepLimit> substep_limits() const override { return first().substep_limits(); }
  std::vector<Quantity> numerical_viscosity() const override { return first().numerical_viscosity(); }
  std::size_t bytes() const override { return first().bytes(); }
  ParticleBytes field_bytes() const override { return first().field_bytes(); }
  ParticleBytes scratch_bytes() const override { return first().scratch_bytes(); }
  std::vector<Quantity> time_spent() const override { return first().time_spent(); }
  std::vector<RankReport> ranks() override {
    std::vector<RankReport> out;
    for (const auto& of_rank : all_of([](Simulation& s) { return s.ranks(); }))
      out.insert(out.end(), of_rank.begin(), of_rank.end());
    return out;
  }

  std::vector<StepLimit> limits() override {
    return first_of([](Simulation& s) { return s.limits(); });
  }
  std::size_t growth() override {
    std::size_t sum = 0;
    for (const std::size_t bytes : all_of([](Simulation& s) { return s.growth(); })) sum += bytes;
    return sum;
  }
  HostStore snapshot(const std::string& store) override {
    return joined(all_of([&](Simulation& s) { return s.snapshot(store); }));
  }
  HostStore rheology(const std::string& store) override {
    return joined(all_of([&](Simulation& s) { return s.rheology(store); }));
  }
  std::vector<FieldView> fields(const std::string&) override { return {}; }
  std::vector<Quantity> diagnostics() override {
    return first_of([](Simulation& s) { return s.diagnostics(); });
  }
  std::vector<std::vector<Quantity>> spectra() override {
    return first_of([](Simulation& s) { return s.spectra(); });
  }
  std::vector<std::vector<Quantity>> spectra_peaks() override {
    return first_of([](Simulation& s) { return s.spectra_peaks(); });
  }
  std::vector<Quantity> measure(const ProbeConfig& probe) override {
    return first_of([&](Simulation& s) { return s.measure(probe); });
  }
  void begin_interval(const ProbeConfig& probe) override {
    each([&](Simulation& s) { s.begin_interval(probe); });
  }
  std::vector<Loss> losses() override {
    return first_of([](Simulation& s) { return s.losses(); });
  }
  std::vector<Quantity> body_state(int body) override {
    return first_of([&](Simulation& s) { return s.body_state(body); });
  }
  SavedState save() override {
    return joined(all_of([](Simulation& s) { return s.save(); }));
  }
  void load(const SavedState& state) override {
    each([&](Simulation& s) { s.load(state); });
  }
  SavedState save_grains() override {
    return joined(all_of([](Simulation& s) { return s.save_grains(); }));
  }
  void load_grains(const SavedState& state) override {
    each([&](Simulation& s) { s.load_grains(state); });
  }

 private:
  using Parts = std::vector<std::unique_ptr<Simulation>>;
  const Simulation& first() const { return *(*parts_)[0]; }
  template <class F>
  void each(const F& f) {
    workers_.run([parts = parts_, f](int rank) { f(*(*parts)[std::size_t(rank)]); });
  }
  template <class F>
  using Result = std::invoke_result_t<F, Simulation&>;
  template <class F>
  std::vector<Result<F>> all_of(const F& f) {
    const auto all = std::make_shared<std::vector<Result<F>>>(parts_->size());
    workers_.run(
        [parts = parts_, all, f](int rank) { (*all)[std::size_t(rank)] = f(*(*parts)[std::size_t(rank)]); });
    return std::move(*all);
  }
  template <class F>
  Result<F> first_of(const F& f) {
    return std::move(all_of(f)[0]);
  }
  /// What a rank has allocated is freed by its own thread; never, if some do not respond.
  void release() {
    static auto& kept = *new std::vector<std::shared_ptr<Parts>>;
    try {
      workers_.run([parts = parts_](int rank) { (*parts)[std::size_t(rank)].reset(); });
    } catch (const DeviceError&) {
      kept.push_back(parts_);
    }
  }

  std::shared_ptr<Parts> parts_;
  Workers workers_;
};

}  // namespace

HostStore joined(std::vector<HostStore> parts) {
  const HostStore& first = parts[0];
  if (!first.find("block")) return std::move(parts[0]);
  HostStore out{first.name, 0, {}};
  out.lines = first.lines;
  for (const HostStore& part : parts) out.count += part.count;
  /// Entries of a rank that follow one another.
  struct Run {
    std::size_t rank, from, to, count;
  };
  std::vector<Run> runs;
  std::vector<std::size_t> at(parts.size(), 0);
  const auto components = std::size_t(first.find("block")->components);
  const auto block = [&](std::size_t rank, std::size_t entry) {
    return std::span(parts[rank].find("block")->as<std::uint32_t>() + entry * components, components);
  };
  const auto before = [&](std::size_t a, std::size_t b) {  // of what comes next from two ranks
    const auto of_a = block(a, at[a]), of_b = block(b, at[b]);
    return std::lexicographical_compare(of_a.begin(), of_a.end(), of_b.begin(), of_b.end());
  };
  for (std::size_t done = 0; done < out.count;) {
    std::size_t next = parts.size(), second = parts.size();  // ranks that come next
    for (std::size_t r = 0; r < parts.size(); ++r) {
      if (at[r] == parts[r].count) continue;
      if (next == parts.size() || before(r, next))
        second = next, next = r;
      else if (second == parts.size() || before(r, second))
        second = r;
    }
    const std::size_t from = at[next];
    do ++at[next];
    while (at[next] < parts[next].count && (second == parts.size() || !before(second, next)));
    runs.push_back({next, from, done, at[next] - from});
    done += at[next] - from;
  }
  for (std::size_t k = 0; k < first.arrays.size(); ++k) {
    const HostArray& a = first.arrays[k];
    if (a.name == "block") continue;
    const std::size_t row = size_of(a.type) * std::size_t(a.components);
    out.arrays.push_back({a.name, a.unit, a.type, a.components, HostBytes(out.count * row)});
    std::byte* const to = out.arrays.back().bytes.data();
    host_for_each(runs.size(), [&](std::size_t n) {
      const Run& run = runs[n];
      std::memcpy(to + run.to * row, parts[run.rank].arrays[k].bytes.data() + run.from * row,
                  run.count * row);
    });
    for (HostStore& part : parts) part.arrays[k].bytes = {};  // all twice is more than a host may have
  }
  return out;
}

SavedState joined(std::vector<SavedState> parts) {
  SavedState out{{}, std::move(parts[0].scalars)};
  for (std::size_t s = 0; s < parts[0].stores.size(); ++s) {
    std::vector<HostStore> stores;
    for (SavedState& part : parts) stores.push_back(std::move(part.stores[s]));
    out.stores.push_back(joined(std::move(stores)));
  }
  return out;
}

std::unique_ptr<Simulation> make_team(const TeamOptions& options) {
  return std::make_unique<TeamSimulation>(options);
}

}  // namespace bedload
