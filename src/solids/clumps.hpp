#pragma once
// Clumps of grains: state, mass properties, motion. A rigid fill is one clump of a kind of its own.

#include <memory>
#include <vector>

#include "bedload/host_data.hpp"
#include "bedload/parallel/loops.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/bodies/clump_drag.hpp"
#include "kernels/bodies/clumps.hpp"
#include "src/solids/grain_matter.hpp"
#include "src/solids/parameters.hpp"

namespace BL_SOLVER {

struct ClumpStore : Store {
  ClumpStore() : Store("clumps") {}
  Field<Id> id{*this, "id", "-", Lifetime::kept, Output{.order = 99}};
  Field<Vec3d> x{*this, "x", "m", Lifetime::kept};  ///< not wrapped
  Field<Vec3d> v{*this, "v", "m/s", Lifetime::kept, Output{.order = 1, .name = "velocity"}};
  Field<Vec3d> angular_momentum{*this, "angular_momentum", "kg m2/s", Lifetime::kept, Output{.order = 5}};
  Field<Vec4<double>> rotation{*this, "rotation", "-", Lifetime::kept, Output{.order = 3}};  ///< x, y, z, w
  Field<std::uint32_t> kind{*this, "kind", "-", Lifetime::kept};
  Field<double> scale{*this, "scale", "m", Lifetime::kept, Output{.order = 4, .name = "diameter"}};
};

/// Grains of clumps that this rank has, and behind them those of the others; and what they gain in a substep.
struct MemberStore : Store {
  MemberStore() : Store("members") {}
  Field<std::uint32_t> slot{*this, "slot", "-", Lifetime::kept};
  Field<Vec3d> momentum{*this, "momentum", "N s", Lifetime::derived};
  Field<Vec3d> angular{*this, "angular", "N m s", Lifetime::derived};
  // of MemberSum; left out where none share drag
  Field<Vec4<double>> term_a{*this, "term_a", "-", Lifetime::derived};
  Field<Vec4<double>> term_b{*this, "term_b", "-", Lifetime::derived};
};

/// Puts clumps of a frame or checkpoint in the order of their ids. Returns where each has come to.
std::vector<Index> order_by_id(HostStore& clumps);

/// One rank sorts clumps as their grains. Several each have all clumps, in one order, and move them by what
/// the grains of all ranks gain, in the order of their spheres.
class Clumps {
 public:
  /// Adds the fields of membership to `grains`: construct before the store is filled or loaded.
  Clumps(const SolidParameters& parameters, const Frame& frame, GrainStore& grains);

  bool any() const { return !kinds_.empty(); }
  /// For each grain 1 + its clump, 0 without one; empty if no fill has any.
  Span<const std::uint32_t> of_grains() const {
    return clump_ ? clump_->span() : Span<const std::uint32_t>();
  }
  /// Which sphere of its clump each grain is; empty if no fill has any.
  Span<const std::uint32_t> members() const {
    return member_ ? member_->span() : Span<const std::uint32_t>();
  }
  /// Joins grains at initialisation; `setup`: of all grains, by id. Rigid fills come first, in their order.
  void bind(GrainStore& grains, const Setup::Grains& setup);
  /// Fields of membership, for a pass that adds grains; empty if there are none.
  struct Membership {
    Span<std::uint32_t> clump, member;
    Span<Vec3d> arm;
  };
  Membership membership() {
    if (!any()) return {};
    return {clump_->span(), member_->span(), arm_->span()};
  }
  /// Keeps the clumps at these places alone, once the grains of the others are gone.
  void keep(Span<const Index> kept, const GrainStore& grains);
  /// Of those that inlets drop; each kind of them has a material of its own.
  std::uint32_t kind_of_dropped(std::uint32_t material) const;
  /// What a clump of spheres with these radii (m), as they are kept, is scaled by.
  static double size_of(const ClumpShape& shape, const std::vector<Real>& radii);
  /// Adds clumps, and moves their grains, `come`, to where they belong.
  void add(const std::vector<NewClump>& more, GrainStore& grains, Range come);
  /// After a sort of grains.
  void place(const GrainStore& grains);

  /// Bytes of a grain.
  std::size_t scratch_bytes() const {
    if (!any()) return 0;
    return sizeof(Index) + (in_one_pass() && !shares_drag_ ? 0 : members_.entry_bytes() + sizeof(Index));
  }

