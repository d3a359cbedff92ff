// An input script of LIGGGHTS to a case file.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "case_text.hpp"
#include "convert.hpp"
#include "xml_reader.hpp"

namespace bedload {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Commands without which a case is the same.
const std::set<std::string_view> kSilent = {"atom_style",     "atom_modify",
                                            "communicate",    "comm_modify",
                                            "newton",         "processors",
                                            "neighbor",       "neigh_modify",
                                            "echo",           "log",
                                            "thermo",         "thermo_style",
                                            "thermo_modify",  "compute_modify",
                                            "print",          "soft_particles",
                                            "hard_particles", "coarsegraining_info",
                                            "group",          "shell",
                                            "restart",        "write_restart",
                                            "write_data",     "pair_coeff",
                                            "dump_modify",    "undump",
                                            "run_style",      "compute",
                                            "modify_timing",  "partitioner_style",
                                            "lattice"};
const std::set<std::string_view> kSilentFixes = {
    "nve/sphere", "nve/integrate", "check/timestep/gran", "printb",  "print",
    "ave/time",   "ave/atom",      "ave/euler",           "balance", "mesh/surface/stress/deform"};

/// One command, whose variables have been replaced.
struct Line {
  int number = 0;
  std::vector<std::string> words;
};

struct Template {
  int type = 1;
  double radius = 0, density = 2500;
};
struct Distribution {
  std::vector<std::pair<std::string, double>> of;
  bool by_mass = true;
};
struct Region {
  std::string kind;  ///< block, cylinder, sphere
  Vec3d min, max;    ///< of a block, m
  Vec3d a, b;        ///< ends of a cylinder's axis; centre of a sphere, m
  double radius = 0;
};
struct Mesh {
  std::string file;
  int type = 1;
  double scale = 1;
  Vec3d move, turn_axis{0, 0, 1};
  double turn_angle = 0;
  Vec3d surface_velocity;
  std::string motion;
};
struct Wall {
  std::string name, keys;
  int type = 1;
};

class Script {
 public:
  Script(const std::filesystem::path& file, std::filesystem::path folder)
      : file_(file), folder_(std::move(folder)) {}

  Conversion convert() {
    for (Line& line : read()) {
      line_ = line.number;
      words_ = &line.words;
      command();
    }
    return {assemble(), left_};
  }

 private:
  // Text.

  /// Joins lines that end in '&' and leaves out comments.
  std::vector<Line> read() const {
    std::istringstream in(read_text(file_));
    std::vector<Line> out;
    std::string text, whole;
    int number = 0, first = 0;
    while (std::getline(in, text)) {
      ++number;
      if (whole.empty()) first = number;
      if (const auto hash = text.find('#'); hash != text.npos) text.resize(hash);
      while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
      const bool goes_on = !text.empty() && text.back() == '&';
      if (goes_on) text.pop_back();
      whole += ' ' + text;
      if (goes_on) continue;
      if (auto words = words_in(whole, " \t\r"); !words.empty()) out.push_back({first, std::move(words)});
      whole.clear();
    }
    return out;
  }

  std::string place() const { return fmt::format("{}:{}: {}", file_.string(), line_, (*words_)[0]); }
  [[noreturn]] void fail(const std::string& what) const { throw CaseError(place() + ' ' + what); }
  void leave(const std::string& what, const std::string& reason = "") {
    left_.push_back(fmt::format("{}:{}: {}: {}", file_.string(), line_, what,
                                reason.empty() ? "there is no counterpart" : reason));
  }

