#pragma once
// Grains that the fluid of a lattice flows around: which nodes they cover, what the fluid does to them.

#include "bedload/parallel/groups.hpp"
#include "kernels/lattice/link_pass.hpp"
#include "kernels/lattice/node_passes.hpp"

namespace BL_SOLVER::lattice {

/// What NodeStore::solid holds of grains, besides 0 and what Setup::Nodes has of walls. Of several grains
/// that cover a node, the one with the lowest id has the largest mark.
namespace mark {
constexpr std::uint32_t kLeft = 1u << 30, kGrain = 1u << 31, kIds = kLeft - 1;
/// Beyond a sheared side, where fluid comes from: ids stay below kIds.
constexpr std::uint32_t kBeyond = kLeft;
BL_HD std::uint32_t grain(Id id) { return kGrain + (kIds - std::uint32_t(id)); }
/// A grain has just moved off the node.
BL_HD std::uint32_t left_by(Id id) { return kLeft + (kIds - std::uint32_t(id)); }
BL_HD bool is_wall(std::uint32_t m) { return m != 0 && (m < kLeft || m == kNone); }
/// No population comes from there, except from a surface.
BL_HD bool is_solid(std::uint32_t m) { return m != 0 && m != kBeyond; }
}  // namespace mark

/// A grain among nodes, in units of the lattice and counted from node 0, and the nodes around it.
struct Ball {
  NodeGrid grid;
  bool periodic[3];
  Vec3d centre, v, omega;
  double radius;
  Id id;
  int low[3], count[3];  ///< of the box around it, with all nodes from which links reach it

  struct Member {
    bool there = false;  ///< not beyond a side of the domain
    NodeGrid::Place place;
    Index node = 0;
    Vec3d d;  ///< from the centre
  };
  BL_HD Index size() const { return Index(count[0]) * Index(count[1]) * Index(count[2]); }
  BL_HD Member member(Index k) const {
    const Index row = k / Index(count[0]);
    const int at[3] = {low[0] + int(k % Index(count[0])), low[1] + int(row % Index(count[1])),
                       low[2] + int(row / Index(count[1]))};
    Member m;
    for (int a = 0; a < 3; ++a) {
      const int n = int(grid.n[a]);
      if (!periodic[a] && (at[a] < 0 || at[a] >= n)) return m;
      m.place.of[a] = Index(((at[a] % n) + n) % n);
      m.d[a] = at[a] - centre[a];
    }
    m.node = grid.node(m.place);
    m.there = true;
    return m;
  }
  BL_HD bool holds(const Vec3d& d) const { return norm2(d) < radius * radius; }
  /// From the nearest image of the centre.
  BL_HD Vec3d nearest(Vec3d d) const {
    for (int a = 0; a < 3; ++a)
      if (periodic[a]) d[a] -= grid.n[a] * std::rint(d[a] / grid.n[a]);
    return d;
  }
  /// Fraction of a link c from d outside to the surface, where d + c is inside.
  BL_HD double fraction(const Vec3d& d, const Vec3d& c) const {
    const double a = norm2(c), b = dot(d, c), e = norm2(d) - radius * radius;
    return (-b - std::sqrt(max_of(0.0, b * b - a * e))) / a;
  }
  BL_HD Vec3d velocity_at(const Vec3d& d) const { return v + cross(omega, d); }
};

/// Of a box whose images across z move along x, see sheared_sides.hpp; units of the lattice.
struct SideImages {
  bool there = false;
  double offset = 0, speed = 0;  ///< of the image above
};

struct Balls {
  NodeGrid grid;
  bool periodic[3];
  Vec3d first;    ///< place of node 0, m
  double dx, dt;  ///< m, s
  bool held;      ///< they are at rest for the fluid
  Span<const Vec3d> x;
  Span<const Real3> v, omega;
  Span<const Real> radius;
  Span<const Id> id;
  SideImages images = {};
  bool across = false;  ///< their images across the nearer sheared side, as far as nodes are near these

