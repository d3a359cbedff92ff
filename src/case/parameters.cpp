#include "bedload/case/parameters.hpp"

#include <fmt/format.h>

#include <cmath>

#include "describe.hpp"

namespace bedload {

std::string Interval::text() const {
  const bool below = std::isfinite(lo), beyond = std::isfinite(hi);
  if (below && beyond && !lo_open && !hi_open) return fmt::format("within {}..{}", lo, hi);
  std::string out;
  if (below) out = fmt::format("{} {}", lo_open ? ">" : ">=", lo);
  if (beyond) out += fmt::format("{}{} {}", below ? " and " : "", hi_open ? "<" : "<=", hi);
  return out;
}

void describe(Parameters& p, Config& c) {
  describe_top(p, c);
  describe_domain(p, c);
  describe_shapes(p, c.shapes);
  const bool particles = of_particles(p, c.fluid);
  if (particles) describe_frame(p, c.frame);
  if (c.fluid.present) describe_fluid(p, c.fluid);
  if (c.fluid.lattice() || p.everything()) describe_lattice(p, c.lattice);
  if (particles) describe_fluid_models(p, c);
  describe_drive(p, c);
  describe_contact(p, c.contact);
  if (c.grain.present) describe_lubrication(p, c.lubrication);
  describe_walls(p, c);
  if (c.fluid.present && particles) describe_inlets(p, c.inlets);
  if (particles) describe_outlets(p, c.outlets);
  if (c.grain.present) {
    describe_grains(p, c);
    describe_grain_inlets(p, c.grain_inlets);
  }
  if (particles) describe_coupling(p, c.couple);
  describe_time(p, c);
  describe_output(p, c.out);
  describe_paper(p, c);
}

}  // namespace bedload
