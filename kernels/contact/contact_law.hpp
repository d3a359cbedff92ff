#pragma once
// One contact between two grains, or a grain and a wall: force, torques, history.
// Signs: n points from j to i, v = v_i - v_j, the force is that on i.

#include "bedload/case/config.hpp"
#include "kernels/contact/normal.hpp"
#include "kernels/contact/rolling.hpp"
#include "kernels/contact/tangential.hpp"

namespace bedload::inline BL_VARIANT {

enum class NormalLaw : std::uint32_t { none, hertz, linear };
enum class SlidingLaw : std::uint32_t { none, mindlin, mindlin_deresiewicz, linear };
enum class RollingLaw : std::uint32_t { none, epsd, cdt };

/// Where two bodies touch. Walls: R_star = R, m_star = m, arm_i = R - overlap, arm_j = 0.
struct ContactGeometry {
  Vec3d n;
  double overlap;        ///< > 0, m
  Real R_star, m_star;   ///< m, kg
  Real arm_i, arm_j;     ///< centre to contact, m
  Real inverse_spin;     ///< 1/I_i + 1/I_j
  Real inverse_rolling;  ///< sum of 1/(I + m R2)
};

/// Two grains of solid matter; r = x_i - x_j.
struct Sphere {
  Real R, m;
  BL_HD Real inertia() const { return Real(0.4) * m * R * R; }
};
BL_HD ContactGeometry touch(const Sphere& i, const Sphere& j, const Vec3d& r, double distance,
                            double overlap) {
  const Real half = Real(0.5 * overlap);
  return {r * (1 / distance),
          overlap,
          i.R * j.R / (i.R + j.R),
          i.m * j.m / (i.m + j.m),
          i.R - half,
          j.R - half,
          1 / i.inertia() + 1 / j.inertia(),
          (1 / i.inertia() + 1 / j.inertia()) * Real(0.4 / 1.4)};
}
BL_HD ContactGeometry touch_wall(const Sphere& i, const Vec3d& n, double overlap) {
  return {n, overlap, i.R, i.m, i.R - Real(overlap), 0, 1 / i.inertia(), 1 / i.inertia() * Real(0.4 / 1.4)};
}

struct ContactForce {
  Real3 force;               ///< on i, N
  Real3 torque_i, torque_j;  ///< about the centres, N m
};

/// All laws of a case with their parameters.
struct ContactLaw {
  NormalLaw normal = NormalLaw::hertz;
  SlidingLaw sliding = SlidingLaw::mindlin;
  RollingLaw rolling = RollingLaw::epsd;
  bool clip_tension = true;
  Real mu = 0;
  Real sliding_damping = 1;  ///< fraction of the damping of friction's spring
  Hertz hertz;
  LinearSpring spring;
  Mindlin mindlin;
  MindlinDeresiewicz deresiewicz;
  LinearSliding linear_sliding;
  ElasticPlasticRolling epsd;
  ConstantRolling cdt;

  BL_HD NormalState normal_state(Real R_star, Real m_star, Real overlap) const {
    return normal == NormalLaw::hertz ? hertz(R_star, m_star, overlap) : spring(R_star, m_star, overlap);
  }
  BL_HD SlidingState sliding_state(const SlidingInput& in, const Vec3d& xi) const {
    SlidingState s = sliding == SlidingLaw::mindlin  ? mindlin(in, xi)
                     : sliding == SlidingLaw::linear ? linear_sliding(in, xi)
                                                     : deresiewicz(in, xi);
    s.damping *= sliding_damping;
    return s;
  }

