// A case of DualSPHysics (Case_Def.xml) to a case file.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "bedload/core/error.hpp"
#include "case_text.hpp"
#include "convert.hpp"
#include "dual_geometry.hpp"
#include "dual_motion.hpp"

namespace bedload {
namespace {

/// Parameters without which a case is the same: output, limits, schemes that find their own values.
const std::set<std::string_view> kSilent = {
    "SavePosDouble", "PosDouble",    "StepAlgorithm",  "VerletSteps",    "ViscoBoundFactor", "RigidAlgorithm",
    "CoefDtMin",     "DtIni",        "DtMin",          "DtAllParticles", "RhopOutMin",       "RhopOutMax",
    "PartsOutMax",   "WrnPartsOut",  "FtIgnoreRadius", "DensityDTvalue", "MinFluidStop",     "ShiftCoef",
    "ShiftTFS",      "ShiftAdvCoef", "TimePart",       "NoPenetration"};

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::filesystem::path folder)
      : xml_(file), folder_(std::move(folder)) {}

  Conversion convert() {
    const pugi::xml_node root = xml_.root();
    if (std::string_view(root.name()) != "case" || !root.child("casedef"))
      throw CaseError(fmt::format("{}: is not a case of DualSPHysics: it must hold <case> with <casedef>",
                                  xml_.file().string()));
    const pugi::xml_node definition = root.child("casedef"), execution = root.child("execution");
    read_parameters(execution.child("parameters"));
    const pugi::xml_node geometry = xml_.child(definition, "geometry");
    read_constants(xml_.child(definition, "constantsdef"), geometry);
    pieces_ = drawn_pieces(xml_, geometry, folder_);
    if (pieces_.empty()) xml_.fail(geometry, "draws nothing that has a counterpart");
    turn_pieces(definition.child("initials"));
    find_domain(execution.child("parameters"));
    BodyKeys keys;
    const double end = parameter("TimeMax", 0);
    const double pause = parameter("FtPause", 0);  // of floating bodies: read even where there are none
    if (const pugi::xml_node motion = definition.child("motion"))
      read_motions(xml_, motion, end > 0 ? end : 1e9, keys);
    if (const pugi::xml_node paddles = execution.child("special").child("wavepaddles"))
      if (xml_.flag(paddles, "active", true)) read_paddles(xml_, paddles, keys);
    std::set<int> closed;
    if (const pugi::xml_node floatings = definition.child("floatings")) {
      read_floatings(xml_, floatings, pause, keys);
      for (const pugi::xml_node& f : floatings.children("floating"))
        for (const int mk : numbers_in(xml_, f, "mkbound")) closed.insert(mk);
    }
    check_bodies(definition, keys);
    const PiecesText text = text_of(pieces_, place_, keys, initial_velocities(definition.child("initials")),
                                    closed, xml_.file().string(), xml_.left);
    std::string probes;
    read_special(execution.child("special"), probes);
    for (const char* rest : {"properties", "normals"})
      if (std::string_view(rest) != "normals")
        if (const pugi::xml_node node = definition.child(rest))
          xml_.leave(node, "materials belong to wall.body and grain");
    return {assemble(text, probes), xml_.left};
  }

 private:
  // Parameters.

  void read_parameters(const pugi::xml_node& parameters) {
    for (const pugi::xml_node& p : parameters.children("parameter")) {
      const std::string key = p.attribute("key").value();
      if (!key.starts_with('#')) parameters_[key] = p;
    }
  }
  bool has(const std::string& key) const { return parameters_.contains(key); }
  double parameter(const std::string& key, double fallback) {
    const auto found = parameters_.find(key);
    if (found == parameters_.end()) return fallback;
    read_.insert(key);
    return xml_.number(found->second, "value");
  }

