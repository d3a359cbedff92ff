// How a state is filled, saved and loaded.

#include "src/time/state.hpp"

#include <algorithm>

namespace BL_SOLVER {
namespace {

/// More than any pair loop looks for, m.
double farthest_pair(const Config& c) { return 8 * std::max({c.fluid.h(), c.couple.hc, c.grain.d_max}); }

void put_places(const Frame& frame, const Setup::Fluid& f, const Taken& some, FluidStore& fluid) {
  fluid.resize(some.count);
  set_from_host(fluid.x, some.count,
                [&](Index a) { return as_position<FluidPosition>(frame, f.x[some[a]]); });
}

void put_fluid(const Config& config, const Frame& frame, const Setup::Fluid& f, const Taken& some,
               FluidStore& fluid) {
  put_places(frame, f, some, fluid);
  const auto set = [n = some.count](auto& field, const auto& value) { set_from_host(field, n, value); };
  set(fluid.id, [&](Index a) { return Id(some[a]); });
  set(fluid.v_rho, [&](Index a) { return VelocityDensity<>{Real3(f.v[some[a]]), Real(config.fluid.rho0)}; });
  set(fluid.mass, [&](Index a) { return Real(f.mass[some[a]]); });
  for (Field<Real>* field : {&fluid.eps, &fluid.solid_factor}) set(*field, [](Index) { return Real(1); });
  set(fluid.eos_state, [](Index) { return EosState<>{}; });
  if (config.couple.suspension != SuspensionLaw::none) set(fluid.viscosity, [](Index) { return Real(1); });
  if (config.fluid.species.empty()) return;
  std::vector<std::uint32_t> of_fill;
  for (const FluidFill& fill : config.fluid.fills) of_fill.push_back(config.fluid.species_of(fill));
  const auto species = [&](Index a) { return of_fill[f.fill[some[a]]]; };
  set(fluid.species, species);
  set(fluid.viscosity, [&](Index a) { return Real(config.fluid.species[species(a)].mu / config.fluid.mu); });
}

void put_walls(const Setup::Walls& w, const Taken& some, WallStore& walls) {
  walls.resize(some.count);
  const auto set = [n = some.count](auto& field, const auto& value) { set_from_host(field, n, value); };
  const auto place = [&](Index b) { return w.x[some[b]]; };
  set(walls.id, [&](Index b) { return Id(some[b]); });
  set(walls.x0, place);
  set(walls.x, place);
  set(walls.body, [&](Index b) { return w.body[some[b]]; });
  set(walls.compression,
      [&](Index b) { return !w.outer.empty() && w.outer[some[b]] ? kNoCompression : Real(0); });
  if (w.mirror.empty()) return;
  MirrorStore& images = walls.mirrors;
  images.resize(some.count);
  for (Field<Vec3d>* field : {&images.x0, &images.x}) set(*field, [&](Index b) { return w.mirror[some[b]]; });
}

void put_places(const Setup::Grains& g, const Taken& some, GrainStore& grains) {
  grains.resize(some.count);
  set_from_host(grains.x, some.count, [&](Index i) { return g.x[some[i]]; });
}

void put_grains(const Config& config, const Setup::Grains& g, const Taken& some, GrainStore& grains) {
  put_places(g, some, grains);
  const auto set = [n = some.count](auto& field, const auto& value) { set_from_host(field, n, value); };
  set(grains.id, [&](Index i) { return Id(some[i]); });
  set(grains.v, [&](Index i) { return Real3(g.v[some[i]]); });
  if (!g.omega.empty()) set(grains.omega, [&](Index i) { return Real3(g.omega[some[i]]); });
  std::vector<std::uint32_t> of_fill;
  for (std::size_t k = 0; k < config.grain.fills.size(); ++k) of_fill.push_back(config.grain.material_of(k));
  set(grains.material, [&](Index i) { return of_fill[g.fill[some[i]]]; });
  set(grains.radius, [&](Index i) { return Real(g.radius[some[i]]); });
  set(grains.eps, [](Index) { return Real(1); });
  set(grains.clump_d, [&](Index i) {
    const std::uint32_t clump = some[i] < g.clump.size() ? g.clump[some[i]] : 0;
    if (clump == 0) return Real(0);
    const Setup::Grains::Clump& of = g.clumps[clump - 1];
    return config.grain.clump_of(config.grain.fills[of.fill])->shares_drag() ? Real(of.d) : Real(0);
  });
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
  leave_out_unless(config.grain.has_clumps(), {&grains.clump_d});  // a bed settles without fluid
  if (!coupled) grains.clump_d.begin_at_zero();
  if (!two_way && !config.domain.sheared()) fluid.flux.leave_out();
}

HostState State::particles_of(const Config& config, const Setup& setup) {
  HostState from;
  if (has_fluid) {
    from.fluid = {
        &fluid, Index(setup.fluid.x.size()),
        [this, &setup](const Taken& some) { put_places(frame, setup.fluid, some, fluid); },
        [this, &config, &setup](const Taken& some) { put_fluid(config, frame, setup.fluid, some, fluid); }};
    const auto put = [this, &setup](const Taken& some) {
      put_walls(setup.walls, some, walls);
      walls.mirrors.count();
      if (walls.size() > 0) WallMotion::place(frame, walls, poses_now());
    };
    from.walls = {&walls, Index(setup.walls.x.size()), put, put};
  }
  if (has_grains)
    from.grains = {
        &grains, Index(setup.grains.x.size()),
        [this, &setup](const Taken& some) { put_places(setup.grains, some, grains); },
        [this, &config, &setup](const Taken& some) { put_grains(config, setup.grains, some, grains); }};
  return from;
}

HostState State::particles_of(const Config& config, const SavedState& saved) {
  HostState from;
  if (has_grains) from.grains = saved_particles(store_of(saved, "grains"), grains);
  if (!has_fluid) return from;
  from.fluid = saved_particles(store_of(saved, "fluid"), fluid);
  from.walls = saved_particles(store_of(saved, "walls"), walls);
  const auto mirrored = [](const WallBody& body) { return body.type->kind == WallKind::mirrored; };
  if (std::any_of(config.wall.bodies.begin(), config.wall.bodies.end(), mirrored)) {
    const HostParticles images = saved_particles(store_of(saved, "mirrors"), walls.mirrors);
    from.walls.put_places =
        from.walls.put = [this, of_walls = from.walls.put, of_images = images.put](const Taken& some) {
          of_walls(some), of_images(some);
          walls.mirrors.count();
        };
  }
  return from;
}

void State::save(SavedState& out) const {
  if (has_fluid) {
    out.stores.push_back(fluid.save());
    out.stores.push_back(walls.save());
    if (walls.mirrors.everywhere() > 0) out.stores.push_back(walls.mirrors.save());
  }
  bodies.save(out.stores);
  for (const Quantity& q : {Quantity{"time", "s", clock.time}, Quantity{"step", "-", double(clock.step)},
                            Quantity{"last_dt", "s", clock.last_dt}})
    out.scalars.push_back(q);
  open.save(out.scalars);
  for (int b = 0; b < motion.walls(); ++b)
    out.scalars.push_back({"removed_" + std::to_string(b), "-", motion.removed(b) ? 1.0 : 0.0});
}

void State::load(const SavedState& saved) {
  const auto scalar = [&](const std::string& name) { return scalar_of(saved, name); };
  clock.time = scalar("time");
  clock.step = std::int64_t(scalar("step"));
  clock.last_dt = scalar("last_dt");
  open.load(scalar, clock.time);
  for (int b = 0; b < motion.walls(); ++b)
    if (scalar("removed_" + std::to_string(b)) != 0) motion.remove(b);
  bodies.load([&](const char* name) -> const HostStore& { return store_of(saved, name); }, clock.time);
}

}  // namespace BL_SOLVER
