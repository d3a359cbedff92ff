#pragma once
// Exchange of volume, force and momentum between grains and fluid (unresolved, locally averaged).
//
// Order in a step, everything at time n until the fluid drifts:
//   gather    grains read the fluid and get force, velocity and drag coefficients, held for the step;
//   (substeps of the grains, which add up the drag impulse and the spin impulse)
//   react     the fluid takes the impulses and the force back, with the weights of gather;
//   porosity  after both have moved.

#include <string>

#include "bedload/case/config.hpp"
#include "bedload/neighbours/verlet_list.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/coupling/orifice_share.hpp"
#include "kernels/coupling/reaction_pass.hpp"
#include "kernels/coupling/wall_share.hpp"
#include "src/walls/wall_geometry.hpp"

namespace bedload::inline BL_VARIANT {

/// What a run must be told about, from the last gather and porosity.
struct CouplingCounters {
  std::uint64_t floor_hits = 0;  ///< fluid particles held at the least porosity
  std::uint64_t limited = 0;     ///< grains in fluid that drag would stop within one step
  std::uint64_t wet = 0;         ///< grains that feel fluid
};

class Coupling {
 public:
  /// The walls that fluid and that grains meet must outlive this.
  Coupling(const Config& config, const Frame& frame, const WallGeometry& fluid_walls,
           const WallGeometry& grain_walls);

  /// How far grains and fluid feel each other, m.
  double range() const { return range_; }

  /// Renews both lists: all pairs within range() + skin (m) where the phases' own lists were built.
  void rebuild_lists(const FluidStore& fluid, const CellGridView& fluid_grid, const GrainStore& grains,
                     const CellGridView& grain_grid, double skin);

  /// Fills eps, wetness, U, omega_f, fluid_force, K and K_rot of the grains. pose: of every wall body, on the
  /// device; dt (s): the fluid step for which they hold, which bounds K when the fluid is to take the
  /// reaction. Waits for the device then.
  void gather(const FluidStore& fluid, GrainStore& grains, Span<const BodyPose> pose, double dt);
  /// Gives grains.impulse and spin_impulse, those of a step dt (s), back to the velocities of the fluid, and
  /// sets fluid.drag_kick to what they changed by and fluid.reaction; the fluid must not have changed since
  /// gather.
  void react(FluidStore& fluid, const GrainStore& grains, double dt);
  /// Sets fluid.eps for the present positions; pose as in gather.
  /// `moved`: in the course of a step, so that the superficial density of torn fluid follows; else eps alone.
  void porosity(FluidStore& fluid, const GrainStore& grains, Span<const BodyPose> pose, bool moved = false);

  /// Largest fluid step that drag allows (s), after the last gather; infinite without a reaction.
  double stable_dt() const;
  /// Counts what is to be reported. Waits for the device.
  CouplingCounters counters(const FluidStore& fluid, const GrainStore& grains) const;

 private:
  bool moments() const { return torque_ || angmom_; }
  void pack(const GrainStore& grains);
  OrificeShare orifice_share() const { return {frame_, orifices_, dx_, h_c_}; }
  GrainSurroundings surroundings();
  DragShares drag_shares();
  Reactions reactions();

  Frame frame_;
  std::string kernel_, drag_law_;
  double dx_, h_c_, range_, mu_, drag_fraction_;
  Real eps_min_, S_dry_, S_wet_;
  bool two_way_, torque_, angmom_, local_slip_;
  double fastest_ = 0;   ///< how fast drag stops any fluid particle, 1/s
  bool limits_ = false;  ///< whether that is faster than the step

  SurfaceSet fluid_walls_, grain_walls_;  ///< that the wetness and that the porosity knows of
  HalfSpaceShare half_space_;
  Buffer<Orifice> orifices_;

  VerletList fluid_of_grain_, grains_of_fluid_;
  Buffer<PairPosition> grains_at_;  ///< as pair loops read them
  Buffer<Real> inv_S_, rho_, bed_eps_, fast_slip_, stiffness_, rate_, still_;
  Buffer<FlowSums<>> flow_, fast_;
  Buffer<Real3> pressure_arm_, drag_arm_;
  Buffer<SymmetricMatrix<Real>> pressure_inv_M_, drag_inv_M_;
  Buffer<Real4> theta_, solids_, by_slip_, impulse_, force_, spin_, couple_;
};

}  // namespace bedload::inline BL_VARIANT
