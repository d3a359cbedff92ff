// How a state is filled, saved and loaded.

#include "src/time/state.hpp"

#include <algorithm>
#include <numeric>

namespace BL_SOLVER {
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

/// More than any pair loop looks for, m.
double farthest_pair(const Config& c) { return 8 * std::max({c.fluid.h(), c.couple.hc, c.grain.d_max}); }

void fill_fluid(const Config& config, const Frame& frame, const Setup& setup, FluidStore& fluid) {
  const auto& f = setup.fluid;
  fluid.resize(Index(f.x.size()));
  fluid.id.assign(ids(f.x.size()));
  std::vector<FluidPosition> x;
  std::vector<VelocityDensity<>> v;
  for (std::size_t a = 0; a < f.x.size(); ++a) {
    x.push_back(as_position<FluidPosition>(frame, f.x[a]));
    v.push_back({Real3(f.v[a]), Real(config.fluid.rho0)});
  }
  fluid.x.assign(x);
  fluid.v_rho.assign(v);
  fluid.mass.assign(converted<Real>(f.mass));
  fluid.eps.assign(std::vector<Real>(f.x.size(), Real(1)));
  fluid.solid_factor.assign(std::vector<Real>(f.x.size(), Real(1)));
  fluid.eos_state.assign(std::vector<EosState<>>(f.x.size()));
  if (config.couple.suspension != SuspensionLaw::none)
    fluid.viscosity.assign(std::vector<Real>(f.x.size(), Real(1)));
  if (config.fluid.species.empty()) return;
  std::vector<std::uint32_t> species;
  std::vector<Real> viscosity;
  for (const std::uint32_t fill : f.fill) {
    species.push_back(config.fluid.species_of(config.fluid.fills[fill]));
    viscosity.push_back(Real(config.fluid.species[species.back()].mu / config.fluid.mu));
  }
  fluid.species.assign(species);
  fluid.viscosity.assign(viscosity);
}

void fill_walls(const Setup& setup, WallStore& walls) {
  const auto& w = setup.walls;
  walls.resize(Index(w.x.size()));
  walls.id.assign(ids(w.x.size()));
  walls.x0.assign(w.x);
  walls.x.assign(w.x);
  walls.body.assign(w.body);
  std::vector<Real> compression(w.x.size(), Real(0));
  for (std::size_t i = 0; i < w.outer.size(); ++i)
    if (w.outer[i]) compression[i] = kNoCompression;
  walls.compression.assign(compression);
  if (w.mirror.empty()) return;
  walls.mirrors.resize(walls.size());
  walls.mirrors.x0.assign(w.mirror);
  walls.mirrors.x.assign(w.mirror);
}

void fill_grains(const Config& config, const Setup& setup, GrainStore& grains) {
  const auto& g = setup.grains;
  grains.resize(Index(g.x.size()));
  grains.id.assign(ids(g.x.size()));
  grains.x.assign(g.x);
  grains.v.assign(converted<Real3>(g.v));
  if (!g.omega.empty()) grains.omega.assign(converted<Real3>(g.omega));
  if (grains.material.used()) {
    std::vector<std::uint32_t> of_fill, material;
    for (std::size_t k = 0; k < config.grain.fills.size(); ++k)
      of_fill.push_back(config.grain.material_of(k));
    for (const std::uint32_t fill : g.fill) material.push_back(of_fill[fill]);
    grains.material.assign(material);
  }
  grains.radius.assign(converted<Real>(g.radius));
  grains.eps.assign(std::vector<Real>(g.x.size(), Real(1)));
  std::vector<Real> clump_d;
  for (const std::uint32_t clump : g.clump) clump_d.push_back(clump > 0 ? Real(g.clumps[clump - 1].d) : 0);
  grains.clump_d.assign(clump_d);
}

}  // namespace

const HostStore& store_of(const SavedState& saved, const std::string& name) {
  for (const auto& s : saved.stores)
    if (s.name == name) return s;
  throw FileError("checkpoint has no " + name);
}

double scalar_of(const SavedState& saved, const std::string& name) {
  for (const auto& q : saved.scalars)
    if (q.name == name) return q.value;
  throw FileError("checkpoint has no " + name);
}

