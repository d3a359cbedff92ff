#pragma once
// Error of the pressure force on bodies in a linear pressure, and its correction.

#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/bodies/body_kicks.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"

namespace BL_SOLVER {

/// A linear pressure about a body's reference point, P + g . d.
struct BodyPressure {
  double P = 0;  ///< Pa
  Vec3d g;       ///< Pa/m
};

/// Sums over the wet wall particles of a body, by which a linear pressure is fitted to theirs: 1, d, d d, p,
/// p d.
struct BodyPressureSums {
  double sum[14];
  BL_HD static BodyPressureSums zero() { return {}; }
  BL_HD static void combine(BodyPressureSums& into, const BodyPressureSums& from) {
    for (int k = 0; k < 14; ++k) into.sum[k] += from.sum[k];
  }
  BL_HD void add(const Vec3d& d, double p) {
    const double more[14] = {1,         d.x,       d.y,       d.z, d.x * d.x, d.y * d.y, d.z * d.z,
                             d.y * d.z, d.x * d.z, d.x * d.y, p,   p * d.x,   p * d.y,   p * d.z};
    for (int k = 0; k < 14; ++k) sum[k] += more[k];
  }
  /// By least squares; uniform where the particles do not span all three axes, or both of a plane.
  BL_HD BodyPressure fit() const {
    const double n = sum[0];
    if (n == 0) return {};
    const Vec3d mean = Vec3d{sum[1], sum[2], sum[3]} / n, slope = Vec3d{sum[11], sum[12], sum[13]} / n;
    const double p = sum[10] / n;
    SymmetricMatrix<double> about{sum[4] / n, sum[5] / n, sum[6] / n, sum[7] / n, sum[8] / n, sum[9] / n};
    about.add_outer(-1, mean);
    const double size = about.trace();
    if (about.yy < 1e-9 * size) about.yy = size;  // a plane flow
    if (!(about.determinant() > 1e-6 * size * size * size)) return {p, {}};
    const Vec3d g = about.inverse() * (slope - p * mean);
    return {p - dot(g, mean), g};
  }
};

struct BodyPressureReduction {
  using Value = BodyPressureSums;
  static std::array<double, 14> largest(const LoadBounds& b) {
    const double L = b.length, L2 = L * L, P = b.pressure;
    return {1, L, L, L, L2, L2, L2, L2, L2, L2, P, P * L, P * L, P * L};
  }
  BodyParticles particles;
  Span<const WallState<>> state;
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index w) const {
    Value sum = Value::zero();
    const WallState<> m = state[w];
    if (particles.has(w) && m.mass != 0)
      sum.add(particles.arm(w), double(m.p_over_rho2) * square(double(m.rho)));
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

struct FitBodyPressure {
  Span<const EnclosedSolid> solids;
  Span<const BodyPressureSums> sums;  ///< [solids]
  Span<BodyPressure> fitted;          ///< [bodies]
  BL_HD void operator()(Index k) const { fitted[solids[k].body] = sums[k].fit(); }
};

/// Of the pairs of fluid and one wall particle.
struct PairsOfWall {
  Vec3d force;    ///< in the linear pressure fitted around its body, N
  double weight;  ///< by how much the fluid there loses its own error (LinearFit), 0 to 1
  Vec3d area;     ///< into the fluid, by what they make of a uniform pressure, m2
  double swept;   ///< area . d about the body's reference point, m3
};

/// Linear pressures around bodies, 0 where none is fitted, and where to write what pairs make of them.
struct BodyPressures {
  Span<const BodyPressure> fitted;  ///< [bodies]
  const BodyPose* poses;
  Span<PairsOfWall> pairs;  ///< [walls]
};

/// What the pairs of fluid and wall particles make of linear pressures around bodies.
template <class W>
struct BodyPressurePass {
  W w;
  Span<const EosState<>> eos_state;
  Span<const Real4> correction;  ///< of fluid; w: weight of LinearFit
  Span<const WallState<>> wall_state;
  Span<const Vec3d> x0;
  Span<const std::uint32_t> body;
  BodyPressures pressures;

  struct Sum {
    BodyPressure pressure;  ///< about the wall particle
    Vec3d arm;              ///< from the body's reference point to it, m
    Vec3d force, area;      ///< over its volume; area: half of it and turned about
    Real near, weighted;
  };
  BL_HD Sum start(Index b) const {
    const BodyPose& pose = pressures.poses[body[b]];
    const Vec3d arm = pose.place(x0[b]) - pose.origin();
    BodyPressure p = pressures.fitted[body[b]];
    p.P += dot(p.g, arm);
    return {p, arm, {}, {}, 0, 0};
  }
  BL_HD auto sources() const { return sources_of(eos_state, correction); }
  BL_HD void pair(Sum& sum, const Real3& r_ba, Real r2, Real, const EosState<>& ma, const Real4& fit) const {
    const Real VF = ma.mass_over_eps / ma.rho * w.F(std::sqrt(r2)), surface = VF * r2;
    const double P = 2 * sum.pressure.P - dot(sum.pressure.g, Vec3d(r_ba));
    sum.force += double(VF) * P * Vec3d(r_ba);
    sum.area += double(VF) * Vec3d(r_ba);
    sum.near += surface;
    sum.weighted += surface * fit.w;
  }
  BL_HD void merge(Sum& into, const Sum& other) const {
    into.force += other.force;
    into.area += other.area;
    into.near += other.near;
    into.weighted += other.weighted;
  }
  BL_HD void finish(Index b, const Sum& sum) const {
    const WallState<> m = wall_state[b];
    const bool wet = sum.near > 0 && m.mass > 0;
    if (!wet) {
      pressures.pairs[b] = {};
      return;
    }
    const double V = double(m.mass / m.rho);
    const Vec3d area = -2 * V * sum.area;
    pressures.pairs[b] = {V * sum.force, double(sum.weighted / sum.near), area,
                          dot(area, sum.arm) + V * double(sum.near)};  // half way to the fluid
  }
};

/// PairsOfWall of one body, summed, and how many particles are wet.
struct PairsOfBody {
  LoadSum load;
  double wet, weight;
  Vec3d area;
  double swept;
};
struct PairsOfBodyReduction {
  using Value = PairsOfBody;
  static std::array<double, 12> largest(const LoadBounds& b) {
    const auto load = b.load();
    const double area = 1024 * b.area;
    return {load[0], load[1], load[2], load[3], load[4], load[5], 1, 1, area, area, area, area * b.length};
  }
  BodyParticles particles;
  Span<const WallState<>> state;
  Span<const PairsOfWall> pairs;
  BL_HD Value identity() const { return {LoadSum::zero(), 0, 0, {}, 0}; }
  BL_HD Value operator()(Index w) const {
    Value sum = identity();
    if (!particles.has(w) || state[w].mass == 0) return sum;
    const PairsOfWall& p = pairs[w];
    sum.load.add(p.force, cross(particles.arm(w), p.force));
    sum.wet = 1, sum.weight = p.weight;
    sum.area = p.area, sum.swept = p.swept;
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const {
    LoadSum::combine(into.load, from.load);
    into.wet += from.wet, into.weight += from.weight;
    into.area += from.area, into.swept += from.swept;
  }
};

/// Buoyancy correction of bodies: replaces what pairs make of the linear pressure P + g . d around a body by
/// -g V at the centre of its volume, times a weight. Needed with LinearFit: in uniform pressure the force of
/// the pairs on a body is minus the sum of the errors of the fluid around, which LinearFit removes from the
/// fluid. Weight: smoothstep from 0 to 1 of the mean weight of LinearFit around wet particles, from 3/4 to 1,
/// so for bodies within the fluid only. A body on a floor, or with fluid inside, is recognised by the volume
/// that pairs see, (1/n) sum of area . d.
struct CorrectBody {
  /// By how much the volume that pairs see over that of the body may differ from 1: with the whole weight,
  /// and with any. Balls have 0.9 and more, a box without fluid at one of its six faces 5/6.
  static constexpr double kWhole = 0.11, kAny = 0.16;

  Span<const EnclosedSolid> solids;
  const BodyPose* poses;
  Span<const BodyPressure> fitted;  ///< [bodies]
  Span<const PairsOfBody> pairs;    ///< [solids]
  int dimensions;                   ///< of the flow, where bodies must have fluid all around; else 0
  Span<LoadSum> added;              ///< [bodies]; about their reference points, N, N m
  BL_HD void operator()(Index k) const {
    const EnclosedSolid& solid = solids[k];
    const PairsOfBody& p = pairs[k];
    LoadSum& out = added[solid.body];
    out = LoadSum::zero();
    if (p.wet == 0 || solid.volume == 0) return;
    const Vec3d g = fitted[solid.body].g, buoyancy = -solid.volume * g,
                at = poses[solid.body].rotation.rotate(solid.middle);
    double w = smooth(4 * p.weight / p.wet - 3);
    if (dimensions > 0) {
      const double seen = (p.swept - dot(at, p.area)) / (dimensions * solid.volume);
      w *= smooth((kAny - std::abs(seen - 1)) / (kAny - kWhole));
    }
    out.add(w * (buoyancy - p.load.force()), w * (cross(at, buoyancy) - p.load.torque()));
  }

 private:
  BL_HD static double smooth(double x) {
    const double t = clamp(x, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
};

}  // namespace BL_SOLVER
