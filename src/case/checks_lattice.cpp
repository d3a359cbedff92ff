// Fluid on the nodes of a lattice against the rest of a case.

#include <cmath>

#include "bedload/case/lattice_step.hpp"
#include "checks.hpp"

namespace bedload {

void Checks::lattice() const {
  const char* with = "with fluid.model = \"lattice\"";
  if (c.preset != Preset::standard)
    fail("preset", quoted(c.preset.name()), fmt::format("must be left out {}", with));
  if (c.grain.present) lattice_grains();
  if (c.drive.mode == DriveMode::particle)
    fail("drive.mode", quoted(c.drive.mode.name()), fmt::format("must be \"volume\" or \"mass\" {}", with));
  double nodes = 1;
  for (int k = 0; k < 3; ++k) {
    const double side = c.domain.max[k] - c.domain.min[k], cells = double(cells_along(c, k));
    if (std::abs(side - cells * c.fluid.dx) > 1e-6 * c.fluid.dx)
      fail("fluid.dx", c.fluid.dx,
           fmt::format("must divide the domain's length along {}, {:g} m; {:.8g} m does", "xyz"[k], side,
                       side / cells));
    nodes *= cells + (has_outer_nodes(c, k) ? 2 : 0);
  }
  if (nodes >= 2147483648.0)
    fail("fluid.dx", c.fluid.dx,
         fmt::format("must be larger; it makes {:.3g} nodes of at most 2147483647", nodes));
  for (std::size_t i = 0; i < c.fluid.fills.size(); ++i) {
    const std::string path = fmt::format("fluid.fill.{}", i);
    box(path, c.fluid.fills[i].min, c.fluid.fills[i].max);
    inside_domain(path + ".min", c.fluid.fills[i].min);
    inside_domain(path + ".max", c.fluid.fills[i].max);
    initial_speed(c.fluid.fills[i]);
  }
  lattice_walls();
  if (c.domain.sheared()) lattice_shear();
  for (std::size_t i = 0; i < c.out.probes.size(); ++i)
    if (const auto type = c.out.probes[i].type;
        type != ProbeType::point && type != ProbeType::box && type != ProbeType::force)
      fail(fmt::format("probe.{}.type", i), quoted(type.name()),
           fmt::format("must be \"point\", \"box\" or \"force\" {}", with));
  if (c.out.contacts != ContactFrames::none)
    fail("out.contacts", quoted(c.out.contacts.name()), fmt::format("must be \"none\" {}", with));
  if (c.out.spectra) fail("out.spectra", "true", fmt::format("must be false {}", with));
  lattice_step();
}

/// Grains around which the fluid flows.
void Checks::lattice_grains() const {
  const char* with = "with fluid.model = \"lattice\"";
  constexpr double kLeast = 5, kEnough = 8;  // nodes across a grain
  const double across = c.grain.d_min / c.fluid.dx;
  if (across < kLeast * (1 - 1e-9))
    fail("fluid.dx", c.fluid.dx,
         fmt::format("must be at most {:.4g} m, for {:g} nodes across the smallest grain of {:.4g} m",
                     c.grain.d_min / kLeast, kLeast, c.grain.d_min));
  if (across < kEnough * (1 - 1e-9))
    warn("fluid.dx: {:.3g} nodes across the smallest grain; below {:g} drag is off by 1 to 3 %", across,
         kEnough);
  for (std::size_t k = 0; k < c.grain.fills.size(); ++k) {
    if (c.grain.fills[k].rigid.present)
      fail(fmt::format("grain.fill.{}.rigid", k), "[grain.fill.rigid]",
           fmt::format("must be left out {}", with));
    if (c.grain.clump_of(c.grain.fills[k]))
      fail(fmt::format("grain.fill.{}.clump", k), quoted(c.grain.fills[k].clump),
           fmt::format("must be left out {}", with));
    if (c.grain.fills[k].replaces_fluid)
      fail(fmt::format("grain.fill.{}.replaces_fluid", k), "true", fmt::format("must be false {}", with));
  }
  if (!c.grain_inlets.empty())
    fail("grain_inlet.0.name", quoted(c.grain_inlets[0].name), fmt::format("must be left out {}", with));
  if (c.out.energy) fail("out.energy", "true", fmt::format("must be false {}", with));
  if (c.grain.fixed) return;
  for (int k = 0; k < 3; ++k)
    if (c.domain.periodic[k] && c.gravity[k] != 0)
      warn(
          "gravity along {}, which is periodic: the weight of the grains accelerates fluid and grains for "
          "ever, unless "
          "drive.f holds it",
          "xyz"[k]);
  constexpr double kInertia =
      1.25;  // R / dx times the ratio of densities: an explicit step is stable from there
  for (const GrainMaterial& m : c.grain.all_materials())
    if (0.5 * across * m.rho / c.fluid.rho0 < kInertia)
      fail("fluid.dx", c.fluid.dx,
           fmt::format(
               "must be at most {:.4g} m: grains of {:g} kg/m3 are too light for the time step where fewer "
               "nodes lie across them",
               0.5 * c.grain.d_min * m.rho / c.fluid.rho0 / kInertia, m.rho));
}

/// A box whose images move.
void Checks::lattice_shear() const {
  for (const auto& [there, what] :
       {std::pair{!c.wall.bodies.empty(), "[[wall.body]]"},
        {norm(c.gravity) > 0, "gravity"},
        {norm(c.drive.f) > 0, "[drive]"},
        {c.grain.present && c.grain.fixed, "grain.fixed = true"},
        {c.grain.present && c.grain.release_time > 0, "grain.release_time > 0"},
        {c.grain.present && c.grain.settle, "grain.settle = true"},
        {c.grain.present && c.grain.d_max >= 2 * c.grain.d_min, "grains twice as large as others"}})
    if (there)
      fail("domain.shear_rate", c.domain.shear_rate,
           fmt::format("must be 0 with {} and fluid.model = \"lattice\"", what));
  for (int k = 0; k < 3; ++k)
    if (!c.domain.periodic[k])
      fail("domain.periodic", fmt::format("false along {}", "xyz"[k]), "must be true with domain.shear_rate");
  for (std::size_t i = 0; i < c.out.probes.size(); ++i)
    if (c.out.probes[i].type == ProbeType::point)
      fail(fmt::format("probe.{}.type", i), quoted(c.out.probes[i].type.name()),
           "must be another with domain.shear_rate");
}

void Checks::lattice_walls() const {
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    const WallType type = c.wall.bodies[i].type;
    if (type != WallType::adami && type != WallType::fluid_only && type != WallType::grains_only)
      fail(fmt::format("wall.body.{}.type", i), quoted(c.wall.bodies[i].type.name()),
           "must be \"adami\", \"fluid_only\" or \"grains_only\" with fluid.model = \"lattice\", whose walls "
           "have "
           "no particles");
    if (c.wall.bodies[i].wear != WearLaw::none)
      fail(fmt::format("wall.body.{}.wear", i), quoted(c.wall.bodies[i].wear.name()),
           "must be \"none\" with fluid.model = \"lattice\"");
  }
}

