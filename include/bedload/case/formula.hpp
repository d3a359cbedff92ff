#pragma once
// Formulas in case files.

#include <memory>
#include <string>
#include <string_view>

#include "bedload/core/vec.hpp"

namespace bedload {

/// An expression in x, y, z (m) or other variables of one letter, e.g. "0.1*sin(2*pi*z)"; functions as in
/// muParser, constants pi and e. Up to four variables.
class Formula {
 public:
  /// Throws CaseError with the reason, without naming file or key.
  explicit Formula(const std::string& text, std::string_view variables = "xyz");
  Formula(Formula&&) noexcept;
  ~Formula();

  double operator()(const Vec3d& x) const;            ///< of the first three variables
  double operator()(const Vec3d& x, double t) const;  ///< of four
  bool uses(char variable) const;
  double operator()(double t) const { return (*this)(Vec3d{t, 0, 0}); }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bedload
