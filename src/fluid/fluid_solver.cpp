#include "src/fluid/fluid_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/fluid/collision_pass.hpp"
#include "kernels/fluid/density_pass.hpp"
#include "kernels/fluid/force_pass.hpp"
#include "kernels/fluid/one_pass.hpp"
#include "kernels/fluid/wall_density.hpp"
#include "kernels/integrate/fluid_kicks.hpp"
#include "kernels/smoothing/registry.hpp"
#include "kernels/walls/crossing.hpp"
#include "src/boundaries/orifices.hpp"
#include "src/fluid/registry.hpp"
#include "src/measure/sweeps.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

template <class P>
struct WrapPass {
  Frame frame;
  Span<P> x;
  BL_HD void operator()(Index i) const { x[i] = as_position<P>(frame, frame.wrap(coordinates(frame, x[i]))); }
};

/// Copies of positions as pair loops read them, `back` (s) before where they are, with their weights.
template <class P>
struct PackBackPass {
  Frame frame;
  Real back;
  Span<const P> x;
  Span<const Real4> v, m_state;  ///< m_state: empty without weights
  Span<PairPosition> xp;
  BL_HD void operator()(Index i) const {
    const Vec3d at = coordinates(frame, x[i]) - Vec3d(back * v[i].xyz());
    xp[i] = pair_position(frame, at, m_state ? m_state[i].x : Real(0));
  }
};

struct HasEntries {
  VerletListView list;
  BL_HD bool operator()(Index i) const { return list.count[i] > 0; }
};

/// What bounds the next step; on the way velocities are corrected by `kick` of what the acceleration has
/// changed.
struct CorrectSweep {
  using Value = FluidExtremes;
  Frame frame;
  Real kick;  ///< s
  Span<const Real3> acc_old, acc;
  Span<const Real> eps, s;
  Span<const Real3> drift;
  Span<const FluidPosition> x, x_list;
  Span<const Real> h, h_list;  ///< empty where all have one length
  Span<Real4> v_rho;

  BL_HD Value identity() const { return {}; }
  BL_HD Value operator()(Index a) const {
    const Real3 acceleration = acc[a];
    Real3 v = v_rho[a].xyz();
    if (kick != 0) {
      v += kick * (acceleration - acc_old[a]);
      v_rho[a] = {v, v_rho[a].w};
    }
    if (drift) v += drift[a];
    Value out;
    out.v2 = norm2(v);
    out.acc2 = norm2(acceleration);
    out.moved2 = norm2(frame.separation(coordinates(frame, x[a]), coordinates(frame, x_list[a])));
    if (eps) out.eps_min = eps[a];
    if (h) out.h_min = h[a], out.growth = h[a] / h_list[a];
    const bool good = out.v2 < 1e30 && out.acc2 < 1e30 && s[a] >= Real(-0.5) && s[a] <= Real(1);
    out.bad = good ? kNone : a;
    return out;
  }
  BL_HD void combine(Value& into, const Value& v) const {
    into.v2 = max_of(into.v2, v.v2);
    into.acc2 = max_of(into.acc2, v.acc2);
    into.moved2 = max_of(into.moved2, v.moved2);
    into.eps_min = min_of(into.eps_min, v.eps_min);
    into.h_min = min_of(into.h_min, v.h_min);
    into.growth = max_of(into.growth, v.growth);
    into.bad = min_of(into.bad, v.bad);
  }
};

/// The force of a single layer, with the strength K = D / 5 of the softer one. Its particles weigh as much as
/// the wall for which they stand.
LayerLaw layer_law(const Config& config, const WallBody& body, double kappa) {
  const double dx = config.fluid.dx, spacing = config.wall.spacing(body), D = config.wall.rep_D;
  LayerLaw law;
  switch (body.force) {
    case LayerForce::monaghan:
      law.steep = {Real(D), Real(config.wall.layer_r0 > 0 ? config.wall.layer_r0 : dx), Real(1e30)};
      return law;
    case LayerForce::kajtar:
      break;
  }
  double volume = 0;
  with_fluid_kernel(config, [&](const auto& w) {
    volume = spacing * config.domain.spacing_along(1, spacing) * layer_depth(w);
  });
  const double fraction = 2 * volume / (config.domain.cell_volume(dx) + volume), beta = dx / spacing;
  law.soft = {Real(D / 5 / beta * fraction), Real(kappa * config.fluid.h() / 2)};
  return law;
}

