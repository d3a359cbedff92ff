// How a simulation begins, is saved and continues.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bedload/geometry/depth.hpp"
#include "src/time/coupled_simulation.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

template <class To, class From>
std::vector<To> converted(const std::vector<From>& from) {
  std::vector<To> to;
  to.reserve(from.size());
  for (const auto& f : from) to.push_back(To(f));
  return to;
}

std::vector<Id> ids(std::size_t n) {
  std::vector<Id> out(n);
  std::iota(out.begin(), out.end(), Id(0));
  return out;
}

/// Initial fluid fills what the grains leave, at hydrostatic pressure and the density that goes with
/// it: in balance from the start, and heavier than at rho0 by its compression.
struct LayPass {
  EquationOfState eos;
  Frame frame;
  Span<const Real> eps, pressure;
  Span<Real> mass, s;
  BL_HD void operator()(Index a) const {
    const Real x = eos.compression(pressure[a]);
    mass[a] *= eps[a] * (1 + x);
    s[a] = x;
  }
};

/// Depth below the top of the block of fluid that holds x, along gravity, m.
double depth_at(const Config& config, const Vec3d& gravity, const Vec3d& x) {
  const double g = norm(gravity);
  if (g == 0) return 0;
  const Vec3d up = gravity * (-1 / g);
  double depth = 0;
  for (const auto& fill : config.fluid.fills) {
    if (!fill.file.empty()) continue;
    bool inside = true;
    double top = 0;
    for (int k = 0; k < 3; ++k) {
      inside = inside && x[k] >= fill.min[k] && x[k] <= fill.max[k];
      top += up[k] * (up[k] > 0 ? fill.max[k] : fill.min[k]);
    }
    if (inside) depth = std::max(depth, std::min(top, fill.level) - dot(up, x));
  }
  return depth;
}

/// Depth of each fluid particle of that mass (kg), m: in its block, or among the particles themselves where a
/// file gave some.
std::vector<double> depths_of(const Config& config, const Vec3d& gravity, const std::vector<Vec3d>& x,
                              const std::vector<Real>& mass) {
  std::vector<double> depth;
  for (const Vec3d& at : x) depth.push_back(depth_at(config, gravity, at));
  bool listed = false;
  for (const auto& fill : config.fluid.fills) listed = listed || !fill.file.empty();
  if (!listed || norm(gravity) == 0) return depth;
  std::vector<double> size;  // edge of the cell for which a particle stands, m
  const double thickness = config.domain.thickness();
  for (const Real m : mass) {
    const double volume = double(m) / config.fluid.rho0;
    size.push_back(thickness > 0 ? std::sqrt(volume / thickness) : std::cbrt(volume));
  }
  const auto below = depth_in_columns(x, gravity * (-1 / norm(gravity)), config.fluid.dx, size);
  for (std::size_t a = 0; a < x.size(); ++a)
    if (depth[a] == 0) depth[a] = below[a];
  return depth;
}

/// Gravity works against a wall or a free surface, not along a periodic axis.
bool hydrostatic(const Config& config) {
  for (int k = 0; k < 3; ++k)
    if (config.domain.periodic[k] && config.gravity[k] != 0) return false;
  return norm(config.gravity) > 0;
}

/// The part of the effective gravity along gravity. Fluid starts with a level surface, which cannot balance
/// what acts across it.
Vec3d level_gravity(const Config& config, const Vec3d& effective) {
  return config.gravity * std::max(0.0, dot(effective, config.gravity) / norm2(config.gravity));
}

}  // namespace

const HostStore& store_of(const SavedState& state, const std::string& name) {
  for (const auto& s : state.stores)
    if (s.name == name) return s;
  throw FileError("checkpoint has no " + name);
}

namespace {
/// More than any pair loop looks for, m.
double farthest_pair(const Config& c) { return 8 * std::max({c.fluid.h(), c.couple.hc, c.grain.d_max}); }
}  // namespace

