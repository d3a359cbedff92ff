#include "src/solids/clumps.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "bedload/geometry/body.hpp"
#include "bedload/parallel/compact.hpp"
#include "bedload/parallel/reductions.hpp"
#include "bedload/parallel/sort.hpp"
#include "src/walls/free_bodies.hpp"

namespace BL_SOLVER {
namespace {

/// Clumps while grains are joined to them.
struct Joined {
  std::vector<std::uint32_t> clump, member;  ///< of each grain
  std::vector<Vec3d> arm;                    ///< likewise
  std::vector<std::uint32_t> kind;           ///< of each clump, as what follows
  std::vector<double> size;
  std::vector<Vec3d> x, v, omega;
  std::vector<Vec4<double>> rotation;

  void add(std::uint32_t of_kind, double of_size, const Vec3d& at, const Vec3d& velocity, const Vec3d& spin,
           const Quat<double>& turn) {
    kind.push_back(of_kind), size.push_back(of_size), x.push_back(at);
    v.push_back(velocity), omega.push_back(spin), rotation.push_back(to_vec4(turn));
  }
};

/// Grain of a rigid group.
struct Member {
  Id id;
  std::uint32_t kind;
  double radius;  ///< m
  Vec3d arm;      ///< m
};

/// Those of all ranks.
std::vector<Member> gathered(std::vector<Member> own) {
  Link* const link = Context::current().link();
  if (!link) return own;
  const std::vector<std::size_t> count = all_gather(own.size());
  const std::size_t most = *std::max_element(count.begin(), count.end());
  if (most == 0) return own;
  own.resize(most);
  std::vector<Member> padded(most * count.size()), all;
  link->all_gather(own.data(), padded.data(), most * sizeof(Member));
  for (std::size_t r = 0; r < count.size(); ++r) {
    const auto first = padded.begin() + std::ptrdiff_t(r * most);
    all.insert(all.end(), first, first + std::ptrdiff_t(count[r]));
  }
  return all;
}

/// Sum of the cubes of the radii.
double cubes(const ClumpShape& shape) {
  double sum = 0;
  for (const ClumpSphere& s : shape.spheres) sum += s[3] * s[3] * s[3];
  return sum;
}

}  // namespace

std::vector<Index> order_by_id(HostStore& clumps) {
  std::vector<Index> order(clumps.count), place(clumps.count);
  const Id* const id = clumps.find("id")->as<Id>();
  std::iota(order.begin(), order.end(), Index(0));
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return id[a] < id[b]; });
  for (Index k = 0; k < Index(order.size()); ++k) place[order[k]] = k;
  for (HostArray& a : clumps.arrays) {
    const HostBytes from = a.bytes;
    const std::size_t size = clumps.count > 0 ? from.size() / clumps.count : 0;
    for (std::size_t k = 0; k < clumps.count; ++k)
      std::memcpy(a.bytes.data() + size * k, from.data() + size * order[k], size);
  }
  return place;
}

Clumps::Clumps(const SolidParameters& parameters, const Frame& frame, GrainStore& grains)
    : kinds_(parameters.clumps), plane_(parameters.plane), frame_(frame), matter_(parameters.materials) {
  std::vector<std::uint32_t> shares;
  for (const ClumpKind& k : kinds_) {
    shares.push_back(k.shares_drag ? 1 : 0);
    shares_drag_ = shares_drag_ || k.shares_drag;
  }
  if (!shares_drag_) members_.term_a.leave_out(), members_.term_b.leave_out();
  if (!any()) return;
  shares_.assign(shares);
  clump_ = std::make_unique<Field<std::uint32_t>>(grains, "clump", "-", Lifetime::kept);
  member_ = std::make_unique<Field<std::uint32_t>>(grains, "member", "-", Lifetime::kept);
  arm_ = std::make_unique<Field<Vec3d>>(grains, "clump_arm", "m", Lifetime::kept);
  clump_->resize(grains.size());
  member_->resize(grains.size());
  arm_->resize(grains.size());
}

