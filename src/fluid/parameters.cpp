#include "src/fluid/parameters.hpp"

#include <algorithm>

#include "bedload/case/config.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/boundaries/orifices.hpp"

namespace BL_SOLVER {
namespace {

/// The force of a single layer, with the strength K = D / 5 of the softer one. Its particles weigh as much as
/// the wall for which they stand.
LayerLaw layer_law(const Config& config, const WallBody& body) {
  const double dx = config.fluid.dx, spacing = config.wall.spacing(body), D = config.wall.rep_D;
  LayerLaw law;
  switch (body.force) {
    case LayerForce::monaghan:
      law.steep = {Real(D), Real(config.wall.layer_r0 > 0 ? config.wall.layer_r0 : dx), Real(1e30)};
      return law;
    case LayerForce::kajtar:
      break;
  }
  double volume = 0;
  with_fluid_kernel(config.fluid, config.domain, [&](const auto& w) {
    volume = spacing * config.domain.spacing_along(1, spacing) * layer_depth(w);
  });
  const double fraction = 2 * volume / (config.domain.cell_volume(dx) + volume), beta = dx / spacing;
  law.soft = {Real(D / 5 / beta * fraction), Real(config.fluid.kappa() * config.fluid.h() / 2)};
  return law;
}

void add_walls(const Config& config, FluidParameters& p) {
  const std::vector<WallBody>& bodies = config.wall.bodies;
  p.repulsion = {Real(config.wall.rep_D), Real(config.wall.rep_r0), 0};
  p.suction = config.wall.suction;
  p.energy_consistent = config.wall.energy_consistent && config.wall.suction &&
                        config.time.integrator == TimeIntegrator::kdk && config.fluid.model->wall_work &&
                        !config.fluid.variable_h && !bodies.empty() &&
                        std::all_of(bodies.begin(), bodies.end(),
                                    [](const WallBody& body) -> bool { return body.type->wall_work; });
  bool layered = false;
  for (const WallBody& body : bodies) {
    p.repelled = p.repelled || body.repels() || body.no_penetration;
    p.frozen = p.frozen || body.type->kind == WallKind::frozen;
    layered = layered || body.single_layer();
  }
  p.orifices = orifices_of(config.inlets, bodies.size(), config.fluid.dx, config.domain);
  if (!layered) return;
  p.layers.resize(bodies.size() + config.inlets.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].single_layer()) p.layers[b] = layer_law(config, bodies[b]);
}

}  // namespace

FluidParameters fluid_parameters(const Config& config) {
  FluidParameters p{.fluid = config.fluid,
                    .several = !config.fluid.species.empty(),
                    .domain = config.domain,
                    .eos = config.eos,
                    .pressure = config.pressure,
                    .density = config.density,
                    .visc = config.visc,
                    .sdpd = config.sdpd,
                    .drive = config.drive,
                    .time = config.time,
                    .xsph = config.xsph,
                    .shift = config.shift,
                    .order = particle_order(config),
                    .tensile = config.tensile,
                    .tensile_one_sign = config.tensile_one_sign,
                    .skin = config.skin_fluid * config.fluid.dx,
                    .seed = config.seed,
                    .block = int(config.block),
                    .mixed = config.grain.present && config.couple.mode == CouplingMode::two_way};
  p.thickens = p.mixed && config.couple.suspension != SuspensionLaw::none;
  if (p.mixed) p.spreading = config.couple.spreading;
  add_walls(config, p);
  return p;
}

}  // namespace BL_SOLVER
