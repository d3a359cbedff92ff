#include "dual_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh.hpp"

namespace bedload {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kMostRuns = 1000;  ///< of lists, within each other too

/// Commands that change nothing of what is there at the start.
constexpr std::string_view kSilent[] = {
    "setshapemode", "setdrawmode", "shapeout",        "setfrdrawmode", "setdpctes",     "dpctessave",
    "dpctesload",   "dpctesreset", "setboxlimitmode", "cellsout",      "pointsmkout",   "printf",
    "exportvar",    "debugout",    "setnormalinvert", "newvarstr",     "newvarstrcte",  "setvarstr",
    "delvar",       "varssave",    "varsload",        "setactive",     "setmknextauto", "resetdraw",
    "clipdomain",   "clipreset",   "setmkbackclear"};

/// Where the things drawn next are put: scaled, turned, moved.
struct Transform {
  Vec3d scale{1, 1, 1};
  Quat<double> turn;
  Vec3d shift;
  bool turned() const { return std::abs(turn.w) < 1 - 1e-14; }
  bool even() const { return scale.x == scale.y && scale.y == scale.z; }
  Vec3d scaled(const Vec3d& v) const { return {scale.x * v.x, scale.y * v.y, scale.z * v.z}; }
  Vec3d place(const Vec3d& v) const { return shift + turn.rotate(scaled(v)); }
  void move(const Vec3d& by) { shift += turn.rotate(scaled(by)); }
};

Quat<double> about(const Vec3d& axis, double degrees) {
  const double length = norm(axis);
  return length > 0 ? Quat<double>::from_rotation(axis * (degrees * kDegree / length)) : Quat<double>{};
}

class Drawing {
 public:
  Drawing(XmlReader& xml, const std::filesystem::path& folder) : xml_(xml), folder_(folder) {}

  void run(const pugi::xml_node& commands, const pugi::xml_node& list) {
    if (++runs_ > kMostRuns) xml_.fail(list, fmt::format("runs more than {} lists of commands", kMostRuns));
    for (const pugi::xml_node& node : list.children())
      if (node.type() == pugi::node_element && wanted(node)) command(commands, node);
  }

  std::vector<Piece> pieces;

 private:
  bool wanted(const pugi::xml_node& node) const {
    return !node.attribute("if") || xml_.number(node, "if") != 0;
  }

  void command(const pugi::xml_node& commands, const pugi::xml_node& node) {
    const std::string_view name = node.name();
    const auto is = [&](std::string_view other) { return name == other; };
    if (is("setdrawmode")) surface_ = std::string_view(node.attribute("mode").value()) == "face";
    if (name.starts_with('_') || std::find(std::begin(kSilent), std::end(kSilent), name) != std::end(kSilent))
      return;
    if (is("setmkfluid"))
      as_ = Drawn::fluid, mk_ = xml_.whole(node, "mk", 65535);
    else if (is("setmkbound"))
      as_ = Drawn::bound, mk_ = xml_.whole(node, "mk", 65535);
    else if (is("setmkvoid"))
      as_ = Drawn::nothing;
    else if (is("mksave"))
      saved_as_ = as_, saved_mk_ = mk_;
    else if (is("mkload"))
      as_ = saved_as_, mk_ = saved_mk_;
    else if (is("newvar") || is("newvarcte") || is("setvar"))
      set_variables(node);
    else if (is("matrixreset"))
      at_ = {};
    else if (is("matrixsave") || is("statesave"))
      saved_at_.push_back(at_);
    else if (is("matrixload") || is("stateload"))
      load_matrix();
    else if (is("move"))
      at_.move(xml_.vector(node));
    else if (is("scale"))
      scale(node, xml_.vector(node, 1));
    else if (is("rotate"))
      rotate(about(xml_.vector(node), xml_.number(node, "ang")));
    else if (is("rotateline"))
      rotate_line(node);
    else if (is("runlist"))
      run_list(commands, node);
    else if (is("drawbox"))
      draw_box(node);
    else if (is("drawcylinder"))
      draw_cylinder(node);
    else if (is("drawsphere"))
      draw_sphere(node);
    else if (is("drawfilestl") || is("drawfileply"))
      draw_mesh(node);
    else if (is("fillbox"))
      fill_box(node);
    else
      xml_.leave(node);
  }

