// Inlets, outlets and probes against the rest of a case.

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "bedload/case/grain_sizes.hpp"
#include "bedload/case/materials.hpp"
#include "checks.hpp"

namespace bedload {

void Checks::openings() const {
  std::set<std::string> names;
  const auto named = [&](const std::string& path, const std::string& name) {
    file_name(path + ".name", name);
    if (!names.insert(name).second)
      fail(path + ".name", quoted(name), "must differ from other inlets' and outlets'");
  };
  for (std::size_t i = 0; i < c.inlets.size(); ++i) {
    const std::string path = fmt::format("inlet.{}", i);
    named(path, c.inlets[i].name);
    inside_domain(path + ".centre", c.inlets[i].centre);
  }
  for (std::size_t i = 0; i < c.outlets.size(); ++i) {
    const OutletConfig& outlet = c.outlets[i];
    const std::string path = fmt::format("outlet.{}", i);
    if (c.grain.present && outlet.takes(Phase::grains) && !c.grain.rigid_fills().empty())
      fail(path + ".phase", quoted(outlet.phase.name()), "must be \"fluid\" where grains form rigid groups");
    named(path, outlet.name);
    if (outlet.shape == OutletShape::box) box(path, outlet.min, outlet.max);
    if (outlet.shape != OutletShape::plane && !in_sight(outlet.min, outlet.max))
      fail(path + ".shape", quoted(outlet.shape.name()), "must reach into the domain");
    if (outlet.phase != OutletPhase::both &&
        !(outlet.phase == OutletPhase::fluid ? c.fluid.present : c.grain.present))
      fail(path + ".phase", quoted(outlet.phase.name()),
           fmt::format("must name something in this case; it has no {}", outlet.phase.name()));
  }
  for (std::size_t i = 0; i < c.grain_inlets.size(); ++i) {
    named(fmt::format("grain_inlet.{}", i), c.grain_inlets[i].name);
    grain_inlet(fmt::format("grain_inlet.{}", i), c.grain_inlets[i]);
  }
}

void Checks::grain_inlet(const std::string& path, const GrainInletConfig& inlet) const {
  double d = 0;
  for (const SizeClass& size : inlet.sizes) d = std::max(d, size_range(size).second);
  if (const ClumpConfig* clump = c.grain.clump_named(inlet.clump)) d *= 2 * clump->shape.reach;
  if (c.grain.fixed) fail("grain.fixed", "true", "must be false with grain_inlet");
  if (inlet.shape == GrainInletShape::disc) {
    inside_domain(path + ".centre", inlet.centre);
    if (2 * inlet.radius < d)
      fail(path + ".radius", inlet.radius, fmt::format("must be at least {}, for the largest grain", d / 2));
    return;
  }
  box(path, inlet.min, inlet.max);
  inside_domain(path + ".min", inlet.min);
  inside_domain(path + ".max", inlet.max);
  for (int k = 0; k < 3; ++k)
    if (inlet.max[k] - inlet.min[k] < d * (1 - 1e-9))
      fail(path + ".max", to_text(inlet.max),
           fmt::format("must leave space along {} for the largest grain, {} m", "xyz"[k], d));
}

void Checks::mixing(const std::string& path, const ProbeConfig& probe) const {
  box(path, probe.min, probe.max);
  const auto materials = c.grain.all_materials();
  if (!probe.of.empty() && std::none_of(materials.begin(), materials.end(),
                                        [&](const GrainMaterial& m) { return name_in_pairs(m) == probe.of; }))
    fail(path + ".of", quoted(probe.of), "must name a grain.material, or be \"grain\"");
  constexpr double kMost = 1e7;
  double cells = 1;
  for (int k = 0; k < 3; ++k) cells *= std::ceil((probe.max[k] - probe.min[k]) / probe.cell);
  if (cells > kMost)
    fail(path + ".cell", fmt::format("{} m", probe.cell),
         fmt::format("must be larger: the box has {:.3g} cells, of at most {:.3g}", cells, kMost));
}

void Checks::field(const std::string& path, const ProbeConfig& probe) const {
  if (!c.grain.present) return;
  if (probe.sample_every > probe.every * (1 + 1e-9))
    fail(path + ".sample_every", fmt::format("{} s", probe.sample_every),
         fmt::format("must be <= {} s, the interval of its rows", probe.every));
  const auto refuse = [&](bool there, const char* what) {
    if (there) fail(path + ".type", quoted(probe.type.name()), fmt::format("must be another with {}", what));
  };
  refuse(c.domain.sheared(), "domain.shear_rate");
  refuse(!c.grain.rigid_fills().empty(), "rigid groups");
  double widest = c.grain.largest();
  const auto look = [&](const ClumpConfig* clump, const std::vector<SizeClass>& sizes) {
    if (!clump) return;
    for (const SizeClass& size : sizes)
      widest = std::max(widest, 2 * clump->shape.reach * size_range(size).second);
  };
  for (const GrainFill& fill : c.grain.fills) look(c.grain.clump_of(fill), fill.sizes);
  for (const GrainInletConfig& inlet : c.grain_inlets) look(c.grain.clump_named(inlet.clump), inlet.sizes);
  double most = std::numeric_limits<double>::infinity();  // images are then at most one period away
  for (int k = 0; k < 3; ++k)
    if (c.domain.periodic[k]) most = std::min(most, 0.5 * (c.domain.max[k] - c.domain.min[k]));
  const char* const what = widest > c.grain.largest() ? "clump" : "grain";
  if (const double least = 2 * widest; probe.radius < least * (1 - 1e-9) || probe.radius > most)
    fail(path + ".radius", fmt::format("{} m", probe.radius),
         std::isinf(most)
             ? fmt::format("must be >= {} m, two diameters of the largest {}", least, what)
             : fmt::format("must be within {}..{} m, from two diameters of the largest {} to half a period",
                           least, most, what));
}

void Checks::probes() const {
  std::set<std::string> names;
  for (std::size_t i = 0; i < c.out.probes.size(); ++i) {
    const ProbeConfig& probe = c.out.probes[i];
    const std::string path = fmt::format("probe.{}", i);
    file_name(path + ".name", probe.name);
    if (!names.insert(probe.name).second)
      fail(path + ".name", quoted(probe.name), "must differ from other probes'");
    if (probe.type == ProbeType::box) {
      box(path, probe.min, probe.max);
      if (!in_sight(probe.min, probe.max))
        fail(path + ".min", to_text(probe.min), "must have a part of the domain in its box");
    }
    if (probe.type == ProbeType::mixing) mixing(path, probe);
    if (probe.type == ProbeType::field) field(path, probe);
    if (probe.type == ProbeType::flux) {
      box(path, probe.min, probe.max);
      inside_domain(path + ".min", probe.min);
      inside_domain(path + ".max", probe.max);
    }
    if (probe.type == ProbeType::wall_pressure) inside_domain(path + ".at", probe.at);
    const auto measured = [&](const std::string& key, const Vec3d& x) {
      if (probe.type == ProbeType::point || probe.type == ProbeType::field) inside_domain(key, x);
      if (probe.type == ProbeType::height) column_in_domain(key, x, probe.along);
    };
    measured(path + ".at", probe.at);
    for (std::size_t corner = 1; corner < std::size_t(1) << probe.span.size(); ++corner) {
      Vec3d x = probe.at;
      for (std::size_t k = 0; k < probe.span.size(); ++k)
        if (corner >> k & 1) x += probe.span[k];
      measured(path + ".span", x);
    }
    const bool has_phase =
        probe.type == ProbeType::front || probe.type == ProbeType::box || probe.type == ProbeType::flux;
    const bool of_grains = probe.type == ProbeType::mixing || probe.type == ProbeType::field;
    const Chosen<Phase> phase = has_phase   ? probe.phase
                                : of_grains ? Chosen(Phase::grains)
                                            : Chosen(Phase::fluid);
    if (probe.type != ProbeType::force && !(phase == Phase::fluid ? c.fluid.present : c.grain.present))
      fail(path + (has_phase ? ".phase" : ".type"), quoted(has_phase ? phase.name() : probe.type.name()),
           fmt::format("must name something in this case; it has no {}", phase.name()));
    if (probe.type == ProbeType::force || !probe.body.empty()) body_exists(path + ".body", probe.body);
  }
}
}  // namespace bedload
