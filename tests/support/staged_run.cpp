// Compiled once for each build of the solver that tests/backends compares.

#include "tests/support/staged_run.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "bedload/geometry/setup.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

using test::StageField, test::StageFields;

/// A number of `scalar` type, the k-th.
double number(const HostArray& a, std::size_t k) {
  switch (a.type) {
    case Scalar::f32:
      return a.as<float>()[k];
    case Scalar::f64:
      return a.as<double>()[k];
    case Scalar::u32:
      return a.as<std::uint32_t>()[k];
    case Scalar::u64:
      return double(a.as<std::uint64_t>()[k]);
  }
  return 0;
}

/// Which components are one quantity: vectors; of four, a vector and another, but for states.
std::vector<int> groups_of(const std::string& name, int components) {
  std::vector<int> group(components);
  std::iota(group.begin(), group.end(), 0);
  const auto one = [&](int first) { group[first + 1] = group[first + 2] = group[first]; };
  if (components == 3 || (components == 4 && name != "eos_state" && name != "state")) one(0);
  if (components == 12) one(1), one(4), one(7);  // what a grain remembers of a wall: normal, spring, couple
  return group;
}

class VariantRun final : public test::StagedRun {
 public:
  explicit VariantRun(const Config& config) : config_(config), simulation_(config_, setup_of(config_)) {
    simulation_.start();
  }
  void step(const Observer& f) override {
    std::string ended;
    stepper().step([&](const Stage* next) {
      f(ended);
      if (next) ended = next->name;
    });
  }
  StageFields fields() const override {
    StageFields all;
    each([&](const Store& store, FieldBase& field, const std::vector<Index>& order) {
      HostArray raw = field.to_host();
      const std::size_t row = raw.components * size_of(raw.type);
      if (!order.empty() && raw.count() == order.size()) {
        HostArray sorted = raw;
        for (std::size_t i = 0; i < order.size(); ++i)
          std::copy_n(raw.bytes.data() + order[i] * row, row, sorted.bytes.data() + i * row);
        raw = std::move(sorted);
      }
      StageField out{store.name + "/" + field.name, std::move(raw), {}, {}};
      decode(field, out);
      all.push_back(std::move(out));
    });
    return all;
  }
  void take(const StageFields& from) override {
    std::size_t n = 0;
    each([&](const Store&, FieldBase& field, const std::vector<Index>& order) {
      HostArray raw = from.at(n++).raw;
      const std::size_t row = raw.components * size_of(raw.type);
      if (!order.empty() && raw.count() == order.size()) {
        const HostArray sorted = raw;
        for (std::size_t i = 0; i < order.size(); ++i)
          std::copy_n(sorted.bytes.data() + i * row, row, raw.bytes.data() + order[i] * row);
      }
      field.from_host(raw);
    });
  }

 private:
  static Setup setup_of(const Config& config) {
    std::vector<std::string> warnings;
    return build_setup(config, warnings);
  }
  Stepper& stepper() const { return simulation_.stepper(); }

  /// f(store, field, order) for each that the case uses; order: places of the particles by their ids.
  template <class F>
  void each(const F& f) const {
    std::vector<Index> order;
    for (const Store* store : stepper().stores()) {
      if (store->name != "mirrors") order = by_id(*store);  // those are in the order of the walls
      for (FieldBase* field : store->fields())
        if (field->used()) f(*store, *field, order);
    }
  }
  static std::vector<Index> by_id(const Store& store) {
    for (const FieldBase* field : store.fields()) {
      if (field->name != "id") continue;
      const HostArray id = field->to_host();
      std::vector<Index> order(id.count());
      std::iota(order.begin(), order.end(), Index(0));
      std::sort(order.begin(), order.end(),
                [&](Index a, Index b) { return id.as<std::uint32_t>()[a] < id.as<std::uint32_t>()[b]; });
      return order;
    }
    return {};
  }
  void decode(const FieldBase& field, StageField& out) const {
    const Frame& frame = simulation_.state().frame;
    const auto places = [&]<class P>(std::type_identity<P>, const auto& coordinates_of, bool weighed) {
      out.group = weighed ? std::vector{0, 0, 0, 1} : std::vector{0, 0, 0};
      for (std::size_t i = 0; i < out.raw.count(); ++i) {
        const P p = out.raw.as<P>()[i];
        const Vec3d x = coordinates_of(p);
        out.values.insert(out.values.end(), {x.x, x.y, x.z});
        if constexpr (requires { p.weight; }) out.values.push_back(p.weight);
      }
    };
    if (dynamic_cast<const Field<FixedPosition>*>(&field))
      return places(
          std::type_identity<FixedPosition>{},
          [&](const FixedPosition& p) {
            return Vec3d{p.x / frame.quanta.x, p.y / frame.quanta.y, p.z / frame.quanta.z};
          },
          true);
    if (dynamic_cast<const Field<PackedPosition>*>(&field))
      return places(
          std::type_identity<PackedPosition>{}, [&](const PackedPosition& p) { return frame.unpack(p); },
          false);
    out.group = groups_of(field.name, out.raw.components);
    for (std::size_t k = 0; k < out.raw.count() * out.raw.components; ++k)
      out.values.push_back(number(out.raw, k));
  }

  const Config config_;
  mutable CoupledSimulation simulation_;
};

}  // namespace

std::unique_ptr<test::StagedRun> staged_run(const Config& config) {
  return std::make_unique<VariantRun>(config);
}

}  // namespace BL_SOLVER