  void set_variables(const pugi::xml_node& node) {
    for (const pugi::xml_attribute& a : node.attributes())
      if (a.name()[0] != '_') xml_.variables.set(a.name(), xml_.number(node, a.name()));
  }
  void load_matrix() {
    if (saved_at_.empty()) return;
    at_ = saved_at_.back();
    saved_at_.pop_back();
  }
  void scale(const pugi::xml_node& node, const Vec3d& by) {
    if (at_.turned() && !(by.x == by.y && by.y == by.z))
      return xml_.leave(node, "it follows a rotation, and is not the same along x, y and z");
    at_.scale = at_.scaled(by);
  }
  void rotate(const Quat<double>& by) { at_.turn = at_.turn * by; }
  void rotate_line(const pugi::xml_node& node) {
    const pugi::xml_node first = xml_.child(node, "point"), second = first.next_sibling("point");
    if (!second) xml_.fail(node, "must hold two elements <point>");
    const Vec3d from = xml_.vector(first), to = xml_.vector(second);
    at_.move(from);
    rotate(about(to - from, xml_.number(node, "ang")));
    at_.move(-from);
  }
  void run_list(const pugi::xml_node& commands, const pugi::xml_node& node) {
    const std::string_view name = node.attribute("name").value();
    for (const pugi::xml_node& list : commands.children("list"))
      if (list.attribute("name").value() == name) {
        const int times = xml_.whole_or(node, "times", 1);
        for (int k = 0; k < times; ++k) run(commands, list);
        return;
      }
    xml_.fail(node, fmt::format("name=\"{}\" must name a <list> of this case", name));
  }

  Piece piece(const pugi::xml_node& node, Form form) const {
    Piece p;
    p.as = as_, p.mk = mk_, p.line = xml_.line(node), p.form = form;
    p.surface = surface_ && as_ == Drawn::bound;
    return p;
  }
  /// Around points that are given.
  static void enclose(Piece& p, const std::vector<Vec3d>& points, double around = 0) {
    p.min = {1e300, 1e300, 1e300}, p.max = -p.min;
    for (const Vec3d& x : points)
      for (int k = 0; k < 3; ++k)
        p.min[k] = std::min(p.min[k], x[k] - around), p.max[k] = std::max(p.max[k], x[k] + around);
  }
  /// The rotation of `at_` as that of a shape: about an axis through the origin, before the translation.
  void turn(Piece& p, const Transform& at) const {
    if (!at.turned()) return;
    const Vec3d axis{at.turn.x, at.turn.y, at.turn.z};
    p.turn_axis = axis / norm(axis);
    p.turn_angle = 2 * std::atan2(norm(axis), at.turn.w) / kDegree;
  }

  std::pair<Vec3d, Vec3d> corners(const pugi::xml_node& node) const {
    const Vec3d from = xml_.vector(node, "point");
    const pugi::xml_node end = node.child("endpoint");
    const Vec3d to = end ? xml_.vector(end) : from + xml_.vector(node, "size");
    Vec3d lo, hi;
    for (int k = 0; k < 3; ++k) lo[k] = std::min(from[k], to[k]), hi[k] = std::max(from[k], to[k]);
    return {lo, hi};
  }

  void draw_box(const pugi::xml_node& node) {
    Piece p = piece(node, Form::box);
    const auto [lo, hi] = corners(node);
    static constexpr std::string_view kSides[6] = {"left", "right", "front", "back", "bottom", "top"};
    std::string fill = node.child_value("boxfill");
    for (std::size_t at = 0; (at = fill.find('^', at)) != fill.npos; at += 3) fill.replace(at, 1, " ^ ");
    bool drawn = true;  // false behind ^: all but this side
    for (const std::string& word : words_in(fill, "| ,\t\r\n")) {
      if (word == "^") {
        drawn = false;
        continue;
      }
      const auto side = std::find(std::begin(kSides), std::end(kSides), word);
      if (side != std::end(kSides))
        p.faces[std::size_t(side - kSides)] = std::exchange(drawn, true);
      else if (word == "all")
        p.faces.fill(true);
      else if (word != "solid")
        xml_.fail(node, fmt::format(
                            "boxfill \"{}\" must be solid, all, or of left, right, front, back, bottom, top; "
                            "all ^ top is all but top",
                            word));
      if (word == "solid") {
        p.faces.fill(false);
        break;
      }
    }
    if (p.as != Drawn::bound) p.faces.fill(false);  // a void or fluid face is one layer of particles
    if (const pugi::xml_node layers = node.child("layers"))
      xml_.leave(layers, "walls are as deep as the kernel needs them");
    if (at_.turned()) {
      Vec3d a = at_.scaled(lo), b = at_.scaled(hi);
      std::vector<Vec3d> around;
      for (int k = 0; k < 8; ++k)
        around.push_back(at_.place({k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z}));
      if (p.by_faces()) {
        p.faces.fill(false);
        p.surface = true;
      }
      p.min = a, p.max = b, p.shift = at_.shift;
      turn(p, at_);
      return pieces.push_back(p);
    }
    enclose(p, {at_.place(lo), at_.place(hi)});
    pieces.push_back(p);
  }

  double even_scale(const pugi::xml_node& node) const {
    if (!at_.even()) xml_.fail(node, "is scaled differently along x, y and z, which only boxes can be");
    return at_.scale.x;
  }