struct LengthBody {
  Span<const Real> h;
  BL_HD double operator()(Index a) const { return h[a]; }
};

struct CountBody {
  Span<const std::uint32_t> count;
  BL_HD void operator()(Index a, double* out) const { out[0] = count[a]; }
};

}  // namespace

/// The passes that know the kernel function, and whether particles have smoothing lengths of their own.
template <class W, class Lengths>
class FluidSolverWith final : public FluidSolver {
 public:
  FluidSolverWith(const Config& config, const Frame& frame, const WallGeometry& walls, FluidStore& fluid,
                  const W& w)
      : FluidSolver(config, frame, walls, fluid, W::kappa), w_(w), cut_(CutFraction::of(w)) {}

  void density(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, double dt) override {
    if (!smooths() && !shifts())
      continuity<false, false>(fluid, walls, dt, NoShifting{});
    else if (mixed_)
      continuity<true, true>(fluid, walls, dt, NoShifting{});
    else if (!shifts())
      continuity<true, false>(fluid, walls, dt, NoShifting{});
    else if constexpr (!Lengths::vary)
      continuity<true, false>(fluid, walls, dt, shifting(dt));
    if (!frozen_) return;
    const FrozenPass<W> frozen{w_,
                               Real(config_.fluid.rho0),
                               Real(dt),
                               least(),
                               flux(fluid),
                               fluid.m_state,
                               walls.v_rho,
                               walls.m_state,
                               walls.body,
                               pose,
                               walls.compression};
    for_each_pair(walls.owned(), wall_fluid_, PairSeparation{frame_, walls.xp, fluid.xp}, range(), frozen);
  }

  void walls(const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, double drag_dt,
             bool moving) override {
    if (walls.mirrors.size() > 0) {
      const MirrorPass<W> mirror{w_,
                                 frame_,
                                 Real(config_.fluid.rho0),
                                 least(),
                                 least_sum(),
                                 flux(fluid),
                                 fluid.m_state,
                                 walls.x,
                                 walls.mirrors.x,
                                 walls.body,
                                 pose,
                                 walls.compression};
      for_each_pair(walls.owned(), image_fluid_, PairSeparation{frame_, walls.mirrors.xp, fluid.xp}, range(),
                    mirror);
    }
    extrapolate(w_, fluid, walls, pose, drag_dt, moving, lengths());
  }

