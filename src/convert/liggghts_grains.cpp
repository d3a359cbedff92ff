#include "liggghts_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "xml_reader.hpp"

namespace bedload {

void ScriptGrains::region(const Command& c) {
  Region r;
  r.kind = c.word(2);
  if (r.kind == "block") {
    for (int k = 0; k < 3; ++k) r.min[k] = c.number(3 + 2 * k), r.max[k] = c.number(4 + 2 * k);
  } else if (r.kind == "cylinder") {
    const std::string axis = c.word(3);
    if (axis != "x" && axis != "y" && axis != "z") c.fail(fmt::format("{} must be x, y or z", axis));
    const int k = axis[0] - 'x', i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
    r.a[i] = r.b[i] = c.number(4), r.a[j] = r.b[j] = c.number(5), r.radius = c.number(6);
    r.a[k] = c.number(7), r.b[k] = c.number(8);
  } else if (r.kind == "sphere") {
    r.a = c.vector(3), r.radius = c.number(6);
  } else {
    c.leave(fmt::format("region {} {}", c.word(1), r.kind),
            "grains fill boxes, cylinders, spheres and other shapes");
    return;
  }
  regions_[c.word(1)] = r;
}

const ScriptGrains::Region& ScriptGrains::region_named(const Command& c, const std::string& name) const {
  const auto found = regions_.find(name);
  if (found == regions_.end())
    c.fail(fmt::format("names region {}, which is not there or was not converted", name));
  return found->second;
}

void ScriptGrains::particle_template(const Command& c) {
  Template t;
  if (const std::size_t at = c.after("atom_type", 4)) t.type = c.whole(at);
  const std::size_t radius = c.after("radius", 4), density = c.after("density", 4);
  if (!radius || !density) c.fail("must have radius and density");
  if (c.word(radius) != "constant")
    c.leave(fmt::format("radius {}", c.word(radius)),
            "sizes are grain.fill.sizes: set them; here its first number");
  if (c.word(density) != "constant")
    c.leave(fmt::format("density {}", c.word(density)), "a material has one density; here its first number");
  t.radius = c.number(radius + 1), t.density = c.number(density + 1);
  if (!(t.radius > 0)) c.fail("must have a radius above 0");
  templates_[c.word(1)] = t;
}

void ScriptGrains::distribution(const Command& c) {
  Distribution d;
  d.by_mass = !c.word(3).ends_with("numberbased");
  const int count = c.whole(5);
  for (int k = 0; k < count; ++k) d.of.emplace_back(c.word(6 + 2 * k), c.number(7 + 2 * k));
  for (const auto& [name, weight] : d.of)
    if (!templates_.contains(name))
      c.fail(fmt::format("names template {}, which is not there or was not converted", name));
  distributions_[c.word(1)] = d;
}

/// The sizes of a distribution; empty if there is one, which is grain.d.
std::string ScriptGrains::sizes(const Distribution& d) const {
  if (d.of.size() == 1 && templates_.at(d.of[0].first).radius == first().radius) return "";
  std::string out = "sizes = [\n";
  for (const auto& [name, weight] : d.of)
    out += fmt::format("  {{ d = {}, {} = {} }},\n", number_text(2 * templates_.at(name).radius),
                       d.by_mass ? "mass_fraction" : "number_fraction", number_text(weight));
  return out + "]\n";
}

void ScriptGrains::insert(const Command& c, const ScriptBox& box) {
  const std::string id = c.word(1), style = c.word(3);
  const std::size_t named = c.after("distributiontemplate", 4);
  if (!named || !distributions_.contains(c.word(named)))
    c.fail("must name a distributiontemplate that was converted");
  const Distribution& d = distributions_.at(c.word(named));
  const std::set<std::string> known([&] {
    std::set<std::string> types;
    for (const auto& [name, weight] : d.of) types.insert(std::to_string(templates_.at(name).type));
    return types;
  }());
  if (known.size() > 1) c.leave("insert " + id, "of several materials: a fill has one; make one for each");
  const std::size_t vel = c.after("vel", 4);
  Vec3d velocity;
  if (vel && (c.word(vel) == "constant" || c.word(vel) == "uniform" || c.word(vel) == "gaussian"))
    velocity = c.vector(vel + 1);
  if (style == "insert/pack")
    fill(c, d, velocity);
  else if (style == "insert/rate/region" || style == "insert/stream")
    inlet(c, d, velocity, box);
  else
    c.leave(style, missing_reason("LIGGGHTS", style));
}

/// A volume filled from the start.
void ScriptGrains::fill(const Command& c, const Distribution& d, const Vec3d& velocity) {
  const bool once = !c.after("insert_every", 4) || c.word(c.after("insert_every", 4)) == "once";
  Section s("[[grain.fill]]");
  if (!once) c.leave("insert_every", "a fill is there from the start; a grain_inlet inserts at a rate");
  volume(s, region_named(c, c.word(c.after("region", 4) ? c.after("region", 4) : c.size())));
  if (const std::size_t at = c.after("particles_in_region", 4))
    s.set("count", std::round(c.number(at)));
  else if (const std::size_t in = c.after("mass_in_region", 4))
    s.set("mass", c.number(in));
  else if (const std::size_t part = c.after("volumefraction_region", 4))
    s.set("packing_fraction", std::min(c.number(part), 0.64));
  else
    c.fail("must have particles_in_region, mass_in_region or volumefraction_region");
  if (norm(velocity) > 0) s.set("velocity", velocity);
  fills_ += s.text() + sizes(d) + '\n';
}

/// Grains that come in at a rate.
void ScriptGrains::inlet(const Command& c, const Distribution& d, const Vec3d& velocity,
                         const ScriptBox& box) {
  const std::string id = c.word(1), style = c.word(3);
  const std::size_t particles = c.after("particlerate", 4), mass = c.after("massrate", 4);
  Section s("[[grain_inlet]]");
  s.set("name", id);
  if (style == "insert/stream") {
    const std::size_t face = c.after("insertion_face", 4);
    c.leave("insert/stream " + id,
            fmt::format("the inlet is the box of the case: set min and max to where the face {} is",
                        face ? c.word(face) : ""));
    if (!box.present) c.fail("must follow create_box");
    s.set("min", box.min).set("max", box.max);
  } else {
    const Region& r = region_named(c, c.word(c.after("region", 4) ? c.after("region", 4) : c.size()));
    if (r.kind == "block")
      s.set("min", r.min).set("max", r.max);
    else {
      const Vec3d lo = r.kind == "sphere"
                           ? r.a
                           : Vec3d{std::min(r.a.x, r.b.x), std::min(r.a.y, r.b.y), std::min(r.a.z, r.b.z)};
      const Vec3d hi = r.kind == "sphere"
                           ? r.a
                           : Vec3d{std::max(r.a.x, r.b.x), std::max(r.a.y, r.b.y), std::max(r.a.z, r.b.z)};
      const double inner = r.radius / std::sqrt(2.0);
      Vec3d around{inner, inner, inner};
      for (int k = 0; k < 3; ++k)
        if (r.kind == "cylinder" && r.a[k] != r.b[k]) around[k] = 0;
      s.set("min", lo - around).set("max", hi + around);
      c.leave("region of " + id, "a grain inlet is a box or a disc: here a box within it");
    }
  }
  double rate = 0;
  if (mass)
    s.set("mass_rate", rate = c.number(mass));
  else if (particles)
    s.set("rate", rate = c.number(particles));
  else
    c.fail("must have particlerate or massrate");
  if (norm(velocity) > 0) s.set("velocity", velocity);
  const std::size_t number_of = c.after("nparticles", 4), mass_of = c.after("mass", 4);
  const std::size_t total = mass ? mass_of : number_of;
  if (total && c.word(total) != "INF")
    s.raw("stop", number_text(c.number(total) / rate), "s, when all are in");
  inlets_ += s.text() + sizes(d) + '\n';
}

void ScriptGrains::volume(Section& s, const Region& r) {
  if (r.kind == "block") {
    s.set("min", r.min).set("max", r.max);
    return;
  }
  const std::string name = fmt::format("region_{}", ++region_shapes_);
  Section shape("[[shape]]");
  shape.set("name", name).set("kind", r.kind);
  if (r.kind == "cylinder")
    shape.set("a", r.a).set("b", r.b);
  else
    shape.set("centre", r.a);
  shapes_ += shape.set("radius", r.radius).text() + '\n';
  s.set("shape", name);
}

}  // namespace bedload
