// Contacts of grains with walls, compiled for the laws and surface kinds of a case.
#include <algorithm>
#include <type_traits>

#include "src/solids/solid_solver.hpp"

namespace BL_SOLVER {

WallContacts SolidSolver::wall_contacts(const GrainStore& g, const BodyPose* poses, double dt) const {
  return {.grains = view(g),
          .dt = Real(dt),
          .walls = walls_.view(),
          .memory = wall_list_.memories(),
          .row = wall_list_.row_of().data,
          .count = wall_list_.remembered(),
          .capacity = walls_.contacts(),
          .laws = wall_laws_.data(),
          .materials = matter_.materials(),
          .poses = poses,
          .free_bodies = bodies_ ? bodies_->constants() : nullptr,
          .lubrication = parameters_.films,
          .wetness = g.wetness.span()};
}

template <class Scope>
void SolidSolver::evaluate_walls(const WallContacts& contacts, const ContactLoads& loads) {
  // lanes share a grain with several contacts; loads on free bodies are recorded by one thread per grain
  const unsigned bits = loads ? 0 : std::min(lane_bits(4 * wall_list_.everywhere()), 2u);
  for_each({0, wall_list_.size() << bits}, WallContactPass<Scope>{.contacts = contacts,
                                                                  .rows = wall_list_.rows(),
                                                                  .lane_bits = bits,
                                                                  .sums = by_walls_.data(),
                                                                  .loads = loads});
}

void SolidSolver::choose_wall_law() {
  with_surface_kinds(walls_.surfaces(), [&]<class Kinds>(std::type_identity<Kinds>) {
    if constexpr (!std::is_same_v<Kinds, AllKinds>)
      if (!bodies_ || !bodies_->any())
        return with_contact_law(parameters_.wall_laws, [&]<class Law>(std::type_identity<Law>) {
          use_wall_law<WallScope<Law, Kinds, false>>();
        });
    use_wall_law<WallScope<ContactLaw, Kinds, true>>();
  });
}

}  // namespace BL_SOLVER
