#include "src/coupling/coupling.hpp"

#include <limits>

#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/coupling/drag_pass.hpp"
#include "kernels/coupling/limit_pass.hpp"
#include "kernels/coupling/porosity_pass.hpp"
#include "kernels/coupling/wetness_pass.hpp"
#include "kernels/drag/registry.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/boundaries/orifices.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

using GrainToFluid = CrossSeparation<Vec3d, FluidPosition>;
using FluidToGrain = CrossSeparation<FluidPosition, Vec3d>;

/// with_kernel, with the weight of fluid particles built on it.
template <class F>
void with_weight(const std::string& kernel, double h_c, const FluidStore& fluid, F&& f) {
  with_kernel(kernel, h_c, [&](auto w) { f(FluidWeight<decltype(w)>{w, fluid.v_rho, fluid.mass}); });
}

/// f(std::true_type) or f(std::false_type).
template <class F>
void with_flag(bool flag, F&& f) {
  if (flag)
    f(std::true_type{});
  else
    f(std::false_type{});
}

struct LargestRate {
  using Value = Real;
  Span<const Real> rate;
  BL_HD Value identity() const { return 0; }
  BL_HD Value operator()(Index a) const { return rate[a]; }
  BL_HD void combine(Value& into, const Value& v) const { into = max_of(into, v); }
};

/// How many entries are above a bound, or at and below it.
struct CountEntries {
  using Value = std::uint64_t;
  Span<const Real> entry;
  Real bound;
  bool above;
  BL_HD Value identity() const { return 0; }
  BL_HD Value operator()(Index i) const { return (entry[i] > bound) == above ? 1 : 0; }
  BL_HD void combine(Value& into, const Value& v) const { into += v; }
};

}  // namespace

Coupling::Coupling(const Config& config, const Frame& frame, const WallGeometry& fluid_walls,
                   const WallGeometry& grain_walls)
    : frame_(frame),
      kernel_(config.fluid.kernel),
      drag_law_(config.couple.drag),
      dx_(config.fluid.dx),
      h_c_(config.couple.hc),
      range_(kernel_kappa(kernel_) * h_c_),
      mu_(config.fluid.mu),
      drag_fraction_(config.time.drag),
      eps_min_(Real(config.couple.eps_min)),
      S_dry_(Real(config.couple.S_dry)),
      S_wet_(Real(config.couple.S_wet)),
      two_way_(config.couple.mode == "two_way"),
      torque_(config.couple.torque),
      angmom_(config.couple.angmom),
      local_slip_(config.couple.slip == "local"),
      fluid_walls_(fluid_walls.view()) {
  if (config.couple.wall_normalise) grain_walls_ = grain_walls.view();
  with_kernel(kernel_, h_c_, [&](auto w) { half_space_ = HalfSpaceShare::of(w); });
  orifices_.assign(orifices_of(config));
}

GrainSurroundings Coupling::surroundings() {
  return {.x = x_,
          .inv_S = inv_S_,
          .rho = rho_,
          .flow = flow_,
          .fast = fast_,
          .fast_slip = fast_slip_,
          .pressure = {pressure_arm_, pressure_inv_M_},
          .drag = {drag_arm_, drag_inv_M_}};
}
DragShares Coupling::drag_shares() { return {still_, by_slip_}; }
Reactions Coupling::reactions() { return {impulse_, force_, spin_couple_, force_couple_, mean_}; }

void Coupling::rebuild_lists(const FluidStore& fluid, const CellGridView& fluid_grid,
                             const GrainStore& grains, const CellGridView& grain_grid, double skin) {
  const double reach = range_ + skin;
  fluid_of_grain_.build(grains.size(), fluid_grid,
                        CrossNear<Vec3d, FluidPosition>{frame_, grains.x_list, fluid.x_list, reach});
  grains_of_fluid_.build(fluid.size(), grain_grid,
                         CrossNear<FluidPosition, Vec3d>{frame_, fluid.x_list, grains.x_list, reach});
}