State::State(const Config& config)
    : has_fluid(config.fluid.present),
      has_grains(config.grain.present),
      coupled(has_fluid && has_grains && config.couple.mode != CouplingMode::off),
      two_way(coupled && config.couple.mode == CouplingMode::two_way),
      // all of a plane flow is in one place along y, and shapes have no images there
      frame(config.domain.min, config.domain.max, config.domain.periodic[0],
            config.domain.periodic[1] && !config.domain.two_d, config.domain.periodic[2],
            farthest_pair(config)),
      clock(config.time),
      geometry(config.wall.bodies, config.domain),
      grain_geometry(config.wall.bodies, config.domain,
                     [](const WallBody& body) { return body.stops_grains(); }),
      shells(config.wall.bodies, config.domain, [](const WallBody& body) { return body.single_layer(); }),
      bodies(free_body_parameters(config), frame, grain_geometry),
      motion(wall_motion_parameters(config), bodies),
      open(open_boundary_parameters(config), frame, motion, grains),
      gravity(config.gravity, config.frame.motion, config.time.end),
      matter(config.grain.all_materials()) {
  if (!coupled) fluid.solid_factor.leave_out(), grains.xp.leave_out(), grains.x_before.leave_out();
  if (matter.materials() == 1) grains.material.leave_out();
  const auto leave_out_unless = [](bool needed, std::initializer_list<FieldBase*> fields) {
    for (FieldBase* field : fields)
      if (!needed) field->leave_out();
  };
  leave_out_unless(two_way, {&fluid.reaction, &fluid.drag_kick, &fluid.drag_rate, &grains.reaction_impulse,
                             &grains.reaction_force, &grains.reaction_spin});
  leave_out_unless(coupled, {&grains.still});
  leave_out_unless(coupled && config.couple.slip == DragSlip::local, {&grains.by_slip});
  leave_out_unless(coupled && config.couple.angmom, {&grains.lever_at_centre, &grains.lever_off_centre});
  leave_out_unless(two_way && config.couple.angmom, {&grains.reaction_couple});
  leave_out_unless(config.grain.has_clumps(), {&grains.clump_d});  // beds settle for cases with fluid
  if (!coupled) grains.clump_d.begin_at_zero();
  if (!two_way && !config.domain.sheared()) fluid.flux.leave_out();
}

void State::fill(const Config& config, const Setup& setup) {
  fill_fluid(config, frame, setup, fluid);
  fill_walls(setup, walls);
  if (walls.size() > 0) WallMotion::place(frame, walls, poses_now());
  fill_grains(config, setup, grains);
  open.start(fluid, grains);
}

void State::save(SavedState& out) const {
  if (has_fluid) {
    out.stores.push_back(fluid.save());
    out.stores.push_back(walls.save());
    if (walls.mirrors.size() > 0) out.stores.push_back(walls.mirrors.save());
  }
  bodies.save(out.stores);
  for (const Quantity& q : {Quantity{"time", "s", clock.time}, Quantity{"step", "-", double(clock.step)},
                            Quantity{"last_dt", "s", clock.last_dt}})
    out.scalars.push_back(q);
  open.save(out.scalars);
  for (int b = 0; b < motion.walls(); ++b)
    out.scalars.push_back({"removed_" + std::to_string(b), "-", motion.removed(b) ? 1.0 : 0.0});
}

void State::load(const Config& config, const SavedState& saved) {
  const auto scalar = [&](const std::string& name) { return scalar_of(saved, name); };
  clock.time = scalar("time");
  clock.step = std::int64_t(scalar("step"));
  clock.last_dt = scalar("last_dt");
  open.load(scalar, clock.time);
  for (int b = 0; b < motion.walls(); ++b)
    if (scalar("removed_" + std::to_string(b)) != 0) motion.remove(b);
  if (has_fluid) {
    fluid.load(store_of(saved, "fluid"));
    walls.load(store_of(saved, "walls"));
    const auto mirrored = [](const WallBody& body) { return body.type->kind == WallKind::mirrored; };
    if (std::any_of(config.wall.bodies.begin(), config.wall.bodies.end(), mirrored))
      walls.mirrors.load(store_of(saved, "mirrors"));
  }
  bodies.load([&](const char* name) -> const HostStore& { return store_of(saved, name); }, clock.time);
}

}  // namespace BL_SOLVER
