#include "src/solids/parameters.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/case/config.hpp"

namespace BL_SOLVER {
namespace {

/// Between grains of two materials.
ContactLaw law_between(const GrainMaterial& a, const GrainMaterial& b, const Config& config) {
  const ElasticCompliance i(a.E, a.nu), j(b.E, b.nu);
  const SurfacePair both = surfaces(a, b, config.contact);
  return make_contact_law({.normal = i.normal + j.normal,
                           .tangential = i.tangential + j.tangential,
                           .nu = 0.5 * (a.nu + b.nu),
                           .mu = both.mu,
                           .mu_r = both.mu_r,
                           .e = both.e,
                           .contact = config.contact});
}

/// The same between grains and a wall body.
ContactLaw law_between(const GrainMaterial& material, const WallBody& body, const Config& config) {
  const Elasticity of_wall = wall_elasticity(body, config.grain);
  const ElasticCompliance grain(material.E, material.nu), wall(of_wall.E, of_wall.nu);
  const SurfacePair both = surfaces(material, body, config.grain, config.contact);
  return make_contact_law({.normal = grain.normal + wall.normal,
                           .tangential = grain.tangential + wall.tangential,
                           .nu = 0.5 * (material.nu + of_wall.nu),
                           .mu = both.mu,
                           .mu_r = both.mu_r,
                           .e = both.e,
                           .contact = config.contact});
}

WearGrid patches_of(const WallBody& body, const Config& config) {
  if (body.wear == WearLaw::none) return {};
  const WearPatches patches(body, config.domain, config.grain.largest());
  WearGrid grid{.lo = patches.lo, .size = patches.size, .k_over_H = body.k_over_H, .law = body.wear};
  for (int k = 0; k < 3; ++k) grid.count[k] = int(patches.count[k]);
  return grid;
}

}  // namespace

SolidParameters solid_parameters(const Config& config) {
  const GrainConfig& g = config.grain;
  SolidParameters p{
      .materials = g.all_materials(),
      .d_max = g.largest(),
      .d_min = g.smallest(),
      .skin = config.skin_grain * g.smallest(),
      .contacts = config.contact.normal != NormalLaw::none,
      .films = config.fluid.lattice() ? Lubrication::of(config.lubrication, config.fluid.mu, config.fluid.dx)
                                      : Lubrication::of(config.lubrication, config.fluid.mu),
      .gravity = config.gravity,
      .fixed = g.fixed,
      .exponential = config.couple.integrator == DragIntegrator::exponential,
      .drag_fraction = config.time.drag,
      .limits = SubstepLimits(config),
      .reflect = config.domain.reflect,
      .plane = config.domain.two_d,
      .energy = config.out.energy || config.out.spectra || config.wall.wears(),
      .spectra = {config.out.spectra_from, config.out.spectra_from_force,
                  config.out.spectra ? int(config.out.spectra_bins) : 0, config.out.spectra_sizes},
      .shear_rate = config.domain.shear_rate,
      .single_forces = config.out.contacts != ContactFrames::none,
      .near_gap = config.out.contacts == ContactFrames::all
                      ? std::min(0.1, config.skin_grain / 3) * g.smallest()
                      : 0};
  for (const GrainMaterial& a : p.materials)
    for (const GrainMaterial& b : p.materials) p.pair_laws.push_back(law_between(a, b, config));
  for (const WallBody& body : config.wall.bodies)
    for (const GrainMaterial& m : p.materials) p.wall_laws.push_back(law_between(m, body, config));
  if (config.wall.wears())
    for (const WallBody& body : config.wall.bodies) p.wear.push_back(patches_of(body, config));
  for (const int k : g.rigid_fills()) {
    const GrainFill& fill = g.fills[k];
    p.clumps.push_back({k, g.material(fill.material), fill.velocity, fill.rigid});
  }
  for (const int k : g.clump_fills())
    p.clumps.push_back({.fill = k,
                        .material = g.material_of(k),
                        .shape = g.clump_of(g.fills[k])->shape,
                        .density = g.density(g.fills[k]),
                        .spheres = std::uint32_t(g.clump_of(g.fills[k])->shape.spheres.size()),
                        .shares_drag = g.clump_of(g.fills[k])->shares_drag()});
  for (const ClumpConfig& clump : g.clumps)
    for (const std::string& of : clump.dropped)
      p.clumps.push_back({.fill = -1,
                          .material = g.material_of_dropped(clump.name, of),
                          .shape = clump.shape,
                          .density = g.density(clump.name, of),
                          .spheres = std::uint32_t(clump.shape.spheres.size()),
                          .shares_drag = clump.shares_drag()});
  return p;
}

}  // namespace BL_SOLVER
