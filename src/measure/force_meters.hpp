#pragma once
// Means of what acts on wall bodies, for force probes: summed on the device after each step, copied when a
// row is due.

#include <array>
#include <string>
#include <vector>

#include "bedload/case/config/output.hpp"
#include "bedload/parallel/loops.hpp"
#include "kernels/bodies/body_action.hpp"

namespace bedload::inline BL_VARIANT {

/// On one body, by parts.
using BodyActions = std::array<BodyAction, kActionParts>;

class ForceMeters {
 public:
  void add(const ProbeConfig& probe, int body, int free_place);

  bool any() const { return !meters_.empty(); }
  int size() const { return int(meters_.size()); }
  /// Of the probe of that name; -1: it has none.
  int place_of(const std::string& probe) const;
  const std::vector<std::uint32_t>& bodies() const { return bodies_; }

  /// From time t (s) on, with what acts then.
  void begin(int meter, double t, const BodyActions& now);
  /// The sums start again, at time t (s).
  void begin_interval(int meter, double t);
  /// `pass` with all but bodies and sums, which are filled in.
  void advance(SumActionsPass pass);
  /// Since the interval began until t (s); what acts now if that is no time.
  BodyActions mean(int meter, double t) const;

  void save(SavedState& out) const;
  /// False where the state has none of that meter: it is yet to begin.
  bool load(int meter, const SavedState& saved);

 private:
  struct Meter {
    std::string probe;
    Vec3d about;       ///< m
    double since = 0;  ///< s
  };
  std::array<double, kActionParts> key(int meter) const;

  std::vector<Meter> meters_;
  std::vector<std::uint32_t> bodies_;
  std::vector<MeteredBody> metered_;
  Buffer<MeteredBody> device_metered_;
  Buffer<BodyAction> action_, sum_;  ///< [meters][kActionParts]
};

}  // namespace bedload::inline BL_VARIANT
