#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/fluid/views.hpp"
#include "kernels/fluid/wall_mass.hpp"

namespace BL_SOLVER {

/// Continuity of the mixture over dt, eps_a d rho_a / dt = -sum_b M_b (q_a - q_b) . r_ab F_ab, and nothing
/// else that changes density; walls count as in DensityPass.
template <class W>
struct ContinuityPass {
  W w;
  Real rho0, dt;  ///< kg/m3, s
  FluidView fluid;
  WallView walls;
  Span<const Real> compression;
  Span<Real> compression_next;

  template <class N = Real>
  struct Sum {
    Vec3<N> q;
    N rate;
  };
  BL_HD Sum<> start(Index a) const { return {fluid.flux[a].v, 0}; }
  BL_HD auto sources() const { return sources_of(fluid.flux); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& qb) const {
    sum.rate += M * w.F(root(r2)) * dot(sum.q - qb.v, r);
  }
  BL_HD auto wall_sources() const { return sources_of(walls.v_rho, walls.state); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const VelocityDensity<N>& vb,
                       const WallState<N>& mb) const {
    sum.rate += continuity_mass(mb, rho0) * w.F(root(r2)) * dot(sum.q - vb.v, r);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.rate += other.rate; }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    compression_next[a] = compression[a] - dt * sum.rate / (fluid.state[a].eps * rho0);
  }
};

/// Density by summation [tsuzuki (16)], as s = density / rho0 - 1:
///   rho_a = n sum_b M_b W_ab, with b = a and walls, n making it rho0 on the initial lattice of fluid.
/// kGrains: grains are counted as fluid of their volume [tsuzuki 2.4], and fluid by its own mass instead of
/// that of the mixture:
///   rho_a = n (sum_b m_b W_ab + rho0 sum_j V_j W_aj).
template <class W, bool kGrains>
struct SummationPass {
  W w;
  Real rho0, n;  ///< kg/m3, -
  Span<const EosState<>> eos_state;
  Span<const WallState<>> wall_state;
  Span<const Real> eps, grains;  ///< grains: sum_j V_j W_aj; both of kGrains
  Span<Real> compression;

  template <class N = Real>
  struct Sum {
    N rho;
  };
  BL_HD Sum<> start(Index) const { return {}; }
  BL_HD auto sources() const { return sources_of(read_if<kGrains>(eps)); }
  template <class N, class Porosity>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N M, [[maybe_unused]] const Porosity& eps_b) const {
    if constexpr (kGrains) M = eps_b * M;
    sum.rho += M * w.W(root(r2));
  }
  BL_HD auto wall_sources() const { return sources_of(wall_state); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>&, N r2, const WallState<N>& m) const {
    sum.rho += m.mass * w.W(root(r2));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.rho += other.rho; }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    Real rho = eos_state[a].mass_over_eps * w.W(Real(0));
    if constexpr (kGrains) rho = eps[a] * rho + rho0 * grains[a];
    compression[a] = n * (rho + sum.rho) / rho0 - 1;
  }
};

/// The same for frozen wall particles that have their own density: over the walls around, all of which
/// count at rho0, and the fluid.
template <class W>
struct FrozenSummationPass {
  W w;
  Real rho0, n;  ///< kg/m3, -
  Span<const Real> volume;
  Span<const EosState<>> eos_state;
  WallBodies bodies;
  Span<Real> compression;

  template <class N = Real>
  struct Sum {
    N s;
  };
  BL_HD Sum<> start(Index) const { return {}; }
  BL_HD auto sources() const { return sources_of(volume); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N, N V) const {
    sum.s += V * w.W(root(r2));
  }
  BL_HD auto wall_sources() const { return sources_of(eos_state); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>&, N r2, const EosState<N>& m) const {
    sum.s += quotient(m.mass_over_eps, N(rho0)) * w.W(root(r2));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.s += other.s; }
  BL_HD void finish(Index b, const Sum<>& sum) const {
    if (bodies[b].kind != WallKind::frozen || compression[b] == kNoCompression) return;
    compression[b] = n * (volume[b] * w.W(Real(0)) + sum.s) - 1;
  }
};

/// For how much each wall particle stands, m3.
struct WallVolume {
  WallBodies bodies;
  Span<Real> volume;
  BL_HD void operator()(Index b) const {
    const BodyPose& k = bodies[b];
    volume[b] = k.present ? Real(k.volume) : Real(0);
  }
};

/// Shepard's mean over a particle and the fluid around it,
///   q_a <- sum_b V_b q_b W_ab / sum_b V_b W_ab,   V = M / (rho0 (1 + s)),
/// which leaves what is the same everywhere as it is.
template <class W>
struct ShepardPass {
  W w;
  Real rho0;
  Span<const EosState<>> eos_state;
  Span<const Real> compression, q;
  Span<Real> mean;

  template <class N = Real>
  struct Sum {
    N weight, q;
  };
  BL_HD Sum<> start(Index) const { return {}; }
  BL_HD auto sources() const { return sources_of(compression, q); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N M, N s_b, N q_b) const {
    const N V = quotient(M, rho0 * (1 + s_b)) * w.W(root(r2));
    sum.weight += V;
    sum.q += V * q_b;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.weight += other.weight;
    into.q += other.q;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const Real V = eos_state[a].mass_over_eps / (rho0 * (1 + compression[a])) * w.W(Real(0));
    mean[a] = (sum.q + V * q[a]) / (sum.weight + V);
  }
};

/// P from P / rho^2, and back.
struct PressureOf {
  Span<const EosState<>> eos_state;
  Span<Real> p;
  BL_HD void operator()(Index a) const { p[a] = eos_state[a].pressure(); }
};
struct SetPressure {
  Span<const Real> p;
  Span<EosState<>> eos_state;
  Span<Real> p_rho2;
  BL_HD void operator()(Index a) const {
    EosState<>& state = eos_state[a];
    p_rho2[a] = p[a] / square(state.rho);
    state.p_over_rho2 = p_rho2[a];
  }
};

}  // namespace BL_SOLVER
