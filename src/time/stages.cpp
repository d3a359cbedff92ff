// What a step is made up of: which stage reads and writes which fields. tests/time/stages_test.cpp holds it
// against what they do, docs/architecture.md shows it.

#include <algorithm>

#include "src/time/stepper.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

Fields operator+(Fields a, const Fields& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Fields all_of(const Store& store) { return {store.fields().begin(), store.fields().end()}; }

Fields all_of(const std::vector<const Store*>& stores) {
  Fields out;
  for (const Store* store : stores) out = out + all_of(*store);
  return out;
}

/// What outlives a step, among others.
Fields lasting(Fields fields) {
  std::erase_if(fields, [](const FieldBase* f) { return f->lifetime == Lifetime::derived; });
  return fields;
}

/// What the case has of them, each once.
Fields present(const Fields& fields) {
  Fields out;
  for (const FieldBase* f : fields)
    if (f->used() && std::find(out.begin(), out.end(), f) == out.end()) out.push_back(f);
  return out;
}

}  // namespace

std::vector<const Store*> Stepper::stores() const {
  std::vector<const Store*> out{&fluid_, &walls_, &walls_.mirrors, &grains_};
  for (const Store* store : bodies_.stores()) out.push_back(store);
  if (has_grains())
    for (const Store* store : solid_solver_->groups().stores()) out.push_back(store);
  return out;
}

void Stepper::add(std::string_view name, Part part, void (Stepper::*run)(Step&), const Fields& reads,
                  const Fields& writes) {
  stages_.push_back({name, part, present(reads), present(writes), run});
}

void Stepper::list_stages() {
  Fields sorted, packed;  // with the lists
  if (has_fluid())
    sorted = all_of({&fluid_, &walls_, &walls_.mirrors}),
    packed = {&fluid_.xp, &walls_.xp, &walls_.mirrors.xp};
  if (has_grains()) sorted = sorted + all_of({&grains_});
  if (coupled()) packed.push_back(&grains_.xp);
  add("renew_lists", Part::lists, &Stepper::renew_lists, lasting(sorted) + packed, sorted);
  if (has_grains() || bodies_.any()) list_solid_stages();
  if (has_fluid()) list_fluid_stages();
  Fields watched = all_of(bodies_.stores());
  if (has_grains()) watched = watched + Fields{&grains_.x, &grains_.v, &grains_.omega, &grains_.K};
  add("finish", Part::checks, &Stepper::finish, watched, {});
}

void Stepper::list_solid_stages() {
  const FluidStore& f = fluid_;
  const GrainStore& g = grains_;
  const Fields drag{&g.U, &g.omega_f, &g.K, &g.K_rot}, impulses{&g.impulse, &g.spin_impulse};
  if (coupled())
    add("interpolate", Part::coupling, &Stepper::interpolate,
        {&f.x, &f.xp, &f.v_rho, &f.m_state, &f.mass, &f.eps, &f.theta, &f.solid_factor, &g.x, &g.xp, &g.v,
         &g.omega, &g.radius, &g.fluid_force, &g.id},
        drag + Fields{&g.eps, &g.wetness, &g.x_before});

  Fields moved = all_of(bodies_.stores()), by = lasting(moved);
  if (has_grains()) {
    moved = moved + impulses + Fields{&g.x, &g.v, &g.omega, &g.force, &g.torque, &g.drag_force} +
            solid_solver_->fields_of_contacts() + all_of(solid_solver_->groups().stores());
    by = lasting(moved) + drag + Fields{&g.id, &g.radius, &g.material, &g.fluid_force, &g.wetness};
  }
  add("move_solids", Part::grains, &Stepper::move_solids, by, moved);

  if (two_way())
    add("react", Part::coupling, &Stepper::react,
        impulses + drag + Fields{&f.xp, &f.v_rho, &f.mass, &f.m_state, &g.xp},
        {&f.v_rho, &f.drag_kick, &f.reaction});
}

