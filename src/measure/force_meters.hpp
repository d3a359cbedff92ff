#pragma once
// Mean loads on wall bodies for force probes: summed on the device after each step, copied when a row is due.

#include <array>
#include <string>
#include <vector>

#include "bedload/case/config/output.hpp"
#include "bedload/parallel/loops.hpp"
#include "kernels/bodies/body_action.hpp"

namespace BL_SOLVER {

/// Load on one body, by source.
using BodyActions = std::array<BodyAction, kActionParts>;

class ForceMeters {
 public:
  void add(const ProbeConfig& probe, int body, int free_place);

  bool any() const { return !meters_.empty(); }
  int size() const { return int(meters_.size()); }
  /// Index of the meter of that probe; -1: it has none.
  int place_of(const std::string& probe) const;
  const std::vector<std::uint32_t>& bodies() const { return bodies_; }

  /// Starts at time t (s) with the present load.
  void begin(int meter, double t, const BodyActions& now);
  /// Resets the sums at time t (s).
  void begin_interval(int meter, double t);
  /// Runs `pass`; its bodies and sums are set here.
  void advance(SumActionsPass pass);
  /// Mean over the interval until t (s); the present load if the interval is empty.
  BodyActions mean(int meter, double t) const;

  void save(SavedState& out) const;
  /// False if the state has no such meter, which then has to begin.
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

}  // namespace BL_SOLVER
