#pragma once
// Exchange of volume, force and momentum between grains and fluid (unresolved, locally averaged).
//
// Fluid and grains form a mixture: a fluid particle represents the volume V_a = m_a / (eps_a rho_a), of which
// grain j occupies the fraction w_ja. The fluid solver moves that volume as if all of it were fluid. The
// stress on it is then split between fluid and grains by eps_a and w_ja, the same weights with which their
// velocities enter the volume flux in the density equation: momentum is conserved pair by pair, and the
// exchange creates no energy.
//
// Order in a step, everything at time n until the fluid drifts:
//   gather    interpolates the fluid to the grains: velocities and drag coefficients, constant over the step;
//   (substeps of the grains, which sum the drag impulse and the spin impulse)
//   react     applies the opposite impulses to the fluid, with the weights of gather;
//   porosity  after both have moved: weights and volume flux;
//   push      the grains' part of the stress, once the fluid has its forces.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bedload/neighbours/filled_rows.hpp"
#include "bedload/neighbours/for_each_piece.hpp"
#include "bedload/neighbours/level_lists.hpp"
#include "bedload/neighbours/pairing.hpp"
#include "bedload/parallel/reading.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"
#include "bedload/particles/scratch.hpp"
#include "kernels/coupling/averaging.hpp"
#include "kernels/coupling/orifice_weight.hpp"
#include "kernels/coupling/porosity_pass.hpp"
#include "kernels/coupling/reaction_pass.hpp"
#include "kernels/coupling/wall_free_fraction.hpp"
#include "src/coupling/drag_table.hpp"
#include "src/coupling/parameters.hpp"
#include "src/solids/grain_matter.hpp"
#include "src/walls/wall_geometry.hpp"

namespace BL_SOLVER {

/// Counters reported per step: limiter and floor activations in the last gather and porosity.
struct CouplingCounters {
  std::uint64_t floor_hits = 0;  ///< fluid particles at the porosity floor
  std::uint64_t limited = 0;     ///< grains whose drag the limiter weakened
  std::uint64_t wet = 0;         ///< grains in fluid
  std::uint64_t densest = 0;     ///< grains at the porosity floor, with or without an orifice's clear water
  std::uint64_t cornered = 0;    ///< grains whose kernel is cut by walls to below WallFreeFraction::kLeast
  std::uint64_t uncoupled = 0;   ///< wet grains whose fluid takes no couple
  std::uint64_t bent = 0;        ///< grains whose DragLine is limited
};

/// Upper bounds on the stiffness of drag.
struct StiffestDrag {
  Real rate;   ///< largest rate of drag on a fluid particle, 1/s
  Real lever;  ///< largest sum of DragLevers, -
};

class Clumps;

/// Where grains are.
struct GrainCells {
  CellGridView cells;
  Span<const Index> order = {};        ///< the grain in each place of the cells; empty: as they are stored
  const SizeLevels* levels = nullptr;  ///< of grains that are stored by level; else null
};

class Coupling {
 public:
  /// The walls of the fluid must outlive this.
  Coupling(const CouplingParameters& parameters, const Frame& frame, const WallGeometry& walls);

  /// Before gather(), if grains of these clumps share their drag. They must outlive this.
  void share_drag(Clumps& clumps) { clumps_ = &clumps; }

  /// Range of the interaction between grains and fluid, of the largest grains, m.
  double range() const { return farthest_; }

  /// Rebuilds both lists: all pairs within range() and half skins at the positions where the lists of the
  /// phases were built. Also packs the positions of the grains. still: poses of all wall bodies if none ever
  /// moves; else empty.
  void rebuild_lists(const FluidStore& fluid, const CellGridView& fluid_grid, const HalfSkins& of_fluid,
                     GrainStore& grains, const GrainCells& grain_cells, const HalfSkins& of_grains,
                     Span<const BodyPose> still = {});