  void read_constants(const pugi::xml_node& constants, const pugi::xml_node& geometry) {
    const pugi::xml_node definition = xml_.child(geometry, "definition");
    place_.dp = xml_.number(definition, "dp");
    if (!(place_.dp > 0)) xml_.fail(definition, "dp must be above 0 m");
    place_.min = xml_.vector(definition, "pointmin"), place_.max = xml_.vector(definition, "pointmax");
    place_.two_d = place_.max.y - place_.min.y < place_.dp * 1e-6;
    const Vec3d g = xml_.vector(constants, "gravity");
    gravity_ = g;
    rho0_ = constants.child("rhop0") ? xml_.number(constants.child("rhop0"), "value") : 1000;
    Variables& v = xml_.variables;
    v.set("Dp", place_.dp), v.set("dp", place_.dp), v.set("Rhop0", rho0_), v.set("Data2D", place_.two_d);
    const char* axes[3] = {"x", "y", "z"};
    for (int k = 0; k < 3; ++k) {
      v.set(fmt::format("PosMin_{}", axes[k]), place_.min[k]),
          v.set(fmt::format("PosMax_{}", axes[k]), place_.max[k]);
      v.set(fmt::format("Gravity_{}", axes[k]), g[k]);
    }
    constants_ = constants;
  }

  double constant(const char* name, double fallback) const {
    const pugi::xml_node node = constants_.child(name);
    return node && !xml_.flag(node, "auto", false) ? xml_.number(node, "value") : fallback;
  }

  // Domain.