CoupledSimulation::CoupledSimulation(const Config& config, const Setup& setup)
    : config_(config),
      // all of a plane flow is in one place along y, and shapes have no images there
      frame_(config.domain.min, config.domain.max, config.domain.periodic[0],
             config.domain.periodic[1] && !config.domain.two_d, config.domain.periodic[2],
             farthest_pair(config)),
      clock_(config.time),
      geometry_(config),
      grain_geometry_(config, [](const WallBody& body) { return body.stops_grains(); }),
      shells_(config, [](const WallBody& body) { return body.single_layer(); }),
      bodies_(config, frame_, grain_geometry_),
      motion_(config, bodies_),
      open_(config, frame_, motion_),
      gravity_(config),
      matter_(config.grain),
      drive_factor_(config.drive) {
  if (has_grains()) {
    const bool wet = has_fluid() && config.couple.mode != CouplingMode::off;
    solid_solver_ = std::make_unique<SolidSolver>(config, frame_, grain_geometry_, grains_, &bodies_, wet);
    grain_grid_ = CellGrid(frame_, frame_.origin, frame_.origin + frame_.length, solid_solver_->range());
  }
  if (has_fluid()) fluid_solver_ = FluidSolver::make(config, frame_, geometry_, fluid_);
  if (has_fluid() && has_grains() && config.couple.mode != CouplingMode::off)
    coupling_ = std::make_unique<Coupling>(config, frame_, geometry_);
  if (!coupled()) fluid_.solid_factor.leave_out();
  if (config.grain.materials.empty()) grains_.material.leave_out();
  if (!two_way())
    for (FieldBase* field : std::initializer_list<FieldBase*>{&fluid_.reaction, &fluid_.drag_kick})
      field->leave_out();
  if (!two_way() && !config.domain.sheared()) fluid_.flux.leave_out();
  upload(setup);
}

void CoupledSimulation::upload(const Setup& setup) {
  const auto& f = setup.fluid;
  fluid_.resize(Index(f.x.size()));
  fluid_.id.assign(ids(f.x.size()));
  std::vector<FluidPosition> x;
  std::vector<Real4> v;
  for (std::size_t a = 0; a < f.x.size(); ++a) {
    x.push_back(as_position<FluidPosition>(frame_, f.x[a]));
    v.push_back({Real3(f.v[a]), Real(config_.fluid.rho0)});
  }
  fluid_.x.assign(x);
  fluid_.v_rho.assign(v);
  fluid_.mass.assign(converted<Real>(f.mass));
  fluid_.eps.assign(std::vector<Real>(f.x.size(), Real(1)));
  fluid_.solid_factor.assign(std::vector<Real>(f.x.size(), Real(1)));
  fluid_.m_state.assign(std::vector<Real4>(f.x.size()));
  if (const FluidConfig& fluid = config_.fluid; !fluid.species.empty()) {
    std::vector<std::uint32_t> species;
    std::vector<Real> viscosity;
    for (const std::uint32_t fill : f.fill) {
      species.push_back(fluid.species_of(fluid.fills[fill]));
      viscosity.push_back(Real(fluid.species[species.back()].mu / fluid.mu));
    }
    fluid_.species.assign(species);
    fluid_.viscosity.assign(viscosity);
  }

  const auto& w = setup.walls;
  walls_.resize(Index(w.x.size()));
  walls_.id.assign(ids(w.x.size()));
  walls_.x0.assign(w.x);
  walls_.x.assign(w.x);
  walls_.body.assign(w.body);
  std::vector<Real> compression(w.x.size(), Real(0));
  for (std::size_t i = 0; i < w.outer.size(); ++i)
    if (w.outer[i]) compression[i] = kNoCompression;
  walls_.compression.assign(compression);
  if (!w.mirror.empty()) {
    walls_.mirrors.resize(walls_.size());
    walls_.mirrors.x0.assign(w.mirror);
    walls_.mirrors.x.assign(w.mirror);
  }
  if (walls_.size() > 0) WallMotion::place(frame_, walls_, poses_now());

  const auto& g = setup.grains;
  grains_.resize(Index(g.x.size()));
  grains_.id.assign(ids(g.x.size()));
  grains_.x.assign(g.x);
  grains_.v.assign(converted<Real3>(g.v));
  if (!g.omega.empty()) grains_.omega.assign(converted<Real3>(g.omega));
  std::vector<std::uint32_t> material;
  for (const std::uint32_t fill : g.fill)
    material.push_back(config_.grain.material(config_.grain.fills[fill].material));
  if (!config_.grain.materials.empty()) grains_.material.assign(material);
  grains_.radius.assign(converted<Real>(g.radius));
  grains_.eps.assign(std::vector<Real>(g.x.size(), Real(1)));
  if (has_grains()) solid_solver_->groups().bind(grains_, g.fill);
  open_.start(fluid_, grains_);
}

void CoupledSimulation::start() {
  refresh(has_fluid(), has_grains());
  if (has_grains()) solid_solver_->evaluate(grains_, poses_now());
  if (bodies_.any()) bodies_.evaluate(poses_now());
  if (has_fluid()) {
    initialise_fluid();
    if (two_way()) update_porosity(0);
    fluid_solver_->state(fluid_, 0, two_way());
    evaluate_fluid(0, 0);
    load_bodies(0, 0);
    fluid_solver_->correct(fluid_, 0);
    if (coupled()) push_grains(0, 0);
  }
  sweep();
  if (coupled()) {  // for the first step's drag limit
    coupling_->gather(fluid_, grains_, poses_now(), 0);
    drag_limit_ = coupling_->stable_dt();
  }
}