  std::size_t size() const { return words_->size(); }
  std::string word(std::size_t at) const {
    if (at >= size()) fail(fmt::format("must have {} words or more", at + 1));
    std::string out = (*words_)[at];
    for (auto from = out.find("${"); from != out.npos; from = out.find("${", from)) {  // their values
      const auto to = out.find('}', from);
      if (to == out.npos) fail(fmt::format("{} has a bracket that does not close", out));
      const std::string name = out.substr(from + 2, to - from - 2);
      const auto text = texts_.find(name);
      const auto value = variables_.find(name);
      if (text == texts_.end() && !value) fail(fmt::format("uses the variable {}, which has no value", name));
      const std::string with = text != texts_.end() ? text->second : number_text(*value);
      out.replace(from, to - from + 1, with);
      from += with.size();
    }
    return out;
  }
  double number(std::size_t at) const {
    std::string text = word(at);
    if (text.starts_with("v_")) text = text.substr(2);
    try {
      return variables_.value(text);
    } catch (const CaseError& error) {
      fail(fmt::format("\"{}\" must be a number: {}", text, error.what()));
    }
  }
  int whole(std::size_t at) const {
    const double value = number(at);
    if (!(value >= 0 && value <= 100000)) fail(fmt::format("{} must be within 0..100000", word(at)));
    return int(value);
  }
  Vec3d vector(std::size_t at) const { return {number(at), number(at + 1), number(at + 2)}; }
  /// The place after a keyword; 0 if it is not there.
  std::size_t after(const std::string& keyword, std::size_t from = 0) const {
    for (std::size_t k = from; k < size(); ++k)
      if ((*words_)[k] == keyword) return k + 1;
    return 0;
  }

  // Commands.

  void command() {
    const std::string name = word(0);
    if (kSilent.contains(name)) return;
    if (name == "units") {
      if (word(1) != "si") fail(fmt::format("{} must be si: other units are not converted", word(1)));
    } else if (name == "variable") {
      variable();
    } else if (name == "boundary") {
      for (std::size_t k = 0; k < 3; ++k) periodic_[k] = word(1 + k) == "p";
    } else if (name == "region") {
      region();
    } else if (name == "create_box") {
      const Region& box = region_named(word(2));
      if (box.kind != "block") fail("must name a region of style block");
      min_ = box.min, max_ = box.max, has_box_ = true;
    } else if (name == "pair_style") {
      pair_style();
    } else if (name == "timestep") {
      dt_ = number(1);
    } else if (name == "run" || name == "run_upto") {
      if (dt_ <= 0) fail("must follow a timestep");
      end_ = std::max(end_, name == "run_upto" ? number(1) * dt_ : end_ + number(1) * dt_);
      const std::size_t upto = after("upto");
      if (name == "run" && upto) end_ = number(1) * dt_;
    } else if (name == "dump") {
      if (every_ == 0 && dt_ > 0) every_ = number(4) * dt_;
    } else if (name == "fix") {
      fix();
    } else if (name == "unfix") {
      leave("unfix " + word(1),
            "what a fix does lasts for the whole run; grain_inlet.stop and wall.body.motion.stop end it");
    } else {
      leave(name, missing_reason("LIGGGHTS", name));
    }
  }

  void variable() {
    const std::string style = word(2);
    if (style == "equal") {
      std::string text;
      for (std::size_t k = 3; k < size(); ++k) text += word(k);
      if (text.size() > 1 && text.front() == '"' && text.back() == '"')
        text = text.substr(1, text.size() - 2);
      for (auto at = text.find("v_"); at != text.npos; at = text.find("v_", at))
        if (at == 0 || !(std::isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == '_'))
          text.erase(at, 2);
        else
          ++at;
      variables_.set("PI", std::numbers::pi), variables_.set("dt", dt_);
      try {
        variables_.set(word(1), variables_.value(text));
      } catch (const CaseError&) {
        leave(fmt::format("variable {}", word(1)),
              "it is no number at the start; formulas of a case are in t");
      }
    } else if (style == "string" || style == "index") {
      texts_[word(1)] = word(3);
    } else {
      leave(fmt::format("variable {} {}", word(1), style),
            "sweeps run a case for each of several values: --set");
    }
  }