  void forces(FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, double dt) override {
    if constexpr (Lengths::vary) {
      run(fluid, walls, range(),
          OmegaPass<W>{w_, lengths(), Real(config_.fluid.h_least()), Real(config_.fluid.h_most()),
                       Real(config_.fluid.rho0), fluid.m_state, walls.m_state, lengths_->omega,
                       fluid.p_rho2});
      artificial().acts() ? momentum<true, false>(fluid, walls) : momentum<false, false>(fluid, walls);
    } else {
      constant_length_forces(fluid, walls, dt);
    }
    if (layers_.size() > 0)
      for_each_pair(fluid.owned(), fluid_wall_, PairSeparation{frame_, fluid.xp, walls.xp}, range(),
                    LayerPass<W>{layer(walls, pose, dt), flux(fluid), fluid.theta, fluid.acc_next});
    corrected_ = 0;
  }

  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, double dt,
                   Buffer<Vec3d>& force) override {
    force.resize(walls.size());
    forces_on_walls<WholeForce>(fluid, walls, pose, dt, force, {});
  }
  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, double dt,
                   Buffer<Vec3d>& pressure, Buffer<Vec3d>& friction) override {
    pressure.resize(walls.size());
    friction.resize(walls.size());
    forces_on_walls<ForceParts>(fluid, walls, pose, dt, pressure, friction);
  }

  void moments(FluidStore& fluid, const WallStore& walls, double, FluidMoments& out) override {
    config_.tensile > 0 ? stress<true>(fluid, walls, out) : stress<false>(fluid, walls, out);
  }

 private:
  Lengths lengths() const {
    if constexpr (Lengths::vary)
      return {lengths_->h, lengths_->omega, Real(config_.fluid.h()), config_.domain.two_d};
    else
      return {};
  }
  void constant_length_forces(FluidStore& fluid, const WallStore& walls, double dt) {
    const bool added = config_.tensile > 0 || config_.xsph > 0;
    if (one_pass())
      smooths() || shifts() ? momentum_and_continuity<true>(fluid, walls, dt, shifting(dt))
                            : momentum_and_continuity<false>(fluid, walls, dt, NoShifting{});
    else if (!config_.fluid.species.empty())
      momentum<true, true, true>(fluid, walls);
    else if (artificial().acts())
      added ? momentum<true, true>(fluid, walls) : momentum<true, false>(fluid, walls);
    else
      added ? momentum<false, true>(fluid, walls) : momentum<false, false>(fluid, walls);
  }
  template <class Force>
  void forces_on_walls(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, double dt,
                       Span<Vec3d> force, Span<Vec3d> friction) {
    const WallForcePass<W, Force, Lengths> pass{w_,
                                                WallPair{viscosity()},
                                                layer(walls, pose, dt),
                                                Real(mixed_ ? 0 : corrected_),
                                                fluid.acc,
                                                fluid.acc_next,
                                                flux(fluid),
                                                fluid.m_state,
                                                walls.v_rho,
                                                walls.m_state,
                                                walls.v_visc,
                                                force,
                                                friction,
                                                fluid.viscosity,
                                                lengths()};
    for_each_pair(walls.owned(), wall_fluid_, PairSeparation{frame_, walls.xp, fluid.xp}, range(), pass);
  }
  template <class Pass>
  void run(const FluidStore& fluid, const WallStore& walls, double cutoff, const Pass& pass) {
    for_each_pair(fluid.owned(), fluid_fluid_, PairSeparation{frame_, fluid.xp, fluid.xp}, fluid_wall_,
                  PairSeparation{frame_, fluid.xp, walls.xp}, cutoff, pass);
  }
  Real least() const { return -Real(config_.density.cavitation_limit); }
  Viscosity viscosity() const {
    return Viscosity::of(config_.visc.model, config_.fluid.mu, config_.fluid.rho0, config_.fluid.c, w_);
  }
  ArtificialViscosity artificial() const {
    return {Real(config_.visc.alpha), Real(config_.visc.beta), Real(config_.fluid.c),
            Real(config_.fluid.h())};
  }
  /// Writes s_new.
  template <bool kSmooth, bool kPorous, class Shift>
  DensityPass<W, Shift, kSmooth, kPorous, Lengths> density_pass(FluidStore& fluid, const WallStore& walls,
                                                                double dt, const Shift& shift,
                                                                Span<Real> s_new) {
    const double c = config_.fluid.c;
    return {w_,
            flux(fluid),
            fluid.m_state,
            walls.v_rho,
            walls.m_state,
            Real(2 * config_.density.delta * config_.fluid.h() * c),
            gravity_ * Real(config_.fluid.rho0 / (c * c)),
            eos_.gamma - 2,
            Real(config_.fluid.rho0),
            Real(dt),
            fluid.s,
            s_new,
            cut_,
            least(),
            Real(config_.density.void_relaxation * c / config_.fluid.h()),
            Real(mixed_ ? config_.couple.spreading * c / config_.fluid.h() : 0),
            shift,
            drift_of(fluid),
            lengths()};
  }
  template <bool kArtificial, bool kAdded, bool kSpecies = false>
  ForcePass<W, kArtificial, kAdded, kSpecies, Lengths> force_pass(FluidStore& fluid, const WallStore& walls) {
    return {w_,
            WallPair{viscosity()},
            flux(fluid),
            fluid.m_state,
            fluid.p_rho2,
            walls.v_rho,
            walls.m_state,
            walls.v_visc,
            artificial(),
            tensile(),
            Real(config_.xsph),
            gravity_,
            drive(fluid),
            fluid.theta,
            fluid.acc_next,
            fluid.drift,
            fluid.viscosity,
            lengths()};
  }
  template <bool kSmooth, bool kPorous, class Shift>
  void continuity(FluidStore& fluid, const WallStore& walls, double dt, const Shift& shift) {
    run(fluid, walls, range(), density_pass<kSmooth, kPorous>(fluid, walls, dt, shift, fluid.s_next));
  }
  template <bool kArtificial, bool kAdded, bool kSpecies = false>
  void momentum(FluidStore& fluid, const WallStore& walls) {
    run(fluid, walls, range(), force_pass<kArtificial, kAdded, kSpecies>(fluid, walls));
  }
  template <bool kTensile>
  void stress(FluidStore& fluid, const WallStore& walls, FluidMoments& out) {
    using Force = ForcePass<W, true, kTensile, false, Lengths>;
    const Force whole = force_pass<true, kTensile>(fluid, walls);
    Force inviscid = whole;
    inviscid.artificial = {};
    inviscid.wall.viscosity.mu = 0;
    run(fluid, walls, range(), StressPass<Force>{whole, inviscid, out.parts(fluid.size(), false)});
  }
  template <bool kSmooth, class Shift>
  void momentum_and_continuity(FluidStore& fluid, const WallStore& walls, double dt, const Shift& shift) {
    const auto both = [&](const auto& force) {
      const auto density = density_pass<kSmooth, false>(fluid, walls, dt, shift, fluid.s);
      run(fluid, walls, range(),
          OnePass<std::decay_t<decltype(force)>, std::decay_t<decltype(density)>>{force, density,
                                                                                  *rates_.back()});
    };
    artificial().acts() ? both(force_pass<true, false>(fluid, walls))
                        : both(force_pass<false, false>(fluid, walls));
    accept_rates(dt);
  }
  Shifting shifting(double dt) const {
    const double h = config_.fluid.h(), dx = config_.fluid.dx, rate = dt > 0 ? 1 / dt : 0;
    const bool plane = config_.domain.two_d;
    return {Real(config_.shift * h * h), Real(0.5 * h * h * rate), Real(0.1 * dx * rate),
            Real(plane ? 1. / 2 : 1. / 3), Real(plane ? 0.93 : 0.97)};
  }
  TensileTerm tensile() const {
    if (config_.tensile == 0) return {};
    const Real s = Real(0.01);
    return {s, config_.tensile_one_sign ? s : Real(0.2), w_.W(Real(config_.fluid.dx))};
  }
  LayerForces<W> layer(const WallStore& walls, Span<const BodyPose> pose, double dt) const {
    return {w_, artificial(), layers_, Real(repulsion_cap(dt)), walls.body, pose, walls.v_rho};
  }

  W w_;
  CutFraction cut_;
};

