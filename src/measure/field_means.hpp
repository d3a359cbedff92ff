#pragma once
// Means over time of coarse-grained fields: sums over instants of an interval, the same on all ranks.

#include <cstdint>
#include <string>
#include <vector>

#include "bedload/core/types.hpp"
#include "bedload/host_data.hpp"

namespace BL_SOLVER {

class FieldMeans {
 public:
  /// every: between instants, s.
  void add(const std::string& probe, double every) { means_.push_back({.probe = probe, .every = every}); }
  bool any() const { return !means_.empty(); }

  void begin_interval(const std::string& probe, double t);
  /// Adds what `sums(probe)` returns for those whose next instant has come.
  template <class Sums>
  void sample(double t, Sums&& sums) {
    for (Mean& mean : means_)
      if (t >= mean.next) take(mean, t, sums(mean.probe));
  }
  /// Over the instants of the interval so far; empty: there is none, or no such probe.
  std::vector<double> mean(const std::string& probe) const;

  void save(SavedState& out) const;
  /// Those that the state lacks begin at t.
  void load(const SavedState& saved, double t);

 private:
  struct Mean {
    std::string probe;
    double every;                  ///< s
    double since = 0, next = 0;    ///< s
    std::int64_t instants = 0;     ///< in the sum
    std::vector<double> sum = {};  ///< [instants > 0 ? size : 0]

    std::string store() const { return "probe_" + probe; }
    void begin(double t) { since = t, next = t + every, instants = 0, sum.clear(); }
  };
  static void take(Mean& mean, double t, const std::vector<double>& now);

  std::vector<Mean> means_;
};

}  // namespace BL_SOLVER