void CoupledSimulation::initialise_fluid() {
  if (two_way()) update_porosity(0);
  std::vector<Real> pressure(fluid_.size(), Real(config_.eos.background));
  if (hydrostatic(config_)) {
    const Vec3d g = level_gravity(config_, gravity_.at(0));
    std::vector<Vec3d> x;
    for (const auto& at : fluid_.x.values()) x.push_back(coordinates(frame_, at));
    const std::vector<double> depth = depths_of(config_, g, x, fluid_.mass.values());
    for (Index a = 0; a < fluid_.size(); ++a) pressure[a] += Real(config_.fluid.rho0 * norm(g) * depth[a]);
  }
  Buffer<Real> device;
  device.assign(pressure);
  for_each(fluid_.owned(), LayPass{fluid_solver_->eos(), frame_, fluid_.eps, device, fluid_.mass, fluid_.s});
}

SavedState CoupledSimulation::save_grains() {
  SavedState out;
  if (!has_grains()) return out;
  out.stores = {grains_.save(), solid_solver_->save_contacts(grains_)};
  solid_solver_->groups().save(out.stores);
  return out;
}

void CoupledSimulation::load_grains(const SavedState& state) {
  if (!has_grains()) return;
  load_grain_store(state);
  solid_solver_->load_contacts(grains_, grain_grid_, store_of(state, "contacts"));
}

void CoupledSimulation::load_grain_store(const SavedState& state) {
  grains_.load(store_of(state, "grains"));
  RigidGroups& groups = solid_solver_->groups();
  if (groups.any()) groups.load(store_of(state, "groups"), grains_);
}

SavedState CoupledSimulation::save() {
  SavedState out = save_grains();
  if (has_fluid()) {
    out.stores.push_back(fluid_.save());
    out.stores.push_back(walls_.save());
    if (walls_.mirrors.size() > 0) out.stores.push_back(walls_.mirrors.save());
  }
  out.scalars = {{"time", "s", clock_.time},         {"step", "-", double(clock_.step)},
                 {"last_dt", "s", clock_.last_dt},   {"drag_limit", "s", drag_limit_},
                 {"walls_moved", "m", walls_moved_}, {"rebuilds", "-", double(rebuilds_)}};
  bodies_.save(out.stores);
  open_.save(out.scalars);
  if (has_fluid()) fluid_solver_->save(out.scalars);
  for (int b = 0; b < motion_.walls(); ++b)
    out.scalars.push_back({"removed_" + std::to_string(b), "-", motion_.removed(b) ? 1.0 : 0.0});
  return out;
}

void CoupledSimulation::load(const SavedState& state) {
  const auto scalar = [&](const std::string& name) {
    for (const auto& q : state.scalars)
      if (q.name == name) return q.value;
    throw FileError("checkpoint has no " + name);
  };
  clock_.time = scalar("time");
  clock_.step = std::int64_t(scalar("step"));
  clock_.last_dt = scalar("last_dt");
  drag_limit_ = scalar("drag_limit");
  walls_moved_ = scalar("walls_moved");
  rebuilds_ = std::int64_t(scalar("rebuilds"));
  open_.load(scalar, clock_.time);
  for (int b = 0; b < motion_.walls(); ++b)
    if (scalar("removed_" + std::to_string(b)) != 0) motion_.remove(b);
  if (has_fluid()) {
    fluid_.load(store_of(state, "fluid"));
    fluid_solver_->load(scalar);
    fluid_solver_->set_gravity(gravity_.at(clock_.time));
    fluid_solver_->set_drive(fluid_, clock_.time);
    fluid_solver_->set_step(clock_.step);
    walls_.load(store_of(state, "walls"));
    const auto mirrored = [](const WallBody& body) { return body.type == WallType::mdbc; };
    if (std::any_of(config_.wall.bodies.begin(), config_.wall.bodies.end(), mirrored))
      walls_.mirrors.load(store_of(state, "mirrors"));
  }
  if (has_grains()) load_grain_store(state);
  bodies_.load([&](const char* name) -> const HostStore& { return store_of(state, name); }, clock_.time);
  wall_forces_.step = fluid_loads_.step = grain_loads_.step = -1;
  restore_lists(state);
  if (has_fluid()) fluid_solver_->survey(fluid_);
  sweep();
}

std::unique_ptr<Simulation> make_coupled(const Config& config, const Setup& setup) {
  return std::make_unique<CoupledSimulation>(config, setup);
}

}  // namespace bedload::inline BL_VARIANT
