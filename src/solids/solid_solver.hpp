#pragma once
// Moves the grains: contacts with each other and with walls, fluid forces, drag, in substeps.

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "bedload/neighbours/level_lists.hpp"
#include "bedload/parallel/reading.hpp"
#include "bedload/particles/grains.hpp"
#include "bedload/particles/scratch.hpp"
#include "bedload/particles/walls.hpp"
#include "bedload/simulation.hpp"
#include "kernels/contact/lubrication_pass.hpp"
#include "kernels/contact/registry.hpp"
#include "kernels/integrate/grain_sums.hpp"
#include "kernels/integrate/relaxation.hpp"
#include "kernels/stress/pair_moment.hpp"
#include "src/solids/clumps.hpp"
#include "src/solids/contact_frames.hpp"
#include "src/solids/energy_books.hpp"
#include "src/solids/grain_matter.hpp"
#include "src/solids/pair_histories.hpp"
#include "src/solids/parameters.hpp"
#include "src/solids/spectra_books.hpp"
#include "src/solids/wall_list.hpp"
#include "src/solids/wear_books.hpp"
#include "src/walls/free_bodies.hpp"
#include "src/walls/substep_loads.hpp"
#include "src/walls/wall_geometry.hpp"

namespace BL_SOLVER {

struct GrainKick;
class ArrivingContacts;
struct GrainActions;

/// Extremes over all grains that limit steps and lists; from one reduction.
struct GrainWatch {
  double speed = 0;         ///< largest, m/s
  double displacement = 0;  ///< largest since the lists were built, m
  double drag_rate = 0;     ///< largest drag_coefficient / mass, 1/s
  Id bad = kNone;           ///< smallest id of a grain whose position, velocity or spin is not finite
};

/// Sums over all grains, in fp64.
struct GrainTotals {
  double mass = 0;         ///< kg
  double kinetic = 0;      ///< of translation, J
  double rotational = 0;   ///< J
  double elastic = 0;      ///< stored in contacts, J
  Vec3d momentum;          ///< kg m/s
  Vec3d angular;           ///< about the origin, spin included, kg m2/s
  Vec3d centre;            ///< of mass, m
  double max_speed = 0;    ///< m/s
  double max_overlap = 0;  ///< overlap / diameter, walls included
  double contacts = 0;     ///< pairs of grains in contact
  double wall_contacts = 0;
  double coordination = 0;  ///< mean number of contacts per grain
};

/// Grains removed or inserted since the lists were last built.
struct GrainRenewal {
  Span<const Index> source_index;  ///< former index of each grain; kNone if it is new
  Index before = 0;                ///< how many there were
  bool any = false;
};

class SolidSolver {
 public:
  /// Adds the histories of wall contacts to `grains`: construct before the store is filled or loaded. `walls`
  /// and `bodies`, the free ones among them, must outlive this. `wet`: a fluid may act on grains.
  SolidSolver(const SolidParameters& parameters, const Frame& frame, const WallGeometry& walls,
              GrainStore& grains, FreeBodies* bodies = nullptr, bool wet = true);
  ~SolidSolver();

  double skin() const { return parameters_.skin; }  ///< m
  /// Largest centre distance in the lists, m.
  double range() const {
    return parameters_.d_max + skin() + range_beyond(parameters_.pair_laws, parameters_.d_max / 4);
  }
  const ContactLaw& law() const { return parameters_.pair_laws[0]; }