std::unique_ptr<FluidSolver> FluidSolver::make(const Config& config, const Frame& frame,
                                               const WallGeometry& walls, FluidStore& fluid) {
  return FluidModels::make(config, frame, walls, fluid);
}

std::unique_ptr<FluidSolver> Wcsph::make(const Config& config, const Frame& frame, const WallGeometry& walls,
                                         FluidStore& fluid) {
  std::unique_ptr<FluidSolver> solver;
  with_fluid_kernel(config, [&](const auto& w) {
    using W = std::decay_t<decltype(w)>;
    if (config.fluid.variable_h)
      solver = std::make_unique<FluidSolverWith<W, OwnLengths>>(config, frame, walls, fluid, w);
    else
      solver = std::make_unique<FluidSolverWith<W, OneLength>>(config, frame, walls, fluid, w);
  });
  return solver;
}

FluidSolver::FluidSolver(const Config& config, const Frame& frame, const WallGeometry& walls,
                         FluidStore& fluid, double kappa)
    : config_(config),
      frame_(frame),
      kappa_(kappa),
      mixed_(config.grain.present && config.couple.mode == CouplingMode::two_way),
      lengths_(config.fluid.variable_h ? std::make_unique<SmoothingLengths>(fluid, config.fluid.h())
                                       : nullptr),
      gravity_(config.gravity),
      drive_factor_(config.drive) {
  eos_ = EquationOfState::of(config);
  set_skin(config.skin_fluid * config.fluid.dx);
  const auto acts = [](const WallBody& body) { return body.repels() || body.no_penetration; };
  if (std::any_of(config.wall.bodies.begin(), config.wall.bodies.end(), acts)) repelling_ = walls.view();
  orifices_.assign(orifices_of(config));
  std::vector<LayerLaw> layers(config.wall.bodies.size() + config.inlets.size());
  bool layered = false;
  for (std::size_t b = 0; b < config.wall.bodies.size(); ++b) {
    const WallBody& body = config.wall.bodies[b];
    frozen_ = frozen_ || body.type == WallType::frozen;
    layered = layered || body.single_layer();
    if (body.single_layer()) layers[b] = layer_law(config, body, kappa);
  }
  if (layered) layers_.assign(layers);
  if (config.fluid.species.empty()) fluid.species.leave_out(), fluid.viscosity.leave_out();
  fluid.drift.begin_at_zero();
  if (!drifts()) fluid.drift.leave_out();
  if (config.time.integrator != TimeIntegrator::ab3) return;
  fluid.s_next.leave_out();
  for (const char* name : {"density_rate", "density_rate_before", "density_rate_long_before"}) {
    rates_.push_back(std::make_unique<Field<Real>>(fluid, name, "1/s", Lifetime::kept));
    rates_.back()->begin_at_zero();
  }
}

