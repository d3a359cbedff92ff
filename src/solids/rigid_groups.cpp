#include "src/solids/rigid_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bedload/geometry/body.hpp"
#include "bedload/parallel/reductions.hpp"
#include "src/walls/free_bodies.hpp"

namespace BL_SOLVER {

RigidGroups::RigidGroups(const SolidParameters& parameters, const Frame& frame, GrainStore& grains)
    : groups_(parameters.groups), plane_(parameters.plane), frame_(frame), matter_(parameters.materials) {
  if (!any()) return;
  group_ = std::make_unique<Field<std::uint32_t>>(grains, "group", "-", Lifetime::kept);
  arm_ = std::make_unique<Field<Vec3d>>(grains, "group_arm", "m", Lifetime::kept);
  group_->resize(grains.size());
  arm_->resize(grains.size());
  store_.resize(Index(groups_.size()));
  gained_.resize(groups_.size());
  constexpr double fastest = 1e3;  // m/s: far above what a grain gains in a substep
  double momentum = 0;
  for (std::uint32_t k = 0; k < matter_.materials(); ++k)
    momentum = std::max(momentum, fastest * matter_.per_r3(k) * cube(parameters.d_max / 2));
  most_gained_ = LoadBounds{momentum, 1, norm(frame.length)}.load();
}

void RigidGroups::bind(const GrainStore& grains, const std::vector<std::uint32_t>& fill) {
  if (!any()) return;
  const auto x = grains.x.values();
  const auto radius = grains.radius.values();
  const std::size_t n = groups_.size();
  std::vector<std::uint32_t> group(x.size());
  std::vector<double> mass(n);
  std::vector<Vec3d> centre(n), v(n), arm(x.size());
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (int(fill[i]) != groups_[k].fill) continue;
      const double R = radius[i], m = matter_.per_r3(groups_[k].material) * R * R * R;
      group[i] = std::uint32_t(k + 1);
      mass[k] += m;
      centre[k] += m * x[i];
    }
    if (mass[k] > 0) centre[k] = centre[k] / mass[k];
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    if (group[i] > 0) arm[i] = x[i] - centre[group[i] - 1];
  group_->assign(group);
  arm_->assign(arm);
  measure(grains);
  for (std::size_t k = 0; k < n; ++k) v[k] = bodies_[k].movable(groups_[k].velocity);
  store_.x.assign(centre);
  store_.v.assign(v);
  store_.angular_momentum.assign(std::vector<Vec3d>(n));
  store_.rotation.assign(std::vector<Vec4<double>>(n, to_vec4({})));
}

/// Mass and inertia, summed in the order of ids so that the result does not depend on sorting.
void RigidGroups::measure(const GrainStore& grains) {
  const auto id = grains.id.values();
  const auto radius = grains.radius.values();
  const auto group = group_->values();
  const auto arm = arm_->values();
  std::vector<std::size_t> order(id.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return id[a] < id[b]; });
  std::vector<MassProperties> sums(groups_.size());
  for (auto& s : sums) s.inertia.fill(0);
  for (const std::size_t i : order) {
    if (group[i] == 0) continue;
    MassProperties& s = sums[group[i] - 1];
    const double R = radius[i], m = matter_.per_r3(groups_[group[i] - 1].material) * R * R * R,
                 own = 0.4 * m * R * R;
    s.mass += m;
    const auto grain = shifted_inertia({own, own, own, 0, 0, 0}, m, arm[i]);
    for (int k = 0; k < 6; ++k) s.inertia[k] += grain[k];
  }
  bodies_.clear();
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const RigidConfig& c = groups_[k].freedom;
    bodies_.push_back(rigid_body(sums[k], {}, c.move, c.turn, c.axis, plane_));
  }
  constants_.assign(bodies_);
}

GrainGroups RigidGroups::view() const {
  return {.groups = constants_.data(),
          .x = store_.x,
          .v = store_.v,
          .angular_momentum = store_.angular_momentum,
          .rotation = store_.rotation,
          .group = group_->span(),
          .arm = arm_->span()};
}

void RigidGroups::follow(GrainStore& g, const Velocities<Real3>& rest, double drift) {
  if (!any() || g.everywhere() == 0) return;
  const GrainGroups all = view();
  for (Index k = 0; k < store_.size(); ++k)
    total_into(gained_.data() + k, g.owned(),
               GainReduction{.all = all,
                             .of = k,
                             .mass_per_r3 = matter_.of(g),
                             .radius = g.radius,
                             .now = {g.v, g.omega},
                             .rest = {rest.v, rest.omega}},
               most_gained_);
  for_each(store_.owned(), GroupPass{all, gained_.data(), drift});
  for_each(g.owned(), FollowPass{all, frame_, g.x, {g.v, g.omega}, rest});
}

void RigidGroups::stop() {
  if (!any()) return;
  store_.v.buffer().zero();
  store_.angular_momentum.buffer().zero();
}

RigidMotion RigidGroups::motion(int k) const {
  RigidMotion m;
  m.centre = store_.x.values()[k];
  m.rotation = to_quat(store_.rotation.values()[k]);
  m.v = store_.v.values()[k];
  m.omega = bodies_[k].omega(m.rotation, store_.angular_momentum.values()[k]);
  return m;
}

LoadSum RigidGroups::by_contacts(int k, const GrainStore& g) const {
  return total(
      g.owned(),
      GroupLoadReduction{
          .all = view(), .of = Index(k), .force = g.force, .torque = g.torque, .more = {}, .per_torque = 1});
}

LoadSum RigidGroups::by_fluid(int k, const GrainStore& g, double dt) const {
  return total(g.owned(), GroupLoadReduction{.all = view(),
                                             .of = Index(k),
                                             .force = g.fluid_force,
                                             .torque = g.spin_impulse,
                                             .more = g.drag_force,
                                             .per_torque = dt > 0 ? 1 / dt : 0});
}

void RigidGroups::save(std::vector<HostStore>& stores) const {
  if (any()) stores.push_back(store_.save());
}

void RigidGroups::load(const HostStore& groups, const GrainStore& grains) {
  store_.load(groups);
  measure(grains);
}

}  // namespace BL_SOLVER