  /// "default + 20%", "0.5" or "default - 2"; `size`: to which per cent refer.
  double limit(const pugi::xml_node& node, const char* axis, double fallback, double size) const {
    std::string text = node.attribute(axis).value();
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t'; }),
               text.end());
    if (text.empty() || text == "default") return fallback;
    if (!text.starts_with("default")) return xml_.number(node, axis);
    std::string rest = text.substr(7);
    const bool percent = rest.ends_with('%');
    if (percent) rest.pop_back();
    try {
      const double by = xml_.variables.value(rest);
      return fallback + (percent ? by / 100 * size : by);
    } catch (const CaseError& error) {
      xml_.fail(node, fmt::format("{}=\"{}\" must be a number, \"default\", or \"default + 10%\"", axis,
                                  node.attribute(axis).value()));
    }
  }

  void find_domain(const pugi::xml_node& parameters) {
    Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
    for (const Piece& p : pieces_) {
      if (p.as == Drawn::nothing || p.flooded) continue;  // what is filled ends at walls
      const auto [a, b] = p.extent();
      for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], a[k]), hi[k] = std::max(hi[k], b[k]);
    }
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::max(lo[k], place_.min[k]), hi[k] = std::min(hi[k], place_.max[k]);
      if (!(place_.two_d && k == 1) && !(hi[k] > lo[k]))
        xml_.fail(xml_.child(xml_.root(), "casedef"),
                  fmt::format("draws nothing between pointmin and pointmax along {}", "xyz"[k]));
    }
    const Vec3d size = hi - lo;
    hi.z += parameter("IncZ", 0) * size.z;
    if (const pugi::xml_node domain = parameters.child("simulationdomain")) {
      const char* axes[3] = {"x", "y", "z"};
      const pugi::xml_node from = domain.child("posmin"), to = domain.child("posmax");
      for (int k = 0; k < 3; ++k) {
        lo[k] = limit(from, axes[k], lo[k], size[k]);
        hi[k] = limit(to, axes[k], hi[k], size[k]);
      }
    }
    if (place_.two_d) {  // masses there are those of one metre
      const double middle = place_.min.y;
      lo.y = middle - 0.5, hi.y = middle + 0.5;
    }
    place_.min = lo, place_.max = hi;
    const bool all[3] = {has("XYPeriodic") || has("XZPeriodic"), has("XYPeriodic") || has("YZPeriodic"),
                         has("XZPeriodic") || has("YZPeriodic")};
    const char* axes[3] = {"X", "Y", "Z"};
    for (int k = 0; k < 3; ++k) {
      periodic_[k] = all[k];
      for (const char* other : axes)
        if (const std::string key = fmt::format("{}PeriodicInc{}", axes[k], other); has(key)) {
          periodic_[k] = true;
          if (parameter(key, 0) != 0)
            xml_.leave(parameters_[key], key + ": periodic sides have no step; turn gravity instead");
        }
    }
    for (const char* key : {"XYPeriodic", "XZPeriodic", "YZPeriodic"}) read_.insert(key);
    if (place_.two_d) periodic_[1] = false;
  }

  // What moves.

  void check_bodies(const pugi::xml_node& definition, BodyKeys& keys) {
    for (auto it = keys.begin(); it != keys.end();) {
      const bool drawn = std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& p) {
        return p.as == Drawn::bound && p.mk == it->first;
      });
      if (!drawn)
        xml_.left.push_back(
            fmt::format("{}: mkbound {} moves or floats, but draws nothing that has a counterpart",
                        xml_.place(definition), it->first));
      it = drawn ? std::next(it) : keys.erase(it);
    }
  }

  /// What is turned or moved after it is drawn.
  void turn_pieces(const pugi::xml_node& initials) {
    for (const pugi::xml_node& node : initials.children()) {
      const std::string_view name = node.name();
      Quat<double> turn;
      Vec3d from, by;
      if (name == "rotateaxis") {
        from = xml_.vector(node, "axisp1");
        const Vec3d axis = xml_.vector(node, "axisp2") - from;
        if (!(norm(axis) > 0)) xml_.fail(node, "must have two different points axisp1 and axisp2");
        const bool radians = std::string_view(node.attribute("anglesunits").value()) == "radians";
        const double angle = xml_.number(node, "angle") * (radians ? 1 : std::numbers::pi / 180);
        turn = Quat<double>::from_rotation(axis * (angle / norm(axis)));
      } else if (name == "move") {
        by = xml_.vector(node);
      } else {
        continue;
      }
      const auto of = [&](const char* attribute) {
        return node.attribute(attribute) ? numbers_in(xml_, node, attribute) : std::vector<int>{};
      };
      const std::vector<int> bound = of("mkbound"), fluid = of("mkfluid");
      if (bound.empty() && fluid.empty()) xml_.fail(node, "must have the attribute mkbound or mkfluid");
      for (Piece& p : pieces_) {
        const std::vector<int>& wanted = p.as == Drawn::bound ? bound : fluid;
        if (p.as != Drawn::nothing && std::find(wanted.begin(), wanted.end(), p.mk) != wanted.end())
          p.turn_and_move(turn, from + by - turn.rotate(from));
      }
    }
  }

  std::map<int, std::string> initial_velocities(const pugi::xml_node& initials) {
    std::map<int, std::string> out;
    for (const pugi::xml_node& node : initials.children()) {
      const std::string_view name = node.name();
      if (node.type() != pugi::node_element || name.starts_with('_') || name == "rotateaxis" ||
          name == "move")
        continue;
      if (name != "velocity" || node.child("onlypos") || node.child("velocity2") || node.child("velocity3")) {
        xml_.leave(
            node,
            "velocities at the start are those of a whole fill, as numbers or formulas: fluid.fill.velocity");
        continue;
      }
      Vec3d v = xml_.vector(node);
      if (const pugi::xml_node direction = node.child("direction")) {
        const Vec3d along = xml_.vector(direction);
        v = along * (xml_.number(xml_.child(node, "velocity"), "v") / std::max(norm(along), 1e-300));
      }
      for (const int mk : numbers_in(xml_, node, "mkfluid")) out[mk] = Section("").set("velocity", v).text();
    }
    return out;
  }

  // Gauges and what else is special.

  void read_special(const pugi::xml_node& special, std::string& out) {
    for (const pugi::xml_node& node : special.children()) {
      if (node.type() != pugi::node_element) continue;
      const std::string_view name = node.name();
      if (name == "gauges")
        read_gauges(node, out);
      else if (name == "wavepaddles")
        continue;  // moves a body, above
      else if (xml_.flag(node, "active", true))
        xml_.leave(node);
    }
  }

  /// Whether the check points of a gauge lie beside each other rather than one above the other.
  bool level(const pugi::xml_node& swl) {
    if (!swl.child("point2")) return false;
    const Vec3d along = xml_.vector(swl, "point2") - xml_.vector(swl, "point0");
    return std::max(std::abs(along.x), std::abs(along.y)) > std::abs(along.z);
  }

  void read_gauges(const pugi::xml_node& gauges, std::string& out) {
    const pugi::xml_node defaults = gauges.child("default");
    for (const pugi::xml_node& node : gauges.children()) {
      const std::string_view kind = node.name();
      if (node.type() != pugi::node_element || kind == "default") continue;
      Section s("[[probe]]");
      std::string name = node.attribute("name").value();
      for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-' && c != '.') c = '_';
      s.set("name", name.empty() ? fmt::format("gauge_{}", xml_.line(node)) : name);
      if (kind == "velocity") {
        s.set("type", "point").set("at", xml_.vector(node, "point"));
      } else if (kind == "swl" && level(node)) {
        const Vec3d from = xml_.vector(node, "point0"), to = xml_.vector(node, "point2");
        const int axis = std::abs(to.x - from.x) < std::abs(to.y - from.y) ? 1 : 0;
        s.set("type", "front").set("phase", "fluid");
        s.set("direction", fmt::format("{}{}", "xy"[axis], to[axis] < from[axis] ? '-' : '+'));
        xml_.leave(node, "a level line of check points: the probe is the furthest fluid at any height");
      } else if (kind == "swl" || kind == "maxz") {
        s.set("type", "height").set("at", xml_.vector(node, kind == "swl" ? "point0" : "point"));
      } else if (kind == "force") {
        s.set("type", "force")
            .set("body", body_name(numbers_in(xml_, xml_.child(node, "target"), "mkbound")[0]));
      } else {
        xml_.leave(node, "probes measure points, heights, boxes and forces");
        continue;
      }
      for (const pugi::xml_node& from : {node, defaults})
        if (const pugi::xml_node dt = from.child("computedt")) {
          if (const double every = xml_.number(dt, "value"); every > 0) s.set("every", every);
          break;
        }
      out += s.text() + '\n';
    }
  }

  // The case file.

  void numerics(Section& fluid, std::string& other) {
    const double h = constants_.child("hdp")
                         ? constant("hdp", 1.5)
                         : constant("coefh", 0.866025) * std::sqrt(place_.two_d ? 2.0 : 3.0);
    if (std::abs(h - 1.5) > 1e-3) {
      const double kept = std::clamp(h, 1.2, 3.0);
      fluid.raw("h_over_dx", number_text(std::round(kept * 1e4) / 1e4), "smoothing length over spacing");
      if (kept != h)
        xml_.leave(
            constants_,
            fmt::format("a smoothing length of {:.4g} dp: it is within 1.2 to 3 dx here, {}", h, kept));
    }
    if (parameter("Kernel", 2) == 1) fluid.set("kernel", "cubic");
    const double speed = constant("speedsystem", 0), coefficient = constant("coefsound", 20);
    if (speed > 0) fluid.set("vmax", speed);
    const double factor = speed > 0 ? coefficient : coefficient / std::sqrt(2.0);
    const double kept = std::clamp(factor, 5.0, 50.0);
    fluid.raw(
        "c_factor", number_text(std::round(kept * 100) / 100),
        speed > 0 ? "sound speed over vmax" : "sound speed over sqrt(2 g H); coefsound is over sqrt(g H)");
    if (constant("speedsound", 0) > 0)
      xml_.leave(constants_.child("speedsound"), "the sound speed is fluid.c_factor times fluid.vmax");

    const double treatment = parameter("ViscoTreatment", 1);
    const double visco = parameter("Visco", 0.01);
    if (treatment == 1) {
      other += Section("[visc]")
                   .raw("alpha", number_text(visco), "artificial viscosity alone")
                   .set("model", "none")
                   .text() +
               '\n';
    } else {
      fluid.raw("mu", number_text(visco * rho0_), "Pa s, rho0 times the kinematic viscosity");
      if (treatment == 2)
        xml_.leave(parameters_["ViscoTreatment"], "ViscoTreatment 2, SPS: there is no turbulence model");
    }
    const double diffusion = has("DensityDT")
                                 ? (parameter("DensityDT", 0) > 0 ? parameter("DensityDTvalue", 0.1) : 0)
                                 : parameter("DeltaSPH", 0);
    if (diffusion != 0.1)
      other += Section("[density]")
                   .raw("delta", number_text(std::clamp(diffusion, 0.0, 0.2)), "density diffusion")
                   .text() +
               '\n';
    if (constant("gamma", 7) != 7) other += Section("[eos]").set("gamma", constant("gamma", 7)).text() + '\n';
  }

  std::string walls() {
    if (parameter("Boundary", 1) == 2) {
      Section s("[wall]");
      s.set("type", "mdbc");
      if (parameter("SlipMode", 1) == 3) s.set("slip", "slip");
      return s.text() + '\n';
    }
    xml_.left.push_back(xml_.file().string() +
                        ": dynamic boundaries (DBC): walls are of wall.type \"adami\" here, the default");
    return "";
  }

  std::string assemble(const PiecesText& text, const std::string& probes) {
    Section top(""), domain("[domain]"), fluid("[fluid]"), time("[time]"), out("[out]");
    top.set("title", xml_.file().stem().string());
    if (!(gravity_ == Vec3d{0, 0, -9.81})) top.set("gravity", gravity_);
    domain.set("min", place_.min).set("max", place_.max);
    if (periodic_[0] || periodic_[1] || periodic_[2])
      domain.raw("periodic", fmt::format("[{}, {}, {}]", periodic_[0], periodic_[1], periodic_[2]));
    if (place_.two_d) domain.raw("two_d", "true", "forces and masses are those of 1 m along y");
    fluid.raw("dx", number_text(place_.dp), "m");
    if (rho0_ != 1000) fluid.raw("rho0", number_text(rho0_), "kg/m3");
    std::string other;
    numerics(fluid, other);
    const std::string wall = walls();

    if (!has("TimeMax")) xml_.fail(xml_.root(), "must have the parameter TimeMax");
    time.raw("end", number_text(parameter("TimeMax", 0)), "s");
    if (const double cfl = constant("cflnumber", 0.2); cfl > 0)
      time.raw("cfl", number_text(std::min(cfl, 0.5)), "of h/(c + v)");
    if (parameter("DtFixed", 0) > 0)
      xml_.leave(parameters_["DtFixed"], "the step follows from the limits; time.dt fixes it");
    out.raw("every", number_text(parameter("TimeOut", 0.01)), "s");
    if (parameter("Shifting", 0) == 0)
      xml_.left.push_back(
          xml_.file().string() +
          ": no particle shifting: it is on here, as by default; shift.A = 0 switches it off");
    for (const auto& [key, node] : parameters_)
      if (!read_.contains(key) && !kSilent.contains(key) &&
          std::string_view(node.attribute("value").value()) != "NONE") {
        const std::string reason = missing_reason("DualSPHysics", key);
        xml_.leave(node, key + ": " + (reason.empty() ? "there is no counterpart" : reason));
      }

    std::string result;
    for (const Section* s : {&top, &domain, &fluid}) result += s->text() + '\n';
    result += text.shapes + text.fills + wall + text.bodies + other;
    result += time.text() + '\n' + out.text() + '\n' + probes;
    while (result.ends_with("\n\n")) result.pop_back();
    return result;
  }

  XmlReader xml_;
  std::filesystem::path folder_;
  std::map<std::string, pugi::xml_node> parameters_;
  std::set<std::string> read_;
  pugi::xml_node constants_;
  Place place_;
  Vec3d gravity_;
  double rho0_ = 1000;
  bool periodic_[3] = {};
  std::vector<Piece> pieces_;
};

}  // namespace

Conversion from_dualsphysics(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return Reader(file, folder).convert();
}

}  // namespace bedload