  /// With several ranks: divides the blocks of cells among them by the grains in them, at x.
  void divide(const GrainStore& grains, CellGrid& grid, Span<const Vec3d> x);
  /// From now on cells are divided among ranks by someone else, who calls regroup() then.
  void follow() { follows_ = true; }
  /// Once the cells are divided anew: moves grains to their ranks. Lists remain as they were built.
  void regroup(GrainStore& grains, CellGrid& grid);
  /// Wraps and sorts the grains, which have no ghosts, and rebuilds the lists; histories of surviving pairs
  /// are kept. order() is then the index of each grain at the previous build. Grains of unlike sizes are in
  /// levels: then they are not sorted by the cells of `grid`.
  void refresh(GrainStore& grains, CellGrid& grid, const GrainRenewal& renewal = {});
  const Buffer<Index>& order() const { return order_; }
  /// By how much the images of a sheared box will have moved since then, in dt (s), m.
  double image_travel(double dt) const {
    const MeanShear& shear = frame_.shear;
    return std::abs(shear.strain + shear.rate * dt - listed_strain_) * shear.height;
  }
  const VerletList& list() const { return list_; }
  bool in_levels() const { return levels_.count() > 1; }
  const SizeLevels& levels() const { return levels_; }
  /// Of grains in levels: their order by the cells of `grid`, where they were listed, ghosts too.
  Span<const Index> order_by_cells(const GrainStore& grains, CellGrid& grid);
  /// What puts the grains of all ranks into one order, as an array "block".
  HostArray blocks(const GrainStore& grains, const CellGrid& grid) const;
  /// Number of grains near walls.
  Index near_walls() const { return wall_list_.size(); }

  /// Fluid flows around the grains: advance() takes its forces from fluid_force, its torques (N m) from here.
  void flow_around(const Field<Real3>& torque) { fluid_torque_ = &torque; }

  GrainWatch watch(const GrainStore& grains) {
    begin_watch(grains);
    return watch();
  }
  /// The same in two steps: what the first queues, the second waits for.
  void begin_watch(const GrainStore& grains);
  GrainWatch watch() const;
  /// All limits on a substep, of which the caller takes the least.
  std::vector<StepLimit> limits(const GrainWatch& watch) const;
  StepLimit stable_dt(const GrainWatch& watch) const { return least_of(limits(watch)); }
  StepLimit stable_dt(const GrainStore& grains) { return stable_dt(watch(grains)); }

  /// Contact forces at the present positions with dt = 0; also the loads on free
  /// bodies. poses: [bodies] on the device. For a new run only: a loaded state contains its forces.
  void evaluate(GrainStore& grains, Span<const BodyPose> poses);
  /// `substeps` velocity-Verlet substeps over dt (s). poses: device array [substeps + 1][bodies], at the
  /// start and after each substep. Reads fluid_force and what drag refers to; leaves the drag impulses of
  /// this call in impulse and spin_impulse, their mean in drag_force. Held (or fixed) grains keep position
  /// and velocity, and are at rest for the fluid. gravity: at the start and after each substep, m/s2; that of
  /// the case if empty. Free bodies, after their begin(), move in the same substeps and write their poses;
  /// they are held while grains settle. wall_travel: upper bound on the displacement of any wall in dt, m.
  /// drive: constant force on each grain during dt, N; may be empty.
  void advance(GrainStore& grains, Span<const BodyPose> poses, int bodies, double dt, int substeps, bool held,
               const std::vector<Vec3d>& gravity = {}, double wall_travel = WallList::kAnywhere,
               Span<const Real3> drive = {});

  ParticleBytes scratch_bytes() const {
    const std::size_t orders = Context::current().several() ? 3 : 1;
    const std::size_t by_level = parameters_.d_max < 2 * parameters_.d_min ? 0 : orders * sizeof(Index);
    const double more = cube(range() / (parameters_.d_max + skin()));  // entries, by what does not touch
    return {
        .grains = of_grains_.entry_bytes() + clumps_.scratch_bytes() + (books_ ? EnergyBooks::kScratch : 0) +
                  (forces_ ? sizeof(Real3) * walls_.contacts() : 0),
        .near_grains = std::size_t(more * double(sizeof(Index) + by_level + PairHistoryBuffers::kBytes +
                                                 (books_ ? sizeof(ContactAction) : 0) +
                                                 (spectra_ ? 2 * sizeof(OpenContact) : 0) +
                                                 (forces_ ? (single_films() ? 2 : 1) * sizeof(Real3) : 0))),
        .near_walls = wall_list_.row_bytes()};
  }

