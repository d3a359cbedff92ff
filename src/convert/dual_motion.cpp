#include "dual_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "case_text.hpp"
#include "dual_geometry.hpp"

namespace bedload {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kMostParts = 200;    ///< of one body
constexpr int kMostRows = 100000;  ///< of a table

/// Some seconds of a motion, as keys of [wall.body.motion].
struct Part {
  std::string keys;
  double start = 0, stop = -1;  ///< s; stop < 0: never
};

/// An angle (degrees) in t, s, from the start of a part.
struct Angle {
  std::string degrees;  ///< a formula
};

bool moves(const std::string& keys) { return keys.find("[wall.body.motion]") != keys.npos; }

class Motions {
 public:
  Motions(XmlReader& xml, double end) : xml_(xml), end_(end) {}

  void object(const pugi::xml_node& node, std::vector<Part> parts, BodyKeys& keys) {
    movements(node, parts);
    if (std::string_view(node.name()) == "objreal")
      for (const int mk : numbers_in(xml_, node, "ref")) keys[mk] += text(parts, moves(keys[mk]));
    for (const pugi::xml_node& child : node.children())
      if (std::string_view name = child.name(); name == "obj" || name == "objreal")
        object(child, parts, keys);
  }

 private:
  static std::string text(const std::vector<Part>& parts, bool more) {
    std::string out;
    for (const Part& part : parts) {
      out += more ? "[[wall.body.motion.add]]\n" : "[wall.body.motion]\n";
      more = true;
      out += part.keys;
      if (part.start > 0) out += fmt::format("start = {}\n", number_text(part.start));
      if (part.stop >= 0) out += fmt::format("stop = {}\n", number_text(part.stop));
    }
    return out;
  }

  static bool is_movement(std::string_view name) { return name.starts_with("mv") || name == "wait"; }

  void movements(const pugi::xml_node& node, std::vector<Part>& parts) {
    std::vector<pugi::xml_node> begins;
    for (const pugi::xml_node& begin : node.children("begin")) begins.push_back(begin);
    for (const pugi::xml_node& begin : begins) {
      const double finish = xml_.number(begin, "finish", -1);
      double time = std::max(0.0, xml_.number(begin, "start", 0));
      int next = xml_.whole(begin, "mov");
      velocity_ = {}, rate_ = 0;
      while (next != 0) {
        const pugi::xml_node move = movement(node, begin, next);
        const double duration = xml_.number(move, "duration", -1);
        double stop = duration >= 0 ? time + duration : -1;
        if (finish >= 0) stop = stop < 0 ? finish : std::min(stop, finish);
        if (std::string_view name = move.name(); name != "wait" && name != "mvnull")
          add(move, time, stop, parts);
        if (stop < 0 || (finish >= 0 && stop >= finish) || stop >= end_) break;
        if (stop <= time && ++idle_ > kMostParts) xml_.fail(move, "is repeated without any duration");
        time = stop;
        next = xml_.whole_or(move, "next", 0);
        if (int(parts.size()) > kMostParts)
          xml_.fail(node, fmt::format("makes more than {} movements", kMostParts));
      }
    }
  }

  pugi::xml_node movement(const pugi::xml_node& node, const pugi::xml_node& begin, int id) const {
    for (const pugi::xml_node& child : node.children())
      if (is_movement(child.name()) && xml_.whole_or(child, "id", 0) == id) return child;
    xml_.fail(begin, fmt::format("names movement {}, which is not there", id));
  }

  bool radians(const pugi::xml_node& move) const {
    return std::string_view(move.attribute("anglesunits").value()) == "radians";
  }
  /// A child's attribute, an angle or angular velocity, in degrees.
  double degrees(const pugi::xml_node& move, const char* child, const char* attribute) const {
    return xml_.number(xml_.child(move, child), attribute) * (radians(move) ? 1 / kDegree : 1);
  }
  double degrees(const pugi::xml_node& move, const char* child, const char* attribute,
                 double fallback) const {
    return move.child(child) ? degrees(move, child, attribute) : fallback;
  }

  /// The angle of a rotation or of a circular motion.
  Angle angle(const pugi::xml_node& move, const std::string& kind, double length) {
    if (kind == "ace") {
      const double a = degrees(move, "ace", "ang"), w = degrees(move, "velini", "ang", rate_);
      rate_ = w + a * std::max(0.0, length);
      return {parabola(w, a / 2)};
    }
    if (kind == "sinu") {
      const double f = xml_.number(xml_.child(move, "freq"), "v"),
                   phase = degrees(move, "phase", "v", 0) * kDegree;
      return {sine(degrees(move, "ampl", "v"), f, phase)};
    }
    rate_ = degrees(move, "vel", "ang");
    return {parabola(rate_, 0)};
  }

