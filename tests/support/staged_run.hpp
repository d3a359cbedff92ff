#pragma once
// A run of one build, stage by stage, as one who knows neither precision nor device sees it.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload::test {

/// One field of the state, in the order of ids where its particles have some.
struct StageField {
  std::string name;  ///< "store/field"
  HostArray raw;     ///< as the build keeps it
  /// As numbers, count() times `components`; those of one group are components of one quantity.
  std::vector<double> values;
  std::vector<int> group;  ///< [components]
  int components() const { return int(group.size()); }
};
using StageFields = std::vector<StageField>;

class StagedRun {
 public:
  virtual ~StagedRun() = default;
  /// Called with the stage that has ended: with nothing before the first.
  using Observer = std::function<void(const std::string& ended)>;
  /// One step; calls f before the first stage and after each.
  virtual void step(const Observer& f) = 0;
  virtual StageFields fields() const = 0;
  /// Goes on with the values of a run of the same case and precision.
  virtual void take(const StageFields& fields) = 0;
};

}  // namespace bedload::test