  /// Fills eps, wetness and the drag coefficients and fluid velocities of the grains. pose: of every wall
  /// body, on the device; dt (s): the fluid step for which they hold, which bounds drag when the fluid is to
  /// take the reaction; step: which one, of noise.
  void gather(FluidStore& fluid, GrainStore& grains, Span<const BodyPose> pose, double dt,
              std::uint64_t step = 0);
  /// Applies the opposite of grains.impulse and spin_impulse, those of a step dt (s), to the velocities of
  /// the fluid; sets fluid.drag_kick, their change, and fluid.reaction. The fluid must not have changed since
  /// gather.
  void react(FluidStore& fluid, GrainStore& grains, double dt);
  /// Sets eps, flux, the mass in eos_state and, where needed, viscosity and grains_around of the fluid for
  /// the present positions; pose as in gather. dt (s): the step of the grains since gather, 0 if they have
  /// not moved.
  void porosity(FluidStore& fluid, GrainStore& grains, Span<const BodyPose> pose, double dt);
  /// Sets fluid_force of the grains from the stress of the fluid, and adds its change times `kick` (s) to
  /// their velocities unless they are held. After porosity.
  void push(const FluidStore& fluid, GrainStore& grains, double kick, bool held);

  /// Effective viscosity (Pa s) by which drag with local slip resists shear of slow fluid in a bed of that
  /// porosity and grain diameter (m): half of the dissipation beta |s . grad u|^2 over the kernel of h_c.
  /// Zero with the mean slip.
  double bed_viscosity(double porosity, double d) const;
  /// Reads the stiffness of drag in the last exchange. Waits for the device.
  void read_survey();
  /// Largest fluid step that drag allows (s), as last read; infinite without a reaction.
  double stable_dt() const;
  /// State for a restart.
  void save(std::vector<Quantity>& scalars) const;
  void load(const std::function<double(const std::string&)>& scalar);
  /// Waits for the device.
  CouplingCounters counters(const FluidStore& fluid, const GrainStore& grains);
  ParticleBytes scratch_bytes() const {
    return {.fluid = of_fluid_.entry_bytes(), .grains = of_grains_.entry_bytes()};
  }

 private:
  /// f(kernel) with the kernel of the coupling.
  template <class F>
  void with_coupling_kernel(F&& f) const;
  /// f(kernel, averages) with OneAverage or OwnAverages.
  template <class F>
  void with_averages(F&& f) const;
  bool own_lengths() const { return range_.per_radius > 0; }
  bool moments() const { return torque_ || angmom_; }
  void pack(GrainStore& grains);
  /// List of the sources near each target, where both were when the lists of the phases were built; places:
  /// of the sources, in the order of the cells.
  template <class Targets, class Sources, class P>
  VerletList& build(Pairing<>& pairs, const Targets& targets, const HalfSkins& of_targets,
                    const Sources& sources, const HalfSkins& of_sources, const CellGridView& grid,
                    Span<const P> places);
  /// Both lists of grains with averaging lengths of their own.
  void build_own(const FluidStore& fluid, const CellGridView& fluid_grid, const HalfSkins& of_fluid,
                 const GrainStore& grains, const GrainCells& grain_cells, const HalfSkins& of_grains,
                 Span<const Vec3d> places);
  /// Runs a pass over the fluid around each grain.
  template <class Pass>
  void over_fluid(const Pass& pass) const {
    cut_rows_.run(fluid_of_grain_.targets(), fluid_of_grain_.list(), fluid_of_grain_.separation(),
                  fluid_of_grain_.reach(), pass);
  }
  /// Runs a pass over the grains around each fluid particle.
  template <class Pass>
  void over_grains(const Pass& pass) const {
    beside_grains_.run(grains_of_fluid_, pass);
  }
  void volumes(const GrainStore& grains, Span<const BodyPose> pose, double dt);
  /// Those of grains that walls may cut. Kinds: of all surfaces.
  template <class Kinds>
  void cut_volumes(const GrainVolumePass& volumes, Range grains, Span<const BodyPose> pose) const;
  template <class Kinds>
  void use_surface_kinds() {
    cut_volumes_ = &Coupling::cut_volumes<Kinds>;
  }
  template <class Kinds = AllKinds>
  WallFreeFraction<Kinds> wall_free(Span<const BodyPose> pose) const {
    return {half_space_, frame_, walls_, pose};
  }
  DragLevers levers(GrainStore& grains) {
    return {grains.lever_at_centre, grains.lever_off_centre, lever_sum_};
  }
  OrificeWeight orifice_weight() const { return {frame_, orifices_, dx_, h_c_}; }
  template <bool Local>
  FluidOfDrag<Local> fluid_of_drag(const GrainStore& grains);
  /// How drag follows slip, by the last gather.
  template <bool Local, class Law>
  DragLines<Law, Local> drag_lines(const Law& law, const GrainStore& grains);
  std::uint64_t bent_lines(const GrainStore& grains);
  void limit(FluidStore& fluid, GrainStore& grains, double dt);
  void survey(const FluidStore& fluid, const GrainStore& grains);
  Span<const Real> lever_sums(Index grains) const;  ///< of the first ones; empty without a couple
  GrainSurroundings surroundings();
  PushPass push_pass(const FluidStore& fluid);
  static DragWeights drag_weights(GrainStore& grains) { return {grains.still, grains.by_slip}; }
  static Reactions reactions(GrainStore& grains) {
    return {grains.reaction_impulse, grains.reaction_force, grains.reaction_spin, grains.reaction_couple};
  }

