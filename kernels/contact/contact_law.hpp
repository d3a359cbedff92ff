#pragma once
// One contact between two grains, or a grain and a wall: force, torques, history.
// Signs: n points from j to i, v = v_i - v_j, the force is that on i.

#include <limits>

#include "kernels/contact/one_of.hpp"
#include "kernels/contact/rolling.hpp"
#include "kernels/contact/tangential.hpp"

namespace BL_SOLVER {

/// Geometry of a contact. Walls: R_star = R, m_star = m, arm_i = R - overlap, arm_j = 0.
struct ContactGeometry {
  Real3 n, n_mid;        ///< at the end and in the middle of the substep
  Real overlap;          ///< m; negative: apart, within the range of the law
  Real R_star, m_star;   ///< m, kg
  Real arm_i, arm_j;     ///< centre to contact, m
  Real inverse_spin;     ///< 1/I_i + 1/I_j
  Real inverse_rolling;  ///< sum of 1/(I + m R2)
};

struct Sphere {
  Real R, m;
  BL_HD Real inertia() const { return Real(0.4) * m * R * R; }
};
/// How far two spheres are apart; r = x_i - x_j, m. Their overlap is the quotient of a difference of squares
/// in fp64, so that it has all digits of a Real.
struct SphereGap {
  double squares;  ///< (R_i + R_j)^2 - r^2, m2; > 0: they overlap
  Real distance;   ///< of the centres, m
  Real reach;      ///< R_i + R_j, m
  BL_HD SphereGap(const Vec3d& r, Real R_i, Real R_j) {
    const double most = double(R_i) + double(R_j), r2 = norm2(r);
    squares = most * most - r2;
    distance = std::sqrt(Real(r2));
    reach = Real(most);
  }
  BL_HD bool overlaps() const { return squares > 0; }
  BL_HD Real overlap() const { return quotient(Real(squares), reach + distance); }  ///< m; < 0: apart
};
/// Two grains; r = x_i - x_j, which has changed by `drift` (m) in the substep.
BL_HD ContactGeometry sphere_contact(const Sphere& i, const Sphere& j, const Vec3d& r, Real distance,
                                     Real overlap, const Vec3d& drift = {}) {
  const Real half = Real(0.5) * overlap;
  const Real3 r_end = Real3(r), r_mid = r_end - Real(0.5) * Real3(drift);
  return {.n = r_end * quotient(Real(1), distance),
          .n_mid = r_mid * quotient(Real(1), norm(r_mid)),
          .overlap = overlap,
          .R_star = quotient(i.R * j.R, i.R + j.R),
          .m_star = quotient(i.m * j.m, i.m + j.m),
          .arm_i = i.R - half,
          .arm_j = j.R - half,
          .inverse_spin = 1 / i.inertia() + 1 / j.inertia(),
          .inverse_rolling = (1 / i.inertia() + 1 / j.inertia()) * Real(0.4 / 1.4)};
}
/// A grain and a wall, whose normal was n_before at the beginning of the substep.
BL_HD ContactGeometry wall_contact(const Sphere& i, const Vec3d& n_before, const Vec3d& n, Real overlap) {
  return {.n = Real3(n),
          .n_mid = halfway(Real3(n_before), Real3(n)),
          .overlap = overlap,
          .R_star = i.R,
          .m_star = i.m,
          .arm_i = i.R - overlap,
          .arm_j = 0,
          .inverse_spin = 1 / i.inertia(),
          .inverse_rolling = 1 / i.inertia() * Real(0.4 / 1.4)};
}

struct ContactForce {
  Real3 force;               ///< on i, N
  Real3 torque_i, torque_j;  ///< about the centres, N m
};

/// Energy in the springs of a contact, J.
struct StoredEnergy {
  double normal = 0, sliding = 0, rolling = 0;
  BL_HD double sideways() const { return sliding + rolling; }
  BL_HD double total() const { return normal + sideways(); }
};

/// The laws of a contact with their parameters, each a type or OneOf several.
template <class Normal, class Sliding, class Rolling>
struct ContactLawOf {
  Normal normal;
  Sliding sliding;
  Rolling rolling;
  bool clip_tension = true;
  Real mu = 0;
  Real sliding_damping = 1;  ///< fraction of the damping of friction's spring