  /// Force now and history after dt (s). v is the relative velocity of the centres, for a wall of the grain's
  /// centre and the wall at the contact. Velocities are those in the middle of the step, which suits springs;
  /// normal damping extrapolates to its end, which keeps restitution second order. dt = 0: no time passes.
  BL_HD ContactForce operator()(const ContactGeometry& at, const Real3& v, const Real3& omega_i,
                                const Real3& omega_j, Real dt, ContactHistory& h) const {
    const Real3 n = Real3(at.n);
    const NormalState ns = normal_state(at.R_star, at.m_star, Real(at.overlap));
    const Real v_n = dot(v, n);
    Real damping = ns.damping;
    if (normal == NormalLaw::linear)
      damping *= dashpot_fraction(h.overlap, Real(at.overlap), v_n, dt, !clip_tension);
    const Real ahead = dt > 0 && h.overlap > 0 ? Real(0.5) * (v_n - Real(h.recede)) : Real(0);
    Real f_n = ns.elastic - damping * (v_n + ahead);
    if (clip_tension) f_n = max_of(f_n, Real(0));
    const Real pressing = max_of(f_n, Real(0));

    const double twist = 0.5 * dt * double(dot(omega_i + omega_j, n));
    ContactForce out{f_n * n, {}, {}};
    if (sliding != SlidingLaw::none) {
      const Real3 v_t = v - v_n * n - cross(at.arm_i * omega_i + at.arm_j * omega_j, n);
      const Real3 f_t = slide(at, ns, pressing, v_t, twist, dt, h);
      const Real3 couple = cross(f_t, n);  // - n x F_t
      out.force += f_t;
      out.torque_i = at.arm_i * couple;
      out.torque_j = at.arm_j * couple;
    }
    if (rolling != RollingLaw::none) {
      Real3 w = omega_i - omega_j;
      w -= dot(w, n) * n;
      const RollingInput in{w, pressing, ns.stiffness, at.R_star, at.inverse_spin, at.inverse_rolling, dt};
      Real3 couple;
      if (rolling == RollingLaw::epsd) {
        h.couple = turn_with_contact(h.couple, at.n, twist);
        couple = epsd(in, h.couple);
      } else {
        couple = cdt(in);
      }
      out.torque_i += couple;
      out.torque_j -= couple;
    }
    h.overlap = at.overlap;
    h.recede = v_n;
    return out;
  }

  /// Energy stored in springs, J.
  BL_HD double stored(Real R_star, Real m_star, const ContactHistory& h) const {
    const double overlap = h.overlap < 0 ? -h.overlap : h.overlap;
    const NormalState ns = normal_state(R_star, m_star, Real(overlap));
    double energy = (normal == NormalLaw::hertz ? 0.4 : 0.5) * double(ns.elastic) * overlap;
    const SlidingInput in{ns.elastic, ns.stiffness, ns.damping, std::sqrt(R_star * Real(overlap)),
                          m_star,     overlap};
    if (sliding == SlidingLaw::mindlin_deresiewicz) {
      const double longest = deresiewicz.longest(overlap);
      if (longest > 0) {
        const double s = min_of(norm(h.xi) / longest, 1.0), q = std::sqrt(1 - s);
        energy += double(mu) * ns.elastic * longest * (s - 0.4 * (1 - q * q * q * q * q));
      }
    } else if (sliding != SlidingLaw::none) {
      energy += 0.5 * double(sliding_state(in, h.xi).stiffness) * norm2(h.xi);
    }
    if (rolling == RollingLaw::epsd && epsd.mu_r > 0)
      energy += 0.5 * norm2(h.couple) / double(epsd.stiffness(ns.stiffness, R_star));
    return energy;
  }

 private:
  BL_HD Real3 slide(const ContactGeometry& at, const NormalState& ns, Real pressing, const Real3& v_t,
                    double twist, Real dt, ContactHistory& h) const {
    Vec3d xi = turn_with_contact(h.xi, at.n, twist);
    if (sliding == SlidingLaw::mindlin) xi = Mindlin::rescale(xi, h.overlap, at.overlap);
    xi += double(dt) * Vec3d(v_t);
    const bool partial_slip = sliding == SlidingLaw::mindlin_deresiewicz;
    if (partial_slip) {
      const double longest = deresiewicz.longest(at.overlap), length = norm(xi);
      if (length > longest) xi *= longest / length;
    }
    const SlidingInput in{pressing,  ns.stiffness, ns.damping, std::sqrt(at.R_star * Real(at.overlap)),
                          at.m_star, at.overlap};
    const SlidingState s = sliding_state(in, xi);
    Real3 f_t = s.elastic - s.damping * v_t;
    const Real size = norm(f_t), limit = mu * pressing;
    if (size > limit) {
      f_t *= limit / size;
      if (!partial_slip && s.stiffness > 0)
        xi = (Vec3d(f_t) + double(s.damping) * Vec3d(v_t)) * (-1 / double(s.stiffness));
    }
    h.xi = xi;
    return f_t;
  }
};

/// The laws of a case, between grains. Throws CaseError where the restitution cannot be had.
ContactLaw make_contact_law(const Config& config);
/// The same between grains and a wall body, with the friction and restitution of that.
ContactLaw make_wall_law(const Config& config, const WallBody& body);

}  // namespace bedload::inline BL_VARIANT