  /// Whether the grains of any clumps share one drag, and those of this kind. Which do, GrainStore::clump_d
  /// says.
  bool share_drag() const { return shares_drag_; }
  bool share_drag(std::uint32_t kind) const { return kinds_[kind].shares_drag; }
  /// Sums over the grains of each clump that share their drag, rounded alike on any number of ranks.
  template <class Terms>
  void sum_over_members(const Terms& terms, Buffer<MemberSum>& out) {
    for_each(members_.owned(), MemberTermsPass<Terms>{grain_, terms, members_.term_a, members_.term_b});
    members_.term_a.set_shared(false), members_.term_b.set_shared(false);
    members_.share({&members_.term_a, &members_.term_b});
    out.resize(store_.size());
    for_each(store_.owned(), SumMembersPass{{place_, begin_, first_},
                                            store_.kind.span(),
                                            shares_,
                                            std::as_const(members_.term_a).span(),
                                            std::as_const(members_.term_b).span(),
                                            out});
  }
  /// Before an advance of substeps 2 h (s), or of the time `held` without motion.
  void begin_drag(const GrainStore& grains, double h, bool exponential, double held = 0);
  /// After it, its duration being dt (s).
  void end_drag(GrainStore& grains, double dt) const;
  /// Of each clump; null if none shares it.
  CentreDrag* drag() { return shares_drag_ ? drag_.data() : nullptr; }

  /// Moves the clumps after every grain was kicked, and drifted by `drift` (s), on its own; the grains
  /// follow. Rest: low parts of the velocities, may be empty. fall: what gravity added to velocities, m/s.
  /// kicks: of half a substep, in which drag acts.
  void follow(GrainStore& grains, const Velocities<Real3>& rest, double drift, const Vec3d& fall = {},
              int kicks = 0);
  /// Sets the velocities of the clumps to zero, as those of their grains are.
  void stop();

  /// Present motion of clump k, with its centre as the reference point.
  RigidMotion motion(int k) const;
  /// Force and torque about its centre from the contacts of its grains.
  LoadSum by_contacts(int k, const GrainStore& grains) const;
  /// From the fluid; the torque on single grains is a mean over the last step dt (s).
  LoadSum by_fluid(int k, const GrainStore& grains, double dt) const;

  const ClumpStore& store() const { return store_; }
  /// What a substep changes of them.
  std::vector<const FieldBase*> moving() const {
    if (!any()) return {};
    return {&store_.x, &store_.v, &store_.angular_momentum, &store_.rotation};
  }
  ClumpView view() const;
  /// After `grains` has been saved, whose clumps get other numbers there.
  void save(std::vector<HostStore>& stores) const;
  /// After `grains` has been loaded.
  void load(const HostStore& clumps, GrainStore& grains);

 private:
  /// Mass and inertia of the kinds, of size 1 m.
  void measure(const GrainStore& grains);
  void cut_pieces();
  /// Sorts clumps as their grains.
  void sort(const GrainStore& grains);
  bool in_one_pass() const { return one_piece_ && !Context::current().several(); }
  /// Gives the grains the numbers of their clumps when these places are all that is kept, in that order.
  void reorder(Span<const Index> kept, const GrainStore& grains);

  std::vector<ClumpKind> kinds_;
  bool plane_;  ///< they move in the xz plane
  Frame frame_;
  std::vector<RigidBody> bodies_;  ///< one per kind, about their centres of mass
  GrainMatter matter_;
  std::unique_ptr<Field<std::uint32_t>> clump_, member_;
  std::unique_ptr<Field<Vec3d>> arm_;
  mutable ClumpStore store_;
  Buffer<RigidBody> constants_;
  Buffer<Vec3d> offsets_;
  Buffer<Index> spheres_;         ///< of each kind
  Buffer<std::uint32_t> shaped_;  ///< of ClumpKeyPass
  bool one_piece_ = true;         ///< every clump is
  bool shares_drag_ = false;
  Buffer<std::uint32_t> shares_;  ///< of each kind: its grains share one drag
  double h_ = 0;                  ///< of begin_drag
  Buffer<MemberSum> sums_;
  Buffer<CentreDrag> drag_;
  MemberStore members_;                  ///< none where ClumpPass does without
  Buffer<Index> grain_;                  ///< of each member that this rank has
  Buffer<Index> slot_;                   ///< of PlaceClumpsPass and SlotPass
  Buffer<Index> place_, begin_, first_;  ///< of ClumpPieces
  Buffer<LoadSum> gained_;               ///< [pieces]
};

}  // namespace BL_SOLVER