  /// Whether `law` is composed of these laws.
  template <class Law>
  static bool is(const Law& law) {
    return acts_as<Normal>(law.normal) && acts_as<Sliding>(law.sliding) && acts_as<Rolling>(law.rolling);
  }
  /// The same law, composed of these types.
  template <class Law>
  BL_HD static ContactLawOf of(const Law& law) {
    return {.normal = law.normal,
            .sliding = law.sliding,
            .rolling = law.rolling,
            .clip_tension = law.clip_tension,
            .mu = law.mu,
            .sliding_damping = law.sliding_damping};
  }

  BL_HD bool slides() const {
    return with_law(sliding, [](const auto& law) { return law.kActs; });
  }
  BL_HD bool rolls() const {
    return with_law(rolling, [](const auto& law) { return law.kActs; });
  }
  /// Whether rolling friction keeps a couple from one substep to the next.
  BL_HD bool remembers_couple() const {
    return with_law(rolling, [](const auto& law) { return law.kRemembers; });
  }
  /// Whether these laws may act between what has touched and is apart again; else nothing is compiled for it.
  static constexpr bool kApart = kReaches<Normal>;
  /// How far they do so, over R*.
  BL_HD Real range() const {
    return with_law(normal, [](const auto& law) {
      if constexpr (kReaches<std::decay_t<decltype(law)>>)
        return law.range;
      else
        return Real(0);
    });
  }
  /// Whether two spheres act on each other; `touched`: they did in the substep before.
  BL_HD bool acts(const SphereGap& gap, Real R_i, Real R_j, bool touched) const {
    if (gap.overlaps()) return true;
    if constexpr (kApart)
      return touched && range() > 0 && gap.overlap() > -range() * quotient(R_i * R_j, R_i + R_j);
    else
      return false;
  }
  /// Overlap at the last evaluation, m; negative only with a range.
  template <class S>
  BL_HD S last_overlap(const HistoryOf<S>& h) const {
    if constexpr (kApart)
      if (range() > 0) return h.overlap;
    return std::abs(h.overlap);
  }
  BL_HD NormalState normal_state(Real R_star, Real m_star, Real overlap) const {
    return with_law(normal, [&](const auto& law) { return law(R_star, m_star, overlap); });
  }

  /// Force now and history after dt (s). v is the relative velocity of the centres, for a wall of the grain's
  /// centre and the wall at the contact. Velocities are those in the middle of the step, which suits springs;
  /// normal damping extrapolates to its end, which keeps restitution second order. What slides and rolls is
  /// taken with the normal of the middle too, then turned to that of the end: with the latter alone, grains
  /// that roll about their normal would slide sideways [vyas25]. dt = 0: no time passes.
  template <class S>
  BL_HD ContactForce operator()(const ContactGeometry& at, const Real3& v, const Real3& omega_i,
                                const Real3& omega_j, Real dt, HistoryOf<S>& h) const {
    const Real3 &n = at.n, &n_mid = at.n_mid;
    const Real overlap_before = Real(h.overlap);
    const NormalState ns = normal_state(at.R_star, at.m_star, at.overlap);
    const Real v_n = dot(v, n);
    const Real acts = with_law(normal, [&](const auto& law) {
      return law.dashpot(overlap_before, at.overlap, v_n, dt, !clip_tension);
    });
    const Real damping = ns.damping * acts;
    const bool began = kApart ? overlap_before != 0 : overlap_before > 0;
    const Real ahead = dt > 0 && began ? Real(0.5) * (v_n - Real(h.recede)) : Real(0);
    Real f_n = ns.elastic - damping * (v_n + ahead);
    if (clip_tension) f_n = max_of(f_n, kApart ? min_of(ns.elastic, Real(0)) : Real(0));
    const Real pressing = max_of(f_n, Real(0));

    const NormalState before =
        overlap_before > 0 ? normal_state(at.R_star, at.m_star, overlap_before) : ns;  // of the springs
    ContactForce out{f_n * n, {}, {}};
    if constexpr (kApart)
      if (!(at.overlap > 0)) {  // nothing presses; 0 stands for what has not touched
        h = {{}, {}, S(min_of(at.overlap, -std::numeric_limits<Real>::min())), S(v_n)};
        return out;
      }
    const ContactTurn turn(n_mid, n, Real(0.5) * dt * dot(omega_i + omega_j, n_mid));
    if (slides()) {
      const Real3 slip = v - dot(v, n_mid) * n_mid - cross(at.arm_i * omega_i + at.arm_j * omega_j, n_mid);
      const Real3 v_t = turn.tilted(slip), turning = turn.change(Real3(h.xi));
      const SlidingInput in{.normal_force = pressing,
                            .normal = ns,
                            .before = before,
                            .root = std::sqrt(at.R_star * at.overlap),
                            .m_star = at.m_star,
                            .overlap = at.overlap,
                            .overlap_before = overlap_before};
      const Real3 f_t =
          with_law(sliding, [&](const auto& law) { return slide(law, in, v_t, turning, dt * v_t, h.xi); });
      const Real3 couple = cross(f_t, n);  // - n x F_t
      out.force += f_t;
      out.torque_i = at.arm_i * couple;
      out.torque_j = at.arm_j * couple;
    }
    if (rolls()) {
      Real3 w = omega_i - omega_j;
      w -= dot(w, n_mid) * n_mid;
      w = turn.tilted(w);
      const RollingInput in{.omega = w,
                            .normal_force = pressing,
                            .normal_stiffness = ns.stiffness,
                            .stiffness_before = before.stiffness,
                            .R_star = at.R_star,
                            .inverse_spin = at.inverse_spin,
                            .inverse_rolling = at.inverse_rolling,
                            .dt = dt};
      if (remembers_couple()) h.couple += Vec3<S>(turn.change(Real3(h.couple)));
      const Real3 couple = with_law(rolling, [&](const auto& law) { return law(in, h.couple); });
      out.torque_i += couple;
      out.torque_j -= couple;
    }
    h.overlap = at.overlap;
    h.recede = v_n;
    return out;
  }

