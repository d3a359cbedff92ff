#pragma once
// Error of the pressure force on free bodies in a linear pressure, and its correction.

#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/bodies/body_kicks.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"

namespace bedload::inline BL_VARIANT {

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
  Span<const BodyPressureSums> sums;
  Span<BodyPressure> fitted;
  BL_HD void operator()(Index k) const { fitted[k] = sums[k].fit(); }
};

/// Of free bodies by their place, and that of wall bodies among them.
struct BodyPressures {
  Span<const BodyPressure> fitted;
  const BodyPose* poses;
  BL_HD BodyPressure about(const BodyPose& pose) const {
    return pose.free ? fitted[pose.free - 1] : BodyPressure{};
  }
};

/// Force of the pairs of fluid and each wall particle of a free body (N) in the linear pressure fitted around
/// it, and by how much the fluid there loses its own error (LinearFit), 0 to 1, as one vector.
template <class W>
struct BodyPressurePass {
  W w;
  Span<const EosState<>> eos_state;
  Span<const Real4> correction;  ///< of fluid; w: weight of LinearFit
  Span<const WallState<>> wall_state;
  Span<const Vec3d> x0;
  Span<const std::uint32_t> body;
  BodyPressures pressures;
  Span<Vec4<double>> force;

  struct Sum {
    BodyPressure pressure;  ///< about the wall particle
    Vec3d force;            ///< over its volume
    Real near, weighted;
  };
  BL_HD Sum start(Index b) const {
    const BodyPose& pose = pressures.poses[body[b]];
    BodyPressure p = pressures.about(pose);
    p.P += dot(p.g, pose.place(x0[b]) - pose.origin());
    return {p, {}, 0, 0};
  }
  BL_HD auto sources() const { return sources_of(eos_state, correction); }
  BL_HD void pair(Sum& sum, const Real3& r_ba, Real r2, Real, const EosState<>& ma, const Real4& fit) const {
    const Real VF = ma.mass_over_eps / ma.rho * w.F(std::sqrt(r2)), surface = VF * r2;
    const double P = 2 * sum.pressure.P - dot(sum.pressure.g, Vec3d(r_ba));
    sum.force += double(VF) * P * Vec3d(r_ba);
    sum.near += surface;
    sum.weighted += surface * fit.w;
  }
  BL_HD void merge(Sum& into, const Sum& other) const {
    into.force += other.force;
    into.near += other.near;
    into.weighted += other.weighted;
  }
  BL_HD void finish(Index b, const Sum& sum) const {
    const WallState<> m = wall_state[b];
    const bool wet = sum.near > 0 && m.mass > 0;
    const Vec3d f = wet ? double(m.mass / m.rho) * sum.force : Vec3d{};
    force[b] = {f.x, f.y, f.z, wet ? double(sum.weighted / sum.near) : 0};
  }
};

/// What BodyPressurePass has found for the wall particles of one body, summed: the force and torque of the
/// pairs in the linear pressure, how many particles are wet, and their weights.
struct PairsInPressure {
  LoadSum load;
  double wet, weight;
};
struct PairsInPressureReduction {
  using Value = PairsInPressure;
  BodyParticles particles;
  Span<const WallState<>> state;
  Span<const Vec4<double>> force;
  BL_HD Value identity() const { return {LoadSum::zero(), 0, 0}; }
  BL_HD Value operator()(Index w) const {
    Value sum = identity();
    if (!particles.has(w) || state[w].mass == 0) return sum;
    sum.load.add(force[w].xyz(), cross(particles.arm(w), force[w].xyz()));
    sum.wet = 1, sum.weight = force[w].w;
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const {
    LoadSum::combine(into.load, from.load);
    into.wet += from.wet, into.weight += from.weight;
  }
};

/// Buoyancy correction of free bodies: replaces what pairs make of the linear pressure P + g . d around a
/// body by -g V at the centre of its volume, times a weight. Needed with LinearFit: in uniform pressure the
/// force of the pairs on a body is minus the sum of the errors of the fluid around, which LinearFit removes
/// from the fluid. Weight: smoothstep from 0 to 1 of the mean weight of LinearFit around wet particles, from
/// 3/4 to 1, so for bodies within the fluid only.
struct CorrectBody {
  const RigidBody* bodies;
  const BodyPressure* fitted;
  const PairsInPressure* pairs;
  Span<const Vec4<double>> rotation;
  Span<Vec3d> force, torque;  ///< of the fluid; N, N m
  Span<Vec3d> added_force, added_torque;
  BL_HD void operator()(Index k) const {
    const RigidBody& body = bodies[k];
    const PairsInPressure& p = pairs[k];
    added_force[k] = added_torque[k] = {};
    if (p.wet == 0 || body.volume == 0) return;
    const double t = clamp(4 * p.weight / p.wet - 3, 0.0, 1.0), w = t * t * (3 - 2 * t);
    const Vec3d buoyancy = -body.volume * fitted[k].g, at = to_quat(rotation[k]).rotate(body.middle);
    added_force[k] = w * (buoyancy - p.load.force());
    added_torque[k] = w * (cross(at, buoyancy) - p.load.torque());
    force[k] += added_force[k];
    torque[k] += added_torque[k];
  }
};

}  // namespace bedload::inline BL_VARIANT
