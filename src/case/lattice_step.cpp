#include "bedload/case/lattice_step.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/case/formula.hpp"

namespace bedload {
namespace {

constexpr double kForceStep = 1e-3;         // of a node, by the body force from rest in a step, twice that
constexpr double kHydrostaticRange = 0.05;  // relative density by the weight of the fluid

/// The largest body force on the fluid, m/s2.
double largest_acceleration(const Config& c) {
  double drive = norm(c.drive.f);
  if (c.drive.mode == DriveMode::volume) drive /= c.fluid.rho0;
  const double gravity = norm(gravity_on_fluid(c));
  if (drive == 0) return gravity;
  const Formula factor(c.drive.factor, "xyzt");
  double most = 0;
  constexpr int looks = 1000;
  for (int k = 0; k <= looks; ++k) most = std::max(most, std::abs(factor({}, c.time.end * k / looks)));
  return gravity + most * drive;
}

/// Pressure by gravity between walls over the density, m2/s2.
double static_head(const Config& c) {
  double head = 0;
  for (int k = 0; k < 3; ++k)
    if (!c.domain.periodic[k]) head += std::abs(gravity_on_fluid(c)[k]) * (c.domain.max[k] - c.domain.min[k]);
  return head;
}

}  // namespace

std::int64_t cells_along(const Config& c, int axis) {
  return std::max<std::int64_t>(1, std::llround((c.domain.max[axis] - c.domain.min[axis]) / c.fluid.dx));
}

bool has_outer_nodes(const Config& c, int axis) {
  return !c.domain.periodic[axis] || (axis == 2 && c.domain.sheared());
}

Vec3d gravity_on_fluid(const Config& c) { return c.grain.present && !c.grain.fixed ? Vec3d{} : c.gravity; }

LatticeStep lattice_step(const Config& c) {
  const LatticeConfig& l = c.lattice;
  const double dx = c.fluid.dx, nu = c.fluid.mu / c.fluid.rho0;
  LatticeStep step;
  const auto limit = [&](Limit by, double seconds) {
    step.limits.push_back({.limit = by, .seconds = seconds});
  };
  if (l.tau > 0) {
    limit(Limit::fixed_relaxation, (l.tau - 0.5) * dx * dx / (3 * nu));
  } else {
    limit(Limit::flow_speed, l.velocity * dx / c.fluid.vmax);
    limit(Limit::relaxation, (l.tau_max - 0.5) * dx * dx / (3 * nu));
    if (const double a = largest_acceleration(c); a > 0)
      limit(Limit::body_force, std::sqrt(kForceStep * dx / a));
    if (const double head = static_head(c); head > 0)
      limit(Limit::static_head, dx * std::sqrt(kHydrostaticRange / (3 * head)));
  }
  step.limits = with_binding(std::move(step.limits));
  step.dt = least_of(step.limits).seconds;
  step.tau = 0.5 + 3 * nu * step.dt / (dx * dx);
  step.vmax = c.fluid.vmax * step.dt / dx;
  step.sound = dx / step.dt / std::sqrt(3.0);
  return step;
}

}  // namespace bedload