  /// What advance() keeps of wall contacts, besides what grains remember of them; of those near walls their
  /// places there, where others write too.
  std::vector<const FieldBase*> fields_of_contacts() const;
  std::vector<const FieldBase*> places_at_walls() const { return wall_list_.places(); }
  /// Adds what grains remember of wall contacts to what was saved of them, and takes it from there.
  void save_walls(HostStore& saved) const { wall_list_.save(saved); }
  void load_walls(const HostStore& saved, const GrainStore& grains) { wall_list_.load(saved, grains); }

  Clumps& clumps() { return clumps_; }
  const Clumps& clumps() const { return clumps_; }

  GrainTotals totals(const GrainStore& grains) const;
  /// Where energy has gone since grains began to move; empty if the case does not ask.
  std::vector<Quantity> energy_terms(const GrainStore& grains) const;
  /// Before grains and clumps leave, whose sinks are not kStays: their energy, and the contacts that end.
  void let_go(const GrainStore& grains, Span<const std::uint32_t> sink, Span<const std::uint32_t> of_clumps);
  /// These grains, and the clumps from this one on, have come in.
  void let_in(const GrainStore& grains, Range come, Index clumps);
  void save(std::vector<Quantity>& scalars) const;
  void load(const std::vector<Quantity>& scalars);
  /// Of what contacts have dissipated; null if the case does not ask.
  const SpectraBooks* spectra() const { return spectra_.get(); }
  /// Of wall bodies; null if none wears.
  const WearBooks* wear() const { return wear_.get(); }
  /// Adds stores of both.
  void save_histograms(std::vector<HostStore>& stores) const;
  /// Of a checkpoint without them: begins anew. Throws FileError for those of another kind.
  void load_histograms(const std::vector<HostStore>& stores);
  /// Number of contacts of grains with walls that are left out (kMostWallContacts). poses: as in body_loads.
  double dropped_contacts(const GrainStore& grains, Span<const BodyPose> poses) const;
  /// Load of the grains on each wall body, about its centre; poses: [bodies] on the device.
  std::vector<LoadSum> body_loads(const GrainStore& grains, Span<const BodyPose> poses) const;

  /// By which grains and bodies moved in the substeps of the last step, for bodies on which they are
  /// recorded.
  SubstepLoads& substep_loads() { return substep_loads_; }

  /// The contacts at the end of the last step as lines, by ids, if the case asks for them; none before the
  /// first step after a state was loaded. With several ranks, those of which this one has the first grain,
  /// with an array "block" by which those of all are put together.
  HostStore contact_lines(const GrainStore& grains) const;

  /// Force moments of the contacts between grains, per grain, J.
  void contact_moments(const GrainStore& grains, Buffer<PairMoment<>>& out) const;
  /// The same of lubrication, if lubricates().
  void film_moments(const GrainStore& grains, Buffer<PairMoment<>>& out) const;
  bool lubricates() const { return parameters_.films.acts(); }
  /// What acts on grains where; poses: as in body_loads.
  GrainActions actions(const GrainStore& grains, Span<const BodyPose> poses) const;

  /// Histories of pairs in contact: arrays "lo", "hi" (ids) and "history"; blocks: of each grain, for an
  /// array "block" with that of the lower one; null where there is one rank.
  HostStore save_contacts(const GrainStore& grains, const HostArray* blocks = nullptr) const;
  /// After `grains` has been loaded: rebuilds the lists as they were at the last refresh and restores the
  /// histories, to the last bit. Throws FileError.
  void load_contacts(GrainStore& grains, CellGrid& grid, const HostStore& contacts);

