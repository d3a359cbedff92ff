#pragma once
// Grains that the fluid of a lattice flows around: which nodes they cover, what the fluid does to them.

#include "bedload/parallel/bricks.hpp"
#include "bedload/parallel/groups.hpp"
#include "kernels/lattice/link_pass.hpp"
#include "kernels/lattice/node_passes.hpp"

namespace BL_SOLVER::lattice {

/// What NodeStore::solid holds of grains, besides 0 and what Setup::Nodes has of walls. Of several grains
/// that cover a node, the one with the lowest id has the largest mark.
namespace mark {
constexpr std::uint32_t kLeft = 1u << 30, kGrain = 1u << 31, kIds = kLeft - 1;
constexpr std::uint32_t kTaken = kGrain + kLeft - 1;
/// Beyond a sheared side, where fluid comes from: ids stay below kIds.
constexpr std::uint32_t kBeyond = kLeft;
BL_HD std::uint32_t grain(Id id) { return kGrain + (kIds - std::uint32_t(id)); }
/// A grain has just moved over the node, which was fluid. Below kNone.
BL_HD std::uint32_t taken_by(Id id) { return kTaken + (kIds - std::uint32_t(id)); }
BL_HD bool is_taken(std::uint32_t m) { return m > kTaken && m != kNone; }
/// A grain has just moved off the node.
BL_HD std::uint32_t left_by(Id id) { return kLeft + (kIds - std::uint32_t(id)); }
BL_HD bool is_wall(std::uint32_t m) { return m != 0 && (m < kLeft || m == kNone); }
}  // namespace mark

/// A grain among nodes, in units of the lattice and counted from node 0, and the nodes around it.
struct Ball {
  NodeGrid grid;
  bool periodic[3];
  Vec3d centre, v, omega;
  double radius = 0;
  double drift = 0;  ///< of an image across a sheared side, along x, besides the motion of the grain itself
  Id id = 0;
  int low[3] = {}, count[3] = {};  ///< of the box around it, with all nodes from which links reach it

  struct Member {
    bool there = false;  ///< not beyond a side of the domain
    NodeGrid::Place place;
    Index node = 0;
    Vec3d d;  ///< from the centre
  };
  /// Nodes of the box, or next to it, with one y and z.
  struct Row {
    bool there = true;
    NodeGrid::Place place{};  ///< but for x
    Index node = 0;           ///< where x is 0
    Vec3d d;
  };
  BL_HD Row row(int y, int z) const {
    Row r;
    r.there = put(1, y, r.place, r.d) && put(2, z, r.place, r.d);
    r.node = grid.node(r.place);
    return r;
  }
  BL_HD Member member(const Row& row, int x) const {
    Member m{row.there, row.place, row.node, row.d};
    m.there = put(0, x, m.place, m.d) && m.there;
    m.node += m.place.of[0];
    return m;
  }
  BL_HD Member member(int x, int y, int z) const { return member(row(y, z), x); }
  BL_HD bool holds(const Vec3d& d) const { return norm2(d) < radius * radius; }
  /// From the nearest image of the centre.
  BL_HD Vec3d nearest(Vec3d d) const {
    for (int a = 0; a < 3; ++a)
      if (periodic[a]) d[a] -= grid.n[a] * std::rint(d[a] / grid.n[a]);
    return d;
  }
  /// Fraction of a link with velocity k from d outside to the surface, where d + c_k is inside.
  BL_HD double fraction(const Vec3d& d, int k) const {
    const double a = k <= 6 ? 1 : 2, b = dot(velocity_of<double>(k), d), e = norm2(d) - radius * radius;
    return (-b - root(max_of(0.0, b * b - a * e))) * (k <= 6 ? 1 : 0.5);
  }
  BL_HD Vec3d velocity_at(const Vec3d& d) const { return v + cross(omega, d); }

