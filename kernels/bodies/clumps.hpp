#pragma once
// Clumps: grains that move as one rigid body. Each is kicked on its own; the sum of the gained momenta moves
// the clump, and its grains then follow it.

#include "kernels/bodies/body_kicks.hpp"
#include "kernels/integrate/grain_substep.hpp"

namespace BL_SOLVER {

/// State of the clumps, and which grains belong to them.
struct ClumpView {
  const RigidBody* kinds;  ///< of size 1 m, about their centres of mass
  const Vec3d* offsets;    ///< of each kind: the centre of its grains' masses from that of mass, m
  Span<const std::uint32_t> kind;
  Span<const double> size;             ///< by which lengths of the kind are multiplied
  Span<Vec3d> x, v, angular_momentum;  ///< of and about the centres: m, m/s, kg m2/s
  Span<Vec4<double>> rotation;
  Span<const std::uint32_t> clump;  ///< of each grain: 1 + its clump, 0 without one
  Span<const Vec3d> arm;            ///< of each grain from the centre of its clump, unturned, m

  BL_HD const RigidBody& body(Index c) const { return kinds[kind[c]]; }
  BL_HD double mass(Index c) const { return body(c).mass * size[c] * size[c] * size[c]; }
  /// Of the kind at the same angular velocity as the clump.
  BL_HD Vec3d momentum_of_kind(Index c) const {
    const double s2 = size[c] * size[c];
    return (1 / (s2 * s2 * size[c])) * angular_momentum[c];
  }
  BL_HD Quat<double> turn(Index c) const { return to_quat(rotation[c]); }
  BL_HD Vec3d omega(Index c) const { return body(c).omega(turn(c), momentum_of_kind(c)); }
  BL_HD Vec3d lever(Index i) const { return turn(clump[i] - 1).rotate(arm[i]); }