  void region() {
    Region r;
    r.kind = word(2);
    if (r.kind == "block") {
      for (int k = 0; k < 3; ++k) r.min[k] = number(3 + 2 * k), r.max[k] = number(4 + 2 * k);
    } else if (r.kind == "cylinder") {
      const std::string axis = word(3);
      if (axis != "x" && axis != "y" && axis != "z") fail(fmt::format("{} must be x, y or z", axis));
      const int k = axis[0] - 'x', i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
      r.a[i] = r.b[i] = number(4), r.a[j] = r.b[j] = number(5), r.radius = number(6);
      r.a[k] = number(7), r.b[k] = number(8);
    } else if (r.kind == "sphere") {
      r.a = vector(3), r.radius = number(6);
    } else {
      leave(fmt::format("region {} {}", word(1), r.kind),
            "grains fill boxes, cylinders, spheres and other shapes");
      return;
    }
    regions_[word(1)] = r;
  }

  const Region& region_named(const std::string& name) const {
    const auto found = regions_.find(name);
    if (found == regions_.end())
      fail(fmt::format("names region {}, which is not there or was not converted", name));
    return found->second;
  }

  void pair_style() {
    if (word(1) != "gran")
      return leave(fmt::format("pair_style {}", word(1)), "contacts are those of pair_style gran");
    const std::string model = after("model") ? word(after("model")) : word(2);
    if (model.starts_with("hooke")) {
      leave("model hooke",
            "its stiffness follows from characteristicVelocity there, and is contact.k, N/m, here: set it; "
            "contacts are of Hertz until then");
    } else if (!model.starts_with("hertz")) {
      leave("model " + model, "contacts are of Hertz");
    }
    if (const std::size_t at = after("tangential"); at && word(at) != "history") {
      if (word(at) == "off")
        frictionless_ = true;
      else
        leave("tangential " + word(at), "friction has a history");
    }
    const std::size_t rolling = after("rolling_friction");
    rolling_ = !rolling || word(rolling) == "off"  ? "none"
               : word(rolling).starts_with("epsd") ? "epsd"
                                                   : "cdt";
    if (rolling && word(rolling) == "epsd2") rolling_damping_ = 0;
    if (const std::size_t cohesion = after("cohesion"); cohesion && word(cohesion) != "off")
      leave("cohesion " + word(cohesion), missing_reason("LIGGGHTS", word(cohesion)));
  }

  void fix() {
    const std::string id = word(1), style = word(3);
    if (kSilentFixes.contains(style)) return;
    if (style == "property/global") return property();
    if (style == "gravity") return gravity();
    if (style.starts_with("mesh/surface")) return mesh(id, style);
    if (style == "move/mesh") return move_mesh();
    if (style.starts_with("wall/gran")) return wall(id);
    if (style == "particletemplate/sphere") return particle_template(id);
    if (style.starts_with("particledistribution/discrete")) return distribution(id, style);
    if (style.starts_with("insert/")) return insert(id, style);
    const std::string reason = missing_reason("LIGGGHTS", style);
    leave(fmt::format("fix {} {}", id, style), reason);
  }

  void property() {
    const std::string name = word(4), kind = word(5);
    std::vector<double> values;
    const std::size_t from = kind == "peratomtypepair" ? 7 : 6;
    for (std::size_t k = from; k < size(); ++k) values.push_back(number(k));
    if (values.empty()) fail(fmt::format("{} must have a value", name));
    static const std::set<std::string> kRead = {"youngsModulus",
                                                "poissonsRatio",
                                                "coefficientRestitution",
                                                "coefficientFriction",
                                                "coefficientRollingFriction",
                                                "coefficientRollingViscousDamping",
                                                "characteristicVelocity"};
    if (!kRead.contains(name)) return leave(name, missing_reason("LIGGGHTS", name));
    if (kind == "peratomtypepair") {
      const double types = std::round(std::sqrt(double(values.size())));
      if (types * types != double(values.size()))
        fail(fmt::format("{} must have a square number of values", name));
    }
    properties_[name] = values;
  }
  /// Of a type, or of a pair of types, from 1.
  std::optional<double> property(const std::string& name, int i, int j) const {
    const auto found = properties_.find(name);
    if (found == properties_.end()) return {};
    const std::vector<double>& v = found->second;
    const bool pairs = name.starts_with("coefficient");
    const std::size_t types = pairs ? std::size_t(std::round(std::sqrt(double(v.size())))) : v.size();
    const std::size_t at = pairs ? std::size_t(i - 1) * types + std::size_t(j - 1) : std::size_t(i - 1);
    return at < v.size() ? std::optional(v[at]) : std::nullopt;
  }