 private:
  /// False beyond a side of the domain.
  BL_HD bool put(int axis, int cell, NodeGrid::Place& place, Vec3d& d) const {
    int at = low[axis] + cell;
    const int n = int(grid.n[axis]);
    d[axis] = at - centre[axis];
    if (!periodic[axis] && (at < 0 || at >= n)) return false;
    while (at < 0) at += n;
    while (at >= n) at -= n;
    place.of[axis] = Index(at);
    return true;
  }
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

  /// reach: of the box, from the surface on.
  BL_HD Ball operator()(Index i, double reach = 1) const {
    const double nodes = 1 / dx;
    Ball b{.grid = grid,
           .periodic = {periodic[0], periodic[1], periodic[2]},
           .centre = nodes * (x[i] - first),
           .v = {},
           .omega = {},
           .radius = nodes * radius[i],
           .drift = 0,
           .id = id[i],
           .low = {},
           .count = {}};
    if (!held) b.v = (dt * nodes) * Vec3d(v[i]), b.omega = dt * Vec3d(omega[i]);
    if (across) {
      const double height = grid.n[2] - 2.0, to = b.centre.z > 0.5 * (height + 1) ? -1 : 1;
      b.centre.z += to * height, b.centre.x += to * images.offset;
      b.drift = to * images.speed;
      b.v.x += b.drift;
      if (b.centre.z < -(b.radius + reach) || b.centre.z > height + 1 + b.radius + reach) return b;
    }
    for (int a = 0; a < 3; ++a) {
      b.low[a] = int(std::ceil(b.centre[a] - (b.radius + reach)));
      b.count[a] = int(std::floor(b.centre[a] + (b.radius + reach))) - b.low[a] + 1;
    }
    return b;
  }
};

/// Which grains have just moved over or off a node.
struct Movers {
  static constexpr double kReach = 0.5;  ///< more than a grain moves in a step, nodes
  Span<Index> last = {};                 ///< of each grain, the number of the move in which it last did
  Index move = 0;                        ///< of this one

  struct Box : Ball {
    Index grain;
  };
  BL_HD static Box all(const Balls& balls, Index i) { return {balls(i, kReach), i}; }
  /// Without nodes, if it has not.
  BL_HD Box box(const Balls& balls, Index i) const { return last[i] == move ? all(balls, i) : Box{}; }
};

/// Nodes that a grain has moved off are marked so.
struct ReleasePass {
  Balls balls;
  Movers movers;
  Span<std::uint32_t> solid;
  BL_HD Movers::Box box(Index i) const { return Movers::all(balls, i); }
  BL_HD void at(const Movers::Box& ball, const Ball::Row& row, int x) const {
    const Ball::Member m = ball.member(row, x);
    if (!m.there || ball.holds(m.d) || solid[m.node] != mark::grain(ball.id)) return;
    if (ball.holds(ball.nearest(m.d))) return;
    solid[m.node] = mark::left_by(ball.id);
    movers.last[ball.grain] = movers.move;
  }
};

/// Nodes whose centre lies in a grain and in no wall are covered by it. Those that were fluid are marked so,
/// if there are movers.
struct CoverPass {
  Balls balls;
  Span<std::uint32_t> solid;
  Movers movers = {};
  BL_HD Movers::Box box(Index i) const { return {balls(i, 0), i}; }
  BL_HD void at(const Movers::Box& ball, const Ball::Row& row, int x) const {
    const Ball::Member m = ball.member(row, x);
    if (!m.there || !ball.holds(m.d)) return;
    const std::uint32_t here = solid[m.node];
    if (mark::is_wall(here)) return;
    const bool taken = movers.last && (here == 0 || mark::is_taken(here));
    raise_to(solid[m.node], taken ? mark::taken_by(ball.id) : mark::grain(ball.id));
    if (taken) movers.last[ball.grain] = movers.move;
  }
};

/// Fluid where a grain has left: the mean density of the fluid next to it, the velocity of the surface, and
/// the stress of the neighbour that lies farthest off the surface, as if the last step had left it so.
struct RefillPass {
  Balls balls;
  Movers movers;
  NodeMoments before;  ///< of the last step
  Span<const std::uint32_t> solid;
  BL_HD Ball box(Index i) const { return movers.box(balls, i); }
  BL_HD void at(const Ball& ball, const Ball::Row& row, int x) const {
    const Ball::Member m = ball.member(row, x);
    if (m.there && !ball.holds(m.d) && solid[m.node] == mark::left_by(ball.id)) refill(ball, m);
  }