  Frame frame_;
  Chosen<KernelFunction> kernel_;
  Chosen<DragLaw> drag_law_;
  TableOfDrag drag_table_;
  double dx_, h_, h_c_;
  AveragingRange range_;
  double farthest_;  ///< m
  bool top_hat_;
  double mu_;
  Chosen<SuspensionLaw> suspension_;
  double phi_max_;
  double drag_fraction_;
  double kT_;           ///< J
  std::uint64_t seed_;  ///< of noise
  Real eps_min_, S_dry_, S_wet_;
  GrainMatter matter_;
  bool two_way_, counts_grains_, torque_, angmom_, local_slip_;
  bool near_orifices_;                ///< whether there are any
  std::optional<StiffestDrag> drag_;  ///< as last read
  Reading<StiffestDrag> stiffest_;
  bool surveyed_ = false;  ///< a survey has not been read yet
  bool limits_ = false;    ///< whether drag is faster than the step

  SurfaceSet walls_;  ///< that cut the kernels of the grains
  void (Coupling::*cut_volumes_)(const GrainVolumePass&, Range, Span<const BodyPose>) const = nullptr;
  HalfSpaceFraction half_space_;
  OwnWake wake_;
  bool walls_move_ = true;
  Buffer<Index> beside_walls_;  ///< grains whose kernel they may cut, where they do not move
  Buffer<Vec3d> grain_places_;  ///< in the order of cells that is not theirs
  Buffer<Orifice> orifices_;
  Clumps* clumps_ = nullptr;           ///< null: no grains share their drag
  Buffer<MemberSum> fluid_of_clumps_;  ///< by the last gather

  Pairing<> fluid_of_grain_, grains_of_fluid_;
  FilledRows beside_grains_;     ///< of grains_of_fluid_
  CrossLevelLists level_lists_;  ///< of grains with lengths of their own
  CutRows cut_rows_;             ///< of fluid_of_grain_, likewise
  // what passes of a step leave for others
  Scratch of_grains_, of_fluid_;
  ScratchArray<Real> wall_free_{of_grains_}, inv_S_{of_grains_}, rho_{of_grains_}, bed_eps_{of_grains_},
      stiffness_{of_grains_};
  ScratchArray<FlowSums<>> flow_{of_grains_};
  ScratchArray<Real4> volume_{of_grains_};
  ScratchArray<Real> shrink_{of_grains_, own_lengths()};
  ScratchArray<Real3> buoyancy_{of_grains_};
  ScratchArray<Real> fast_slip_{of_grains_, local_slip_};
  ScratchArray<FlowSums<>> fast_{of_grains_, local_slip_};
  ScratchArray<Real3> stress_arm_{of_grains_, moments()}, drag_arm_{of_grains_, moments()},
      lost_moment_{of_grains_, moments()};
  ScratchArray<SymmetricMatrix<Real>> stress_inv_M_{of_grains_, moments()},
      drag_inv_M_{of_grains_, moments()};
  ScratchArray<Real> lever_sum_{of_grains_, angmom_};
  ScratchArray<Real4> push_{of_fluid_};
  ScratchArray<Real> counted_{of_fluid_, near_orifices_};
};

}  // namespace BL_SOLVER