void Clumps::bind(GrainStore& grains, const Setup::Grains& setup) {
  if (!any()) return;
  const std::vector<Vec3d>& x = setup.x;
  const std::vector<Real> radius(setup.radius.begin(), setup.radius.end());
  Joined all;
  all.clump.resize(x.size()), all.member.resize(x.size()), all.arm.resize(x.size());
  std::vector<std::uint32_t> kind_of;  // each fill
  for (std::uint32_t k = 0; k < kinds_.size(); ++k) {
    const ClumpKind& of = kinds_[k];
    if (of.fill < 0) continue;
    kind_of.resize(std::max(kind_of.size(), std::size_t(of.fill) + 1));
    kind_of[of.fill] = k;
    if (of.shape) continue;
    double mass = 0;
    Vec3d centre;
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (int(setup.fill[i]) != of.fill) continue;
      const double R = radius[i], m = matter_.per_r3(of.material) * R * R * R;
      members.push_back(i);
      mass += m, centre += m * x[i];
    }
    if (mass > 0) centre = centre / mass;
    all.add(k, 1, centre, of.velocity, {}, {});
    for (std::size_t n = 0; n < members.size(); ++n) {
      all.clump[members[n]] = std::uint32_t(all.kind.size()), all.member[members[n]] = std::uint32_t(n);
      all.arm[members[n]] = x[members[n]] - centre;
    }
  }
  // sizes follow from the radii as they are kept, so that grains and clump weigh the same
  std::size_t i = 0;
  for (std::size_t c = 0; c < setup.clumps.size(); ++c) {
    const Setup::Grains::Clump& from = setup.clumps[c];
    const std::uint32_t k = kind_of[from.fill];
    const ClumpShape& shape = *kinds_[k].shape;
    while (setup.clump[i] != c + 1) ++i;
    const auto first = radius.begin() + std::ptrdiff_t(i);
    const double size = size_of(shape, {first, first + std::ptrdiff_t(shape.spheres.size())});
    all.add(k, size, from.x, from.v, from.omega, normalised(from.rotation));
    for (std::uint32_t n = 0; n < shape.spheres.size(); ++n, ++i) {
      const ClumpSphere& s = shape.spheres[n];
      all.clump[i] = std::uint32_t(all.kind.size()), all.member[i] = n;
      all.arm[i] = size * Vec3d{s[0], s[1], s[2]};
    }
  }
  Joined here;
  for (const Id id : grains.id.values()) {
    here.clump.push_back(all.clump[id]), here.member.push_back(all.member[id]);
    here.arm.push_back(all.arm[id]);
  }
  clump_->assign(here.clump), member_->assign(here.member), arm_->assign(here.arm);
  store_.resize(Index(all.kind.size()));
  std::vector<Id> id(all.kind.size());
  std::iota(id.begin(), id.end(), Id(1));
  store_.id.assign(id);
  store_.kind.assign(all.kind), store_.scale.assign(all.size);
  measure(grains);
  for (std::size_t c = 0; c < all.kind.size(); ++c) {
    const RigidBody& body = bodies_[all.kind[c]];
    all.v[c] = body.movable(all.v[c]);
    all.omega[c] = std::pow(all.size[c], 5) * body.momentum(to_quat(all.rotation[c]), all.omega[c]);
  }
  store_.x.assign(all.x), store_.v.assign(all.v), store_.angular_momentum.assign(all.omega);
  store_.rotation.assign(all.rotation);
  for_each(grains.owned(), FollowPass{view(), frame_, grains.x, {grains.v, grains.omega}, {}});
}

/// Sums over grains of all ranks in the order of ids, so that the result does not depend on sorting.
void Clumps::measure(const GrainStore& grains) {
  const auto id = grains.id.values();
  const auto radius = grains.radius.values();
  const auto clump = clump_->values(), kind = store_.kind.values();
  const auto arm = arm_->values();
  std::vector<Member> members;
  for (Index i = 0; i < grains.owned().size(); ++i)
    if (clump[i] > 0 && !kinds_[kind[clump[i] - 1]].shape)
      members.push_back({id[i], kind[clump[i] - 1], radius[i], arm[i]});
  members = gathered(std::move(members));
  std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.id < b.id; });
  std::vector<MassProperties> sums(kinds_.size());
  for (auto& s : sums) s.inertia.fill(0);
  for (ClumpKind& k : kinds_)
    if (!k.shape) k.spheres = 0;
  for (const Member& member : members) {
    ClumpKind& k = kinds_[member.kind];
    MassProperties& s = sums[member.kind];
    const double R = member.radius, m = matter_.per_r3(k.material) * R * R * R, own = 0.4 * m * R * R;
    s.mass += m;
    const auto grain = shifted_inertia({own, own, own, 0, 0, 0}, m, member.arm);
    for (int n = 0; n < 6; ++n) s.inertia[n] += grain[n];
    ++k.spheres;
  }
  bodies_.clear();
  std::vector<Vec3d> offsets;
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    if (const auto& shape = kinds_[k].shape) {
      sums[k].mass = matter_.per_r3(kinds_[k].material) * cubes(*shape);
      for (int n = 0; n < 6; ++n) sums[k].inertia[n] = kinds_[k].density * shape->inertia[n];
    }
    const RigidConfig& c = kinds_[k].freedom;
    bodies_.push_back(rigid_body(sums[k], {}, c.move, c.turn, c.axis, plane_));
    offsets.push_back(kinds_[k].shape ? kinds_[k].shape->offset : Vec3d{});
  }
  constants_.assign(bodies_);
  offsets_.assign(offsets);
  std::vector<Index> spheres;
  std::vector<std::uint32_t> shaped;
  one_piece_ = true;
  for (const ClumpKind& k : kinds_) {
    spheres.push_back(k.spheres), shaped.push_back(k.shape ? 1 : 0);
    one_piece_ = one_piece_ && k.spheres <= ClumpPieces::kPiece;
  }
  spheres_.assign(spheres), shaped_.assign(shaped);
  cut_pieces();
}