 private:
  BL_HD void refill(const Ball& ball, const Ball::Member& m) const {
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
  }
  BL_HD Real& population(int i, Index node) const {
    return i == 0 ? before.f.at(0, node) : before.f.leaving(i, node);
  }
};

/// What the fluid has given to each grain, N s: since the start; and of it, what the grain has not got yet,
/// seen from the grain.
struct Given {
  Span<Vec3d> received, owed;
  BL_HD void add(Index i, const Ball& ball, const Vec3d& momentum, double mass) const {
    received[i] += momentum;
    owed[i] += momentum - Vec3d{mass * ball.drift, 0, 0};
  }
};

/// The momentum of nodes goes to a grain that has moved over them, and comes from one that has left them,
/// which are fluid again.
struct TakePass {
  struct Value {
    Vec3d momentum;
    double mass = 0;
  };
  Balls balls;
  Movers movers;
  NodeMoments before;  ///< of the last step
  double impulse;      ///< SI of a unit of momentum
  Span<std::uint32_t> solid;
  Given given;

  struct Cells {
    Movers::Box ball;
    const TakePass& pass;
    BL_HD Index size() const { return Index(ball.count[0]) * ball.count[1] * ball.count[2]; }
    BL_HD Value operator()(Index k) const {
      const Index nx = ball.count[0], ny = ball.count[1];
      return pass.at(ball, ball.member(int(k % nx), int(k / nx % ny), int(k / nx / ny)));
    }
    void fetch(Index) const {}
  };
  BL_HD Value identity() const { return {}; }
  BL_HD void combine(Value& into, const Value& from) const {
    into.momentum += from.momentum, into.mass += from.mass;
  }
  BL_HD Cells group(Index i) const { return {movers.box(balls, i), *this}; }
  BL_HD Value at(const Ball& ball, const Ball::Member& m) const {
    if (!m.there) return {};
    std::uint32_t& mark = solid[m.node];
    double sign = 0;
    if (mark == mark::taken_by(ball.id))
      mark = mark::grain(ball.id), sign = 1;
    else if (mark == mark::left_by(ball.id) && !ball.holds(m.d))
      mark = 0, sign = -1;
    if (sign == 0) return {};
    Value of;
    before.sums(m.node, of.mass, of.momentum);
    return {sign * of.momentum, sign * (1 + of.mass)};
  }
  BL_HD void finish(Index i, const Value& sum) const {
    if (sum.mass == 0 && norm2(sum.momentum) == 0) return;
    given.add(i, balls(i), impulse * sum.momentum, impulse * sum.mass);
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

/// A link from a fluid node to one that a grain covers: the node in the box of the grain, 19 bits an axis,
/// the velocity towards the grain, 5 bits, and whether the node behind is solid too.
struct GrainLink {
  int x, y, z, direction;
  bool narrow;

  BL_HD std::uint64_t packed() const {
    return std::uint64_t(x) | std::uint64_t(y) << 19 | std::uint64_t(z) << 38 |
           std::uint64_t(direction) << 57 | std::uint64_t(narrow) << 62;
  }
  BL_HD static GrainLink of(std::uint64_t w) {
    constexpr std::uint64_t kAxis = (1u << 19) - 1;
    return {int(w & kAxis), int(w >> 19 & kAxis), int(w >> 38 & kAxis), int(w >> 57 & 31),
            (w >> 62 & 1) != 0};
  }
  /// More than a sphere can have: of each direction one for every line of nodes that meets it, of which there
  /// are |c| on an area of 1. Radius in nodes.
  static double most(double radius) { return (6 + 12 * std::sqrt(2.0)) * kPi * square(radius + 0.71) + 1; }
};

/// The links of each grain, by direction, then along z, y and x.
struct GrainLinks {
  Span<const Index> begin;     ///< of a grain in `link`
  Span<Index> count, covered;  ///< links, and nodes that it covers
  Span<std::uint64_t> link;
};

/// Finds them. Marks of a node: none of fluid, both where the grain covers it, the first of other solids, the
/// second beyond a sheared side.
struct GrainLinkSearch {
  static constexpr int kKinds = kVelocities - 1;
  Balls balls;
  Span<const std::uint32_t> solid;
  GrainLinks links;

  struct Box : Ball {
    Index begin;
  };
  BL_HD Box box(Index i) const { return {balls(i), links.begin[i]}; }
  BL_HD unsigned marks(const Box& ball, const Ball::Row& row, int x) const {
    const Ball::Member m = ball.member(row, x);
    if (!m.there) return 1;
    const std::uint32_t here = solid[m.node];
    if (here == 0) return 0;
    if (here == mark::kBeyond) return 2;
    return here == mark::grain(ball.id) && ball.holds(m.d) ? 3 : 1;
  }
  /// Fluid nodes from which velocity kind + 1 leads to the grain.
  BL_HD std::uint32_t chosen(const Brick& brick, const BrickRows& rows, int kind, int row) const {
    return ~rows.first[row] & ~rows.second[row] & shifted(brick, rows, kind + 1, row, true);
  }
  /// Those with a solid node behind.
  BL_HD std::uint32_t marked(const Brick& brick, const BrickRows& rows, int kind, int row) const {
    return shifted(brick, rows, opposite(kind + 1), row, false);
  }
  BL_HD void list(const Box& ball, Index place, int kind, int x, int y, int z, bool narrow) const {
    links.link[ball.begin + place] = GrainLink{x, y, z, kind + 1, narrow}.packed();
  }
  BL_HD void finish(Index i, Index found, Index inside) const {
    links.count[i] = found, links.covered[i] = inside;
  }

 private:
  /// The first marks, or both, of what velocity i reaches from each cell of a row.
  BL_HD static std::uint32_t shifted(const Brick& brick, const BrickRows& rows, int i, int row, bool both) {
    const int from = row + velocity(i, 1) + velocity(i, 2) * brick.pitch(), by = velocity(i, 0);
    const std::uint32_t word = both ? rows.first[from] & rows.second[from] : rows.first[from];
    return by > 0 ? word >> 1 : by < 0 ? word << 1 : word;
  }
};

/// A link as passes get it.
struct LinkMet {
  Index node, beyond;  ///< of the fluid; what the odd velocity of the pair reaches from there
  int direction;
  double fraction;  ///< of the link to the surface
  Vec3d d;          ///< of the node from the centre
  BL_HD Vec3d arm() const { return d + fraction * velocity_of<double>(direction); }
};

/// The links of a grain as a group: pass.at() is called for each of them.
template <class Pass>
struct LinksOf {
  Ball ball;
  const Pass& pass;
  const std::uint64_t* links;
  Index count;
  BL_HD LinksOf(const Pass& pass, Index i)
      : ball(pass.balls(i)),
        pass(pass),
        links(pass.links.link.data + pass.links.begin[i]),
        count(pass.links.count[i]) {}
  BL_HD Index size() const { return count; }
  BL_HD auto operator()(Index l) const {
    const GrainLink link = GrainLink::of(links[l]);
    const Ball::Member m = ball.member(link.x, link.y, link.z);
    const double q = link.narrow ? 0.5 : ball.fraction(m.d, link.direction);
    const Index beyond = pass.f.grid.neighbour(m.place, pair_of(link.direction));
    return pass.at(ball, LinkMet{m.node, beyond, link.direction, q, m.d});
  }
#if !BL_CUDA
  [[gnu::always_inline]] void fetch(Index l) const {  // GCC drops calls that do nothing else
    const GrainLink link = GrainLink::of(links[l]);
    const Ball::Member m = ball.member(link.x, link.y, link.z);
    const int pair = pair_of(link.direction);
    for (const Index node : {m.node, pass.f.grid.neighbour(m.place, pair)})
      __builtin_prefetch(&pass.f.near(pair, node), 1), __builtin_prefetch(&pass.f.far(pair, node), 1);
  }
#endif
};

/// Momentum that grains take from the fluid in a step; f is less its weight, so that fluid at rest does not
/// push grains together between which it has no node. Their force does not depend on the frame, and accounts
/// for the nodes that they move over and leave on average; what the fluid has lost beside that is owed to
/// each.
struct GrainLinkPass {
  static constexpr double kPaid = 0.005;  ///< part of what is owed that is paid in a step
  struct Value {
    Vec3d force, torque;  ///< about the centre, units of the lattice
    Vec3d lost;           ///< by the fluid
    double mass = 0;      ///< that goes with it
  };
  Balls balls;
  Populations f;  ///< of the step to come
  GrainLinks links;
  Vec3d push;                             ///< force per volume on fluid, units of the lattice
  Vec3d lift;                             ///< as in LiftPass
  double newton, newton_metre, second;    ///< SI of a unit of force and torque, and of a step
  bool first;                             ///< there is no former step
  Span<Real3> fluid_force, fluid_torque;  ///< mean of this step and the last, N, N m
  Span<Real3> force, torque;              ///< of the last step alone
  Given given;
  Span<Vec3d> displaced;  ///< N s since the start: of the push on what they cover

  BL_HD Value identity() const { return {}; }
  BL_HD void combine(Value& into, const Value& from) const {
    into.force += from.force, into.torque += from.torque;
    into.lost += from.lost, into.mass += from.mass;
  }
  BL_HD LinksOf<GrainLinkPass> group(Index i) const { return {*this, i}; }

  BL_HD Value at(const Ball& ball, const LinkMet& link) const {
    const Vec3d arm = link.arm(), u = ball.velocity_at(arm);
    const Reflection r = reflect(f, link.node, link.beyond, link.direction, Real(link.fraction), u);
    const Vec3d taken = r.taken(link.direction, u);
    return {taken, cross(arm, taken), r.lost(link.direction), r.mass()};
  }
  BL_HD void finish(Index i, const Value& sum) const {
    const Real3 F(newton * sum.force), T(newton_metre * sum.torque);
    const Real part = first ? 1 : Real(0.5);  // of this step in the mean of the last two
    const Real3 ended = balls.across || first ? Real3{} : force[i],
                turned = balls.across || first ? Real3{} : torque[i];
    const Real3 mean = part * (F + ended);
    displaced[i] += (newton * second * links.covered[i]) * push;
    Vec3d& owed = given.owed[i];
    if (!balls.across) {
      const Real3 own = LiftPass::of(balls.radius[i], lift);
      owed = balls.held ? Vec3d{} : owed - second * Vec3d(fluid_force[i] - own);  // what it had in this step
      fluid_force[i] = own, fluid_torque[i] = {}, force[i] = {}, torque[i] = {};
    }
    const double impulse = newton * second;
    const Vec3d before = balls.across ? owed : Vec3d{};
    given.add(i, balls(i), impulse * sum.lost, impulse * sum.mass);
    const Vec3d due = owed - before - second * Vec3d(mean);
    fluid_force[i] += balls.held ? mean : Real3(Vec3d(mean) + (kPaid / second) * due);
    fluid_torque[i] += part * (T + turned);
    force[i] += F, torque[i] += T;
  }
};

/// Sums over grains: what they have received 3 and displaced 3, and what is owed to them 3, N s; the force of
/// the fluid on them 3, N.
struct GrainBooks {
  Span<const Vec3d> received, displaced, owed;
  Span<const Real3> fluid_force;
  BL_HD void operator()(Index i, double* out) const {
    for (int k = 0; k < 3; ++k) {
      out[k] = received[i][k], out[3 + k] = displaced[i][k];
      out[6 + k] = owed[i][k], out[9 + k] = fluid_force[i][k];
    }
  }
};

}  // namespace BL_SOLVER::lattice
