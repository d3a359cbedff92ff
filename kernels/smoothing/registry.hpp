#pragma once
// The kernel functions that a case may name.

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/core/first_look.hpp"
#include "kernels/smoothing/cubic_spline.hpp"
#include "kernels/smoothing/lucy.hpp"
#include "kernels/smoothing/wendland_c2.hpp"

namespace BL_SOLVER {

/// f(kernel) with the kernel function of that name at smoothing length h (m), for a plane flow of that
/// `thickness` (m) where it is not 0: the choice is made here, once, on the host. Throws CaseError where a
/// text is no name.
template <class F>
void with_kernel(Chosen<KernelFunction> name, double h, F&& f, double thickness = 0) {
  switch (name) {
    case KernelFunction::wendland_c2:
      return f(WendlandC2(h, thickness));
    case KernelFunction::cubic:
      if constexpr (!kFirstLook) return f(CubicSpline(h, thickness));
      break;
    case KernelFunction::lucy:
      if constexpr (!kFirstLook) return f(Lucy(h, thickness));
      break;
  }
  if (kFirstLook) not_in_first_look("fluid.kernel", "wendland_c2 alone");
}

/// The same for a fluid.
template <class F>
void with_fluid_kernel(const FluidProperties& fluid, const DomainConfig& domain, F&& f) {
  with_kernel(fluid.kernel, fluid.h(), f, domain.thickness());
}

/// Support of the kernel called `name`, in smoothing lengths.
inline double kernel_kappa(Chosen<KernelFunction> name) {
  double kappa = 0;
  with_kernel(name, 1.0, [&](const auto& w) { kappa = w.kappa; });
  return kappa;
}

}  // namespace BL_SOLVER
