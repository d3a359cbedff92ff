#include "src/measure/field_means.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bedload/core/error.hpp"

namespace BL_SOLVER {

void FieldMeans::begin_interval(const std::string& probe, double t) {
  for (Mean& mean : means_)
    if (mean.probe == probe) mean.begin(t);
}

void FieldMeans::take(Mean& mean, double t, const std::vector<double>& now) {
  if (mean.sum.size() != now.size()) mean.sum.assign(now.size(), 0), mean.instants = 0;
  for (std::size_t k = 0; k < now.size(); ++k) mean.sum[k] += now[k];
  ++mean.instants;
  mean.next = mean.since + (std::floor((t - mean.since) / mean.every) + 1) * mean.every;
  if (mean.next <= t) mean.next += mean.every;  // by round-off
}

std::vector<double> FieldMeans::mean(const std::string& probe) const {
  for (const Mean& mean : means_) {
    if (mean.probe != probe) continue;
    std::vector<double> out = mean.sum;
    for (double& value : out) value /= double(mean.instants);
    return out;
  }
  return {};
}

void FieldMeans::save(SavedState& out) const {
  for (const Mean& mean : means_) {
    HostArray sum{"sum", "-", Scalar::f64, 1, {}};
    sum.bytes.resize(mean.sum.size() * sizeof(double));
    if (!mean.sum.empty()) std::memcpy(sum.bytes.data(), mean.sum.data(), sum.bytes.size());
    out.stores.push_back({mean.store(), mean.sum.size(), {std::move(sum)}});
    out.scalars.push_back({mean.store() + "_since", "s", mean.since});
    out.scalars.push_back({mean.store() + "_next", "s", mean.next});
    out.scalars.push_back({mean.store() + "_instants", "-", double(mean.instants)});
  }
}

void FieldMeans::load(const SavedState& saved, double t) {
  for (Mean& mean : means_) {
    mean.begin(t);
    for (const Quantity& q : saved.scalars) {
      if (q.name == mean.store() + "_since") mean.since = q.value;
      if (q.name == mean.store() + "_next") mean.next = q.value;
      if (q.name == mean.store() + "_instants") mean.instants = std::int64_t(q.value);
    }
    const auto store = std::find_if(saved.stores.begin(), saved.stores.end(),
                                    [&](const HostStore& s) { return s.name == mean.store(); });
    const HostArray* const sum = store == saved.stores.end() ? nullptr : store->find("sum");
    if (!sum) {
      mean.begin(t);
      continue;
    }
    mean.sum.assign(sum->as<double>(), sum->as<double>() + sum->bytes.size() / sizeof(double));
  }
}

}  // namespace BL_SOLVER