void Checks::lattice_step() const {
  const LatticeStep step = bedload::lattice_step(c);
  const char* const key = c.lattice.tau > 0 ? "lattice.tau" : "fluid.dx";
  const double value = c.lattice.tau > 0 ? c.lattice.tau : c.fluid.dx;
  constexpr double least = 0.505, fastest = 0.15;
  if (step.tau < least)
    fail(key, value,
         fmt::format("must be at most {:.3g} m for a relaxation time of {} steps, below which the lattice is "
                     "unstable; it is {:.5g} now, at a step of {:.4g} s",
                     c.fluid.dx * (step.tau - 0.5) / (least - 0.5), least, step.tau, step.dt));
  if (step.vmax > fastest * (1 + 1e-9))
    fail(key, value,
         fmt::format("must be smaller: at its step of {:.4g} s fluid.vmax is {:.3g} nodes a step, at most {} "
                     "are allowed",
                     step.dt, step.vmax, fastest));
  if (step.tau < 0.51)
    warn(
        "the relaxation time is {:.4g} steps; below 0.51 the lattice may become unstable, use a smaller "
        "fluid.dx",
        step.tau);
  if (step.vmax > 0.1)
    warn("fluid.vmax is {:.3g} nodes a step: compressibility errors reach {:.2g} %", step.vmax,
         300 * step.vmax * step.vmax);
  if (const double cell = c.fluid.vmax * c.fluid.dx * c.fluid.rho0 / c.fluid.mu; cell > 10 * (1 + 1e-9))
    warn(
        "the Reynolds number of a cell, fluid.vmax fluid.dx / nu, is {:.3g}; above 10 the flow is not "
        "resolved",
        cell);
}

}  // namespace bedload