  void gravity() {
    const double size = number(4);
    if (word(5) != "vector") return leave("gravity " + word(5), "gravity is a vector");
    const Vec3d along = vector(6);
    if (!(norm(along) > 0)) fail("must have a direction that is not 0");
    gravity_ = along * (size / norm(along));
  }

  void mesh(const std::string& id, const std::string& style) {
    if (style != "mesh/surface" && style != "mesh/surface/stress" && style != "mesh/surface/stress/servo" &&
        style != "mesh/surface/planar")
      return leave(style, missing_reason("LIGGGHTS", style));
    Mesh m;
    const std::size_t file = after("file");
    if (!file) fail("must have a file");
    std::error_code none;
    const std::filesystem::path path = file_.parent_path() / word(file);
    const std::filesystem::path near = std::filesystem::proximate(path, folder_, none);
    m.file = (near.empty() ? path : near).generic_string();
    if (const std::size_t at = after("type", 4)) m.type = whole(at);
    if (const std::size_t at = after("scale", 4)) m.scale = number(at);
    if (const std::size_t at = after("move", 4)) m.move = vector(at);
    if (const std::size_t at = after("rotate", 4)) {
      m.turn_axis = vector(at + 1);
      m.turn_angle = number(at + 5);
      if (m.move.x != 0 || m.move.y != 0 || m.move.z != 0)
        leave("mesh " + id, "moved and rotated: here it is rotated first, then moved");
    }
    if (const std::size_t at = after("surface_vel", 4)) m.surface_velocity = vector(at);
    if (style == "mesh/surface/stress/servo")
      leave(style, "the mesh does not follow a force; wall.body.free moves by the forces on it");
    if (style == "mesh/surface/stress") stressed_.push_back(id);
    meshes_[id] = m;
  }

  void move_mesh() {
    const std::string id = word(5), style = word(6);
    const auto found = meshes_.find(id);
    if (found == meshes_.end()) fail(fmt::format("names mesh {}, which is not there", id));
    Section s(found->second.motion.empty() ? "[wall.body.motion]" : "[[wall.body.motion.add]]");
    if (style == "linear") {
      s.set("kind", "velocity").set("velocity", vector(7));
    } else if (style == "wiggle") {
      s.set("kind", "oscillation")
          .set("amplitude", vector(after("amplitude", 7)))
          .set("frequency", 1 / number(after("period", 7)));
    } else if (style == "rotate") {
      s.set("kind", "rotation")
          .set("axis", vector(after("axis", 7)))
          .set("centre", vector(after("origin", 7)));
      s.raw("rate", number_text(2 * std::numbers::pi / number(after("period", 7))), "rad/s");
    } else if (style == "riggle") {
      const Vec3d axis = vector(after("axis", 7));
      const double amplitude = number(after("amplitude", 7)), period = number(after("period", 7));
      std::string parts[3];
      for (int k = 0; k < 3; ++k)
        parts[k] =
            axis[k] == 0
                ? "0"
                : quoted_text(fmt::format("{}*sin(2*pi*t/{})", number_text(amplitude * axis[k] / norm(axis)),
                                          number_text(period)));
      s.set("kind", "formula")
          .raw("rotation", fmt::format("[{}, {}, {}]", parts[0], parts[1], parts[2]))
          .set("centre", vector(after("origin", 7)));
    } else {
      return leave(fmt::format("move/mesh {}", style),
                   "motions are wall.body.motion of kind formula or table");
    }
    found->second.motion += s.text();
  }