void Coupling::gather(const FluidStore& fluid, GrainStore& grains, Span<const BodyPose> pose, double dt) {
  const Index n = grains.size();
  x_.resize(n);
  inv_S_.resize(n);
  rho_.resize(n);
  flow_.resize(n);
  still_.resize(n);
  stiffness_.resize(n);
  if (local_slip_) {
    fast_.resize(n);
    fast_slip_.resize(n);
    by_slip_.resize(n);
  }
  if (moments()) {
    pressure_arm_.resize(n);
    pressure_inv_M_.resize(n);
    drag_arm_.resize(n);
    drag_inv_M_.resize(n);
  }
  if (orifices_.size() > 0) {
    bed_eps_.resize(n);
    solids_counted_.resize(fluid.size());
    for_each(fluid.owned(), OrificeSharePass{orifice_share(), frame_, fluid.x, solids_counted_});
  }
  const GrainSurroundings around = surroundings();
  const GrainToFluid to_fluid{frame_, grains.x, fluid.x};
  with_weight(kernel_, h_c_, fluid, [&](auto weight) {
    with_flag(moments(), [&](auto with_moments) {
      with_flag(local_slip_, [&](auto local) {
        const InterpolationPass<decltype(weight.w), with_moments, local> pass{
            .weight = weight,
            .S_least = S_dry_ * WallFreeShare::kLeast,
            .eps_min = eps_min_,
            .fluid_eps = fluid.eps,
            .solids_counted = solids_counted_,
            .theta = fluid.theta,
            .x = grains.x,
            .v = grains.v,
            .radius = grains.radius,
            .eps = grains.eps,
            .bed_eps = bed_eps_,
            .fluid_force = grains.fluid_force,
            .surroundings = around};
        for_each_pair(grains.owned(), fluid_of_grain_, to_fluid, range_, pass);
      });
    });
  });
  const WallFreeShare wall_free{half_space_, frame_, fluid_walls_, pose};
  for_each(grains.owned(),
           WetnessPass{S_dry_, S_wet_, wall_free, grains.x, inv_S_, grains.wetness, grains.fluid_force});
  const Span<const Real> bed_eps =
      orifices_.size() > 0 ? Span<Real>(bed_eps_) : Span<Real>(grains.eps.buffer());
  with_drag_law(drag_law_, [&](auto law) {
    with_flag(local_slip_, [&](auto local) {
      for_each(grains.owned(), DragPass<decltype(law), local>{.law = law,
                                                              .mu = Real(mu_),
                                                              .torque = torque_,
                                                              .radius = grains.radius,
                                                              .eps = grains.eps,
                                                              .bed_eps = bed_eps,
                                                              .wetness = grains.wetness,
                                                              .v = grains.v,
                                                              .omega = grains.omega,
                                                              .surroundings = around,
                                                              .shares = drag_shares(),
                                                              .U = grains.U,
                                                              .omega_f = grains.omega_f,
                                                              .K = grains.K,
                                                              .K_rot = grains.K_rot});
    });
  });
  if (!two_way_) return;
  rate_.resize(fluid.size());
  with_weight(kernel_, h_c_, fluid, [&](auto weight) {
    with_flag(local_slip_, [&](auto local) {
      for_each_pair(fluid.owned(), grains_of_fluid_, FluidToGrain{frame_, fluid.x, x_}, range_,
                    DragRatePass<decltype(weight.w), local>{weight, drag_shares(), grains.K, rate_});
    });
  });
  fastest_ = reduce({0, Index(rate_.size())}, LargestRate{rate_});
  limits_ = dt * fastest_ > 1;
  if (limits_)
    for_each_pair(grains.owned(), fluid_of_grain_, to_fluid, range_,
                  LimitPass{Real(dt), rate_, grains.K, grains.K_rot, stiffness_});
}

void Coupling::react(FluidStore& fluid, const GrainStore& grains, double dt) {
  if (!two_way_) {
    fluid.reaction.buffer().zero();
    fluid.drag_kick.buffer().zero();
    return;
  }
  impulse_.resize(grains.size());
  force_.resize(grains.size());
  if (angmom_) {
    spin_couple_.resize(grains.size());
    force_couple_.resize(grains.size());
  }
  if (local_slip_) mean_.resize(grains.size());
  const LocalSlip slip{Real(dt), grains.K, grains.U, grains.omega_f};
  with_flag(angmom_, [&](auto couple) {
    with_flag(local_slip_, [&](auto local) {
      for_each(grains.owned(),
               SharePass<couple, local>{grains.impulse, grains.spin_impulse, grains.fluid_force,
                                        surroundings(), slip, reactions()});
      with_weight(kernel_, h_c_, fluid, [&](auto weight) {
        for_each_pair(fluid.owned(), grains_of_fluid_, FluidToGrain{frame_, fluid.x, x_}, range_,
                      ReactionPass<decltype(weight.w), couple, local>{
                          weight, drag_shares(), reactions(), fluid.v_rho, fluid.reaction, fluid.drag_kick});
      });
    });
  });
}

void Coupling::porosity(FluidStore& fluid, const GrainStore& grains, Span<const BodyPose> pose, bool moved) {
  with_kernel(kernel_, h_c_, [&](auto w) {
    const WallFreeShare wall_free{half_space_, frame_, grain_walls_, pose};
    for_each_pair(fluid.owned(), grains_of_fluid_, FluidToGrain{frame_, fluid.x, grains.x}, range_,
                  PorosityPass<decltype(w)>{
                      w, eps_min_, wall_free, orifice_share(), frame_, fluid.x, grains.radius, fluid.eps,
                      moved ? Span<const Real>(fluid.filled) : Span<const Real>(), fluid.s});
  });
}

double Coupling::stable_dt() const {
  return fastest_ > 0 ? drag_fraction_ / fastest_ : std::numeric_limits<double>::infinity();
}

CouplingCounters Coupling::counters(const FluidStore& fluid, const GrainStore& grains) const {
  const Index n = Index(stiffness_.size());
  return {reduce(fluid.owned(), CountEntries{fluid.eps, eps_min_, false}),
          limits_ ? reduce({0, n}, CountEntries{stiffness_, 1, true}) : 0,
          reduce(grains.owned(), CountEntries{grains.wetness, 0, true})};
}

}  // namespace bedload::inline BL_VARIANT