void FluidSolver::accept_rates(double dt) {
  rates_[0]->buffer().swap(rates_[2]->buffer());
  rates_[1]->buffer().swap(rates_[2]->buffer());
  dt_before_ = last_dt_;
  last_dt_ = dt;
}

void FluidSolver::set_skin(double skin) {
  if (skin == skin_) return;
  skin_ = skin;
  make_cells();
}

void FluidSolver::make_cells() {
  for (CellGrid* grid : {&grid_, &wall_grid_})
    *grid = CellGrid(frame_, frame_.origin, frame_.origin + frame_.length, range() + skin_);
}

void FluidSolver::save(std::vector<Quantity>& scalars) const {
  scalars.push_back({"skin_fluid", "m", skin_});
  if (lengths_) scalars.push_back({"smoothing_length_listed", "m", lengths_->listed});
  scalars.push_back({"density_last_dt", "s", last_dt_});
  scalars.push_back({"density_dt_before", "s", dt_before_});
}

double FluidSolver::friction_limit(const FluidExtremes& now) const {
  if (config_.visc.model == ViscosityModel::none || config_.fluid.mu == 0)
    return std::numeric_limits<double>::infinity();
  return config_.time.visc * square(half_range(now)) * now.eps_min * config_.fluid.rho0 / config_.fluid.mu;
}

double FluidSolver::repulsion_cap(double dt) const {
  return dt > 0 ? 0.1 * config_.fluid.dx / (dt * dt) : 1e30;
}

Drive FluidSolver::drive(const FluidStore& fluid) const {
  const DriveConfig& d = config_.drive;
  const Vec3d spring{d.rate.x * d.rate.x, d.rate.y * d.rate.y, d.rate.z * d.rate.z};
  const DriveField field = d.on_fluid() ? drive_now_ : DriveField{frame_, {}, {}, -1};
  return {field, fluid.x, d.mode, d.on == DrivenPhase::both, spring, d.centre, d.pulls()};
}