  BL_HD Ball operator()(Index i) const {
    Ball b{
        grid, {periodic[0], periodic[1], periodic[2]}, (x[i] - first) / dx, {}, {}, radius[i] / dx, id[i], {},
        {}};
    if (!held) b.v = (dt / dx) * Vec3d(v[i]), b.omega = dt * Vec3d(omega[i]);
    const double reach = b.radius + 1;
    if (across) {
      const double height = grid.n[2] - 2.0, to = b.centre.z > 0.5 * (height + 1) ? -1 : 1;
      b.centre.z += to * height, b.centre.x += to * images.offset;
      b.v.x += to * images.speed;
      if (b.centre.z < -reach || b.centre.z > height + 1 + reach) return b;
    }
    for (int a = 0; a < 3; ++a) {
      b.low[a] = int(std::ceil(b.centre[a] - reach));
      b.count[a] = int(std::floor(b.centre[a] + reach)) - b.low[a] + 1;
    }
    return b;
  }
};

/// The nodes around a grain as a group: pass.at() is called for each of them.
template <class Pass>
struct NodesOf {
  Ball ball;
  const Pass& pass;
  BL_HD Index size() const { return ball.size(); }
  BL_HD auto operator()(Index k) const {
    const Ball::Member m = ball.member(k);
    return m.there ? pass.at(ball, m) : pass.identity();
  }
};

/// Nodes that a grain has moved off are marked so. A grain moves by less than a node in a step.
struct ReleasePass : NoSum {
  Balls balls;
  Span<std::uint32_t> solid;
  BL_HD NodesOf<ReleasePass> group(Index i) const { return {balls(i), *this}; }
  BL_HD Value at(const Ball& ball, const Ball::Member& m) const {
    if (solid[m.node] == mark::grain(ball.id) && !ball.holds(ball.nearest(m.d)))
      solid[m.node] = mark::left_by(ball.id);
    return {};
  }
};

/// Nodes whose centre lies in a grain and in no wall are covered by it.
struct CoverPass : NoSum {
  Balls balls;
  Span<std::uint32_t> solid;
  BL_HD NodesOf<CoverPass> group(Index i) const { return {balls(i), *this}; }
  BL_HD Value at(const Ball& ball, const Ball::Member& m) const {
    if (ball.holds(m.d) && !mark::is_wall(solid[m.node])) raise_to(solid[m.node], mark::grain(ball.id));
    return {};
  }
};

/// Fluid where a grain has left: the mean density of the fluid next to it, the velocity of the surface, and
/// the stress of the neighbour that lies farthest off the surface, as if the last step had left it so.
struct RefillPass : NoSum {
  Balls balls;
  NodeMoments before;  ///< of the last step
  Span<const std::uint32_t> solid;
  BL_HD NodesOf<RefillPass> group(Index i) const { return {balls(i), *this}; }
  BL_HD Value at(const Ball& ball, const Ball::Member& m) const {
    if (solid[m.node] != mark::left_by(ball.id)) return {};
    const Vec3d d = ball.nearest(m.d);
    double excess = 0, best = 0;
    int neighbours = 0, outward = 0;
    for (int i = 1; i < kVelocities; ++i) {
      const Index next = before.f.grid.neighbour_at(m.node, i);
      if (solid[next] != 0) continue;
      excess += double(before(next).excess);
      ++neighbours;
      const Vec3d c = velocity_of<double>(i);
      const double off = dot(c, d) / std::sqrt(norm2(c));
      if (outward == 0 || off > best) best = off, outward = i;
    }
    const NodeState here{neighbours > 0 ? Real(excess / neighbours) : Real(0), Real3(ball.velocity_at(d))};
    Index source = m.node;
    NodeState there{};
    if (outward > 0) source = before.f.grid.neighbour_at(m.node, outward), there = before(source);
    for (int i = 0; i < kVelocities; ++i) {
      Real value = left_in_equilibrium(i, here, before.force);
      if (outward > 0) value += population(i, source) - left_in_equilibrium(i, there, before.force);
      population(i, m.node) = value;
    }
    return {};
  }