 private:
  void choose_levels(const GrainStore& grains);
  /// Into order_, of grains at x.
  void sort(Span<const Vec3d> x, const GrainStore& grains, CellGrid& grid);
  void build_list(const GrainStore& grains, const CellGrid& grid);
  GrainFrame as_listed() const;  ///< where the lists were built
  /// Puts the grains at x, or those that were listed at x_list, into the order of their cells, and builds
  /// their list.
  void relist(GrainStore& grains, CellGrid& grid, const Field<Vec3d>& x, const GrainRenewal& renewal);
  // with several ranks
  bool unbalanced(const GrainStore& grains) const;
  /// Grains go to the ranks in whose blocks they are, with their contacts where those are `listed`. kept: as
  /// move() leaves it, or empty; source_index: as of GrainRenewal, or empty.
  void migrate(GrainStore& grains, CellGrid& grid, const Field<Vec3d>& x, Span<const Index> source_index,
               bool listed, Buffer<Index>& kept);
  void make_ghosts_of(GrainStore& grains, CellGrid& grid, const Field<Vec3d>& x);
  /// Gives ghosts the places and velocities that their owners have reached.
  static void share_motion(GrainStore& grains);
  /// The free bodies, if they move in the substeps; else null.
  FreeBodies* moving() const { return bodies_ && bodies_->any() && !bodies_->settling() ? bodies_ : nullptr; }
  /// With the masses that contacts damp with.
  GrainView view(const GrainStore& grains) const;
  ContactPass contact_pass(const GrainStore& grains, double dt) const;
  WallContacts wall_contacts(const GrainStore& grains, const BodyPose* poses, double dt) const;
  /// How far apart two grains, or a grain and a wall, are near each other for lubrication and these laws, m.
  double range_beyond(const std::vector<ContactLaw>& laws, double R_star) const {
    double most = double(parameters_.films.range(Real(R_star)));
    for (const ContactLaw& law : laws) most = std::max(most, double(law.range()) * R_star);
    return most;
  }
  /// Forces of single films are recorded, too.
  bool single_films() const { return parameters_.near_gap > 0 && lubricates(); }
  LubricationPass films(const GrainStore& grains, ContactSum* sums) const;
  /// Into by_walls_: the wall contacts of the grains, and what they do to free bodies.
  template <class Scope>
  void evaluate_walls(const WallContacts& contacts, const ContactLoads& loads);
  /// Ends a substep of an advance of dt (s): contacts between grains, kicks, and a drift unless it is the
  /// last.
  template <class Law>
  void end_substep(GrainStore& grains, const ContactPass& contacts, const GrainKick& kick, double dt,
                   bool last);
  // not within lambdas, which nvcc would compile for the device
  template <class Law>
  void use_pair_law() {
    end_substep_ = &SolidSolver::end_substep<Law>;
    evaluate_pieces_ = &SolidSolver::evaluate_pieces<Law>;
  }
  /// Into by_pieces_: the contacts of long rows.
  template <class Law>
  void evaluate_pieces(const ContactPass& contacts);
  template <class Scope>
  void use_wall_law() {
    evaluate_walls_ = &SolidSolver::evaluate_walls<Scope>;
  }
  void choose_wall_law();
  /// Evaluates wall contacts and lubrication; returns the pass over the contacts between grains, which adds
  /// them.
  ContactPass contacts_at(const GrainStore& grains, const BodyPose* poses, double dt,
                          const ContactLoads& loads);
  /// Runs a pass with `contacts` of contacts_at; on the GPU it overlaps with the loops over the walls and the
  /// long rows.
  template <class Pass>
  void evaluate(const Pass& pass) {
    if (pass.contacts.by_walls || pass.contacts.by_pieces)
      for_each_early(threads(), pass);
    else
      for_each(threads(), pass);
  }
  double energy(const GrainStore& grains) const;  ///< kinetic and elastic, J
  /// Notes what acts at the start of an advance, at these poses.
  void begin_books(const GrainStore& grains, const BodyPose* poses, const GrainKick& kick);
  /// Flows of energy in a substep dt, before its contacts are evaluated; gravity: its mean, m/s2.
  void count_flows(const GrainStore& grains, const BodyPose* poses, double dt, const GrainKick& kick,
                   const Vec3d& gravity);
  void count_clump_flows(double dt, const GrainKick& kick, const Vec3d& gravity, bool begins);
  template <class Law>
  void count_pair_flows(const GrainStore& grains, double dt, const OpenLosses& losses);
  template <class Law>
  void use_flow_law() {
    count_pair_flows_ = &SolidSolver::count_pair_flows<Law>;
  }
  void choose_flow_law();
  /// The same of lubrication, after it was evaluated.
  void count_film_flows(const GrainStore& grains, const BodyPose* poses, double dt);
  void end_books(const GrainStore& grains, const GrainKick& kick, int substeps);
  KickFlowPass kick_flow(const GrainStore& grains, double dt, const GrainKick& kick, const Vec3d& gravity,
                         bool begins) const;
  /// Forces of single contacts in a substep dt, before they are evaluated, if the case asks for them.
  void record_forces(const GrainStore& grains, const BodyPose* poses, double dt);
  /// What the grains do in substep s to bodies with prescribed motion. dt: of the substep, s: before contacts
  /// are evaluated, which moves their springs; 0: after.
  void record_loads(int s, const GrainStore& grains, const BodyPose* poses, double dt);
  /// What they did to those that move freely: after the bodies' substep.
  void record_loads(int s, const FreeBodies& bodies);
  /// Over the threads of the passes that evaluate pairs.
  Range threads() const { return {0, list_.rows() << list_.view().bits}; }