void FluidSolver::set_drive(const FluidStore& fluid, double t) {
  if (!config_.drive.on_fluid()) return;
  std::vector<Vec3d> x;
  if (drive_factor_.varies())
    for (const auto& at : fluid.x.values()) x.push_back(frame_.wrap(coordinates(frame_, at)));
  drive_now_ = drive_field(config_.drive, drive_factor_, frame_, x, t, drive_factors_);
}

void FluidSolver::collide(FluidStore& fluid) {
  const ViscosityConfig& c = config_.visc;
  if (!c.collision) return;
  const double range = c.collision_range * config_.fluid.dx;
  collisions_.resize(fluid.size());
  collided_.resize(fluid.size());
  const PairSeparation separation{frame_, fluid.xp, fluid.xp};
  for_each_pair(fluid.owned(), fluid_fluid_, separation, range,
                CollisionCountPass{Real(range * range), fluid.v_rho, collisions_});
  for_each_pair(fluid.owned(), fluid_fluid_, separation, range,
                CollisionPass{Real(range * range), Real(c.collision_restitution), Real(1e-12 * range * range),
                              fluid.v_rho, fluid.mass, collisions_, collided_});
  fluid.v_rho.buffer().swap(collided_);
}

WallRepulsion FluidSolver::repulsion(Span<const BodyPose> pose, double dt) const {
  const double dx = config_.fluid.dx, rate = dt > 0 ? std::min(config_.fluid.c / dx, 0.5 / dt) : 0;
  return {{Real(config_.wall.rep_D), Real(config_.wall.rep_r0), Real(repulsion_cap(dt))},
          {Real(0.25 * dx), Real(rate), Real(dt > 0 ? 1 / dt : 0)},
          frame_,
          repelling_,
          pose};
}

void FluidSolver::repel(FluidStore& fluid, Span<const BodyPose> pose, double kick, double dt) {
  if (repelling_.surfaces.size == 0 && orifices_.size() == 0) return;
  const WallRepulsion walls = repulsion(pose, dt);
  const OrificeRepulsion orifices{
      walls.law, Real(0.01 * config_.fluid.c), dt > 0 ? Real(1 / dt) : Real(0), frame_, orifices_, pose};
  for_each({0, Index(beside_walls_.size())},
           RepelPass{walls, orifices, Real(kick), Real(dt), beside_walls_, fluid.x, fluid.v_rho, fluid.acc,
                     fluid.acc_next, fluid.heading, drift_of(fluid)});
}

void FluidSolver::refresh(FluidStore& fluid, WallStore& walls, bool walls_moved, double travel) {
  const double narrow = config_.skin_fluid * config_.fluid.dx, four_steps = 8 * travel;
  if (four_steps > narrow || 2 * four_steps < narrow) {  // in between, as it was
    const double former = skin_;
    set_skin(four_steps > narrow ? 1.5 * narrow : narrow);
    walls_moved = walls_moved || skin_ != former;
  }
  if (lengths_ && renew_lengths(fluid)) walls_moved = true;
  for_each(fluid.owned(), WrapPass<FluidPosition>{frame_, fluid.x});
  grid_.sort(frame_, Span<const FluidPosition>(fluid.x), order_);
  fluid.reorder(order_);
  fluid.x_list.copy(fluid.x);
  if (lengths_) lengths_->h_list.copy(lengths_->h);
  if (walls_moved && walls.size() > 0) {
    MirrorStore& images = walls.mirrors;
    for_each(walls.owned(), WrapPass<Vec3d>{frame_, walls.x});
    for_each(images.owned(), WrapPass<Vec3d>{frame_, images.x});
    wall_grid_.sort(frame_, Span<const Vec3d>(walls.x), order_);
    walls.reorder(order_);
    walls.x_list.copy(walls.x);
    if (images.size() > 0) images.reorder(order_), images.x_list.copy(images.x);
  }
  relist(fluid, walls, false);
}

