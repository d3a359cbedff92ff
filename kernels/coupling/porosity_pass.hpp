#pragma once
#include "bedload/core/span.hpp"
#include "kernels/contact/grain_mass.hpp"
#include "kernels/coupling/averaging.hpp"
#include "kernels/coupling/orifice_weight.hpp"
#include "kernels/coupling/wall_free_fraction.hpp"

namespace BL_SOLVER {

/// Whether walls may cut the kernel of each grain while it stays within `skin` (m) of its position in the
/// list.
struct BesideWalls {
  WallFreeFraction<> free;
  AveragingRange range;
  double skin;
  Span<const Vec3d> x_list;
  Span<const Real> radius;
  BL_HD bool operator()(Index j) const {
    return free.may_cut(x_list[j], Real(range(double(radius[j]))), skin);
  }
};

/// Volume of grain j for V_j W(r; h_c) / s_j, s_j being the fraction of the kernel not cut off by walls, so
/// that the whole volume is distributed; of a grain that is far from walls.
struct GrainVolumePass {
  AveragingRange range;
  Frame frame;
  double per_dt;  ///< 1 / step, 1/s; 0 before the first step
  Span<const Vec3d> x, x_before;
  Span<const Real3> v;
  VolumePerR3 volume_per_r3;
  Span<const Real> radius;
  Span<Real> wall_free;
  Span<Real4> volume;  ///< mean velocity over the step, m/s; V_j / s_j, m3
  Span<Real> shrink;   ///< of OwnAverages; empty: all have the least range

  BL_HD void operator()(Index j) const { set(j, 1); }
  BL_HD void set(Index j, Real s) const {
    const Real3 u = per_dt > 0 ? Real3(per_dt * frame.nearest_image(x[j] - x_before[j])) : v[j];
    if (shrink) shrink[j] = Real(range.least / range(double(radius[j])));
    wall_free[j] = s;
    volume[j] = {u, Real(volume_per_r3(j)) * cube(radius[j]) / s};
  }
};

/// The same of a grain that may be near walls.
template <class Kinds>
struct CutVolumePass {
  WallFreeFraction<Kinds> free;
  Span<const Index> grains;  ///< empty: all
  GrainVolumePass of;
  BL_HD void operator()(Index k) const {
    const Index j = grains ? grains[k] : k;
    of.set(j, free(of.x[j], Real(of.range(double(of.radius[j])))));
  }
};

/// eps_a = 1 - sum_j w_ja with w_ja = f_a V_j W(|r_a - r_j|; h_c) / s_j [harting14] Eq. 6, and the volume
/// flux of the mixture, eps_a v_a + sum_j w_ja u_j. f_a is one except near orifices and where the
/// porosity would fall below its floor. With the same weights grains take their part of the stress
/// (BuoyancyPass).
template <class W, class Averages = OneAverage>
struct PorosityPass {
  W w;
  Averages averages = {};
  bool shares;  ///< whether grains displace fluid; else only the porosity is computed
  Real floor;
  OrificeWeight away_from_orifices;
  Frame frame;
  Span<const FluidPosition> x;
  Span<const Real4> volume;
  Span<const VelocityDensity<>> v_rho;
  Span<const Real> mass;
  Span<Real> eps, solid_factor;
  Span<VelocityDensity<>> flux;
  Span<EosState<>> eos_state;
  Span<PairPosition> xp, xp_mid;  ///< whose weights follow the porosity; xp_mid may be empty

  static constexpr bool kSideBySide = true;

  template <class N = Real>
  struct Sum {
    N solid;
    Vec3<N> q;
  };
  BL_HD Sum<> start(Index) const { return {}; }
  BL_HD auto sources() const { return sources_of(volume, averages.field()); }
  template <class N, class Own>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N, const Vec4<N>& grain, const Own& own) const {
    const N weight = grain.w * averages.W(w, own, root(r2));
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
    const VelocityDensity<> old = v_rho[a];
    solid_factor[a] = factor;
    flux[a] = {porosity * old.v + factor * sum.q, old.rho};
    const Real weight = mass[a] / porosity;
    eos_state[a].mass_over_eps = weight;
    eos_state[a].eps = porosity;
    using Weight = decltype(PairPosition::weight);
    xp[a].weight = Weight(weight);
    if (xp_mid) xp_mid[a].weight = Weight(weight);
  }
};

/// Volume of grains around fluid that is added to its density sum, sum_j V_j W(|r_a - r_j|; h).
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

}  // namespace BL_SOLVER