  void draw_cylinder(const pugi::xml_node& node) {
    Piece p = piece(node, Form::cylinder);
    const pugi::xml_node first = xml_.child(node, "point"), second = first.next_sibling("point");
    if (!second) xml_.fail(node, "must hold two elements <point>");
    p.radius = xml_.number(node, "radius") * even_scale(node);
    p.a = at_.place(xml_.vector(first)), p.b = at_.place(xml_.vector(second));
    const Vec3d axis = p.b - p.a;
    const double length = norm(axis);
    if (!(length > 0) || !(p.radius > 0)) xml_.fail(node, "must have a radius and a length above 0");
    if (node.attribute("mask")) {
      p.surface = p.as == Drawn::bound;
      xml_.leave(node, "mask: both ends of a cylinder are closed; a shape of kind pipe has open ends");
    }
    p.min = {}, p.max = {};
    for (int k = 0; k < 3; ++k) {  // of the discs at its ends
      const double u = axis[k] / length, reach = p.radius * std::sqrt(std::max(0.0, 1 - u * u));
      p.min[k] = std::min(p.a[k], p.b[k]) - reach, p.max[k] = std::max(p.a[k], p.b[k]) + reach;
    }
    pieces.push_back(p);
  }

  void draw_sphere(const pugi::xml_node& node) {
    Piece p = piece(node, Form::sphere);
    p.radius = xml_.number(node, "radius") * even_scale(node);
    if (!(p.radius > 0)) xml_.fail(node, "must have a radius above 0");
    p.a = at_.place(xml_.vector(node, "point"));
    enclose(p, {p.a}, p.radius);
    pieces.push_back(p);
  }

  void draw_mesh(const pugi::xml_node& node) {
    Piece p = piece(node, Form::mesh);
    const std::filesystem::path file = xml_.file().parent_path() / node.attribute("file").value();
    Transform at = at_;
    if (const pugi::xml_node move = node.child("drawmove")) at.move(xml_.vector(move));
    if (const pugi::xml_node turn = node.child("drawrotate"))
      at.turn = at.turn * (about({0, 0, 1}, xml_.number(turn, "angz", 0)) *
                           about({0, 1, 0}, xml_.number(turn, "angy", 0)) *
                           about({1, 0, 0}, xml_.number(turn, "angx", 0)));
    if (const pugi::xml_node scale = node.child("drawscale")) at.scale = at.scaled(xml_.vector(scale, 1));
    if (!at.even()) xml_.fail(node, "is scaled differently along x, y and z, which only boxes can be");
    p.scale = at.scale.x, p.shift = at.shift;
    turn(p, at);
    std::error_code none;
    const std::filesystem::path near = std::filesystem::proximate(file, folder_, none);
    p.file = (near.empty() ? file : near).generic_string();
    p.surface = p.as == Drawn::bound && !xml_.flag(node, "autofill", false);
    std::vector<Vec3d> corners;
    for (const Vec3d& x : read_triangles(file).vertices) corners.push_back(at.place(x));
    enclose(p, corners);
    pieces.push_back(p);
  }

  void fill_box(const pugi::xml_node& node) {
    if (as_ != Drawn::fluid) return xml_.leave(node, "only fluid fills the space around a seed");
    Piece p = piece(node, Form::box);
    const auto [lo, hi] = corners(node);
    enclose(p, {at_.place(lo), at_.place(hi)});
    p.seed = at_.place(xml_.vector(node));
    p.flooded = true;
    pieces.push_back(p);
  }

  XmlReader& xml_;
  const std::filesystem::path& folder_;
  Drawn as_ = Drawn::fluid, saved_as_ = Drawn::fluid;
  int mk_ = 0, saved_mk_ = 0, runs_ = 0;
  bool surface_ = false;
  Transform at_;
  std::vector<Transform> saved_at_;
};

}  // namespace

std::vector<Piece> drawn_pieces(XmlReader& xml, const pugi::xml_node& geometry,
                                const std::filesystem::path& folder) {
  const pugi::xml_node commands = xml.child(geometry, "commands");
  Drawing drawing(xml, folder);
  if (const pugi::xml_node constants = geometry.child("predefinition")) drawing.run(commands, constants);
  drawing.run(commands, xml.child(commands, "mainlist"));
  return std::move(drawing.pieces);
}

std::vector<int> numbers_in(const XmlReader& xml, const pugi::xml_node& node, const char* attribute) {
  std::vector<int> out;
  const auto number = [&](std::string_view text) {
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > 65535)
      xml.fail(node, fmt::format("{}=\"{}\" must hold whole numbers, such as \"3,5-7\"", attribute,
                                 node.attribute(attribute).value()));
    return value;
  };
  for (const std::string& word : words_in(node.attribute(attribute).value(), ", ")) {
    const auto dash = word.find('-');
    const int first = number(std::string_view(word).substr(0, dash));
    const int last = dash == word.npos ? first : number(std::string_view(word).substr(dash + 1));
    for (int k = first; k <= last; ++k) out.push_back(k);
  }
  if (out.empty()) xml.fail(node, fmt::format("must have the attribute {}", attribute));
  return out;
}

}  // namespace bedload