void Stepper::list_fluid_stages() {
  const FluidStore& f = fluid_;
  const WallStore& w = walls_;
  const MirrorStore& m = w.mirrors;
  const GrainStore& g = grains_;
  const FluidSolver& fluid = *fluid_solver_;
  const bool sheared = fluid.shear().acts();
  const SmoothingLengths* const own = fluid.lengths();
  const Fields none, lengths = own ? Fields{&own->h, &own->omega} : none,
                     listed_lengths = own ? Fields{&own->h_list} : none;
  const Fields of_model = fluid.fields_of_forces(), bodies = all_of(bodies_.stores());
  const FieldBase* const flux = f.flux.used() ? &f.flux : &f.v_rho;
  const bool walled =
      !config_.inlets.empty() || std::any_of(config_.wall.bodies.begin(), config_.wall.bodies.end(),
                                             [](const WallBody& body) { return body.stops_fluid(); });
  const Fields drift = fluid.drifts() ? Fields{&f.drift} : none;
  // what density, or forces in one pass with it, makes of the arrangement of particles
  const Fields ordered = Fields{&f.exposure, &f.exposure_next, &f.correction, &f.compression_rate} +
                         (fluid.shifts() ? drift : none);
  const Fields peculiar = sheared ? Fields{&f.flux} : none;
  // what pair loops read of fluid and of walls
  const Fields pairs = Fields{&f.xp, flux, &f.m_state} + lengths, of_walls{&w.xp, &w.v_rho, &w.m_state};

  if (config_.visc.collision)
    add("collide", Part::fluid, &Stepper::collide, {&f.xp, &f.v_rho, &f.mass}, {&f.v_rho});
  if (fluid.one_pass())
    add("advance", Part::fluid, &Stepper::advance,
        of_model + drift + Fields{&f.x, &f.xp, &f.v_rho, &f.acc, &f.s, &f.mass, &f.eps, &f.compression_rate},
        peculiar + Fields{&f.x, &f.xp, &f.v_rho, &f.s, &f.m_state, &f.p_rho2});
  else
    add("kick_drift", Part::fluid, &Stepper::kick_drift,
        drift + Fields{&f.x, &f.xp, &f.v_rho, &f.acc, &f.reaction}, peculiar + Fields{&f.x, &f.xp, &f.v_rho});
  const bool moving = walled && motion_.moves();
  add("move_walls", Part::fluid, &Stepper::move_walls,
      bodies + (moving ? Fields{&w.x0, &w.body, &w.v_rho, &m.x0} : none),
      moving ? Fields{&w.x, &w.v_rho, &w.xp, &m.x, &m.xp} : none);
  if (coupled())
    add("porosity", Part::coupling, &Stepper::porosity,
        {&f.x, &f.v_rho, &f.mass, &f.m_state, &g.x, &g.x_before, &g.v, &g.radius},
        Fields{&g.xp, &f.xp, &f.eps} +
            (two_way() ? Fields{&f.solid_factor, &f.flux, &f.m_state, &f.viscosity, &f.grains_around}
                       : none));
  if (!fluid.one_pass()) {
    const bool summed = config_.density.method == DensityMethod::summation,
               packed = summed || config_.density.reinit_every > 0;
    add("density", Part::fluid, &Stepper::density,
        pairs + of_walls + drift +
            Fields{&f.x, &f.v_rho, &f.s, &f.eps, &f.grains_around, &f.exposure, &f.viscosity, &w.x,
                   &w.compression, &w.body, &m.x},
        ordered + Fields{&f.s, &f.s_next} + (packed ? Fields{&f.xp} : none) +
            (moving ? Fields{&w.xp} : none) + (fluid.freezes() ? Fields{&w.compression} : none));
    add("fluid_state", Part::fluid, &Stepper::fluid_state,
        listed_lengths +
            Fields{flux, &f.x, &f.v_rho, &f.acc, &f.reaction, &f.s, &f.mass, &f.eps, &f.compression_rate},
        (own ? Fields{&own->h} : none) + Fields{flux, &f.v_rho, &f.s, &f.m_state, &f.p_rho2, &f.xp});
  }
  if (walled)
    add("wall_state", Part::fluid, &Stepper::wall_state,
        pairs + of_walls + Fields{&w.v_visc, &w.compression, &w.x0, &w.x, &w.body, &m.x, &m.xp, &f.drag_kick},
        {&w.v_rho, &w.v_visc, &w.m_state, &w.compression});
  add("forces", Part::fluid, &Stepper::forces,
      pairs + of_walls + drift + lasting(of_model) +
          Fields{&f.x, &f.s, &f.mass, &f.id, &f.viscosity, &f.p_rho2, &w.v_visc, &w.body, &w.id} +
          (fluid.one_pass() ? Fields{&f.exposure} : Fields{&f.correction}),
      Fields{&f.theta, &f.acc_next} + drift + of_model + (fluid.one_pass() ? ordered + Fields{&f.s} : none) +
          (own ? Fields{&f.p_rho2} : none) + (config_.eos.filter ? Fields{&f.m_state, &f.p_rho2} : none));
  if (fluid.repels())
    add("repel", Part::fluid, &Stepper::repel,
        drift + Fields{&f.x, &f.v_rho, &f.acc, &f.acc_next, &f.exposure},
        drift + Fields{&f.acc_next, &f.heading});
  if (bodies_.any())
    add("load_bodies", Part::fluid, &Stepper::load_bodies,
        bodies + pairs + of_walls + of_model +
            Fields{&f.x, &f.mass, &f.acc, &f.acc_next, &f.heading, &f.exposure, &f.correction, &f.viscosity,
                   &w.v_visc, &w.x0, &w.body},
        bodies);
  add("correct", Part::fluid, &Stepper::correct,
      drift + lengths + listed_lengths +
          Fields{&f.x, &f.x_list, &f.half_skin, &f.v_rho, &f.acc, &f.acc_next, &f.s, &f.eps},
      {&f.v_rho, &f.acc, &f.acc_next});
  if (coupled()) {
    const Fields groups = all_of(solid_solver_->groups().stores());
    add("push", Part::coupling, &Stepper::push,
        groups + Fields{&g.xp, &f.xp, &f.theta, &f.m_state, &f.solid_factor, &g.v, &g.omega, &g.radius,
                        &g.material, &g.fluid_force},
        Fields{&g.fluid_force, &g.v} + (groups.empty() ? none : Fields{&g.omega}) + groups);
  }
}

}  // namespace bedload::inline BL_VARIANT