void FluidSolver::relist(FluidStore& fluid, WallStore& walls, bool sort) {
  if (sort) {  // saved sorted: the order is the identity
    grid_.sort(frame_, Span<const FluidPosition>(fluid.x), order_);
    wall_grid_.sort(frame_, Span<const Vec3d>(walls.x), order_);
  }
  pack(fluid);
  pack(walls);
  const double reach = range() + skin();
  using Near = SphNear<FluidPosition>;
  const Near fluid_near{frame_, fluid.x, fluid.xp, fluid.xp, reach, true};
  const Near fluid_near_walls{frame_, fluid.x, fluid.xp, walls.xp, reach, false};
  const SphNear<Vec3d> walls_near{frame_, walls.x, walls.xp, fluid.xp, reach, false};
#if BL_CUDA
  fluid_fluid_.build(grid_, frame_, Span<const FluidPosition>(fluid.x), Span<const PairPosition>(fluid.xp),
                     reach);
#endif
  if (lengths_) {
    const Span<const Real> h = lengths_->h_list, none;
    const PairReach pairs{Real(kappa_ * double(kLengthGrowth)), Real(skin()), Real(config_.fluid.h())};
#if !BL_CUDA
    fluid_fluid_.build(fluid.size(), grid_.view(), LengthNear<FluidPosition>{fluid_near, pairs, h, h});
#endif
    fluid_wall_.build(fluid.size(), wall_grid_.view(),
                      LengthNear<FluidPosition>{fluid_near_walls, pairs, h, none}, fluid_fluid_.view().bits);
    wall_fluid_.build(walls.size(), grid_.view(), LengthNear<Vec3d>{walls_near, pairs, none, h});
  } else {
#if !BL_CUDA
    fluid_fluid_.build(fluid.size(), grid_.view(), fluid_near);
#endif
    fluid_wall_.build(fluid.size(), wall_grid_.view(), fluid_near_walls, fluid_fluid_.view().bits);
    wall_fluid_.build(walls.size(), grid_.view(), walls_near);
  }
  compaction_.find(fluid.size(), HasEntries{fluid_wall_.view()}, beside_walls_);
  compaction_.find(walls.size(), HasEntries{wall_fluid_.view()}, wet_walls_);
  relisted_ = true;
  const MirrorStore& images = walls.mirrors;
  if (images.size() > 0)
    image_fluid_.build(images.size(), grid_.view(),
                       SphNear<Vec3d>{frame_, images.x, images.xp, fluid.xp, reach, false});
}

void FluidSolver::pack(FluidStore& fluid, double back) {
  for_each(fluid.owned(),
           PackBackPass<FluidPosition>{frame_, Real(back), fluid.x, fluid.v_rho, fluid.m_state, fluid.xp});
}

void FluidSolver::pack(WallStore& walls, double back) {
  for_each(walls.owned(), PackBackPass<Vec3d>{frame_, Real(back), walls.x, walls.v_rho, {}, walls.xp});
  for_each(walls.mirrors.owned(), PackPass<Vec3d>{frame_, walls.mirrors.x, walls.mirrors.xp});
}

KickDriftPass FluidSolver::kick_drift_pass(FluidStore& fluid, double kick, double drift, double back,
                                           bool coupled) {
  return {frame_,          Real(kick),  Real(drift),
          Real(back),      fluid.acc,   coupled ? Span<const Real3>(fluid.reaction) : Span<const Real3>(),
          drift_of(fluid), fluid.v_rho, fluid.x,
          fluid.xp};
}

StatePass FluidSolver::state_pass(FluidStore& fluid, const DensityHistory& history, double kick,
                                  bool coupled) {
  return {frame_,
          eos_,
          history,
          Real(kick),
          fluid.x,
          fluid.acc,
          coupled ? Span<const Real3>(fluid.reaction) : Span<const Real3>(),
          fluid.s,
          fluid.mass,
          fluid.eps,
          fluid.v_rho,
          mixed_ ? Span<Real4>(fluid.flux) : Span<Real4>(),
          fluid.m_state,
          fluid.p_rho2,
          fluid.xp};
}

