#pragma once
// Lubrication forces of the viscous fluid between two close surfaces. Signs as in contact_law.hpp.

#include "kernels/contact/contact_law.hpp"

namespace BL_SOLVER {

/// Two close surfaces, in contact or not. Walls: R_star = R, skew = 1, arm_j = 0.
struct NearSurfaces {
  Vec3d n;
  double gap;         ///< m; negative: overlap
  Real R_star;        ///< m
  Real skew;          ///< (R_j - R_i) / (R_j + R_i)
  Real arm_i, arm_j;  ///< parts of the distance of the centres, m
  BL_HD static NearSurfaces spheres(Real R_i, Real R_j, const Vec3d& r, double distance) {
    const double gap = distance - double(R_i) - double(R_j);
    const Real half = Real(0.5 * gap);
    return {.n = r * (1 / distance),
            .gap = gap,
            .R_star = R_i * R_j / (R_i + R_j),
            .skew = (R_j - R_i) / (R_j + R_i),
            .arm_i = R_i + half,
            .arm_j = R_j + half};
  }
};

/// The singular parts of the force between two close spheres [jeffrey84], zero beyond the gap s_c and
/// constant below s_m. Squeezing, with the gap s: -6 pi mu R*^2 (1/s - 1/s_c) v_n n. Shearing, with the slip
/// u of the surfaces, the rolling w = (omega_i - omega_j) x n and q = (R_j - R_i) / (R_j + R_i):
///   f = 2/5 pi mu R* ln(s_c / s) ((5 + 3 q^2) u + 6 q R* w),   g = 2/5 pi mu R*^2 ln(s_c / s) (6 q u + 12 R*
///   w);
/// force -f and torque n x (l_i f - g) on i, f and n x (l_j f + g) on j, l being the arms. A rigid motion of
/// the pair causes none; the dissipated power f u + g w is never negative.
struct Lubrication {
  Real mu = 0;                         ///< Pa s; 0: no lubrication
  Real cut_off = 1, least_gap = 0.01;  ///< s_c, s_m over R*
  bool shears = false;
  Real squeezed = kFar, sheared = kFar;  ///< gaps from which the fluid itself resolves it, m

  /// mu: of the fluid, Pa s; node: spacing of nodes between which it flows around grains, m.
  static Lubrication of(const LubricationConfig& l, double mu, double node = kFar) {
    if (!l.acts()) return {};
    return {Real(mu),
            Real(l.cut_off),
            Real(l.least_gap),
            l.forces == LubricationForces::all,
            Real(kSqueezed * node),
            Real(kSheared * node)};
  }
  BL_HD bool acts() const { return mu > 0; }
  /// Gap up to which there is a force, m.
  BL_HD Real range(Real R_star) const { return acts() ? cut_off * R_star : Real(0); }

  /// v: relative velocity of the centres, for a wall of the grain's centre and the wall next to it, m/s.
  BL_HD ContactForce operator()(const NearSurfaces& at, const Real3& v, const Real3& omega_i,
                                const Real3& omega_j) const {
    const Real R = at.R_star, s_c = min_of(cut_off * R, squeezed), s = max_of(Real(at.gap), least_gap * R);
    if (!(s < s_c)) return {};
    const Real3 n = Real3(at.n);
    const Real v_n = dot(v, n);
    ContactForce out{(-6 * kPi * mu * R * R * (1 / s - 1 / s_c) * v_n) * n, {}, {}};
    const Real s_t = min_of(cut_off * R, sheared);
    if (!shears || !(s < s_t)) return out;
    const Real scale = Real(0.4) * kPi * mu * R * std::log(s_t / s), q = at.skew;
    const Real3 u = v - v_n * n - cross(at.arm_i * omega_i + at.arm_j * omega_j, n),
                w = R * cross(omega_i - omega_j, n);
    const Real3 f = scale * ((5 + 3 * q * q) * u + (6 * q) * w),
                g = (scale * R) * ((6 * q) * u + Real(12) * w);
    out.force -= f;
    out.torque_i = cross(n, at.arm_i * f - g);
    out.torque_j = cross(n, at.arm_j * f + g);
    return out;
  }

 private:
  static constexpr double kFar = 1e30;
  static constexpr double kSqueezed = 2.0 / 3, kSheared = 0.5;  ///< nodes [nguyen02]
};

}  // namespace BL_SOLVER
