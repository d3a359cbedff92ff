#include "remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bedload/case/contact_laws.hpp"
#include "bedload/case/parameters.hpp"
#include "bedload/case/particle_order.hpp"
#include "src/viscometer/plane_flow.hpp"

namespace bedload {
namespace {

using Remarks = std::vector<Remark>;

/// Numerical viscosities as multiples of that of the fluid; density diffusion, which is none.
void add_viscosity(Remarks& all, const Config& c, const std::vector<Quantity>& numerical) {
  if (numerical.empty()) return;
  std::string out = fmt::format("{:.3g} m2/s", c.fluid.mu / c.fluid.rho0);
  bool any = false;
  for (const Quantity& q : numerical) {
    if (!(q.value > 0)) continue;
    std::string name = q.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    out += fmt::format("{} {} {:.3g} times the physical", any ? "," : "; numerical:", name, q.value);
    any = true;
  }
  all.push_back({"viscosity", out + (any ? "" : ", none of it numerical")});
  if (c.density.delta > 0)
    all.push_back(
        {"density",
         fmt::format("diffusion of {:.3g} m2/s (density.delta) smooths the pressure; it adds no viscosity",
                     c.density.delta * c.fluid.h() * c.fluid.c)});
}

/// The spurious shear stress of a particle lattice under pressure, and whether pressure.linear_exact removes
/// it.
void add_arrangement(Remarks& all, const Config& c) {
  if (!c.fluid.present || c.fluid.mu == 0 || c.fluid.variable_h || !c.fluid.model->smoothed) return;
  const double pressure = c.fluid.rho0 * norm(c.gravity) * c.fluid.depth + c.eos.background;
  if (pressure == 0) return;
  const double stress = 5e-3 * pressure;  // 2e-3 to 1e-2 on lattices, h = 1.5 dx
  const std::string out = fmt::format(
      "at {:.3g} Pa the particle lattice resists shear with up to about {:.2g} Pa, as much as "
      "viscosity at {:.2g} 1/s; ",
      pressure, stress, stress / c.fluid.mu);
  if (const ParticleOrder order = particle_order(c); !order.linear_exact)
    return all.push_back({"lattice", out + "not removed: " + order.not_exact});
  const double cell = cell_reynolds_number(std::sqrt(pressure / c.fluid.rho0), c.fluid);
  const char* what = cell < kExactPressure                        ? "pressure.linear_exact removes it"
                     : cell < kExactPressure * kExactPressureEnds ? "pressure.linear_exact removes part of it"
                                                                  : "not removed, slower flow is held by it";
  all.push_back({"lattice", out + fmt::format("{} (cell Reynolds number {:.3g}, removed below {:g})", what,
                                              cell, kExactPressure)});
}

/// Why particles do not shift although the case has shift.A.
void add_shifting(Remarks& all, const Config& c) {
  if (!c.fluid.present || c.shift == 0 || !c.fluid.model->smoothed) return;
  const ParticleOrder order = particle_order(c);
  if (!order.shifts) all.push_back({"shifting", "none: " + order.no_shifting});
}

/// Effects of defaults that do not suit every case.
void add_defaults(Remarks& all, const Config& c, bool free_surface) {
  const auto add = [&](const char* about, const std::string& what) { all.push_back({about, what}); };
  const bool grains = c.grain.present && c.fluid.present && c.couple.mode != CouplingMode::off;
  if (c.fluid.present && c.fluid.model->smoothed && c.density.cavitation_limit < 1)
    add("tension",
        fmt::format("fluid cavitates below {:.3g} Pa (density.cavitation_limit; diagnostics.csv counts "
                    "the particles){}",
                    c.eos.background - c.density.cavitation_limit * c.fluid.rho0 * c.fluid.c * c.fluid.c,
                    c.wall.suction ? "; above that it sticks to lids and roofs" : ""));
  if (free_surface && c.fluid.mu > 0 && c.visc.model == ViscosityModel::morris && norm(c.gravity) > 0)
    add("waves",
        "visc.model = \"morris\" damps waves at a free surface half as fast as fluid.mu should; use "
        "\"monaghan\" for waves");
  if (grains && c.couple.mode == CouplingMode::two_way && !c.couple.undisturbed && !c.domain.two_d)
    add("wake", fmt::format("a single grain drags the fluid around it along at up to {:.2g} % of its speed; "
                            "couple.undisturbed corrects its drag for that",
                            100 * 0.537 * c.grain.d_max * c.fluid.kappa() / c.farthest_average()));
  if (c.grain.present && takes_moduli(c.contact.normal) && c.grain.E < 1e9)
    add("contacts",
        fmt::format(
            "grain.E = {:.3g} Pa is softer than stone, glass or steel: impacts last longer with larger "
            "overlap, which also changes rotation",
            c.grain.E));
}

/// Remarks on coarse resolution.
void add_resolution(Remarks& all, const Config& c) {
  const FluidConfig& f = c.fluid;
  const auto add = [&](const char* about, const std::string& what) { all.push_back({about, what}); };
  if (!f.present) return;
  constexpr double few = 10;  // particles
  Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  for (const FluidFill& fill : f.fills)
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], fill.min[k]), hi[k] = std::max(hi[k], fill.max[k]);
  int thinnest = -1;
  for (int k = 0; k < 3; ++k)
    if (!f.fills.empty() && !c.domain.periodic[k] && !c.domain.flat(k) &&
        (thinnest < 0 || hi[k] - lo[k] < hi[thinnest] - lo[thinnest]))
      thinnest = k;
  if (const double across = thinnest < 0 ? few : (hi[thinnest] - lo[thinnest]) / f.dx;
      across < few * (1 - 1e-9))
    add("resolution",
        fmt::format("the fluid is {:.2g} particles across along {}; use at least {:g} across any "
                    "flow of interest",
                    across, "xyz"[thinnest], few));
  if (const double neighbours = f.kappa() * f.h_over_dx / 2;
      !f.variable_h && f.model->smoothed && neighbours < 1.3 * (1 - 1e-9))
    add("kernel", fmt::format("kernel radius {:.3g} fluid.dx; below 2.6 the particle lattice causes noise "
                              "(fluid.h_over_dx)",
                              2 * neighbours));
  for (const WallBody& body : c.wall.bodies) {
    if (!body.free.present || !body.free.fluid) continue;
    const Vec3d side = body.max - body.min;
    double thick = 1e300;
    for (int k = 0; k < 3; ++k)
      if (!c.domain.flat(k)) thick = std::min(thick, side[k]);
    if (thick < 8 * f.dx * (1 - 1e-9))
      add("resolution", fmt::format("wall.body \"{}\" is {:.2g} fluid.dx thick; the flow around a free body "
                                    "is resolved from 8, compare two resolutions",
                                    body.name, thick / f.dx));
  }
}