  /// Of a clump, for all its grains.
  struct Motion {
    Vec3d x, v, omega;
    Quat<double> turn;
    BL_HD Vec3d velocity(const Vec3d& lever) const { return v + cross(omega, lever); }
  };
  BL_HD Motion motion(Index c) const { return {x[c], v[c], omega(c), turn(c)}; }
};

/// The grains of each clump in the order of its spheres, in pieces short enough for one thread.
struct ClumpPieces {
  static constexpr Index kPiece = 32;
  Span<const Index> place;  ///< of each among the gains, clump after clump
  Span<const Index> begin;  ///< [pieces + 1] in `place`
  Span<const Index> first;  ///< [clumps + 1] of the pieces
};

/// Notes where a sort has put the grains of clumps.
struct PlaceClumpsPass {
  Span<const std::uint32_t> clump, member;
  Span<const Index> slot;  ///< of each clump, the first of its grains
  Span<Index> grain;
  BL_HD void operator()(Index i) const {
    if (clump[i] > 0) grain[slot[clump[i] - 1] + member[i]] = i;
  }
};

/// The same on several ranks, each of which has some of the grains.
struct InClump {
  Span<const std::uint32_t> clump;
  BL_HD bool operator()(Index i) const { return clump[i] > 0; }
};
/// Which of all grains of clumps each is, clump after clump.
struct SlotPass {
  Span<const Index> grain;
  Span<const std::uint32_t> clump, member;
  Span<const Index> first;  ///< of each clump, the first of its grains
  Span<std::uint32_t> slot;
  BL_HD void operator()(Index k) const { slot[k] = first[clump[grain[k]] - 1] + member[grain[k]]; }
};
/// Notes where it is.
struct PlaceMembersPass {
  Span<const std::uint32_t> slot;
  Span<Index> place;
  BL_HD void operator()(Index k) const { place[slot[k]] = k; }
};

/// How many grains and pieces each clump has, and where the pieces begin.
struct CountPiecesPass {
  Span<const std::uint32_t> kind;
  Span<const Index> spheres;  ///< of each kind
  Span<Index> grains, pieces;
  BL_HD void operator()(Index c) const {
    grains[c] = spheres[kind[c]];
    pieces[c] = (grains[c] + ClumpPieces::kPiece - 1) / ClumpPieces::kPiece;
  }
};
struct BeginPiecesPass {
  Span<const Index> slot;   ///< [clumps + 1], the first of their grains
  Span<const Index> first;  ///< of ClumpPieces
  Span<Index> begin;
  BL_HD void operator()(Index c) const {
    for (Index piece = first[c]; piece < first[c + 1]; ++piece)
      begin[piece] = slot[c] + (piece - first[c]) * ClumpPieces::kPiece;
    if (c + 2 == slot.size) begin[first[c + 1]] = slot[c + 1];
  }
};

/// By what clumps are sorted: rigid fills stay first, the others come as the first of their grains.
struct ClumpKeyPass {
  Span<const std::uint32_t> kind, shaped;  ///< shaped: of each kind, 0 for rigid fills
  Span<const Index> slot, grain;           ///< of PlaceClumpsPass
  Span<std::uint32_t> key;
  BL_HD void operator()(Index c) const { key[c] = shaped[kind[c]] ? 1 + grain[slot[c]] : 0; }
};

/// A clump to insert.
struct NewClump {
  std::uint32_t id, kind;
  double size;  ///< of ClumpView, m
  Vec3d x, v;   ///< m, m/s
  Vec4<double> rotation;
};

/// Appends new clumps, which do not turn.
struct AddClumpsPass {
  Span<const NewClump> clump;
  Index place;  ///< of the first
  Span<Id> id;
  Span<std::uint32_t> kind;
  Span<double> size;
  Span<Vec3d> x, v;
  Span<Vec4<double>> rotation;
  BL_HD void operator()(Index k) const {
    const Index c = place + k;
    id[c] = clump[k].id, kind[c] = clump[k].kind, size[c] = clump[k].size;
    x[c] = clump[k].x, v[c] = clump[k].v, rotation[c] = clump[k].rotation;
  }
};

/// Where those that stay will be.
struct ClumpPlacePass {
  Span<const Index> kept;
  Span<Index> place;
  BL_HD void operator()(Index k) const { place[kept[k]] = k; }
};
struct RenumberClumpsPass {
  Span<const Index> place;
  Span<std::uint32_t> clump;  ///< of each grain
  BL_HD void operator()(Index i) const {
    if (clump[i] > 0) clump[i] = 1 + place[clump[i] - 1];
  }
};

/// Of each grain the id of its clump, 0: none.
struct ClumpIds {
  Span<const std::uint32_t> clump;
  Span<const Id> id;
  Span<Id> out;
  BL_HD void operator()(Index i) const { out[i] = clump[i] > 0 ? id[clump[i] - 1] : 0; }
};

/// a + b, where b is rounded before, by all compilers: never a fused sum of a product.
BL_HD double sum_of_rounded(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dadd_rn(a, b);
#else
  asm("" : "+m"(b));
  return a + b;
#endif
}

/// Momentum and angular momentum about the centre of its clump that a grain has gained since it last followed
/// it, N s and N m s. Their sum has the same bits whether they have been stored or not.
struct Gain {
  Vec3d momentum, angular;
  BL_HD void add_to(LoadSum& all) const {
    for (int k = 0; k < 3; ++k) {
      all.sum[k] = sum_of_rounded(all.sum[k], momentum[k]);
      all.sum[3 + k] = sum_of_rounded(all.sum[3 + k], angular[k]);
    }
  }
};

/// Of each grain.
struct GainPass {
  ClumpView all;
  Span<const Index> grain;  ///< those of clumps
  MassPerR3 mass_per_r3;
  Span<const Real> radius;
  Velocities<const Real3> now, rest;  ///< rest may be empty
  Span<Vec3d> momentum, angular;
  BL_HD void operator()(Index k) const {
    const Gain gain = of(k, all.motion(all.clump[grain[k]] - 1));
    momentum[k] = gain.momentum, angular[k] = gain.angular;
  }
  /// Of one whose clump moves like this.
  BL_HD Gain of(Index k, const ClumpView::Motion& motion) const {
    const Index i = grain[k];
    const double R = radius[i], m = mass_per_r3(i) * R * R * R;
    const Vec3d v_rest = rest.v ? Vec3d(rest.v[i]) : Vec3d{},
                omega_rest = rest.v ? Vec3d(rest.omega[i]) : Vec3d{};
    const Vec3d lever = motion.turn.rotate(all.arm[i]);
    const Vec3d by_force = m * (Vec3d(now.v[i]) - Vec3d(Real3(motion.velocity(lever))) + v_rest);
    const Vec3d by_torque = 0.4 * m * R * R * (Vec3d(now.omega[i]) - Vec3d(Real3(motion.omega)) + omega_rest);
    return {by_force, cross(lever, by_force) + by_torque};
  }
};

/// The sums of pieces, stored as force and torque.
struct SumGainsPass {
  ClumpPieces pieces;
  Span<const Vec3d> momentum, angular;
  LoadSum* gained;  ///< [pieces]
  BL_HD void operator()(Index piece) const {
    LoadSum sum = LoadSum::zero();
    for (Index slot = pieces.begin[piece]; slot < pieces.begin[piece + 1]; ++slot)
      Gain{momentum[pieces.place[slot]], angular[pieces.place[slot]]}.add_to(sum);
    gained[piece] = sum;
  }
};

/// Drag on a clump at its centre of mass, constant over an advance.
struct CentreDrag {
  Vec3d velocity;          ///< of the fluid, m/s
  double coefficient = 0;  ///< kg/s; 0: its grains have their own
  Vec3d lever;             ///< of its grains' drag, by their coefficients, m
  Relaxation slide;        ///< in half a substep
  Vec3d impulse;           ///< in this advance so far, N s