  /// Keys of a wall of that type of material, where they differ from those of grains of the first type.
  std::string material(int type) const {
    Section s("");
    const auto differ = [&](const char* key, const char* name, int i, int j) {
      const auto own = property(name, i, j), grains = property(name, grain_type(), grain_type());
      if (own && (!grains || *own != *grains)) s.set(key, *own);
    };
    if (type != grain_type()) {
      differ("E", "youngsModulus", type, type);
      differ("nu", "poissonsRatio", type, type);
      differ("mu", "coefficientFriction", grain_type(), type);
      differ("mu_r", "coefficientRollingFriction", grain_type(), type);
      differ("e", "coefficientRestitution", grain_type(), type);
    }
    return s.text();
  }
  int grain_type() const { return templates_.empty() ? 1 : templates_.begin()->second.type; }

  void wall(const std::string& id) {
    if (const std::size_t at = after("meshes", 4)) {
      for (std::size_t k = at; k < size() && meshes_.contains(word(k)); ++k) walled_.insert(word(k));
      return;
    }
    const std::size_t at = after("primitive", 4);
    if (!at) return leave(fmt::format("fix {} wall/gran", id), "a wall is a mesh or a primitive");
    const int type = word(at) == "type" ? whole(at + 1) : 1;
    const std::size_t from = word(at) == "type" ? at + 2 : at;
    const std::string kind = word(from);
    Section s("[[wall.body]]");
    s.set("name", id);
    if (kind == "xplane" || kind == "yplane" || kind == "zplane") {
      if (!has_box_) fail("must follow create_box");
      const int axis = kind[0] - 'x';
      const double x = number(from + 1), middle = 0.5 * (min_[axis] + max_[axis]);
      Vec3d point = 0.5 * (min_ + max_), normal;
      point[axis] = x, normal[axis] = x <= middle ? 1 : -1;
      s.set("shape", "plane").set("point", point).set("normal", normal);
    } else if (kind == "xcylinder" || kind == "ycylinder" || kind == "zcylinder") {
      if (!has_box_) fail("must follow create_box");
      const int k = kind[0] - 'x', i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2;
      Vec3d a, b;
      const double radius = number(from + 1), reach = 0.1 * radius;
      a[i] = b[i] = number(from + 2), a[j] = b[j] = number(from + 3);
      a[k] = min_[k] - reach, b[k] = max_[k] + reach;
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
      return leave(fmt::format("primitive {}", kind), "walls are planes, tanks, boxes and shapes");
    }
    walls_.push_back({id, s.text(), type});
  }

  void particle_template(const std::string& id) {
    Template t;
    if (const std::size_t at = after("atom_type", 4)) t.type = whole(at);
    const std::size_t radius = after("radius", 4), density = after("density", 4);
    if (!radius || !density) fail("must have radius and density");
    if (word(radius) != "constant")
      leave(fmt::format("radius {}", word(radius)),
            "sizes are grain.fill.sizes: set them; here its first number");
    if (word(density) != "constant")
      leave(fmt::format("density {}", word(density)), "a material has one density; here its first number");
    t.radius = number(radius + 1), t.density = number(density + 1);
    if (!(t.radius > 0)) fail("must have a radius above 0");
    templates_[id] = t;
  }

  void distribution(const std::string& id, const std::string& style) {
    Distribution d;
    d.by_mass = !style.ends_with("numberbased");
    const int count = whole(5);
    for (int k = 0; k < count; ++k) d.of.emplace_back(word(6 + 2 * k), number(7 + 2 * k));
    for (const auto& [name, weight] : d.of)
      if (!templates_.contains(name))
        fail(fmt::format("names template {}, which is not there or was not converted", name));
    distributions_[id] = d;
  }

  /// The sizes of a distribution; empty if there is one, which is grain.d.
  std::string sizes(const Distribution& d) const {
    if (d.of.size() == 1 && templates_.at(d.of[0].first).radius == templates_.begin()->second.radius)
      return "";
    std::string out = "sizes = [\n";
    for (const auto& [name, weight] : d.of)
      out += fmt::format("  {{ d = {}, {} = {} }},\n", number_text(2 * templates_.at(name).radius),
                         d.by_mass ? "mass_fraction" : "number_fraction", number_text(weight));
    return out + "]\n";
  }