void Clumps::cut_pieces() {
  Buffer<Index> grains(store_.size()), pieces(store_.size());
  for_each(store_.owned(), CountPiecesPass{store_.kind.span(), spheres_, grains, pieces});
  place_.resize(exclusive_scan(grains, slot_));
  const Index count = exclusive_scan(pieces, first_);
  begin_.resize(count + 1), gained_.resize(count);
  for_each(store_.owned(), BeginPiecesPass{slot_, first_, begin_});
}

double Clumps::size_of(const ClumpShape& shape, const std::vector<Real>& radii) {
  double r3 = 0;
  for (const Real r : radii) r3 += std::pow(double(r), 3);
  return std::cbrt(r3 / cubes(shape));
}

std::uint32_t Clumps::kind_of_dropped(std::uint32_t material) const {
  std::uint32_t k = 0;
  while (kinds_[k].fill >= 0 || kinds_[k].material != material) ++k;
  return k;
}

void Clumps::keep(Span<const Index> kept, const GrainStore& grains) {
  reorder(kept, grains);
  cut_pieces();
}

void Clumps::reorder(Span<const Index> kept, const GrainStore& grains) {
  Buffer<Index> places(store_.size());
  for_each({0, kept.size}, ClumpPlacePass{kept, places});
  for_each(grains.owned(), RenumberClumpsPass{places, clump_->span()});
  store_.reorder(kept);
}

void Clumps::add(const std::vector<NewClump>& more, GrainStore& grains, Range come) {
  const Index before = store_.size();
  Buffer<NewClump> come_in;
  come_in.assign(more);
  store_.grow(before + Index(more.size()));
  for_each({0, Index(more.size())}, AddClumpsPass{.clump = come_in,
                                                  .place = before,
                                                  .id = store_.id,
                                                  .kind = store_.kind,
                                                  .size = store_.scale,
                                                  .x = store_.x,
                                                  .v = store_.v,
                                                  .rotation = store_.rotation});
  cut_pieces();
  for_each(come, FollowPass{view(), frame_, grains.x, {grains.v, grains.omega}, {}});
}

void Clumps::place(const GrainStore& grains) {
  if (!any()) return;
  if (!Context::current().several()) return sort(grains);
  find_all(grains.owned().size(), InClump{clump_->span()}, grain_);
  const Index own = Index(grain_.size());
  members_.resize(own);
  for_each(members_.owned(), SlotPass{grain_, clump_->span(), member_->span(), slot_, members_.slot});
  members_.count();
  const Index ranks = Index(Context::current().ranks()), rank = Index(Context::current().rank());
  std::vector<Index> of_rank{0}, places;
  for (Index r = 0; r < ranks; ++r) {
    for (Index k = 0; r != rank && k < own; ++k) places.push_back(k);
    of_rank.push_back(Index(places.size()));
  }
  Buffer<Index> sent;
  sent.assign(places);
  members_.make_ghosts(of_rank, sent);
  for_each(members_.all(), PlaceMembersPass{std::as_const(members_.slot).span(), place_});
}

void Clumps::sort(const GrainStore& grains) {
  grain_.resize(place_.size());
  for_each(grains.owned(), PlaceClumpsPass{clump_->span(), member_->span(), slot_, grain_});
  Buffer<std::uint32_t> keys(store_.size());
  Buffer<Index> order;
  for_each(store_.owned(), ClumpKeyPass{store_.kind.span(), shaped_, slot_, grain_, keys});
  sort_keys(keys, order, 32);
  reorder(order, grains);
  cut_pieces();
  for_each(grains.owned(), PlaceClumpsPass{clump_->span(), member_->span(), slot_, grain_});
  if (one_piece_ && !shares_drag_) return;
  members_.resize(Index(grain_.size()));
  for_each(members_.owned(), FillIndex{place_});
}

ClumpView Clumps::view() const {
  return {.kinds = constants_.data(),
          .offsets = offsets_.data(),
          .kind = store_.kind.span(),
          .size = store_.scale.span(),
          .x = store_.x,
          .v = store_.v,
          .angular_momentum = store_.angular_momentum,
          .rotation = store_.rotation,
          .clump = clump_->span(),
          .arm = arm_->span()};
}

