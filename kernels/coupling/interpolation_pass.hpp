#pragma once
#include "kernels/coupling/fluid_weight.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"

namespace bedload::inline BL_VARIANT {

/// What a grain found in the fluid around it, kept until the reaction is spread.
struct GrainSurroundings {
  Span<Vec3d> x;                      ///< where the grain was, m
  Span<Real> inv_S;                   ///< 0: dry
  Span<Real> rho;                     ///< intrinsic fluid density, kg/m3
  Span<Real3> arm;                    ///< weighted mean of r_a - r_j, m
  Span<SymmetricMatrix<Real>> inv_M;  ///< 1/m2; zero where the couple is undefined
};

/// Grain j reads the fluid: porosity, velocity, rotation, and the force of pressure and viscous
/// stress on its volume, V_j sum phi rho~ theta [he18] Eqs. 27-29, corrected, as if it were wet all over.
/// Moments: whether the rotation and the couple are wanted.
template <class W, bool Moments>
struct InterpolationPass {
  FluidWeight<W> weight;
  Real S_least, eps_min;  ///< of S, below which there is no mean to be had
  Span<const Real> fluid_eps;
  Span<const Real3> theta;
  Span<const Vec3d> x;
  Span<const Real3> v;
  Span<const Real> radius;
  Span<Real> eps;
  Span<Real3> U, omega_f, fluid_force;
  GrainSurroundings surroundings;

  /// Sums over the fluid of V_a W times what is named; velocities relative to the grain.
  struct Sum {
    Real3 v_grain;
    double S = 0;  // in fp64: every weight is divided by it
    Real eps = 0, rho = 0;
    Real3 u, rho_theta;
    Real3 arm, spin;  // arm = r_a - r_j; spin = arm x u
    SymmetricMatrix<Real> moment;
  };
  BL_HD Sum start(Index j) const {
    Sum sum;
    sum.v_grain = v[j];
    return sum;
  }
  BL_HD void pair(Sum& sum, Index, Index a, const Real3& r_ja, Real r2) const {
    const Real4 state = weight.v_rho[a];
    const Real vw = weight(a, r2);
    const Real3 u = state.xyz() - sum.v_grain;
    sum.S += vw;
    sum.eps += vw * fluid_eps[a];
    sum.rho += vw * state.w / fluid_eps[a];
    sum.u += vw * u;
    sum.rho_theta += vw * state.w * theta[a];
    if constexpr (Moments) {
      const Real3 arm = -r_ja;
      sum.arm += vw * arm;
      sum.spin += vw * cross(arm, u);
      sum.moment.add_outer(vw, arm);
    }
  }
  BL_HD void merge(Sum& into, const Sum& other) const {
    into.S += other.S;
    into.eps += other.eps;
    into.rho += other.rho;
    into.u += other.u;
    into.rho_theta += other.rho_theta;
    if constexpr (Moments) {
      into.arm += other.arm;
      into.spin += other.spin;
      into.moment += other.moment;
    }
  }
  BL_HD void finish(Index j, const Sum& sum) const {
    const Real inv_S = sum.S > S_least ? Real(1 / sum.S) : Real(0);
    surroundings.x[j] = x[j];
    surroundings.inv_S[j] = inv_S;
    surroundings.rho[j] = sum.rho * inv_S;
    eps[j] = sum.S > 0 ? clamp(sum.eps / Real(sum.S), eps_min, Real(1)) : Real(1);
    U[j] = sum.v_grain + inv_S * sum.u;
    fluid_force[j] = (4 * kPi / 3 * cube(radius[j]) * inv_S) * sum.rho_theta;
    omega_f[j] = {};
    if constexpr (Moments) rotation(j, sum, inv_S);
  }

 private:
  /// M = sum phi (s2 1 - s s) about the weighted mean place of the fluid, and M omega_f = sum phi s x u.
  BL_HD void rotation(Index j, const Sum& sum, Real inv_S) const {
    const Real3 arm = inv_S * sum.arm;
    auto moment = sum.moment.template as<double>(1);
    const double second = moment.trace();
    moment.add_outer(-sum.S, Vec3d(arm));
    // Against the moment about the grain, never smaller than M: rounding cannot pass for a spread.
    const auto inverse = moment.inertia().inverse();
    const bool usable = inv_S > 0 && inverse.norm() * second < 1e6;  // false for NaN
    surroundings.arm[j] = arm;
    surroundings.inv_M[j] = usable ? inverse.template as<Real>(sum.S) : SymmetricMatrix<Real>{};
    omega_f[j] = inv_S * (surroundings.inv_M[j] * (sum.spin - cross(arm, sum.u)));
  }
};

}  // namespace bedload::inline BL_VARIANT
