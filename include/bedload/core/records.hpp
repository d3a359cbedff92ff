#pragma once
// What pair loops read of a particle together: four numbers in one aligned load, 16 bytes in fp32. N is Real
// or, for several neighbours at a time, Pack.

#include "bedload/core/pack.hpp"

namespace BL_SOLVER {

/// Velocity of fluid or wall, or volume flux of the mixture, and density.
template <class N = Real>
struct alignas(4 * sizeof(N)) VelocityDensity {
  Vec3<N> v{};  ///< m/s
  N rho{};      ///< kg/m3
};

/// State of a fluid particle.
template <class N = Real>
struct alignas(4 * sizeof(N)) EosState {
  N mass_over_eps{};  ///< M = m / eps, of the mixture that the particle represents, kg
  N p_over_rho2{};    ///< P / rho^2, m5/(kg s2)
  N rho{};            ///< of the fluid alone, kg/m3
  N eps{};            ///< porosity
  BL_HD N pressure() const { return p_over_rho2 * square(rho); }  ///< Pa
};

/// State of a wall particle.
template <class N = Real>
struct alignas(4 * sizeof(N)) WallState {
  N mass{};         ///< kg; 0: no fluid near by
  N p_over_rho2{};  ///< m5/(kg s2)
  N rho{};          ///< kg/m3
  N frozen{};       ///< 1: keeps its mass as fluid does, and turns with its body; else 0
  BL_HD N pressure() const { return p_over_rho2 * square(rho); }  ///< Pa
};

/// With what a wall particle drags fluid along.
template <class N = Real>
struct alignas(4 * sizeof(N)) NoSlip {
  Vec3<N> v{};  ///< such that fluid has the wall's velocity at its surface, m/s
  N mass{};     ///< kg; 0 where fluid slips
};

#if !BL_CUDA
/// A record of four numbers, or of a vector and a number, gathered as Real4 is.
template <template <class> class Record, class J>
[[gnu::always_inline]] inline Record<Pack> gather(const Record<Real>* p, J j) {
  static_assert(sizeof(Record<Real>) == sizeof(Real4) && alignof(Record<Real>) == alignof(Real4));
  const Vec4<Pack> v = gather(reinterpret_cast<const Real4*>(p), j);
  if constexpr (requires { Record<Pack>{v.x, v.y, v.z, v.w}; })
    return {v.x, v.y, v.z, v.w};
  else
    return {v.xyz(), v.w};
}
#endif

}  // namespace BL_SOLVER