  /// a t + b t^2.
  static std::string parabola(double a, double b) {
    const auto term = [](double factor, const char* power) {
      return factor == 1 ? std::string(power) : fmt::format("{}*{}", number_text(factor), power);
    };
    if (b == 0) return a == 0 ? "0" : term(a, "t");
    return (a == 0 ? "" : term(a, "t") + " + ") + term(b, "t^2");
  }

  /// From 0 at the start.
  static std::string sine(double amplitude, double frequency, double phase) {
    if (amplitude == 0 || frequency == 0) return "0";
    const std::string of = fmt::format("2*pi*{}*t", number_text(frequency));
    if (phase == 0) return fmt::format("{}*sin({})", number_text(amplitude), of);
    return fmt::format("{0}*(sin({1} + {2}) - sin({2}))", number_text(amplitude), of, number_text(phase));
  }

  static std::string formulas(const std::string& x, const std::string& y, const std::string& z) {
    const auto one = [](const std::string& s) { return s == "0" ? s : quoted_text(s); };
    return fmt::format("[{}, {}, {}]", one(x), one(y), one(z));
  }
  static std::string times(double factor, const std::string& formula) {
    return std::abs(factor) < 1e-12 ? "0"
           : factor == 1            ? formula
                                    : fmt::format("{}*({})", number_text(factor), formula);
  }

  void add(const pugi::xml_node& move, double start, double stop, std::vector<Part>& parts) {
    const std::string name = move.name();
    const double length = stop < 0 ? -1 : stop - start;
    Section keys("");
    const auto vector = [&](const char* child) { return xml_.vector(move, child); };
    if (name == "mvrect") {
      velocity_ = vector("vel");
      keys.set("kind", "velocity").set("velocity", velocity_);
    } else if (name == "mvrectace") {
      const Vec3d v = move.child("velini") ? vector("velini") : velocity_, a = vector("ace");
      std::string s[3];
      for (int k = 0; k < 3; ++k) s[k] = parabola(v[k], a[k] / 2);
      velocity_ = v + a * std::max(0.0, length);
      keys.set("kind", "formula").raw("displacement", formulas(s[0], s[1], s[2]));
    } else if (name == "mvrectsinu") {
      const Vec3d f = vector("freq"), a = vector("ampl"),
                  phase = move.child("phase") ? vector("phase") : Vec3d{};
      std::string s[3];
      for (int k = 0; k < 3; ++k) s[k] = sine(a[k], f[k], phase[k] * (radians(move) ? 1 : kDegree));
      keys.set("kind", "formula").raw("displacement", formulas(s[0], s[1], s[2]));
    } else if (name == "mvrot" || name == "mvrotace" || name == "mvrotsinu") {
      const Vec3d from = vector("axisp1"), axis = unit(move, vector("axisp2") - from);
      const Angle turn = angle(move, name.substr(5), length);
      if (name == "mvrot")
        keys.set("kind", "rotation")
            .set("axis", axis)
            .set("centre", from)
            .raw("rate", number_text(rate_ * kDegree), fmt::format("rad/s, {} deg/s", number_text(rate_)));
      else
        keys.set("kind", "formula")
            .raw("rotation", formulas(times(axis.x, turn.degrees), times(axis.y, turn.degrees),
                                      times(axis.z, turn.degrees)))
            .set("centre", from);
    } else if (name == "mvcir" || name == "mvcirace" || name == "mvcirsinu") {
      circle(move, angle(move, name.substr(5), length), keys);
    } else if (name == "mvrectfile" || name == "mvrotfile") {
      table(move, name == "mvrotfile", keys);
    } else {
      xml_.leave(move);
      return;
    }
    parts.push_back({keys.text(), start, stop});
  }

  Vec3d unit(const pugi::xml_node& move, const Vec3d& v) const {
    if (!(norm(v) > 0)) xml_.fail(move, "must have two different points axisp1 and axisp2");
    return v / norm(v);
  }

  /// The body follows the point `ref` about the axis, without turning.
  void circle(const pugi::xml_node& move, const Angle& turn, Section& keys) {
    const Vec3d from = xml_.vector(move, "axisp1"), axis = unit(move, xml_.vector(move, "axisp2") - from);
    const Vec3d arm = xml_.vector(move, "ref") - from, across = arm - dot(arm, axis) * axis,
                ahead = cross(axis, across);
    std::string s[3];
    for (int k = 0; k < 3; ++k) {
      s[k] = "0";
      const std::string of = fmt::format("pi/180*({})", turn.degrees);
      const std::string part = times(across[k], fmt::format("cos({})-1", of)),
                        rest = times(ahead[k], fmt::format("sin({})", of));
      if (part != "0") s[k] = part;
      if (rest != "0") s[k] = s[k] == "0" ? rest : s[k] + " + " + rest;
    }
    keys.set("kind", "formula").raw("displacement", formulas(s[0], s[1], s[2]));
  }

