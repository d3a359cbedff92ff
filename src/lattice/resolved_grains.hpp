#pragma once
// Grains around which the fluid of a lattice flows.

#include "bedload/case/config/domain.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/lattice/stress_passes.hpp"
#include "src/lattice/lattice_store.hpp"
#include "src/lattice/parameters.hpp"

namespace BL_SOLVER {

class ResolvedGrains {
 public:
  /// Adds fields to `grains`, which may be filled already and must outlive this. Of their own, fluid_force is
  /// set.
  ResolvedGrains(const DomainConfig& domain, const LatticeUnits& units, const Vec3d& lift,
                 GrainStore& grains);

  const Field<Real3>& torque() const { return fluid_torque_; }  ///< of the fluid on each, N m

  /// Where the images of a sheared box are from now on.
  void shear(const lattice::SideImages& images) { images_ = images; }

  /// Nodes that they cover at the start, and what acts on them before the first step.
  void cover(const lattice::NodeGrid& grid, const Vec3d& first, NodeStore& nodes);
  /// The same after they have moved; nodes that they have left are filled from those around, as the last step
  /// has left these.
  void follow(const lattice::NodeMoments& before, const Vec3d& first, NodeStore& nodes);
  /// What the fluid does to them in the step to come, of that number, under that force per volume on fluid
  /// (units of the lattice). held: they are at rest for it.
  void exchange(const lattice::Populations& f, const Vec3d& first, const NodeStore& nodes, const Vec3d& push,
                std::int64_t step, bool held);
  /// Memory for the links of a grain of that diameter, m.
  std::size_t link_bytes(double d) const {
    return sizeof(std::uint64_t) * std::size_t(lattice::GrainLink::most(0.5 * d / units_.dx));
  }
  /// Other grains are there: links are no longer those that were found.
  void forget_links() { places_ = 0, found_ = false; }

  /// Moments of the force of the fluid about their centres, J, as of StressletPass.
  void stresslets(const lattice::Populations& f, const Vec3d& first, const NodeStore& nodes, bool held,
                  Buffer<PairMoment<>>& out);

  struct Sums {
    Vec3d received, displaced;  ///< since the start, N s: of the fluid; of forces on the fluid they displace
    Vec3d owed;                 ///< of what they have received, what has not yet acted on them, N s
    Vec3d force;                ///< by the fluid, N
  };
  Sums sums() const;

 private:
  lattice::Balls balls(const lattice::NodeGrid& grid, const Vec3d& first, bool held) const;
  /// A pass with these balls, and in a sheared box again with their images.
  template <class Pass>
  void run(Pass pass) const;
  /// The same over their links.
  template <class Pass>
  void run_over_links(Pass pass, const NodeStore& nodes, bool held);
  /// Gives each grain its places in the list of links.
  void make_places();
  void find_links(const lattice::Balls& balls, const NodeStore& nodes);
  lattice::Given given() { return {received_, owed_}; }
  lattice::GrainLinks links() { return {link_begin_, link_count_, covered_, links_}; }

  const DomainConfig domain_;
  const LatticeUnits units_;
  const Vec3d lift_;  ///< as in LatticeParameters
  lattice::SideImages images_;
  GrainStore& grains_;
  Field<Real3> fluid_torque_{grains_, "fluid_torque", "N m", Lifetime::kept};
  Field<Real3> last_force_{grains_, "last_fluid_force", "N", Lifetime::kept};
  Field<Real3> last_torque_{grains_, "last_fluid_torque", "N m", Lifetime::kept};
  Field<Vec3d> received_{grains_, "received", "N s", Lifetime::kept};
  Field<Vec3d> displaced_{grains_, "displaced", "N s", Lifetime::kept};
  Field<Vec3d> owed_{grains_, "owed_momentum", "N s", Lifetime::kept};
  Field<Index> link_begin_{grains_, "link_begin", "-", Lifetime::carried};
  Field<Index> link_count_{grains_, "link_count", "-", Lifetime::carried};
  Field<Index> covered_{grains_, "covered_nodes", "-", Lifetime::carried};
  Buffer<std::uint64_t> links_;  ///< as GrainLinks has them
  Index places_ = 0;             ///< grains that have places in it
  bool found_ = false;           ///< those of grains that have not moved since
  Buffer<Index> last_moved_;     ///< as Movers has it
  Index moves_ = 0;
};

}  // namespace BL_SOLVER
