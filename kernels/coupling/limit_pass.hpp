#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/coupling/drag_pass.hpp"

namespace BL_SOLVER {

/// Rate of drag on a fluid particle, with the couple: L_a / m_a = sum_j phi_ja K_ja / m_a, 1/s.
template <class W, bool Local, bool Couple, class Averages = OneAverage>
struct DragRatePass {
  W w;
  Averages averages = {};
  DragWeights weights;
  DragLevers levers;
  Span<const Real> drag_coefficient, mass;
  Span<const VelocityDensity<>> v_rho;
  Span<const EosState<>> eos_state;
  Span<Real> rate;

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N V, L;
  };
  BL_HD Sum<> start(Index a) const { return {v_rho[a].v, mixture_volume(eos_state[a]), 0}; }
  BL_HD auto sources() const {
    return sources_of(drag_coefficient, weights.still, read_if<Couple>(levers.at_centre),
                      read_if<Couple>(levers.off_centre), read_if<Local>(weights.by_slip), averages.field());
  }
  template <class N, class Lever, class Slip, class Own>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N, const N& K_j, const N& still,
                  [[maybe_unused]] const Lever& at_centre, [[maybe_unused]] const Lever& off_centre,
                  [[maybe_unused]] const Slip& by_slip, const Own& own) const {
    N weight = still;
    if constexpr (Local) weight += slip_weight(sum.v, by_slip);
    const N r = root(r2);
    N L = K_j * sum.V * averages.W(w, own, r) * weight;
    if constexpr (Couple) L *= at_centre + off_centre * r;
    sum.L += L;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.L += other.L; }
  BL_HD void finish(Index a, const Sum<>& sum) const { rate[a] = sum.L / mass[a]; }
};

/// The largest fraction of drag for which a step is stable on the fluid side, x = dt L_a / m_a. Row sums of
/// the exchange then stay at or below one, which is sufficient for energy not to grow, and drag is exact up
/// to x = 1; (1 - exp(-x)) / x would already be 21 % low at the step that time.drag allows.
BL_HD Real allowed_fraction(Real x) { return x > 1 ? 1 / x : Real(1); }

/// Limits the drag of each grain to what is stable for the fluid around it, so that kinetic energy cannot
/// grow however stiff the drag is. Rotational drag acts on the fluid more weakly, by about d2 / 3 M < 1, so
/// the same fraction is sufficient.
struct LimitPass {
  Real dt;  ///< s
  AveragingRange range;
  Span<const Real> radius;
  Span<const Real> rate;
  Span<const Real> lever_sum;  ///< of DragLevers; empty without a couple
  DragFields drag;
  Span<Real> stiffness;  ///< largest dt L_a / m_a around each grain

  struct Largest {
    Real rate, range2;
  };
  BL_HD Largest start(Index j) const { return {0, Real(square(range(double(radius[j]))))}; }
  BL_HD auto sources() const { return sources_of(rate); }
  BL_HD void pair(Largest& largest, const Real3&, Real r2, Real, Real of_fluid) const {
    if (r2 < largest.range2) largest.rate = max_of(largest.rate, of_fluid);
  }
  BL_HD void merge(Largest& largest, const Largest& other) const {
    largest.rate = max_of(largest.rate, other.rate);
  }
  BL_HD void finish(Index j, const Largest& largest) const {
    Real most = largest.rate;
    if (lever_sum) most *= lever_sum[j];
    const Real fraction = allowed_fraction(dt * most);
    drag.coefficient[j] *= fraction;
    drag.rot_coefficient[j] *= fraction;
    stiffness[j] = drag.coefficient[j] > 0 ? dt * most : Real(0);
  }
};

}  // namespace BL_SOLVER
