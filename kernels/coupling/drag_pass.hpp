#pragma once
#include "kernels/bodies/clump_drag.hpp"
#include "kernels/contact/grain_mass.hpp"
#include "kernels/coupling/interpolation_pass.hpp"
#include "kernels/coupling/own_wake.hpp"
#include "kernels/integrate/grain_fields.hpp"

namespace BL_SOLVER {

/// Torque of a viscous fluid on a spinning sphere per relative spin, N m s: Kirchhoff's law, then
/// the fit of Dennis et al. (1980) above a rotational Reynolds number of 32 [dennis80].
BL_HD Real spin_drag(Real d, Real rho, Real mu, Real spin) {
  const Real Re = rho * d * d * spin / mu;
  if (Re < 32) return kPi * mu * cube(d);
  const Real r = Real(0.5) * d;
  return Real(0.5) * rho * square(square(r)) * r * (Real(12.9) / std::sqrt(Re) + Real(128.4) / Re) * spin;
}

/// A drag coefficient that grows by `slope` with the slip, kg/s and kg/m.
struct DragLine {
  Real still, slope;
  bool limited = false;  ///< the law falls with the slip, or grows faster than in proportion to it
  BL_HD Real at(Real slip) const { return still + slope * slip; }
};

/// The line through a law at the mean of |u| and at sum phi u2 / sum phi |u|. Exact for Ergun's law, for
/// equal slips, and for a jet in fluid at rest. Neither its slope nor its start is negative.
template <class K>
BL_HD DragLine drag_line(const K& law, Real mean, Real fast) {
  const Real top = law(fast);
  // closer than this the difference is round-off
  if (!(fast - mean > Real(1e-3) * fast)) return {top, 0};
  const Real steep = (top - law(mean)) / (fast - mean), slope = clamp(steep, Real(0), top / fast);
  return {top - slope * fast, slope, std::abs(steep - slope) > Real(1e-3) * top / fast};
}

/// By how much the couple of a grain can raise the reaction to a force at its centre: particle a gets up to
/// 1 + off_centre |r_a - r_j - arm| <= at_centre + off_centre |r_a - r_j| times its fraction, all particles
/// together `sum` times the force.
struct DragLevers {
  Span<Real> at_centre, off_centre;  ///< -, 1/m
  Span<Real> sum;
};

/// phi_ja K_ja / K_j, the fraction of a grain's drag that acts on a fluid particle, per V_a W: `still`, plus
/// `by_slip` where drag follows the slip of each particle |v_a - v_j|.
struct DragWeights {
  Span<Real> still;
  Span<Real4> by_slip;  ///< the grain's velocity, m/s; w: s/m
};
template <class N>
BL_HD N slip_weight(const Vec3<N>& v_a, const Vec4<N>& by_slip) {
  return by_slip.w * root(norm2(v_a - by_slip.xyz()));
}

/// Whose drag a grain has: its own, or its share, by volume, of that of its clump, which is taken for a
/// sphere of the same volume.
struct DragBodies {
  VolumePerR3 volume_per_r3;
  Span<const Real> radius;
  Span<const Real> clump_d;  ///< of the sphere of its clump's volume, m, 0: it has its own; empty: all have
  Span<const std::uint32_t> clump = {};  ///< of each grain 1 + its clump
  Span<const MemberSum> fluid = {};      ///< of each clump, by FluidTerms
  BL_HD bool clumped(Index j) const { return clump_d && clump_d[j] > 0; }
  BL_HD Real diameter(Index j) const { return clumped(j) ? clump_d[j] : 2 * radius[j]; }
  BL_HD Real share(Index j) const {
    return clumped(j) ? Real(volume_per_r3(j)) * cube(radius[j]) / (kPi / 6 * cube(clump_d[j])) : Real(1);
  }
  /// Of the whole body, m3.
  BL_HD Real volume(Index j) const {
    return clumped(j) ? kPi / 6 * cube(clump_d[j]) : 4 * kPi / 3 * cube(radius[j]);
  }
};

/// What the drag law knows of the fluid around a body.
struct FluidAround {
  Real slip;  ///< the mean of |u|, or the norm of the mean of u, m/s
  Real fast;  ///< sum phi u2 / sum phi |u|, m/s; for local slip
  Real eps, bed, rho;
};

/// Finds it for single grains, and for clumps as means over their grains, by wet volume.
template <bool Local>
struct FluidOfDrag {
  DragBodies bodies;
  Span<const Real> eps, bed_eps;
  GrainSurroundings surroundings;

  /// The mean of |u|, or the norm of the mean of u, at this grain, m/s.
  BL_HD Real mean_slip(Index j) const {
    const Real inv_S = surroundings.inv_S[j];
    if constexpr (Local)
      return inv_S * Real(surroundings.fast[j].weight);
    else
      return inv_S * norm(surroundings.flow[j].u);
  }
  BL_HD Real fast_slip(Index j) const {
    if constexpr (Local)
      return surroundings.fast_slip[j];
    else
      return 0;
  }
  BL_HD FluidAround operator()(Index j) const {
    if (bodies.clumped(j) && Index(bodies.clump[j] - 1) < bodies.fluid.size) {
      const MemberSum& sum = bodies.fluid[bodies.clump[j] - 1];
      if (sum.a.w > 0) return of(sum);
    }
    return {mean_slip(j), fast_slip(j), eps[j], bed_eps[j], surroundings.rho[j]};
  }

