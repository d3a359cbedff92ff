#pragma once
// Density of walls that do not take it from an extrapolated pressure.

#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"
#include "kernels/fluid/views.hpp"

namespace BL_SOLVER {

/// Continuity of the inner layer of frozen walls, the sum C of DensityPass over fluid; s >= `least`.
template <class W>
struct FrozenPass {
  W w;
  Real rho0, dt, least;  ///< kg/m3, s, -
  FluidView fluid;
  WallView walls;
  WallBodies bodies;
  Span<Real> compression;

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N rate;
  };
  BL_HD Sum<> start(Index b) const { return {walls.v_rho[b].v, 0}; }
  BL_HD auto sources() const { return sources_of(fluid.flux); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& qa) const {
    sum.rate += M * w.F(root(r2)) * dot(sum.v - qa.v, r);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.rate += other.rate; }
  BL_HD void finish(Index b, const Sum<>& sum) const {
    const bool dry = walls.state[b].mass == 0;
    if (dry || bodies[b].kind != WallKind::frozen || compression[b] == kNoCompression) return;
    compression[b] = max_of(least, compression[b] - dt * sum.rate / rho0);
  }
};

/// Density of mirrored walls (mDBC) [english22]: density and its gradient at the image of each particle in
/// the fluid, by a corrected SPH sum that is exact for linear fields, extrapolated to the particle. Where the
/// matrix is singular, the Shepard mean.
template <class W>
struct MirrorPass {
  W w;
  Frame frame;
  Real rho0, least, least_sum;  ///< kg/m3; lower bound on the result; no fluid below this sum of W, 1/m3
  FluidView fluid;
  Span<const Vec3d> x, image;
  WallBodies bodies;
  Span<Real> compression;

  static constexpr Real kLeastDeterminant = Real(1e-3);  // 1 where the image is deep in the fluid

  /// With s = x_a - image and weights V_a W, V_a F: the matrix [W, W s; F s, F s s] and [W, F s] rho.
  template <class N = Real>
  struct Sum {
    N number, unity;
    Vec3<N> Ws, Fs;
    SymmetricMatrix<N> Fss;
    N W_rho;
    Vec3<N> Fs_rho;
  };
  BL_HD Sum<> start(Index) const { return {0, 0, {}, {}, {}, 0, {}}; }
  BL_HD auto sources() const { return sources_of(fluid.flux, fluid.state); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& va,
                  const EosState<N>& ma) const {
    const N volume = M / va.rho, distance = root(r2), here = w.W(distance);
    const N W_a = volume * here, F_a = volume * w.F(distance), rho = ma.rho / rho0 - 1;
    sum.number += here;
    sum.unity += W_a;
    sum.Ws -= W_a * r;
    sum.Fs -= F_a * r;
    sum.Fss.add_outer(F_a, r);
    sum.W_rho += W_a * rho;
    sum.Fs_rho -= F_a * rho * r;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.number += other.number;
    into.unity += other.unity;
    into.Ws += other.Ws;
    into.Fs += other.Fs;
    into.Fss += other.Fss;
    into.W_rho += other.W_rho;
    into.Fs_rho += other.Fs_rho;
  }
  BL_HD void finish(Index b, const Sum<>& sum) const {
    if (bodies[b].kind != WallKind::mirrored) return;
    compression[b] = sum.number < least_sum ? kNoCompression : max_of(least, carried_back(b, sum));
  }

 private:
  BL_HD Real carried_back(Index b, const Sum<>& sum) const {
    const Real determinant = sum.Fss.determinant();
    if (determinant > kLeastDeterminant) {
      const SymmetricMatrix<Real> inverse = sum.Fss.inverse();
      const Real pivot = sum.unity - dot(sum.Ws, inverse * sum.Fs);
      if (pivot * determinant > kLeastDeterminant) {
        const Real rho = (sum.W_rho - dot(sum.Ws, inverse * sum.Fs_rho)) / pivot;
        const Real3 slope = inverse * (sum.Fs_rho - rho * sum.Fs);
        return rho + dot(slope, Real3(frame.separation(x[b], image[b])));
      }
    }
    return sum.W_rho / sum.unity;
  }
};

}  // namespace BL_SOLVER
