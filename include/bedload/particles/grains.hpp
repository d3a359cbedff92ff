#pragma once
#include "bedload/particles/store.hpp"

namespace BL_SOLVER {

/// Grains: spheres with spin. Positions always fp64 (overlaps need it).
struct GrainStore : Store {
  GrainStore() : Store("grains") {}

  Field<Id> id{*this, "id", "-", Lifetime::kept, Output{.order = 99}};
  Field<Vec3d> x{*this, "x", "m", Lifetime::kept, Output{.order = 0, .uses = kViews, .name = "position"}};
  Field<Vec3d> x_list{*this, "x_list", "m", Lifetime::renewed};  ///< where the neighbour lists were built
  Field<Real> radius{*this, "radius", "m", Lifetime::kept, Output{.order = 3}};
  Field<std::uint32_t> material{*this, "material", "-", Lifetime::kept, Output{.order = 9}};  ///< place in GrainConfig::all_materials; left out where there is one
  Field<Real3> v{*this, "v", "m/s", Lifetime::kept,
                 Output{.order = 1, .uses = kFrames | kViews | kRheology, .name = "velocity"}};
  Field<Real3> omega{*this, "omega", "rad/s", Lifetime::kept, Output{.order = 2, .name = "angular_velocity"}};
  Field<Real3> force{*this, "contact_force", "N", Lifetime::kept, Output{.order = 4}};  ///< contacts, walls
  Field<Real3> torque{*this, "contact_torque", "N m", Lifetime::kept};
  // from the fluid, constant over a fluid step
  Field<Real3> fluid_force{*this, "fluid_force", "N", Lifetime::kept, Output{.order = 11, .coupled = true}};  ///< stress of the mixture on its volume: buoyancy
  Field<Real3> drag_force{*this, "drag_force", "N", Lifetime::kept, Output{.order = 10, .coupled = true}};  ///< mean over the last step
  Field<Real> eps{*this, "porosity", "-", Lifetime::kept, Output{.order = 12, .coupled = true}};
  Field<Real> wetness{*this, "wetness", "-", Lifetime::kept, Output{.order = 13, .coupled = true}};
  Field<Real3> fluid_velocity{*this, "fluid_velocity", "m/s", Lifetime::derived};  ///< mean, by the weights of drag
  Field<Real3> fluid_angular_velocity{*this, "fluid_angular_velocity", "rad/s", Lifetime::derived};  ///< likewise
  Field<Real> drag_coefficient{*this, "drag_coefficient", "kg/s", Lifetime::kept};  ///< force per slip velocity, limited
  Field<Real> rot_drag_coefficient{*this, "rot_drag_coefficient", "N m s", Lifetime::derived};  ///< torque per relative spin
  Field<Real3> impulse{*this, "impulse", "N s", Lifetime::derived};    ///< drag impulse of this fluid step
  Field<Real3> spin_impulse{*this, "spin_impulse", "N m s", Lifetime::derived};
  Field<Real> clump_d{*this, "clump_diameter", "m", Lifetime::kept};  ///< of the sphere of its clump's volume, whose drag it shares; 0: it has its own; left out where there are no clumps
  // for the exchange with fluid
  Field<PairPosition> xp{*this, "xp", "-", Lifetime::derived};     ///< packed
  // what fluid reads of their drag and of their reaction on it: DragWeights, DragLevers, Reactions
  Field<Real> still{*this, "drag_still", "-", Lifetime::derived};
  Field<Real4> by_slip{*this, "drag_by_slip", "m/s, s/m", Lifetime::derived};
  Field<Real> lever_at_centre{*this, "lever_at_centre", "-", Lifetime::derived};
  Field<Real> lever_off_centre{*this, "lever_off_centre", "1/m", Lifetime::derived};
  Field<Real4> reaction_impulse{*this, "reaction_impulse", "N s, kg", Lifetime::derived};
  Field<Real4> reaction_force{*this, "reaction_force", "N, -", Lifetime::derived};
  Field<Real4> reaction_spin{*this, "reaction_spin", "N s/m, -", Lifetime::derived};
  Field<Real4> reaction_couple{*this, "reaction_couple", "N/m, 1/m", Lifetime::derived};
  Field<Vec3d> x_before{*this, "x_before", "m", Lifetime::derived};  ///< at the start of the step
};

}  // namespace BL_SOLVER