 private:
  BL_HD static FluidAround of(const MemberSum& sum) {
    const double per = 1 / sum.a.w;
    const Vec3d u = per * sum.a.xyz();
    const Vec3d mean = per * sum.b.xyz();
    return {Real(Local ? u.x : norm(u)), Real(Local ? u.y : 0.0), Real(mean.x), Real(mean.y), Real(mean.z)};
  }
};

/// Terms of the means over a clump. a: the mean of u, or that of |u| and what FluidAround::fast is, and the
/// weight; b: porosities and density.
template <bool Local>
struct FluidTerms {
  FluidOfDrag<Local> fluid;
  Span<const Real> wetness;
  BL_HD MemberSum operator()(Index j) const {
    if (!fluid.bodies.clumped(j)) return {};
    const double weight = double(wetness[j]) * double(fluid.bodies.share(j));
    if (!(weight > 0)) return {};
    Vec3d u{double(fluid.mean_slip(j)), double(fluid.fast_slip(j)), 0};
    if constexpr (!Local) u = Vec3d(fluid.surroundings.inv_S[j] * fluid.surroundings.flow[j].u);
    u *= weight;
    return {{u.x, u.y, u.z, weight},
            {weight * double(fluid.eps[j]), weight * double(fluid.bed_eps[j]),
             weight * double(fluid.surroundings.rho[j]), 0}};
  }
};

/// How drag follows the slip of the fluid around each grain.
template <class Law, bool Local>
struct DragLines {
  Law law;
  Real mu;      ///< Pa s
  bool shares;  ///< whether grains displace fluid; else its velocity is the flux
  OwnWake wake;
  Span<const Real> shrink;  ///< of OwnAverages; empty: all have the kernel's length
  FluidOfDrag<Local> fluid;

  /// Near an orifice the law is evaluated with the porosity of the bed, at the actual flux.
  BL_HD DragLine of(Index j) const {
    const FluidAround at = fluid(j);
    const Real d = fluid.bodies.diameter(j), rho = at.rho, share = fluid.bodies.share(j);
    const OwnWake own = shrink ? wake.with(shrink[j]) : wake;
    const Real bed = own.porosity(at.bed, fluid.bodies.volume(j));
    const Real ratio = (shares ? at.eps : Real(1)) / bed;
    const auto by_law = [&](Real w) { return share * ratio * law.K(bed, d, rho, mu, ratio * w); };
    const auto coefficient = [&](Real w) {
      Real K = by_law(w);
      if (!(own.mobility > 0)) return K;
      const Real undisturbed = w / (1 - own.fraction(K, w, bed, rho, mu));
      K = by_law(undisturbed);
      return K / (1 - own.fraction(K, undisturbed, bed, rho, mu));
    };
    if constexpr (Local)
      return drag_line(coefficient, at.slip, at.fast);
    else
      return {coefficient(at.slip), 0};
  }
};

/// Translational and rotational drag coefficients of each grain, times its wetness, and the fluid motion that
/// they refer to: mean velocity and rotation of the fluid weighted with phi K_ja / K_j, K_j = sum phi K_ja.
/// With the couple the velocity is that of this motion at the grain's centre, where the force acts. Local:
/// the law is evaluated at the slip of each particle, so that a jet acts with its own speed; else at the mean
/// slip.
template <class Law, bool Local>
struct DragPass {
  DragLines<Law, Local> lines;
  bool torque;  ///< whether the fluid exerts torque on grains
  bool couple;  ///< whether the reaction has a couple
  Span<const Real> wetness;
  Span<const Real3> v, omega;
  DragWeights weights;
  DragFields drag;
  DragLevers levers;

  BL_HD void operator()(Index j) const {
    const GrainSurroundings& surroundings = lines.fluid.surroundings;
    const Real wet = wetness[j], inv_S = surroundings.inv_S[j];
    FlowSums<> flow = surroundings.flow[j];
    Real k = 0;
    DragLine line{1, 0};
    if (wet > 0) {
      const DragLine law_line = lines.of(j);
      k = law_line.at(lines.fluid.mean_slip(j));
      if (k > 0) line = {law_line.still / k, law_line.slope / k};
    }
    drag.coefficient[j] = wet * k;
    weights.still[j] = inv_S * line.still;
    if constexpr (Local) {
      weights.by_slip[j] = {v[j], inv_S * line.slope};
      flow = flow.blend(line.still, surroundings.fast[j], line.slope);
    }
    drag.velocity[j] = v[j] + inv_S * flow.u;
    drag.rotation[j] = {};
    drag.rot_coefficient[j] = 0;
    const Carriers& carriers = surroundings.drag;
    if (!carriers.inv_M) return;
    const Real spread = carriers.set(j, flow, inv_S);
    drag.rotation[j] = carriers.rotation(j, flow, inv_S);
    if (couple) {
      const Real3 arm = carriers.arm[j];
      drag.velocity[j] -= cross(drag.rotation[j], arm);
      const Real off_centre = norm(arm) * carriers.inv_M[j].norm();
      levers.at_centre[j] = 1 + off_centre * norm(arm);
      levers.off_centre[j] = off_centre;
      levers.sum[j] = 1 + off_centre * spread;
    }
    if (torque && wet > 0 && carriers.inv_M[j].trace() > 0)
      drag.rot_coefficient[j] = wet * lines.fluid.bodies.share(j) *
                                spin_drag(lines.fluid.bodies.diameter(j), surroundings.rho[j], lines.mu,
                                          norm(drag.rotation[j] - omega[j]));
  }
};

}  // namespace BL_SOLVER