/// What costs accuracy or time with grains.
void add_grains(Remarks& all, const Config& c) {
  if (!c.grain.present) return;
  if (const double ratio = c.grain.d_max / c.grain.d_min;
      ratio > 5 * (1 + 1e-9) && c.fluid.present && c.couple.mode != CouplingMode::off && !c.own_lengths())
    all.push_back(
        {"sizes",
         fmt::format("the largest grain is {:.3g} times the smallest: couple.hc follows the largest, "
                     "so each fluid particle is coupled to many of the smallest; couple.own_hc = true gives "
                     "each grain its own",
                     ratio)});
  if (!c.fluid.present || c.couple.mode != CouplingMode::two_way || norm(c.gravity) == 0) return;
  for (const auto& kind : kNames<WallType>)
    if (kind.bed_error > 0 && std::any_of(c.wall.bodies.begin(), c.wall.bodies.end(),
                                          [&](const WallBody& body) { return body.type == kind.value; }))
      all.push_back(
          {"bed",
           fmt::format("on {} walls the buoyancy of a thin bed is {} % too low; with \"adami\" or \"mdbc\" "
                       "it is right within 1 %",
                       kind.name, int(kind.bed_error))});
}

/// Fluid that rests on a reflecting side of the domain.
void add_mirrors(Remarks& all, const Config& c) {
  if (!c.fluid.present) return;
  for (int k = 0; k < 3; ++k) {
    const std::size_t below = 2 * std::size_t(k) + (c.gravity[k] > 0);
    if (c.gravity[k] != 0 && (c.domain.reflect.slip[below] || c.domain.reflect.no_slip[below]))
      return all.push_back(
          {"mirror",
           fmt::format("fluid rests on the reflecting side {} of the domain: its lowest layer collapses and "
                       "the pressure gradient is off by up to 2 rho g; use a wall",
                       kFaces[below])});
  }
}

/// Whether a plane shear flow is suitable for `bedload viscometer`.
void add_viscometer(Remarks& all, const Config& c) {
  try {
    const PlaneFlow flow = plane_flow_of(c);
    blocks_until(flow, c.fluid.mu / c.fluid.rho0, c.time.end);
    all.push_back({"viscometer", flow.name() + " flow; run `bedload viscometer` to measure its viscosity"});
  } catch (const NoPlaneFlow&) {
  } catch (const KeyError& error) {
    all.push_back({"viscometer", std::string("not suitable for `bedload viscometer`: ") + error.what()});
  }
}

}  // namespace

std::vector<Remark> remarks_on(const Config& c, const std::vector<Quantity>& numerical, bool free_surface) {
  Remarks all;
  add_viscosity(all, c, numerical);
  add_resolution(all, c);
  add_arrangement(all, c);
  add_shifting(all, c);
  add_defaults(all, c, free_surface);
  add_grains(all, c);
  add_mirrors(all, c);
  add_viscometer(all, c);
  return all;
}

}  // namespace bedload