  BL_HD double stored(Real R_star, Real m_star, const ContactHistory& h) const {
    return energy(R_star, m_star, h).total();
  }
  BL_HD StoredEnergy energy(Real R_star, Real m_star, const ContactHistory& h) const {
    const double overlap = last_overlap(h);
    const NormalState ns = normal_state(R_star, m_star, Real(overlap));
    StoredEnergy out = stored_sideways(ns, R_star, m_star, std::abs(overlap), h);
    out.normal = with_law(normal, [](const auto& law) { return law.kEnergy; }) * double(ns.elastic) * overlap;
    return out;
  }
  /// Inherits the springs of a contact with `other` laws; the stored energy does not grow.
  BL_HD void take_over(const ContactLawOf& other, Real R_star, Real m_star, ContactHistory& h) const {
    const double overlap = h.overlap < 0 ? -h.overlap : h.overlap;
    const auto energy = [&](const ContactLawOf& law) {
      return law.stored_sideways(law.normal_state(R_star, m_star, Real(overlap)), R_star, m_star, overlap, h)
          .sideways();
    };
    const double had = energy(other), has = energy(*this);
    if (has > had) h.xi *= had / has, h.couple *= had / has;
  }

 private:
  BL_HD StoredEnergy stored_sideways(const NormalState& ns, Real R_star, Real m_star, double overlap,
                                     const ContactHistory& h) const {
    const SlidingInput in{.normal_force = ns.elastic,
                          .normal = ns,
                          .before = ns,
                          .root = std::sqrt(R_star * Real(overlap)),
                          .m_star = m_star,
                          .overlap = Real(overlap),
                          .overlap_before = Real(overlap)};
    return {.sliding = with_law(sliding, [&](const auto& law) { return law.stored(in, h.xi); }),
            .rolling = with_law(rolling,
                                [&](const auto& law) { return law.stored(ns.stiffness, R_star, h.couple); })};
  }
  /// Friction force, limited by Coulomb's law. In slip the spring force is at most the limit, and the damper
  /// does not stretch the spring: that would create energy. turning: change of the spring with its contact,
  /// m.
  template <class Law, class S>
  BL_HD Real3 slide(const Law& law, const SlidingInput& in, const Real3& v_t, const Real3& turning,
                    const Real3& step, Vec3<S>& xi) const {
    xi += Vec3<S>(turning + law.stretch(in, Real3(xi) + turning, step));
    const SlidingState s = law(in, Real3(xi));
    Real3 f_t = s.elastic - sliding_damping * s.damping * v_t;
    const Real size = norm(f_t), limit = mu * in.normal_force;
    if (size > limit) {
      f_t *= limit / size;
      const Real length = norm(Real3(xi)), longest = law.longest(in, limit);
      if (length > longest) xi *= S(longest / length);
    }
    return f_t;
  }
};

}  // namespace BL_SOLVER
