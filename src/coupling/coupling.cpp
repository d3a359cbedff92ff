#include "src/coupling/coupling.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "bedload/parallel/ranks.hpp"
#include "kernels/coupling/buoyancy_pass.hpp"
#include "kernels/coupling/drag_noise.hpp"
#include "kernels/coupling/drag_pass.hpp"
#include "kernels/coupling/limit_pass.hpp"
#include "kernels/coupling/suspension_viscosity.hpp"
#include "kernels/coupling/wetness_pass.hpp"
#include "kernels/drag/registry.hpp"
#include "kernels/smoothing/registry.hpp"
#include "kernels/smoothing/top_hat.hpp"
#include "src/solids/clumps.hpp"

namespace BL_SOLVER {
namespace {

/// f(std::true_type) or f(std::false_type).
template <class F>
void with_flag(bool flag, F&& f) {
  if (flag)
    f(std::true_type{});
  else
    f(std::false_type{});
}

/// The largest rate of drag, and the largest sum of levers if there are any.
struct LargestRate {
  using Value = StiffestDrag;
  Span<const Real> rate, lever_sum;
  BL_HD Value identity() const { return {0, 1}; }
  BL_HD Value operator()(Index i) const {
    return {i < rate.size ? rate[i] : Real(0), i < lever_sum.size ? lever_sum[i] : Real(1)};
  }
  BL_HD void combine(Value& into, const Value& v) const { larger(into, v); }
  BL_HD static void larger(Value& into, const Value& v) {
    into = {max_of(into.rate, v.rate), max_of(into.lever, v.lever)};
  }
};

/// Counts the entries above a bound, or at and below it.
struct CountEntries {
  using Value = std::uint64_t;
  Span<const Real> entry;
  Real bound;
  bool above;
  BL_HD Value identity() const { return 0; }
  BL_HD Value operator()(Index i) const { return (entry[i] > bound) == above ? 1 : 0; }
  BL_HD void combine(Value& into, const Value& v) const { into += v; }
};

/// Counts grains at the porosity floor: theirs is a mean, so up to round-off.
struct CountDense {
  using Value = std::uint64_t;
  Span<const Real> eps, bed_eps;  ///< the latter empty before the first gather
  Real floor;
  BL_HD Value identity() const { return 0; }
  BL_HD Value operator()(Index j) const {
    return eps[j] <= floor || (j < bed_eps.size && bed_eps[j] <= floor) ? 1 : 0;
  }
  BL_HD void combine(Value& into, const Value& v) const { into += v; }
};

/// Counts wet grains around which the fluid lies on a line, or in one place.
struct CountUncoupled {
  using Value = std::uint64_t;
  Span<const Real> inv_S;
  Carriers stress, drag;
  BL_HD Value identity() const { return 0; }
  BL_HD Value operator()(Index j) const {
    const bool couples = stress.inv_M[j].trace() > 0 && drag.inv_M[j].trace() > 0;
    return inv_S[j] > 0 && !couples ? 1 : 0;
  }
  BL_HD void combine(Value& into, const Value& v) const { into += v; }
};

/// Counts wet grains whose DragLine is limited.
template <class Lines>
struct CountBent {
  using Value = std::uint64_t;
  Lines lines;
  Span<const Real> wetness;
  BL_HD Value identity() const { return 0; }
  BL_HD Value operator()(Index j) const { return wetness[j] > 0 && lines.of(j).limited ? 1 : 0; }
  BL_HD void combine(Value& into, const Value& v) const { into += v; }
};

}  // namespace

template <class F>
void Coupling::with_coupling_kernel(F&& f) const {
  if (top_hat_)
    f(TopHat(range_.least));
  else
    with_kernel(kernel_, h_c_, f);
}

template <class F>
void Coupling::with_averages(F&& f) const {
  with_coupling_kernel([&](auto w) { own_lengths() ? f(w, OwnAverages{shrink_}) : f(w, OneAverage{}); });
}

Coupling::Coupling(const CouplingParameters& p, const Frame& frame, const WallGeometry& walls)
    : frame_(frame),
      kernel_(p.fluid.kernel),
      drag_law_(p.couple.drag),
      drag_table_(p.couple.table),
      dx_(p.fluid.dx),
      h_(p.fluid.h()),
      h_c_(p.couple.hc),
      range_{kernel_kappa(kernel_) * h_c_, p.largest_range > kernel_kappa(kernel_) * h_c_ ? 8.0 : 0.0},
      farthest_(max_of(range_.least, p.largest_range)),
      top_hat_(p.couple.kernel == CouplingKernel::top_hat),
      mu_(p.fluid.mu),
      suspension_(p.couple.suspension),
      phi_max_(p.couple.phi_max),
      drag_fraction_(p.drag_fraction),
      kT_(p.kT),
      seed_(p.seed),
      eps_min_(Real(p.couple.eps_min)),
      S_dry_(Real(p.couple.S_dry)),
      S_wet_(Real(p.couple.S_wet)),
      matter_(p.materials),
      two_way_(p.couple.mode == CouplingMode::two_way),
      counts_grains_(p.counts_grains),
      torque_(p.couple.torque),
      angmom_(p.couple.angmom),
      local_slip_(p.couple.slip == DragSlip::local),
      near_orifices_(!p.orifices.empty()),
      walls_(p.couple.wall_normalise ? walls.view() : SurfaceSet{}) {
  with_coupling_kernel([&](auto w) {
    half_space_ = HalfSpaceFraction::of(w);
    if (!two_way_ || p.couple.undisturbed) wake_ = OwnWake::of(w, h_c_, mu_, two_way_);
  });
  if (walls_.surfaces.size > 0)
    with_surface_kinds(walls.surfaces(),
                       [&]<class Kinds>(std::type_identity<Kinds>) { use_surface_kinds<Kinds>(); });
  orifices_.assign(p.orifices);
}

GrainSurroundings Coupling::surroundings() {
  return {.inv_S = inv_S_,
          .rho = rho_,
          .flow = flow_,
          .fast = fast_,
          .fast_slip = fast_slip_,
          .stress = {stress_arm_, stress_inv_M_},
          .drag = {drag_arm_, drag_inv_M_},
          .lost_moment = lost_moment_};
}
PushPass Coupling::push_pass(const FluidStore& fluid) {
  return {fluid.solid_factor, fluid.stress_acceleration, fluid.eos_state, {}, push_};
}

template <bool Local>
FluidOfDrag<Local> Coupling::fluid_of_drag(const GrainStore& grains) {
  return {.bodies = {matter_.volume_of(grains), grains.radius, grains.clump_d.span(),
                     clumps_ ? clumps_->of_grains() : Span<const std::uint32_t>(),
                     span_if(clumps_ != nullptr, fluid_of_clumps_)},
          .eps = grains.eps,
          .bed_eps = bed_eps_,
          .surroundings = surroundings()};
}

template <bool Local, class Law>
DragLines<Law, Local> Coupling::drag_lines(const Law& law, const GrainStore& grains) {
  return {.law = law,
          .mu = Real(mu_),
          .shares = two_way_,
          .wake = wake_,
          .shrink = span_if(own_lengths(), shrink_),
          .fluid = fluid_of_drag<Local>(grains)};
}

void Coupling::volumes(const GrainStore& grains, Span<const BodyPose> pose, double dt) {
  of_grains_.resize(grains.size());
  const GrainVolumePass pass{.range = range_,
                             .frame = frame_,
                             .per_dt = dt > 0 ? 1 / dt : 0,
                             .x = grains.x,
                             .x_before = grains.x_before,
                             .v = grains.v,
                             .volume_per_r3 = matter_.volume_of(grains),
                             .radius = grains.radius,
                             .wall_free = wall_free_,
                             .volume = volume_,
                             .shrink = own_lengths() ? shrink_.span() : Span<Real>()};
  if (!cut_volumes_ || !walls_move_) for_each(grains.all(), pass);
  if (cut_volumes_) (this->*cut_volumes_)(pass, grains.all(), pose);
}

template <class Kinds>
void Coupling::cut_volumes(const GrainVolumePass& volumes, Range grains, Span<const BodyPose> pose) const {
  for_each(
      walls_move_ ? grains : Range{0, Index(beside_walls_.size())},
      CutVolumePass<Kinds>{
          .free = wall_free<Kinds>(pose), .grains = span_if(!walls_move_, beside_walls_), .of = volumes});
}

void Coupling::gather(FluidStore& fluid, GrainStore& grains, Span<const BodyPose> pose, double dt,
                      std::uint64_t step) {
  volumes(grains, pose, 0);
  grains.x_before.copy(grains.x);
  of_fluid_.resize(fluid.size());
  const FluidRecords records{push_, span_if(near_orifices_, counted_)};
  PushPass push = push_pass(fluid);
  push.eps = fluid.eps;
  beside_grains_.each(fluid.all(), push);
  if (records.counted)
    beside_grains_.each(fluid.all(), CountedPass{frame_, orifice_weight(), fluid.x, records.counted});
  const GrainSurroundings around = surroundings();
  with_averages([&](auto w, auto averages) {
    with_flag(moments(), [&](auto with_moments) {
      with_flag(local_slip_, [&](auto local) {
        const InterpolationPass<decltype(w), with_moments, local, decltype(averages)> pass{
            .w = w,
            .averages = averages,
            .S_least = S_dry_ * WallFreeFraction<>::kLeast,
            .eps_min = eps_min_,
            .v_rho = fluid.v_rho,
            .fluid = records,
            .v = grains.v,
            .fluid_force = grains.fluid_force,
            .volume = volume_,
            .wall_free = wall_free_,
            .eps = grains.eps,
            .bed_eps = bed_eps_,
            .surroundings = around};
        over_fluid(pass);
      });
    });
  });
  for_each(grains.owned(), WetnessPass{S_dry_, S_wet_, wall_free_, inv_S_, grains.wetness});
  if (clumps_)
    with_flag(local_slip_, [&](auto local) {
      clumps_->sum_over_members(FluidTerms<local>{fluid_of_drag<local>(grains), grains.wetness},
                                fluid_of_clumps_);
    });
  with_drag_law(
      drag_law_,
      [&](auto law) {
        with_flag(local_slip_, [&](auto local) {
          for_each(grains.owned(), DragPass<decltype(law), local>{.lines = drag_lines<local>(law, grains),
                                                                  .torque = torque_,
                                                                  .couple = angmom_,
                                                                  .wetness = grains.wetness,
                                                                  .v = grains.v,
                                                                  .omega = grains.omega,
                                                                  .weights = drag_weights(grains),
                                                                  .drag = drag_of(grains),
                                                                  .levers = levers(grains)});
        });
      },
      drag_table_.on_device());
  if (two_way_) limit(fluid, grains, dt);
  if (kT_ > 0 && dt > 0)
    for_each(grains.owned(), DragNoisePass{.key = {seed_, step},
                                           .kT = kT_,
                                           .dt = dt,
                                           .mass_per_r3 = matter_.of(grains),
                                           .id = grains.id,
                                           .radius = grains.radius,
                                           .drag = drag_of(grains)});
}

void Coupling::limit(FluidStore& fluid, GrainStore& grains, double dt) {
  // skip the survey if the last drag number was well below the stability limit, 1
  limits_ = false;
  if (drag_ && dt * drag_->rate * drag_->lever < 0.5) return;
  grains.share({&grains.drag_coefficient, &grains.still, &grains.by_slip, &grains.lever_at_centre,
                &grains.lever_off_centre});
  with_averages([&](auto w, auto averages) {
    with_flag(local_slip_, [&](auto local) {
      with_flag(angmom_, [&](auto couple) {
        over_grains(DragRatePass<decltype(w), local, couple, decltype(averages)>{
            .w = w,
            .averages = averages,
            .weights = drag_weights(grains),
            .levers = levers(grains),
            .drag_coefficient = grains.drag_coefficient,
            .mass = fluid.mass,
            .v_rho = fluid.v_rho,
            .eos_state = fluid.eos_state,
            .rate = fluid.drag_rate});
      });
    });
  });
  survey(fluid, grains);
  read_survey();
  limits_ = dt * drag_->rate * drag_->lever > 1;
  if (!limits_) return;
  fluid.share({&fluid.drag_rate});
  over_fluid(LimitPass{.dt = Real(dt),
                       .range = range_,
                       .radius = grains.radius,
                       .rate = fluid.drag_rate,
                       .lever_sum = lever_sums(grains.size()),
                       .drag = drag_of(grains),
                       .stiffness = stiffness_});
  fluid.drag_rate.set_shared(false), grains.drag_coefficient.set_shared(false);
}

Span<const Real> Coupling::lever_sums(Index grains) const {
  return angmom_ ? Span<const Real>(lever_sum_.data(), grains) : Span<const Real>();
}

void Coupling::survey(const FluidStore& fluid, const GrainStore& grains) {
  const LargestRate largest{{fluid.drag_rate.span().data, fluid.owned().size()},
                            lever_sums(grains.owned().size())};
  const Range all{0, max_of(fluid.owned().size(), grains.owned().size())};
  surveyed_ = true;
  stiffest_.take(all, largest);
}

void Coupling::read_survey() {
  if (!std::exchange(surveyed_, false)) return;
  drag_ = all_reduce(stiffest_.read(),
                     [](StiffestDrag& into, const StiffestDrag& more) { LargestRate::larger(into, more); });
}

void Coupling::react(FluidStore& fluid, GrainStore& grains, double dt) {
  if (!two_way_) {
    fluid.reaction.buffer().zero();
    fluid.drag_kick.buffer().zero();
    return;
  }
  with_flag(angmom_, [&](auto couple) {
    with_flag(local_slip_, [&](auto local) {
      for_each(grains.owned(), ReactionTermsPass<couple, local>{.impulse = grains.impulse,
                                                                .spin_impulse = grains.spin_impulse,
                                                                .surroundings = surroundings(),
                                                                .weights = drag_weights(grains),
                                                                .levers = levers(grains),
                                                                .dt = Real(dt),
                                                                .drag = drag_of(std::as_const(grains)),
                                                                .reactions = reactions(grains)});
      grains.share(
          {&grains.reaction_impulse, &grains.reaction_force, &grains.reaction_spin, &grains.reaction_couple});
      with_averages([&](auto w, auto averages) {
        over_grains(
            ReactionPass<decltype(w), couple, local, decltype(averages)>{.w = w,
                                                                         .averages = averages,
                                                                         .mass = fluid.mass,
                                                                         .eos_state = fluid.eos_state,
                                                                         .by_slip = grains.by_slip,
                                                                         .reactions = reactions(grains),
                                                                         .per_dt = Real(1 / dt),
                                                                         .v_rho = fluid.v_rho,
                                                                         .reaction = fluid.reaction,
                                                                         .drag_kick = fluid.drag_kick,
                                                                         .rate = fluid.drag_rate});
      });
    });
  });
  if (!limits_) survey(fluid, grains);  // else keep the survey made before limiting
}

void Coupling::porosity(FluidStore& fluid, GrainStore& grains, Span<const BodyPose> pose, double dt) {
  pack(grains);
  volumes(grains, pose, dt);
  with_averages([&](auto w, auto averages) {
    over_grains(PorosityPass<decltype(w), decltype(averages)>{.w = w,
                                                              .averages = averages,
                                                              .shares = two_way_,
                                                              .floor = eps_min_,
                                                              .away_from_orifices = orifice_weight(),
                                                              .frame = frame_,
                                                              .x = fluid.x,
                                                              .volume = volume_,
                                                              .v_rho = fluid.v_rho,
                                                              .mass = fluid.mass,
                                                              .eps = fluid.eps,
                                                              .solid_factor = fluid.solid_factor,
                                                              .flux = fluid.flux,
                                                              .eos_state = fluid.eos_state,
                                                              .xp = fluid.xp,
                                                              .xp_mid = fluid.xp_mid});
  });
  if (suspension_ != SuspensionLaw::none)
    for_each(fluid.owned(),
             ThickenPass{SuspensionViscosity::of(suspension_, phi_max_), fluid.eps, fluid.viscosity});
  if (!counts_grains_) return;
  with_kernel(kernel_, h_, [&](auto w) {
    grains_of_fluid_.run_within(kernel_kappa(kernel_) * h_,
                                GrainsAroundPass<decltype(w)>{w, grains.radius, fluid.grains_around});
  });
}

void Coupling::push(const FluidStore& fluid, GrainStore& grains, double kick, bool held) {
  of_fluid_.resize(fluid.size());
  beside_grains_.each(fluid.all(), push_pass(fluid));
  with_averages([&](auto w, auto averages) {
    over_fluid(BuoyancyPass<decltype(w), decltype(averages)>{w, averages, push_, volume_, buoyancy_});
  });
  for_each(grains.owned(), BuoyancyKick{.kick = Real(kick),
                                        .mass_per_r3 = matter_.of(grains),
                                        .moves = !held && kick > 0,
                                        .now = buoyancy_,
                                        .radius = grains.radius,
                                        .force = grains.fluid_force,
                                        .v = grains.v});
}

double Coupling::bed_viscosity(double porosity, double d) const {
  if (!local_slip_) return 0;
  double beta = 0, second = 0;  // kg/(m3 s); mean of s^2 over the kernel, m2
  with_drag_law(
      drag_law_,
      [&](auto law) {
        beta = (1 - porosity) * 6 / (M_PI * d * d * d) *
               double(law.K(Real(porosity), Real(d), 1000, Real(mu_), 0));
      },
      drag_table_.on_host());
  with_coupling_kernel([&](auto w) {
    constexpr int shells = 1000;
    for (int k = 0; k < shells; ++k) {
      const double r = (k + 0.5) * range_.least / shells;
      second += 4 * M_PI * r * r * r * r * double(w.W(Real(r))) * range_.least / shells;
    }
  });
  return beta * second * square(range_(d / 2) / range_.least) / 6;
}

double Coupling::stable_dt() const {
  return drag_ && drag_->rate > 0 ? drag_fraction_ / drag_->rate : std::numeric_limits<double>::infinity();
}

void Coupling::save(std::vector<Quantity>& scalars) const {
  if (!drag_) return;
  scalars.push_back({"drag_rate", "1/s", drag_->rate});
  scalars.push_back({"drag_lever", "-", drag_->lever});
}

void Coupling::load(const std::function<double(const std::string&)>& scalar) {
  if (two_way_) drag_ = {Real(scalar("drag_rate")), Real(scalar("drag_lever"))};
}

std::uint64_t Coupling::bent_lines(const GrainStore& grains) {
  std::uint64_t bent = 0;
  with_drag_law(
      drag_law_,
      [&](auto law) {
        const auto lines = drag_lines<true>(law, grains);
        const Index gathered = min_of(grains.owned().size(), Index(fast_slip_.size()));
        bent =
            all_reduce(reduce({0, gathered}, CountBent<std::decay_t<decltype(lines)>>{lines, grains.wetness}),
                       [](std::uint64_t& into, std::uint64_t n) { into += n; });
      },
      drag_table_.on_device());
  return bent;
}

CouplingCounters Coupling::counters(const FluidStore& fluid, const GrainStore& grains) {
  const GrainSurroundings around = surroundings();
  const auto count = [](std::size_t entries, const auto& of) {
    return all_reduce(reduce({0, Index(entries)}, of),
                      [](std::uint64_t& into, std::uint64_t n) { into += n; });
  };
  const std::size_t a = fluid.owned().size(), g = grains.owned().size(),
                    gathered = std::min(g, inv_S_.size());  // none before the first gather
  return {.floor_hits = count(a, CountEntries{fluid.eps, eps_min_, false}),
          .limited = limits_ ? count(gathered, CountEntries{stiffness_, 1, true}) : 0,
          .wet = count(g, CountEntries{grains.wetness, 0, true}),
          .densest = count(g, CountDense{grains.eps, bed_eps_, eps_min_ * (1 + Real(1e-5))}),
          .cornered = count(gathered, CountEntries{wall_free_, WallFreeFraction<>::kLeast, false}),
          .uncoupled = moments() ? count(gathered, CountUncoupled{inv_S_, around.stress, around.drag}) : 0,
          .bent = local_slip_ ? bent_lines(grains) : 0};
}

}  // namespace BL_SOLVER
