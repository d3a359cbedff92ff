#pragma once
// The kernel functions that a case may name.

#include <string>

#include "bedload/case/config.hpp"
#include "bedload/core/error.hpp"
#include "kernels/smoothing/cubic_spline.hpp"
#include "kernels/smoothing/lucy.hpp"
#include "kernels/smoothing/wendland_c2.hpp"

namespace bedload::inline BL_VARIANT {

/// f(kernel) with the kernel function called `name` at smoothing length h (m), for a plane flow of that
/// `thickness` (m) where it is not 0: the choice is made here, once, on the host. Throws CaseError for an
/// unknown name.
template <class F>
void with_kernel(const std::string& name, double h, F&& f, double thickness = 0) {
  if (name == WendlandC2::name)
    f(WendlandC2(h, thickness));
  else if (name == CubicSpline::name)
    f(CubicSpline(h, thickness));
  else if (name == Lucy::name)
    f(Lucy(h, thickness));
  else
    throw CaseError("fluid.kernel = " + name + ": must be wendland_c2, cubic or lucy");
}

/// The same for the fluid of a case.
template <class F>
void with_fluid_kernel(const Config& config, F&& f) {
  with_kernel(config.fluid.kernel, config.fluid.h(), f, config.domain.thickness());
}

/// Support of the kernel called `name`, in smoothing lengths.
inline double kernel_kappa(const std::string& name) {
  double kappa = 0;
  with_kernel(name, 1.0, [&](const auto& w) { kappa = w.kappa; });
  return kappa;
}

}  // namespace bedload::inline BL_VARIANT
