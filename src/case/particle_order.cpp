#include "bedload/case/particle_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "bedload/case/config.hpp"

namespace bedload {

double cell_reynolds_number(double speed, const FluidProperties& fluid) {
  return fluid.mu > 0 ? speed * fluid.dx * fluid.rho0 / fluid.mu : std::numeric_limits<double>::infinity();
}

ParticleOrder particle_order(const Config& c) {
  const bool viscous = c.visc.model != ViscosityModel::none;
  const double flow =
      viscous ? cell_reynolds_number(c.fluid.vmax, c.fluid) : std::numeric_limits<double>::infinity();
  const std::string fast = fmt::format(
      "the fastest flow has a cell Reynolds number of {:.2g}, not below {:g}", flow, kViscousFlow);
  const bool layers = std::any_of(c.wall.bodies.begin(), c.wall.bodies.end(),
                                  [](const WallBody& body) { return body.single_layer(); });
  const bool mixed = c.grain.present && c.couple.mode == CouplingMode::two_way;

  ParticleOrder order;
  if (!c.fluid.model->smoothed)
    order.no_shifting = fmt::format("fluid.model = \"{}\" has none", c.fluid.model.name());
  else if (c.shift == 0)
    order.no_shifting = "shift.A is 0";
  else if (layers)
    order.no_shifting = "walls are single layers";
  else if (mixed && flow >= kViscousFlow)
    order.no_shifting = "there are grains, and " + fast;
  order.shifts = order.no_shifting.empty();

  if (!c.pressure.linear_exact)
    order.not_exact = "pressure.linear_exact is false";
  else if (c.fluid.variable_h)
    order.not_exact = "fluid.variable_h is on";
  else if (!order.shifts)
    order.not_exact = "particles do not shift: " + order.no_shifting;
  else if (!viscous)
    order.not_exact = "the fluid has no viscosity";
  else if (flow >= kViscousFlow)
    order.not_exact = fast;
  order.linear_exact = order.not_exact.empty();
  return order;
}

}  // namespace bedload