  void insert(const std::string& id, const std::string& style) {
    const std::size_t named = after("distributiontemplate", 4);
    if (!named || !distributions_.contains(word(named)))
      fail("must name a distributiontemplate that was converted");
    const Distribution& d = distributions_.at(word(named));
    const std::set<std::string> known([&] {
      std::set<std::string> types;
      for (const auto& [name, weight] : d.of) types.insert(std::to_string(templates_.at(name).type));
      return types;
    }());
    if (known.size() > 1) leave("insert " + id, "of several materials: a fill has one; make one for each");
    const std::size_t vel = after("vel", 4);
    Vec3d velocity;
    if (vel && (word(vel) == "constant" || word(vel) == "uniform" || word(vel) == "gaussian"))
      velocity = vector(vel + 1);
    const bool once = !after("insert_every", 4) || word(after("insert_every", 4)) == "once";
    const std::size_t particles = after("particlerate", 4), mass = after("massrate", 4);
    if (style == "insert/pack") {
      Section s("[[grain.fill]]");
      if (!once) leave("insert_every", "a fill is there from the start; a grain_inlet inserts at a rate");
      volume(s, region_named(word(after("region", 4) ? after("region", 4) : size())));
      if (const std::size_t at = after("particles_in_region", 4))
        s.set("count", std::round(number(at)));
      else if (const std::size_t in = after("mass_in_region", 4))
        s.set("mass", number(in));
      else if (const std::size_t part = after("volumefraction_region", 4))
        s.set("packing_fraction", std::min(number(part), 0.64));
      else
        fail("must have particles_in_region, mass_in_region or volumefraction_region");
      if (norm(velocity) > 0) s.set("velocity", velocity);
      fills_ += s.text() + sizes(d) + '\n';
      return;
    }
    if (style != "insert/rate/region" && style != "insert/stream")
      return leave(style, missing_reason("LIGGGHTS", style));
    Section s("[[grain_inlet]]");
    s.set("name", id);
    if (style == "insert/stream") {
      const std::size_t face = after("insertion_face", 4);
      leave("insert/stream " + id,
            fmt::format("the inlet is the box of the case: set min and max to where the face {} is",
                        face ? word(face) : ""));
      if (!has_box_) fail("must follow create_box");
      s.set("min", min_).set("max", max_);
    } else {
      const Region& r = region_named(word(after("region", 4) ? after("region", 4) : size()));
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
        leave("region of " + id, "a grain inlet is a box or a disc: here a box within it");
      }
    }
    double rate = 0;
    if (mass)
      s.set("mass_rate", rate = number(mass));
    else if (particles)
      s.set("rate", rate = number(particles));
    else
      fail("must have particlerate or massrate");
    if (norm(velocity) > 0) s.set("velocity", velocity);
    const std::size_t number_of = after("nparticles", 4), mass_of = after("mass", 4);
    const std::size_t total = mass ? mass_of : number_of;
    if (total && word(total) != "INF") s.raw("stop", number_text(number(total) / rate), "s, when all are in");
    inlets_ += s.text() + sizes(d) + '\n';
  }

