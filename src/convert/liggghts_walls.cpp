#include "liggghts_walls.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "case_text.hpp"
#include "xml_reader.hpp"

namespace bedload {
namespace {

/// Keys of a wall of that type of material, where they differ from those of grains of the first type.
std::string keys_of(const ScriptMaterials& materials, int type, int grain_type) {
  Section s("");
  const auto differ = [&](const char* key, const char* name, int i, int j) {
    const auto own = materials.value(name, i, j), grains = materials.value(name, grain_type, grain_type);
    if (own && (!grains || *own != *grains)) s.set(key, *own);
  };
  if (type != grain_type) {
    differ("E", "youngsModulus", type, type);
    differ("nu", "poissonsRatio", type, type);
    differ("mu", "coefficientFriction", grain_type, type);
    differ("mu_r", "coefficientRollingFriction", grain_type, type);
    differ("e", "coefficientRestitution", grain_type, type);
  }
  return s.text();
}

}  // namespace

void ScriptMaterials::read(const Command& c) {
  const std::string name = c.word(4), kind = c.word(5);
  std::vector<double> values;
  const std::size_t from = kind == "peratomtypepair" ? 7 : 6;
  for (std::size_t k = from; k < c.size(); ++k) values.push_back(c.number(k));
  if (values.empty()) c.fail(fmt::format("{} must have a value", name));
  static const std::set<std::string> kRead = {"youngsModulus",
                                              "poissonsRatio",
                                              "coefficientRestitution",
                                              "coefficientFriction",
                                              "coefficientRollingFriction",
                                              "coefficientRollingViscousDamping",
                                              "characteristicVelocity"};
  if (!kRead.contains(name)) return c.leave(name, missing_reason("LIGGGHTS", name));
  if (kind == "peratomtypepair") {
    const double types = std::round(std::sqrt(double(values.size())));
    if (types * types != double(values.size()))
      c.fail(fmt::format("{} must have a square number of values", name));
  }
  values_[name] = values;
}

std::optional<double> ScriptMaterials::value(const std::string& name, int i, int j) const {
  const auto found = values_.find(name);
  if (found == values_.end()) return {};
  const std::vector<double>& v = found->second;
  const bool pairs = name.starts_with("coefficient");
  const std::size_t types = pairs ? std::size_t(std::round(std::sqrt(double(v.size())))) : v.size();
  const std::size_t at = pairs ? std::size_t(i - 1) * types + std::size_t(j - 1) : std::size_t(i - 1);
  return at < v.size() ? std::optional(v[at]) : std::nullopt;
}

void ScriptWalls::mesh(const Command& c, const std::filesystem::path& script,
                       const std::filesystem::path& folder) {
  const std::string id = c.word(1), style = c.word(3);
  if (style != "mesh/surface" && style != "mesh/surface/stress" && style != "mesh/surface/stress/servo" &&
      style != "mesh/surface/planar")
    return c.leave(style, missing_reason("LIGGGHTS", style));
  Mesh m;
  const std::size_t file = c.after("file");
  if (!file) c.fail("must have a file");
  std::error_code none;
  const std::filesystem::path path = script.parent_path() / c.word(file);
  const std::filesystem::path near = std::filesystem::proximate(path, folder, none);
  m.file = (near.empty() ? path : near).generic_string();
  if (const std::size_t at = c.after("type", 4)) m.type = c.whole(at);
  if (const std::size_t at = c.after("scale", 4)) m.scale = c.number(at);
  if (const std::size_t at = c.after("move", 4)) m.move = c.vector(at);
  if (const std::size_t at = c.after("rotate", 4)) {
    m.turn_axis = c.vector(at + 1);
    m.turn_angle = c.number(at + 5);
    if (m.move.x != 0 || m.move.y != 0 || m.move.z != 0)
      c.leave("mesh " + id, "moved and rotated: here it is rotated first, then moved");
  }
  if (const std::size_t at = c.after("surface_vel", 4)) m.surface_velocity = c.vector(at);
  if (style == "mesh/surface/stress/servo")
    c.leave(style, "the mesh does not follow a force; wall.body.free moves by the forces on it");
  if (style == "mesh/surface/stress") stressed_.push_back(id);
  meshes_[id] = m;
}

void ScriptWalls::move_mesh(const Command& c) {
  const std::string id = c.word(5), style = c.word(6);
  const auto found = meshes_.find(id);
  if (found == meshes_.end()) c.fail(fmt::format("names mesh {}, which is not there", id));
  Section s(found->second.motion.empty() ? "[wall.body.motion]" : "[[wall.body.motion.add]]");
  if (style == "linear") {
    s.set("kind", "velocity").set("velocity", c.vector(7));
  } else if (style == "wiggle") {
    s.set("kind", "oscillation")
        .set("amplitude", c.vector(c.after("amplitude", 7)))
        .set("frequency", 1 / c.number(c.after("period", 7)));
  } else if (style == "rotate") {
    s.set("kind", "rotation")
        .set("axis", c.vector(c.after("axis", 7)))
        .set("centre", c.vector(c.after("origin", 7)));
    s.raw("rate", number_text(2 * std::numbers::pi / c.number(c.after("period", 7))), "rad/s");
  } else if (style == "riggle") {
    const Vec3d axis = c.vector(c.after("axis", 7));
    const double amplitude = c.number(c.after("amplitude", 7)), period = c.number(c.after("period", 7));
    std::string parts[3];
    for (int k = 0; k < 3; ++k)
      parts[k] =
          axis[k] == 0
              ? "0"
              : quoted_text(fmt::format("{}*sin(2*pi*t/{})", number_text(amplitude * axis[k] / norm(axis)),
                                        number_text(period)));
    s.set("kind", "formula")
        .raw("rotation", fmt::format("[{}, {}, {}]", parts[0], parts[1], parts[2]))
        .set("centre", c.vector(c.after("origin", 7)));
  } else {
    return c.leave(fmt::format("move/mesh {}", style),
                   "motions are wall.body.motion of kind formula or table");
  }
  found->second.motion += s.text();
}

void ScriptWalls::wall(const Command& c, const ScriptBox& box) {
  const std::string id = c.word(1);
  if (const std::size_t at = c.after("meshes", 4)) {
    for (std::size_t k = at; k < c.size() && meshes_.contains(c.word(k)); ++k) walled_.insert(c.word(k));
    return;
  }
  const std::size_t at = c.after("primitive", 4);
  if (!at) return c.leave(fmt::format("fix {} wall/gran", id), "a wall is a mesh or a primitive");
  const int type = c.word(at) == "type" ? c.whole(at + 1) : 1;
  const std::size_t from = c.word(at) == "type" ? at + 2 : at;
  const std::string kind = c.word(from);
  Section s("[[wall.body]]");
  s.set("name", id);
  if (kind == "xplane" || kind == "yplane" || kind == "zplane") {
    if (!box.present) c.fail("must follow create_box");
    const int axis = kind[0] - 'x';
    const double x = c.number(from + 1), middle = 0.5 * (box.min[axis] + box.max[axis]);
    Vec3d point = 0.5 * (box.min + box.max), normal;
    point[axis] = x, normal[axis] = x <= middle ? 1 : -1;
    s.set("shape", "plane").set("point", point).set("normal", normal);
  } else if (kind == "xcylinder" || kind == "ycylinder" || kind == "zcylinder") {
    if (!box.present) c.fail("must follow create_box");
    const int k = kind[0] - 'x', i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
    Vec3d a, b;
    const double radius = c.number(from + 1), reach = 0.1 * radius;
    a[i] = b[i] = c.number(from + 2), a[j] = b[j] = c.number(from + 3);
    a[k] = box.min[k] - reach, b[k] = box.max[k] + reach;
    shapes_ += Section("[[shape]]")
                   .set("name", id)
                   .set("kind", "pipe")
                   .set("a", a)
                   .set("b", b)
                   .set("radius", radius)
                   .raw("thickness", number_text(reach), "m")
                   .text() +
               '\n';
    s.set("shape", id);
  } else {
    return c.leave(fmt::format("primitive {}", kind), "walls are planes, tanks, boxes and shapes");
  }
  primitives_.push_back({s.text(), type});
}

ScriptWalls::Text ScriptWalls::text(const ScriptMaterials& materials, int grain_type, const std::string& file,
                                    std::vector<std::string>& left) const {
  Text out;
  out.shapes = shapes_;
  for (const Primitive& p : primitives_) out.bodies += p.keys + keys_of(materials, p.type, grain_type) + '\n';
  for (const auto& [id, m] : meshes_) {
    if (!walled_.contains(id)) continue;
    Section shape("[[shape]]");
    shape.set("name", id).set("kind", "mesh").set("file", m.file);
    if (m.scale != 1) shape.set("scale", m.scale);
    if (m.turn_angle != 0) shape.set("turn_axis", m.turn_axis).set("turn_angle", m.turn_angle);
    if (norm(m.move) > 0) shape.set("translate", m.move);
    out.shapes += shape.text() + '\n';
    Section body("[[wall.body]]");
    body.set("name", id).set("shape", id);
    if (norm(m.surface_velocity) > 0) body.set("surface_velocity", m.surface_velocity);
    out.bodies += body.text() + keys_of(materials, m.type, grain_type) + m.motion + '\n';
    left.push_back(fmt::format(
        "{}: mesh {}: a surface there, here a solid: it must be closed, with its normals out of the solid",
        file, id));
  }
  for (const std::string& id : stressed_)
    if (walled_.contains(id))
      out.probes += Section("[[probe]]").set("name", id).set("type", "force").set("body", id).text() + '\n';
  return out;
}

}  // namespace bedload
