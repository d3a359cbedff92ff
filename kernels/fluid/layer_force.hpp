#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/fluid/pair_terms.hpp"
#include "kernels/fluid/views.hpp"
#include "kernels/fluid/wall_repulsion.hpp"

namespace BL_SOLVER {

/// Depth of wall (m) for which one layer of particles stands: with the mass of that depth, Morris pairs
/// between the layer and a linear shear flow next to it carry the shear stress of that flow. One over the
/// integral of F |z|, which by symmetry is half that of F r.
template <class W>
double layer_depth(const W& w) {
  constexpr int shells = 4000;
  const double step = double(w.kappa) * double(w.h) / shells, slab = double(w.thickness);
  double sum = 0;
  for (int k = 0; k < shells; ++k) {
    const double r = (k + 0.5) * step;
    const double round = slab > 0 ? 4 * slab : 2 * double(kPi) * r;  // of |z| / r over the shell
    sum += round * r * r * double(w.F(Real(r))) * step;
  }
  return 1 / sum;
}

/// Soft repulsion between particles (Monaghan and Kajtar 2009): strength W(r/h) / r, with their W.
struct SoftRepulsion {
  Real strength = 0, h = 1;  ///< K / beta times the factor of the masses, m2/s2; m
  /// Acceleration away from the wall particle, m/s2.
  BL_HD Real operator()(Real r) const {
    const Real q = r / h;
    if (q >= 2) return 0;
    const Real t = 2 - q;
    return strength * Real(1.77 / 32) * (1 + Real(2.5) * q + 2 * q * q) * square(square(t)) * t /
           max_of(r, Real(1e-3) * h);
  }
};

/// How the particles of one body push fluid away: by one of the two, the other being zero; not at all where
/// the body is no single layer.
struct LayerLaw {
  Repulsion steep;
  SoftRepulsion soft;
  BL_HD Real operator()(Real r) const { return steep(r) + soft(r); }
};

/// Force of single-layer walls on the fluid: repulsion, and artificial viscosity as within the fluid, without
/// which particles would bounce undamped.
template <class W>
struct LayerForces {
  W w;
  ArtificialViscosity artificial;
  Span<const LayerLaw> law;  ///< one a body
  Real cap;                  ///< m/s2
  Span<const BodyPose> pose;

  struct Acceleration {
    Real3 push, damping;  ///< m/s2
    BL_HD void add(const Acceleration& other) {
      push += other.push;
      damping += other.damping;
    }
  };
  /// Of fluid with {v, rho} at r from a wall particle of `body` with its own {v, rho}.
  BL_HD Acceleration operator()(const VelocityDensity<>& va, const VelocityDensity<>& vb, std::uint32_t body,
                                const Real3& r, Real r2) const {
    const BodyPose& k = pose[body];
    if (k.kind != WallKind::single_layer || !k.present || r2 == 0) return {};
    const Real distance = std::sqrt(r2);
    Acceleration out{min_of(law[body](distance), cap) / distance * r, {}};
    if (artificial.acts()) {
      const Real rho_mean = Real(0.5) * (va.rho + vb.rho);
      out.damping =
          artificial.term(vb.rho * Real(k.volume), dot(va.v - vb.v, r), rho_mean, r2, w.F(distance)) * r;
    }
    return out;
  }
};

/// Adds LayerForces to the stress of the mixture: the repulsion replaces the pressure of the wall.
template <class W>
struct LayerPass {
  LayerForces<W> layer;
  Span<const VelocityDensity<>> flux, wall_v_rho;
  Span<const std::uint32_t> wall_body;
  FluidAccelerations out;

  struct Sum {
    VelocityDensity<> v;
    typename LayerForces<W>::Acceleration given;
  };
  BL_HD Sum start(Index a) const { return {flux[a], {}}; }
  BL_HD auto sources() const { return sources_of(wall_v_rho, wall_body); }
  BL_HD void pair(Sum& sum, const Real3& r, Real r2, Real, const VelocityDensity<>& vb,
                  std::uint32_t body) const {
    sum.given.add(layer(sum.v, vb, body, r, r2));
  }
  BL_HD void merge(Sum& into, const Sum& other) const { into.given.add(other.given); }
  BL_HD void finish(Index a, const Sum& sum) const { out.add(a, sum.given.push + sum.given.damping); }
};

}  // namespace BL_SOLVER