  SolidParameters parameters_;
  GrainFrame frame_;
  double listed_strain_ = 0;  ///< of a sheared box, where the lists were built
  GrainMatter matter_;
  Buffer<ContactLaw> pair_laws_;  ///< [materials][materials]; empty where all are of one
  Buffer<ContactLaw> wall_laws_;  ///< [bodies][materials]
  bool wet_;
  const WallGeometry& walls_;
  FreeBodies* bodies_;
  const Field<Real3>* fluid_torque_ = nullptr;
  Clumps clumps_;

  // compiled for the contact laws and surface kinds of the case
  void (SolidSolver::*count_pair_flows_)(const GrainStore&, double, const OpenLosses&) = nullptr;
  void (SolidSolver::*end_substep_)(GrainStore&, const ContactPass&, const GrainKick&, double,
                                    bool) = nullptr;
  void (SolidSolver::*evaluate_pieces_)(const ContactPass&) = nullptr;
  void (SolidSolver::*evaluate_walls_)(const WallContacts&, const ContactLoads&) = nullptr;

  Reading<WatchReduction::Value> watched_;
  SizeLevels levels_;
  LevelLists level_lists_;
  VerletList list_, old_list_;
  LongRows long_rows_;
  mutable PairHistoryBuffers histories_;  ///< mutable: sums read them through ContactPass
  PairHistoryBuffers old_histories_;
  WallList wall_list_;
  SubstepLoads substep_loads_;
  std::array<double, 6> load_bounds_;  ///< of a grain on a body, N, N m
  bool follows_ = false;               ///< others divide the cells
  std::shared_ptr<const Ownership> listed_by_;
  std::unique_ptr<ArrivingContacts> arriving_;
  double imbalance_ = 1;              ///< largest part of a rank over the mean, when grains were last divided
  Buffer<Id> listed_id_, former_id_;  ///< of grains and ghosts, by their places in list_ and old_list_
  std::unique_ptr<EnergyBooks> books_;     ///< null: not asked for
  std::unique_ptr<SpectraBooks> spectra_;  ///< likewise
  std::unique_ptr<WearBooks> wear_;        ///< likewise
  std::unique_ptr<SingleForces> forces_;   ///< likewise
  Buffer<ContactSum> by_walls_;            ///< [rows of wall_list_]
  Buffer<ContactSum> by_pieces_;           ///< [pieces of long_rows_]
  Buffer<Index> order_;
  Buffer<Index> by_cells_;  ///< of grains in levels
  Scratch of_grains_;
  ScratchArray<ContactSum> by_films_{of_grains_, lubricates()};
  ScratchArray<GrainRelaxation> relaxation_{of_grains_, wet_};  ///< of advance
  ScratchArray<Vec3d> next_x_{of_grains_};                      ///< of advance, as what follows
  ScratchArray<Real3> next_v_{of_grains_}, next_omega_{of_grains_}, v_rest_{of_grains_},
      omega_rest_{of_grains_};
};

}  // namespace BL_SOLVER