  void volume(Section& s, const Region& r) {
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

  // The case file.

  std::string assemble() {
    line_ = 1;
    const std::string name = file_.string();
    if (!has_box_) throw CaseError(name + ": must have create_box with a region of style block");
    if (templates_.empty()) throw CaseError(name + ": must have a fix particletemplate/sphere");
    if (end_ == 0) throw CaseError(name + ": must have timestep and run");
    const Template& first = templates_.begin()->second;
    Section top(""), domain("[domain]"), grain("[grain]"), contact("[contact]"), time("[time]"), out("[out]");
    top.set("title", file_.filename().string());
    if (!(gravity_ == Vec3d{0, 0, -9.81})) top.set("gravity", gravity_);
    domain.set("min", min_).set("max", max_);
    if (periodic_[0] || periodic_[1] || periodic_[2])
      domain.raw("periodic", fmt::format("[{}, {}, {}]", periodic_[0], periodic_[1], periodic_[2]));
    grain.raw("d", number_text(2 * first.radius), "m").raw("rho", number_text(first.density), "kg/m3");
    const int t = first.type;
    if (const auto E = property("youngsModulus", t, t)) grain.raw("E", number_text(*E), "Pa");
    if (const auto nu = property("poissonsRatio", t, t)) grain.set("nu", *nu);
    if (const auto mu = frictionless_ ? std::optional(0.0) : property("coefficientFriction", t, t))
      grain.set("mu", *mu);
    if (const auto mu_r = property("coefficientRollingFriction", t, t)) grain.set("mu_r", *mu_r);
    if (const auto e = property("coefficientRestitution", t, t)) grain.set("e", *e);
    if (rolling_ != "epsd") contact.set("rolling", rolling_);
    if (const auto found = properties_.find("coefficientRollingViscousDamping");
        found != properties_.end() && rolling_damping_ != 0)
      rolling_damping_ = found->second[0];
    if (rolling_ == "epsd" && rolling_damping_ >= 0) contact.set("eta_r", rolling_damping_);
    std::string bodies;
    for (const Wall& w : walls_) bodies += w.keys + material(w.type) + '\n';
    for (const auto& [id, m] : meshes_) {
      if (!walled_.contains(id)) continue;
      Section shape("[[shape]]");
      shape.set("name", id).set("kind", "mesh").set("file", m.file);
      if (m.scale != 1) shape.set("scale", m.scale);
      if (m.turn_angle != 0) shape.set("turn_axis", m.turn_axis).set("turn_angle", m.turn_angle);
      if (norm(m.move) > 0) shape.set("translate", m.move);
      shapes_ += shape.text() + '\n';
      Section body("[[wall.body]]");
      body.set("name", id).set("shape", id);
      if (norm(m.surface_velocity) > 0) body.set("surface_velocity", m.surface_velocity);
      bodies += body.text() + material(m.type) + m.motion + '\n';
      left_.push_back(fmt::format(
          "{}: mesh {}: a surface there, here a solid: it must be closed, with its normals out of the solid",
          name, id));
    }
    if (dt_ > 0)
      left_.push_back(
          name + ": timestep: the step of the grains follows from their stiffness; time.dt_dem fixes it");
    time.raw("end", number_text(end_), "s");
    out.raw("every", number_text(every_ > 0 ? every_ : end_ / 100), "s");
    std::string result =
        top.text() + '\n' + domain.text() + '\n' + grain.text() + '\n' + shapes_ + fills_ + inlets_;
    if (!contact.empty()) result += contact.text() + '\n';
    result += bodies + time.text() + '\n' + out.text() + '\n';
    for (const std::string& id : stressed_)
      if (walled_.contains(id))
        result += Section("[[probe]]").set("name", id).set("type", "force").set("body", id).text() + '\n';
    while (result.ends_with("\n\n")) result.pop_back();
    return result;
  }

  const std::filesystem::path& file_;
  std::filesystem::path folder_;
  const std::vector<std::string>* words_ = nullptr;
  int line_ = 0, region_shapes_ = 0;
  Variables variables_;
  std::map<std::string, std::string> texts_;
  std::map<std::string, std::vector<double>> properties_;
  std::map<std::string, Region> regions_;
  std::map<std::string, Mesh> meshes_;
  std::map<std::string, Template> templates_;
  std::map<std::string, Distribution> distributions_;
  std::set<std::string> walled_;
  std::vector<std::string> stressed_, left_;
  std::vector<Wall> walls_;
  std::string shapes_, fills_, inlets_, rolling_ = "none";
  double rolling_damping_ = -1, dt_ = 0, end_ = 0, every_ = 0;
  bool periodic_[3] = {}, has_box_ = false, frictionless_ = false;
  Vec3d min_, max_, gravity_{0, 0, -9.81};
};

}  // namespace

Conversion from_liggghts(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return Script(file, folder).convert();
}

}  // namespace bedload