void Clumps::begin_drag(const GrainStore& g, double h, bool exponential, double held) {
  if (!shares_drag_) return;
  const ClumpView all = view();
  sum_over_members(DragTerms{all, g.clump_d, drag_of(g)}, sums_);
  h_ = h;
  drag_.resize(store_.size());
  for_each(store_.owned(), BeginDragPass{all, sums_, h, exponential, held, drag_.data()});
}

void Clumps::end_drag(GrainStore& g, double dt) const {
  if (!shares_drag_) return;
  for_each(g.owned(), ShareDragPass{.clump = of_grains(),
                                    .clump_d = std::as_const(g.clump_d).span(),
                                    .coefficient = std::as_const(g.drag_coefficient).span(),
                                    .drag = drag_.data(),
                                    .duration = dt,
                                    .impulses = {g.impulse, g.spin_impulse},
                                    .force = g.drag_force});
}

void Clumps::follow(GrainStore& g, const Velocities<Real3>& rest, double drift, const Vec3d& fall,
                    int kicks) {
  if (!any() || store_.size() == 0) return;
  const ClumpView all = view();
  const GainPass gain{.all = all,
                      .grain = grain_,
                      .mass_per_r3 = matter_.of(g),
                      .radius = g.radius,
                      .now = {g.v, g.omega},
                      .rest = {rest.v, rest.omega},
                      .momentum = members_.momentum,
                      .angular = members_.angular};
  const MoveClumpsPass move{.all = all,
                            .first = first_,
                            .gained = gained_.data(),
                            .fall = fall,
                            .drift = drift,
                            .drag = kicks > 0 && shares_drag_ ? drag_.data() : nullptr,
                            .h = h_,
                            .kicks = kicks};
  const FollowPass grains{all, frame_, g.x, {g.v, g.omega}, rest};
  if (in_one_pass()) return for_each(store_.owned(), ClumpPass{gain, begin_, move, grains});
  for_each(members_.owned(), gain);
  members_.momentum.set_shared(false), members_.angular.set_shared(false);
  members_.share({&members_.momentum, &members_.angular});
  for_each({0, Index(gained_.size())}, SumGainsPass{{place_, begin_, first_},
                                                    std::as_const(members_.momentum).span(),
                                                    std::as_const(members_.angular).span(),
                                                    gained_.data()});
  for_each(store_.owned(), move);
  for_each(g.owned(), grains);
}

void Clumps::stop() {
  if (!any()) return;
  store_.v.buffer().zero();
  store_.angular_momentum.buffer().zero();
}

RigidMotion Clumps::motion(int k) const {
  RigidMotion m;
  m.centre = store_.x.values()[k];
  m.rotation = to_quat(store_.rotation.values()[k]);
  m.v = store_.v.values()[k];
  const double s = store_.scale.values()[k];
  m.omega = bodies_[store_.kind.values()[k]].omega(m.rotation,
                                                   std::pow(s, -5) * store_.angular_momentum.values()[k]);
  return m;
}

LoadSum Clumps::by_contacts(int k, const GrainStore& g) const {
  return total(
      g.owned(),
      ClumpLoadReduction{
          .all = view(), .of = Index(k), .force = g.force, .torque = g.torque, .more = {}, .per_torque = 1});
}

LoadSum Clumps::by_fluid(int k, const GrainStore& g, double dt) const {
  return total(g.owned(), ClumpLoadReduction{.all = view(),
                                             .of = Index(k),
                                             .force = g.fluid_force,
                                             .torque = g.spin_impulse,
                                             .more = g.drag_force,
                                             .per_torque = dt > 0 ? 1 / dt : 0});
}

void Clumps::save(std::vector<HostStore>& stores) const {
  if (!any()) return;
  HostStore clumps = store_.save();
  const std::vector<Index> place = order_by_id(clumps);
  for (HostStore& store : stores) {
    if (store.name != "grains") continue;
    for (HostArray& a : store.arrays) {
      if (a.name != clump_->name) continue;
      for (std::size_t i = 0; i < store.count; ++i)
        if (std::uint32_t& clump = a.as<std::uint32_t>()[i]; clump > 0) clump = 1 + place[clump - 1];
    }
  }
  stores.push_back(std::move(clumps));
}

void Clumps::load(const HostStore& clumps, GrainStore& grains) {
  store_.load(clumps);
  measure(grains);
  if (grains.clump_d.used())
    for_each(grains.owned(), ChooseDragPass{clump_->span(), store_.kind.span(), shares_, store_.scale.span(),
                                            grains.clump_d});
}

}  // namespace BL_SOLVER
