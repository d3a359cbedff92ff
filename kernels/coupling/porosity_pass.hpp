#pragma once
#include "bedload/core/span.hpp"
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/coupling/orifice_weight.hpp"
#include "kernels/coupling/wall_free_fraction.hpp"

namespace bedload::inline BL_VARIANT {

/// Whether walls may cut the kernel of each grain while it keeps within `skin` (m) of where it was listed.
struct BesideWallsPass {
  WallFreeFraction free;
  double skin;
  Span<const Vec3d> x_list;
  Span<std::uint8_t> beside;
  BL_HD void operator()(Index j) const { beside[j] = free.may_cut(x_list[j], skin); }
};

/// Where grain j is, for its volume: V_j W(r; h_c) / s_j, s_j being the fraction of the kernel that walls
/// leave free, so that none of it is lost to them.
struct GrainVolumePass {
  WallFreeFraction free;
  Frame frame;
  double per_dt;  ///< 1 / step (s), or 0 where no step has been made
  Span<const Vec3d> x, x_before;
  Span<const Real3> v;
  Span<const Real> radius;
  Span<const std::uint8_t> beside;  ///< that of BesideWallsPass; empty: all may be
  Span<Real> wall_free;
  Span<Real4> volume;  ///< mean velocity over the step, m/s; V_j / s_j, m3

  BL_HD void operator()(Index j) const {
    const Real3 u = per_dt > 0 ? Real3(per_dt * frame.nearest_image(x[j] - x_before[j])) : v[j];
    const Real s = !beside || beside[j] ? free(x[j]) : Real(1);
    wall_free[j] = s;
    volume[j] = {u, 4 * kPi / 3 * cube(radius[j]) / s};
  }
};

/// eps_a = 1 - sum_j w_ja with w_ja = f_a V_j W(|r_a - r_j|; h_c) / s_j [harting14] Eq. 6, and the volume
/// flux of the mixture, eps_a v_a + sum_j w_ja u_j. f_a is one but for fluid beside orifices and where the
/// porosity would fall below its floor. With the same weights grains take their part of the stress
/// (BuoyancyPass).
template <class W>
struct PorosityPass {
  W w;
  bool shares;  ///< whether fluid gives way to grains; else they are but counted
  Real floor;
  OrificeWeight away_from_orifices;
  Frame frame;
  Span<const FluidPosition> x;
  Span<const Real4> volume, v_rho;
  Span<const Real> mass;
  Span<Real> eps, solid_factor;
  Span<Real4> flux, m_state;
  Span<PairPosition> xp, xp_mid;  ///< whose weights follow the porosity; xp_mid may be empty

  template <class N = Real>
  struct Sum {
    N solid;
    Vec3<N> q;
  };
  BL_HD Sum<> start(Index) const { return {}; }
  BL_HD auto sources() const { return sources_of(volume); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N, const Vec4<N>& grain) const {
    const N weight = grain.w * w.W(root(r2));
    sum.solid += weight;
    sum.q += weight * grain.xyz();
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.solid += other.solid;
    into.q += other.q;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    Real factor = sum.solid > 0 ? away_from_orifices(coordinates(frame, x[a])) : Real(1);
    Real porosity = 1 - factor * sum.solid;
    if (porosity < floor) {
      porosity = floor;
      factor = (1 - floor) / sum.solid;
    }
    eps[a] = porosity;
    if (!shares) return;
    const Real4 v = v_rho[a];
    solid_factor[a] = factor;
    flux[a] = {porosity * v.xyz() + factor * sum.q, v.w};
    const Real weight = mass[a] / porosity;
    m_state[a].x = weight;
    m_state[a].w = porosity;
    using Weight = decltype(PairPosition::weight);
    xp[a].weight = Weight(weight);
    if (xp_mid) xp_mid[a].weight = Weight(weight);
  }
};

/// Volume of grains around fluid as its density counts it, sum_j V_j W(|r_a - r_j|; h).
template <class W>
struct GrainsAroundPass {
  W w;
  Span<const Real> radius;
  Span<Real> around;

  template <class N = Real>
  struct Sum {
    N volume;
  };
  BL_HD Sum<> start(Index) const { return {}; }
  BL_HD auto sources() const { return sources_of(radius); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N, const N& R) const {
    sum.volume += 4 * kPi / 3 * cube(R) * w.W(root(r2));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.volume += other.volume; }
  BL_HD void finish(Index a, const Sum<>& sum) const { around[a] = sum.volume; }
};

}  // namespace bedload::inline BL_VARIANT