  /// Rows of the file, within the case.
  void table(const pugi::xml_node& move, bool turns, Section& keys) {
    const pugi::xml_node file = xml_.child(move, "file");
    const std::filesystem::path path = xml_.file().parent_path() / file.attribute("name").value();
    if (!std::filesystem::is_regular_file(path))
      xml_.fail(file, fmt::format("name=\"{}\" must be a file; there is no {}",
                                  file.attribute("name").value(), path.string()));
    std::istringstream in(read_text(path));
    const int at[4] = {xml_.whole_or(file, "fieldtime", 0), xml_.whole_or(file, "fieldx", turns ? 1 : -1),
                       xml_.whole_or(file, "fieldy", -1), xml_.whole_or(file, "fieldz", -1)};
    std::vector<std::array<double, 4>> rows;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      const std::vector<std::string> words = words_in(line, " \t;,\r");
      if (words.empty() || words[0][0] == '#' ||
          !std::isdigit(static_cast<unsigned char>(words[0][words[0][0] == '-' ? 1 : 0])))
        continue;
      std::array<double, 4> row{};
      for (int k = 0; k < 4; ++k) {
        if (at[k] < 0) continue;
        char* end = nullptr;
        const std::string word = at[k] < int(words.size()) ? words[std::size_t(at[k])] : "";
        row[std::size_t(k)] = std::strtod(word.c_str(), &end);
        if (word.empty() || *end)
          throw CaseError(
              fmt::format("{}:{}: must hold a number in column {}", path.string(), number, at[k] + 1));
      }
      rows.push_back(row);
      if (int(rows.size()) > kMostRows)
        throw CaseError(fmt::format("{}: has more than {} rows", path.string(), kMostRows));
    }
    if (rows.size() < 2) throw CaseError(path.string() + ": must hold at least two rows of numbers");
    Vec3d from, axis;
    if (turns) from = xml_.vector(move, "axisp1"), axis = unit(move, xml_.vector(move, "axisp2") - from);
    std::string text;
    for (const auto& row : rows) {
      const double t = row[0] - rows[0][0];
      Vec3d shift{row[1] - rows[0][1], row[2] - rows[0][2], row[3] - rows[0][3]};
      text += text.empty() ? "[" : ",\n  ";
      if (turns) {
        const Vec3d r = axis * (shift.x * (radians(move) ? 1 / kDegree : 1));
        text += fmt::format("[{}, 0, 0, 0, {}, {}, {}]", number_text(t), number_text(r.x), number_text(r.y),
                            number_text(r.z));
      } else {
        text += fmt::format("[{}, {}, {}, {}]", number_text(t), number_text(shift.x), number_text(shift.y),
                            number_text(shift.z));
      }
    }
    keys.set("kind", "table").set("spline", "monotone");
    if (turns) keys.set("centre", from);
    keys.raw("rows", text + "]");
  }

  XmlReader& xml_;
  double end_;
  int idle_ = 0;
  Vec3d velocity_;   ///< at the end of the last movement, m/s
  double rate_ = 0;  ///< the same, degrees/s
};

/// Allowed directions of a constraint: 1 free, 0 held.
int count_free(const Vec3d& dof) { return (dof.x != 0) + (dof.y != 0) + (dof.z != 0); }
Vec3d the_only(const Vec3d& dof, bool free) {
  return {double((dof.x != 0) == free), double((dof.y != 0) == free), double((dof.z != 0) == free)};
}

void constraints(XmlReader& xml, const pugi::xml_node& node, Section& s) {
  const pugi::xml_node shift = node.child("translationDOF"), turn = node.child("rotationDOF");
  std::optional<Vec3d> axis;
  const auto take = [&](const Vec3d& v) {
    if (axis && !(*axis == v)) return false;
    axis = v;
    return true;
  };
  if (shift) {
    const Vec3d dof = xml.vector(shift, 1);
    const int free = count_free(dof);
    if (free == 0) s.set("move", "none");
    if (free == 1 && take(the_only(dof, true))) s.set("move", "axis");
    if (free == 2 && take(the_only(dof, false))) s.set("move", "plane");
  }
  if (turn) {
    const Vec3d dof = xml.vector(turn, 1);
    const int free = count_free(dof);
    if (free == 0) s.set("turn", "none");
    if (free == 1 && take(the_only(dof, true)))
      s.set("turn", "axis");
    else if (free == 1 || free == 2)
      xml.leave(turn, "a body turns freely, about the axis of its translation, or not at all");
  }
  if (axis) s.set("axis", *axis);
}

}  // namespace