  /// Change of v in so many kicks of h (s), in which all else changes it by dv. m: mass, kg.
  BL_HD Vec3d kicked(const Vec3d& v, const Vec3d& dv, double h, int kicks, double m) {
    if (!(coefficient > 0)) return dv;
    const Vec3d a = (1 / (kicks * h)) * dv;
    Vec3d change;
    for (int n = 0; n < kicks; ++n) {
      const Vec3d by_drag = slide.drag(v + change, velocity, a, h);
      change += by_drag + h * a;
      impulse += m * by_drag;
    }
    return change;
  }
};

/// Applies the momenta gained by its grains to a clump, within its constraints, then drifts it.
struct MoveClumpsPass {
  ClumpView all;
  Span<const Index> first;  ///< of ClumpPieces
  const LoadSum* gained;
  Vec3d fall;                  ///< velocity that gravity gave the grains, m/s: it does not turn a clump
  double drift;                ///< s
  CentreDrag* drag = nullptr;  ///< [clumps]; null: grains have their own
  double h = 0;                ///< half a substep, s
  int kicks = 0;               ///< of h, since clumps moved last
  BL_HD void operator()(Index c) const {
    if (first[c] == first[c + 1]) return;
    LoadSum sum = LoadSum::zero();
    for (Index piece = first[c]; piece < first[c + 1]; ++piece) LoadSum::combine(sum, gained[piece]);
    move(c, sum);
  }
  BL_HD void move(Index c, const LoadSum& sum) const {
    const RigidBody& k = all.body(c);
    const double m = all.mass(c);
    const Vec3d offset = all.turn(c).rotate(all.size[c] * all.offsets[all.kind[c]]);
    Vec3d dv = k.movable((1 / m) * sum.force());
    if (drag) dv = drag[c].kicked(all.v[c], dv, h, kicks, m);
    all.v[c] += dv;
    all.angular_momentum[c] += k.turnable(sum.torque() - cross(offset, m * fall));
    if (drift == 0) return;
    all.x[c] += drift * all.v[c];
    all.rotation[c] = to_vec4(k.turned(all.turn(c), all.momentum_of_kind(c), drift));
  }
};

/// Sets position and motion of grains from their clump.
struct FollowPass {
  ClumpView all;
  Frame frame;
  Span<Vec3d> x;
  Velocities<Real3> now, rest;  ///< rest may be empty
  BL_HD void operator()(Index i) const {
    if (all.clump[i] != 0) follow(i, all.motion(all.clump[i] - 1));
  }
  BL_HD void follow(Index i, const ClumpView::Motion& motion) const {
    const Vec3d lever = motion.turn.rotate(all.arm[i]);
    x[i] = frame.wrap(motion.x + lever);
    now.v[i] = Real3(motion.velocity(lever));
    now.omega[i] = Real3(motion.omega);
    if (rest.v) rest.v[i] = {}, rest.omega[i] = {};
  }
};

/// All of this for clumps of one piece where this rank has all grains: each has its motion read and found
/// once.
struct ClumpPass {
  GainPass gain;  ///< its grains clump after clump
  Span<const Index> begin;
  MoveClumpsPass move;
  FollowPass grains;
  BL_HD void operator()(Index c) const {
    const Index piece = move.first[c];
    if (piece == move.first[c + 1]) return;
    LoadSum sum = LoadSum::zero();
    ClumpView::Motion motion = grains.all.motion(c);
    for (Index k = begin[piece]; k < begin[piece + 1]; ++k) gain.of(k, motion).add_to(sum);
    move.move(c, sum);
    motion = grains.all.motion(c);
    for (Index k = begin[piece]; k < begin[piece + 1]; ++k) grains.follow(gain.grain[k], motion);
  }
};

/// Force and torque about its centre on one clump, of forces and torques on its grains.
struct ClumpLoadReduction {
  using Value = LoadSum;
  ClumpView all;
  Index of;
  Span<const Real3> force, torque, more;  ///< N, any unit, N; `more`: another force, may be empty
  double per_torque;                      ///< converts the torque to N m
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index i) const {
    Value sum = Value::zero();
    if (all.clump[i] != of + 1) return sum;
    Vec3d f = Vec3d(force[i]);
    if (more) f += Vec3d(more[i]);
    sum.add(f, cross(all.lever(i), f) + per_torque * Vec3d(torque[i]));
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

/// Conserved sums and energies of clumps, in the order of TotalsReduction::Sum.
struct ClumpTotals {
  static constexpr int kSums = 13;
  ClumpView all;
  Frame frame;
  BL_HD void operator()(Index c, double* out) const {
    const double m = all.mass(c);
    const Vec3d v = all.v[c], x = frame.wrap(all.x[c]), l = all.angular_momentum[c];
    const Vec3d angular = cross(x, m * v) + l;
    out[0] = m;
    out[1] = 0.5 * m * norm2(v);
    out[2] = 0.5 * dot(l, all.omega(c));
    out[3] = 0;  // elastic: that of its grains' contacts
    for (int k = 0; k < 3; ++k) out[4 + k] = m * v[k], out[7 + k] = angular[k], out[10 + k] = m * x[k];
  }
};

}  // namespace BL_SOLVER
