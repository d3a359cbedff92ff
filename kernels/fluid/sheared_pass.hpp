#pragma once
#include "bedload/core/mean_shear.hpp"
#include "kernels/fluid/density_pass.hpp"
#include "kernels/sdpd/kernel_sums.hpp"
#include "kernels/stress/fluid_stress.hpp"

namespace BL_SOLVER {

/// Lees-Edwards adapter of a pass [lees72]: the loop brings unsheared positions and peculiar velocities
/// (MeanShear); the pass gets true separations and velocities relative to that of the row.
template <class Pass>
struct ShearedPass {
  Pass pass;
  Real strain, rate;  ///< -, 1/s

  template <class N = Real>
  using Sum = typename Pass::template Sum<N>;

  BL_HD Sum<> start(Index a) const { return pass.start(a); }
  BL_HD auto sources() const { return pass.sources(); }
  /// Of passes that read velocities, as the first of their sources.
  template <class N, class... Of>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& lattice, N, N M, const VelocityDensity<N>& vb,
                  const Of&... of_b) const {
    const Vec3<N> r = separation(lattice);
    pass.pair(sum, r, norm2(r), M, VelocityDensity<N>{{vb.v.x - rate * r.z, vb.v.y, vb.v.z}, vb.rho},
              of_b...);
  }
  template <class N, class... Of>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& lattice, N, N M, const Of&... of_b) const {
    const Vec3<N> r = separation(lattice);
    pass.pair(sum, r, norm2(r), M, of_b...);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { pass.merge(into, other); }
  BL_HD void finish(Index a, const Sum<>& sum) const { pass.finish(a, sum); }

 private:
  template <class N>
  BL_HD Vec3<N> separation(const Vec3<N>& lattice) const {
    return {lattice.x + strain * lattice.z, lattice.y, lattice.z};
  }
};

/// Passes that are also compiled with Lees-Edwards boundaries: without grains and species, one smoothing
/// length.
template <class Pass>
constexpr bool kSupportsShear = false;
template <class W, class Shift, class Fit, bool kSmooth>
constexpr bool kSupportsShear<DensityPass<W, Shift, Fit, kSmooth, false, OneLength>> = true;
template <class W, bool kArtificial>
constexpr bool kSupportsShear<ForcePass<W, kArtificial, false, false, OneLength>> = true;
template <class Force>
constexpr bool kSupportsShear<StressPass<Force>> = kSupportsShear<Force>;
template <class W>
constexpr bool kSupportsShear<ContinuityPass<W>> = true;
template <class W>
constexpr bool kSupportsShear<SummationPass<W, false>> = true;
template <class W>
constexpr bool kSupportsShear<ShepardPass<W>> = true;
template <class W, bool kSpin, bool kNoise>
constexpr bool kSupportsShear<SdpdForcePass<W, kSpin, kNoise, false>> = true;
template <class Force, bool kNoise>
constexpr bool kSupportsShear<SdpdStressPass<Force, kNoise>> = kSupportsShear<Force>;

}  // namespace BL_SOLVER