void read_motions(XmlReader& xml, const pugi::xml_node& motion, double end, BodyKeys& keys) {
  for (const pugi::xml_node& node : motion.children())
    if (std::string_view name = node.name(); name == "objreal" || name == "obj")
      Motions(xml, end).object(node, {}, keys);
}

void read_paddles(XmlReader& xml, const pugi::xml_node& paddles, BodyKeys& keys) {
  for (const pugi::xml_node& node : paddles.children()) {
    const std::string_view kind = node.name();
    if (node.type() != pugi::node_element || !xml.flag(node, "active", true)) continue;
    const auto value = [&](const char* name, double fallback) {
      const pugi::xml_node child = node.child(name);
      return child ? xml.number(child, "value") : fallback;
    };
    if (kind != "piston" && kind != "flap") {
      xml.leave(node);
      continue;
    }
    Section s("[wall.body.motion]");
    s.set("kind", kind);
    Vec3d direction{1, 0, 0};
    if (kind == "flap") {
      const Vec3d from = xml.vector(node, "flapaxis0"), axis = xml.vector(node, "flapaxis1") - from;
      s.set("centre", from);
      direction = cross(axis, Vec3d{0, 0, 1});
      if (value("variabledraft", 0) != 0) xml.leave(node, "variabledraft: a flap is hinged at the floor");
    } else if (const pugi::xml_node given = node.child("pistondir")) {
      direction = xml.vector(given);
    }
    s.set("wave_height", xml.number(xml.child(node, "waveheight"), "value"));
    s.set("wave_period", xml.number(xml.child(node, "waveperiod"), "value"));
    s.set("wave_depth", xml.number(xml.child(node, "depth"), "value"));
    s.set("wave_order", kind == "piston" && value("waveorder", 1) == 2 ? 2.0 : 1.0);
    if (!(direction == Vec3d{1, 0, 0})) s.set("wave_direction", direction);
    s.set("wave_ramp", value("ramp", 0));
    const double start = value("start", 0), duration = value("duration", 0);
    if (start > 0) s.set("start", start);
    if (duration > 0) s.set("stop", start + duration);
    if (value("phase", 0) != 0) xml.leave(node, "phase: the motion begins at its middle");
    if (value("gainstroke", 1) != 1)
      xml.leave(node, "gainstroke: the stroke is that of the theory; change wave_height");
    if (const pugi::xml_node absorption = node.child("awas_zsurf"))
      xml.leave(absorption, missing_reason("DualSPHysics", "awas"));
    std::string& body = keys[xml.whole(xml.child(node, "mkbound"), "value", 65535)];
    if (moves(body)) xml.fail(node, "moves a body that moves already");
    body += s.text();
  }
}

void read_floatings(XmlReader& xml, const pugi::xml_node& floatings, double release, BodyKeys& keys) {
  static const std::set<std::string_view> kRead = {"massbody",     "center",        "inertia",
                                                   "linearvelini", "angularvelini", "translationDOF",
                                                   "rotationDOF",  "masspart"};
  for (const pugi::xml_node& node : floatings.children("floating")) {
    Section s("[wall.body.free]");
    if (const pugi::xml_node mass = node.child("massbody"))
      s.set("mass", xml.number(mass, "value"));
    else if (node.attribute("relativeweight"))
      s.raw("density",
            number_text(xml.number(node, "relativeweight") * xml.variables.find("Rhop0").value_or(1000)));
    else
      s.set("density", xml.number(node, "rhopbody"));
    if (const pugi::xml_node centre = node.child("center")) s.set("centre_of_mass", xml.vector(centre));
    if (const pugi::xml_node inertia = node.child("inertia")) {
      const Vec3d i = xml.vector(inertia);
      s.raw("inertia",
            fmt::format("[{}, {}, {}, 0, 0, 0]", number_text(i.x), number_text(i.y), number_text(i.z)));
    }
    if (const pugi::xml_node v = node.child("linearvelini")) s.set("velocity", xml.vector(v));
    if (const pugi::xml_node w = node.child("angularvelini")) s.set("spin", xml.vector(w));
    if (release > 0) s.set("release_time", release);
    constraints(xml, node, s);
    for (const pugi::xml_node& child : node.children())
      if (child.type() == pugi::node_element && !kRead.contains(child.name())) xml.leave(child);
    for (const int mk : numbers_in(xml, node, "mkbound")) {
      if (!keys[mk].empty()) xml.fail(node, fmt::format("has mkbound {}, which floats or moves already", mk));
      keys[mk] = s.text();
    }
  }
}

}  // namespace bedload
