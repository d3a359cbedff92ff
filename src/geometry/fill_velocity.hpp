#pragma once
// The initial velocity of fluid.

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/formula.hpp"
#include "bedload/core/error.hpp"
#include "src/case/shortened.hpp"

namespace bedload {

/// The velocity formulas of a fill.
class FillVelocity {
 public:
  FillVelocity(const FluidFill& fill, std::size_t index) : fill_(fill), index_(index) {
    for (int k = 0; k < 3; ++k) {
      try {
        formulas_.emplace_back(fill.velocity[k]);
      } catch (const CaseError& error) {
        fail(k, error.what());
      }
    }
  }

  /// m/s at x.
  Vec3d operator()(const Vec3d& x) const {
    Vec3d v;
    for (int k = 0; k < 3; ++k) {
      v[k] = formulas_[k](x);
      if (!std::isfinite(v[k])) fail(k, fmt::format("it is not at ({:g}, {:g}, {:g}) m", x.x, x.y, x.z));
    }
    return v;
  }

 private:
  [[noreturn]] void fail(int k, const std::string& why) const {
    throw KeyError(fmt::format("fluid.fill.{}.velocity", index_),
                   fmt::format("fluid.fill.velocity = \"{}\" along {} must be finite; {}",
                               shortened(fill_.velocity[k]), "xyz"[k], why));
  }

  const FluidFill& fill_;
  std::size_t index_;
  std::vector<Formula> formulas_;
};

}  // namespace bedload
