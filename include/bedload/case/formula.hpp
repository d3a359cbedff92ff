#pragma once
// Formulas in case files.

#include <string>
#include <string_view>
#include <vector>

#include "bedload/core/formula_code.hpp"

namespace bedload {

/// An expression in x, y, z (m) or other variables of one letter, e.g. "0.1*sin(2*pi*z)". From the loosest:
/// a ? b : c; ||; &&; < <= > >= == !=; + -; * /; signs; ^, which goes from right to left. Conditions are 1
/// or 0. Constants pi and e; sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp ln log (the
/// same) log2 log10 sqrt abs sign rint; atan2(y, x); min max sum avg of one or more. Up to four variables.
class Formula {
 public:
  /// Throws CaseError with the reason, without naming file or key.
  explicit Formula(const std::string& text, std::string_view variables = "xyz");

  /// x, t: the first three variables and the fourth.
  double operator()(const Vec3d& x, double t = 0) const { return code()(x, t); }
  double operator()(double t) const { return (*this)(Vec3d{t, 0, 0}); }
  bool uses(char variable) const;
  const std::vector<FormulaStep>& steps() const { return steps_; }

 private:
  FormulaCode code() const { return {steps_.data(), int(steps_.size())}; }

  std::string variables_;
  std::vector<FormulaStep> steps_;
};

}  // namespace bedload
