#pragma once
// Variables and expressions of the input files of other programs.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bedload {

/// Numbers by name, and expressions of them: "(Dp+2)*2.8", "max(a, sqrt(b))". Functions are those of
/// Formula, and sindg, cosdg, tandg (degrees), pow, floor, ceil, round, int, float, fmod, eval(condition, a,
/// b), pi(), e().
class Variables {
 public:
  void set(const std::string& name, double value) { values_[name] = value; }
  std::optional<double> find(const std::string& name) const;

  /// Throws CaseError with the reason, without naming the file.
  double value(std::string_view expression) const;

 private:
  double call(const std::string& name, const std::vector<double>& arguments) const;

  std::map<std::string, double> values_;
};

}  // namespace bedload