void FluidSolver::kick_drift(FluidStore& fluid, double kick, double drift, double back, bool coupled) {
  for_each(fluid.owned(), kick_drift_pass(fluid, kick, drift, back, coupled));
}

void FluidSolver::state(FluidStore& fluid, double kick, bool coupled) {
  for_each(fluid.owned(), state_pass(fluid, {}, kick, coupled));
  if (lengths_) for_each(fluid.owned(), length_pass(fluid, false));
}

LengthPass FluidSolver::length_pass(FluidStore& fluid, bool renew) {
  const FluidConfig& f = config_.fluid;
  return {.sigma = Real(f.sigma_h),
          .least = Real(f.h_least()),
          .most = Real(f.h_most()),
          .thickness = Real(config_.domain.thickness()),
          .rho0 = Real(f.rho0),
          .first = !lengths_->begun,
          .renew = renew,
          .mass = fluid.mass,
          .m_state = fluid.m_state,
          .listed = lengths_->h_list,
          .h = lengths_->h,
          .omega = lengths_->omega};
}

bool FluidSolver::renew_lengths(FluidStore& fluid) {
  for_each(fluid.owned(), length_pass(fluid, true));
  lengths_->begun = true;
  const double h0 = config_.fluid.h(), longest = max_over(fluid.owned(), LengthBody{lengths_->h});
  // in steps of a ninth, so that cells seldom change; never below h0, to which walls reach
  const double listed = h0 * std::exp2(std::ceil(8 * std::log2(std::max(1.0, longest / h0)) - 1e-6) / 8);
  if (listed == lengths_->listed) return false;
  lengths_->listed = listed;
  make_cells();
  return true;
}

void FluidSolver::advance(FluidStore& fluid, double kick, double dt, double predict) {
  const DensityHistory history(*rates_[0], *rates_[1], *rates_[2], dt, last_dt_, dt_before_);
  for_each(fluid.owned(), AdvancePass{kick_drift_pass(fluid, kick, dt, 0, false),
                                      state_pass(fluid, history, predict, false)});
}

void FluidSolver::correct(FluidStore& fluid, double kick) {
  fluid.acc.buffer().swap(fluid.acc_next.buffer());
  survey(fluid, kick);
  corrected_ = kick;
}

void FluidSolver::survey(FluidStore& fluid, double kick) {
  extremes_.resize(1);
  if (fluid.size() == 0) return extremes_.assign({FluidExtremes{}});
  reduce_into(
      extremes_.data(), fluid.owned(),
      CorrectSweep{frame_, Real(kick), fluid.acc_next, fluid.acc,
                   mixed_ ? Span<const Real>(fluid.eps) : Span<const Real>(), fluid.s, drift_of(fluid),
                   fluid.x, fluid.x_list, lengths_ ? Span<const Real>(lengths_->h) : Span<const Real>(),
                   lengths_ ? Span<const Real>(lengths_->h_list) : Span<const Real>(), fluid.v_rho});
}

FluidExtremes FluidSolver::extremes() const {
  FluidExtremes out = extremes_.to_host()[0];
  if (!std::isfinite(out.h_min)) out.h_min = config_.fluid.h();  // one length, or no fluid
  return out;
}

double FluidSolver::pairs_through(const FluidStore& fluid, const SurfaceSet& surfaces,
                                  Span<const BodyPose> pose) const {
  Buffer<NearestPoint> points(fluid.size());
  Buffer<std::uint32_t> count(fluid.size());
  const NearestPointPass nearest{frame_, surfaces, pose, range(), fluid.x, points};
  for_each(fluid.owned(), nearest);
  for_each_pair(fluid.owned(), fluid_fluid_, PairSeparation{frame_, fluid.xp, fluid.xp}, range(),
                CrossingPass{nearest, 0.25 * config_.fluid.dx, count});
  return sum_over<1>(fluid.owned(), CountBody{count}).v[0] / 2;  // a pair stands in two lists
}

}  // namespace bedload::inline BL_VARIANT