 private:
  BL_HD Real& population(int i, Index node) const {
    return i == 0 ? before.f.at(0, node) : before.f.leaving(i, node);
  }
};

/// Refilled nodes are fluid.
struct ReopenPass : NoSum {
  Balls balls;
  Span<std::uint32_t> solid;
  BL_HD NodesOf<ReopenPass> group(Index i) const { return {balls(i), *this}; }
  BL_HD Value at(const Ball& ball, const Ball::Member& m) const {
    if (solid[m.node] == mark::left_by(ball.id)) solid[m.node] = 0;
    return {};
  }
};

/// What grains feel of fluid that has no weight in its place: force per volume of a grain, N/m3.
struct LiftPass {
  Vec3d lift;
  Span<const Real> radius;
  Span<Real3> fluid_force;
  BL_HD static Real3 of(double R, const Vec3d& lift) { return Real3((4.0 / 3 * kPi * R * R * R) * lift); }
  BL_HD void operator()(Index i) const { fluid_force[i] = of(radius[i], lift); }
};

/// Momentum that grains take from the fluid in a step; f is less its weight, so that fluid at rest does not
/// push grains together between which it has no node.
struct GrainLinkPass {
  struct Value {
    Vec3d force, torque;  ///< about the centre, units of the lattice
    double covered = 0;   ///< nodes
  };
  Balls balls;
  Populations f;  ///< of the step to come
  Span<const std::uint32_t> solid;
  Vec3d push;                             ///< force per volume on fluid, units of the lattice
  Vec3d lift;                             ///< as in LiftPass
  double newton, newton_metre, second;    ///< SI of a unit of force and torque, and of a step
  bool first;                             ///< there is no former step
  Span<Real3> fluid_force, fluid_torque;  ///< mean of this step and the last, N, N m
  Span<Real3> force, torque;              ///< of the last step alone
  Span<Vec3d> received, displaced;  ///< N s since the start: from the fluid; of the push on what they cover

  BL_HD Value identity() const { return {}; }
  BL_HD void combine(Value& into, const Value& from) const {
    into.force += from.force, into.torque += from.torque, into.covered += from.covered;
  }
  BL_HD NodesOf<GrainLinkPass> group(Index i) const { return {balls(i), *this}; }

  BL_HD Value at(const Ball& ball, const Ball::Member& m) const {
    Value sum;
    const std::uint32_t own = mark::grain(ball.id);
    if (solid[m.node] != 0) {
      if (solid[m.node] == own && ball.holds(m.d)) sum.covered = 1;
      return sum;
    }
    if (norm2(m.d) >= square(ball.radius + std::sqrt(2.0))) return sum;
    for (int k = 1; k < kVelocities; ++k) {
      const Vec3d c = velocity_of<double>(k);
      if (!ball.holds(m.d + c) || solid[f.grid.neighbour_at(m.node, k)] != own) continue;
      const bool narrow = mark::is_solid(solid[f.grid.neighbour_at(m.node, opposite(k))]);
      const double q = narrow ? 0.5 : ball.fraction(m.d, c);
      const Vec3d arm = m.d + q * c, u = ball.velocity_at(arm);
      const Reflection r = reflect(f, m.node, k, Real(q), u);
      const Vec3d taken = r.taken(k, u);
      sum.force += taken;
      sum.torque += cross(arm, taken);
    }
    return sum;
  }
  BL_HD void finish(Index i, const Value& sum) const {
    const Real3 F(newton * sum.force), T(newton_metre * sum.torque);
    received[i] += (newton * second) * sum.force;
    displaced[i] += (newton * second * sum.covered) * push;
    if (balls.across) {  // besides those of the grain itself
      const Real weight = first ? 1 : Real(0.5);
      fluid_force[i] += weight * F, fluid_torque[i] += weight * T;
      force[i] += F, torque[i] += T;
      return;
    }
    fluid_force[i] = Real(0.5) * (F + (first ? F : force[i])) + LiftPass::of(balls.radius[i], lift);
    fluid_torque[i] = Real(0.5) * (T + (first ? T : torque[i]));
    force[i] = F, torque[i] = T;
  }
};

/// Sums over grains: what they have received 3 and displaced 3, N s; the force of the fluid on them 3, N.
struct GrainBooks {
  Span<const Vec3d> received, displaced;
  Span<const Real3> fluid_force;
  BL_HD void operator()(Index i, double* out) const {
    for (int k = 0; k < 3; ++k)
      out[k] = received[i][k], out[3 + k] = displaced[i][k], out[6 + k] = fluid_force[i][k];
  }
};

}  // namespace BL_SOLVER::lattice
