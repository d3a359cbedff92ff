#include "src/measure/force_meters.hpp"

#include <cstring>

#include "bedload/core/error.hpp"

namespace BL_SOLVER {
namespace {

std::string store_name(const std::string& probe) { return "probe_" + probe; }

}  // namespace

void ForceMeters::add(const ProbeConfig& probe, int body, int free_place) {
  meters_.push_back({probe.name, probe.about});
  bodies_.push_back(std::uint32_t(body));
  metered_.push_back({std::uint32_t(body), std::uint32_t(free_place + 1), probe.about});
  device_metered_.assign(metered_);
  action_.resize(meters_.size() * kActionParts);
  sum_.resize(meters_.size() * kActionParts);
}

int ForceMeters::place_of(const std::string& probe) const {
  for (int m = 0; m < size(); ++m)
    if (meters_[m].probe == probe) return m;
  return -1;
}

void ForceMeters::begin(int m, double t, const BodyActions& now) {
  copy_to_device(action_.data() + m * kActionParts, now.data(), sizeof now);
  begin_interval(m, t);
}

void ForceMeters::begin_interval(int m, double t) {
  meters_[m].since = t;
  fill_zero(sum_.data() + m * kActionParts, sizeof(BodyActions));
}

void ForceMeters::advance(SumActionsPass pass) {
  pass.bodies = device_metered_;
  pass.action = action_;
  pass.sum = sum_;
  for_each({0, Index(size())}, pass);
}

BodyActions ForceMeters::mean(int m, double t) const {
  BodyActions out;
  const double interval = t - meters_[m].since;
  copy_to_host(out.data(), (interval > 0 ? sum_ : action_).data() + m * kActionParts, sizeof out);
  if (interval > 0)
    for (BodyAction& part : out)
      for (double& value : part.v) value /= interval;
  return out;
}

/// Identifies the sum in a checkpoint: the body and the point of its torque.
std::array<double, kActionParts> ForceMeters::key(int m) const {
  const Vec3d& about = meters_[m].about;
  return {double(bodies_[m]), about.x, about.y, about.z};
}

void ForceMeters::save(SavedState& out) const {
  for (int m = 0; m < size(); ++m) {
    const auto array = [&](const char* name, const char* unit, int components, const void* data) {
      HostArray a{name, unit, Scalar::f64, components, {}};
      a.bytes.resize(kActionParts * components * sizeof(double));
      std::memcpy(a.bytes.data(), data, a.bytes.size());
      return a;
    };
    BodyActions action, sum;
    copy_to_host(action.data(), action_.data() + m * kActionParts, sizeof action);
    copy_to_host(sum.data(), sum_.data() + m * kActionParts, sizeof sum);
    out.stores.push_back({store_name(meters_[m].probe),
                          kActionParts,
                          {array("of", "-, m", 1, key(m).data()),
                           array("action", "N, N m, W", BodyAction::kSize, action.data()),
                           array("sum", "N s, N m s, J", BodyAction::kSize, sum.data())}});
    out.scalars.push_back({store_name(meters_[m].probe) + "_since", "s", meters_[m].since});
  }
}

bool ForceMeters::load(int m, const SavedState& saved) {
  const std::string name = store_name(meters_[m].probe);
  const auto of = key(m);
  for (const HostStore& store : saved.stores) {
    if (store.name != name) continue;
    const auto copy = [&](const char* array, auto* to, std::size_t bytes, const auto& copy_bytes) {
      const HostArray* a = store.find(array);
      if (!a || a->bytes.size() != bytes) throw FileError("checkpoint has no array " + name + "/" + array);
      copy_bytes(to, a->bytes.data(), bytes);
    };
    std::array<double, kActionParts> found;
    copy("of", found.data(), sizeof found, std::memcpy);
    if (found != of) return false;
    copy("action", action_.data() + m * kActionParts, sizeof(BodyActions), copy_to_device);
    copy("sum", sum_.data() + m * kActionParts, sizeof(BodyActions), copy_to_device);
    for (const Quantity& q : saved.scalars)
      if (q.name == name + "_since") meters_[m].since = q.value;
    return true;
  }
  return false;
}

}  // namespace BL_SOLVER
