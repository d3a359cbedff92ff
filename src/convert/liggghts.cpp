// An input script of LIGGGHTS to a case file.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bedload/core/error.hpp"
#include "case_text.hpp"
#include "convert.hpp"
#include "liggghts_command.hpp"
#include "liggghts_grains.hpp"
#include "liggghts_walls.hpp"
#include "xml_reader.hpp"

namespace bedload {
namespace {

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

class Script {
 public:
  Script(const std::filesystem::path& file, std::filesystem::path folder)
      : file_(file), folder_(std::move(folder)) {}

  Conversion convert() {
    const std::string name = file_.string();
    for (const ScriptLine& line : read_script(file_))
      command({name, line.number, line.words, variables_, left_});
    return {assemble(), left_};
  }

 private:
  void command(const Command& c) {
    const std::string name = c.word(0);
    if (kSilent.contains(name)) return;
    if (name == "units") {
      if (c.word(1) != "si") c.fail(fmt::format("{} must be si: other units are not converted", c.word(1)));
    } else if (name == "variable") {
      variable(c);
    } else if (name == "boundary") {
      for (std::size_t k = 0; k < 3; ++k) periodic_[k] = c.word(1 + k) == "p";
    } else if (name == "region") {
      grains_.region(c);
    } else if (name == "create_box") {
      const ScriptGrains::Region& box = grains_.region_named(c, c.word(2));
      if (box.kind != "block") c.fail("must name a region of style block");
      box_ = {true, box.min, box.max};
    } else if (name == "pair_style") {
      pair_style(c);
    } else if (name == "timestep") {
      dt_ = c.number(1);
    } else if (name == "run" || name == "run_upto") {
      if (dt_ <= 0) c.fail("must follow a timestep");
      end_ = std::max(end_, name == "run_upto" ? c.number(1) * dt_ : end_ + c.number(1) * dt_);
      const std::size_t upto = c.after("upto");
      if (name == "run" && upto) end_ = c.number(1) * dt_;
    } else if (name == "dump") {
      if (every_ == 0 && dt_ > 0) every_ = c.number(4) * dt_;
    } else if (name == "fix") {
      fix(c);
    } else if (name == "unfix") {
      c.leave("unfix " + c.word(1),
              "what a fix does lasts for the whole run; grain_inlet.stop and wall.body.motion.stop end it");
    } else {
      c.leave(name, missing_reason("LIGGGHTS", name));
    }
  }

  void variable(const Command& c) {
    const std::string style = c.word(2);
    if (style == "equal") {
      std::string text;
      for (std::size_t k = 3; k < c.size(); ++k) text += c.word(k);
      if (text.size() > 1 && text.front() == '"' && text.back() == '"')
        text = text.substr(1, text.size() - 2);
      for (auto at = text.find("v_"); at != text.npos; at = text.find("v_", at))
        if (at == 0 || !(std::isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == '_'))
          text.erase(at, 2);
        else
          ++at;
      variables_.numbers.set("PI", std::numbers::pi), variables_.numbers.set("dt", dt_);
      try {
        variables_.numbers.set(c.word(1), variables_.numbers.value(text));
      } catch (const CaseError&) {
        c.leave(fmt::format("variable {}", c.word(1)),
                "it is no number at the start; formulas of a case are in t");
      }
    } else if (style == "string" || style == "index") {
      variables_.texts[c.word(1)] = c.word(3);
    } else {
      c.leave(fmt::format("variable {} {}", c.word(1), style),
              "sweeps run a case for each of several values: --set");
    }
  }

  void pair_style(const Command& c) {
    if (c.word(1) != "gran")
      return c.leave(fmt::format("pair_style {}", c.word(1)), "contacts are those of pair_style gran");
    const std::string model = c.after("model") ? c.word(c.after("model")) : c.word(2);
    if (model.starts_with("hooke")) {
      c.leave("model hooke",
              "its stiffness follows from characteristicVelocity there, and is contact.k, N/m, here: set it; "
              "contacts are of Hertz until then");
    } else if (!model.starts_with("hertz")) {
      c.leave("model " + model, "contacts are of Hertz");
    }
    if (const std::size_t at = c.after("tangential"); at && c.word(at) != "history") {
      if (c.word(at) == "off")
        frictionless_ = true;
      else
        c.leave("tangential " + c.word(at), "friction has a history");
    }
    const std::size_t rolling = c.after("rolling_friction");
    rolling_ = !rolling || c.word(rolling) == "off"  ? "none"
               : c.word(rolling).starts_with("epsd") ? "epsd"
                                                     : "cdt";
    if (rolling && c.word(rolling) == "epsd2") rolling_damping_ = 0;
    if (const std::size_t cohesion = c.after("cohesion"); cohesion && c.word(cohesion) != "off")
      c.leave("cohesion " + c.word(cohesion), missing_reason("LIGGGHTS", c.word(cohesion)));
  }

  void fix(const Command& c) {
    const std::string id = c.word(1), style = c.word(3);
    if (kSilentFixes.contains(style)) return;
    if (style == "property/global") return materials_.read(c);
    if (style == "gravity") return gravity(c);
    if (style.starts_with("mesh/surface")) return walls_.mesh(c, file_, folder_);
    if (style == "move/mesh") return walls_.move_mesh(c);
    if (style.starts_with("wall/gran")) return walls_.wall(c, box_);
    if (style == "particletemplate/sphere") return grains_.particle_template(c);
    if (style.starts_with("particledistribution/discrete")) return grains_.distribution(c);
    if (style.starts_with("insert/")) return grains_.insert(c, box_);
    const std::string reason = missing_reason("LIGGGHTS", style);
    c.leave(fmt::format("fix {} {}", id, style), reason);
  }

  void gravity(const Command& c) {
    const double size = c.number(4);
    if (c.word(5) != "vector") return c.leave("gravity " + c.word(5), "gravity is a vector");
    const Vec3d along = c.vector(6);
    if (!(norm(along) > 0)) c.fail("must have a direction that is not 0");
    gravity_ = along * (size / norm(along));
  }

  std::string assemble() {
    const std::string name = file_.string();
    if (!box_.present) throw CaseError(name + ": must have create_box with a region of style block");
    if (grains_.empty()) throw CaseError(name + ": must have a fix particletemplate/sphere");
    if (end_ == 0) throw CaseError(name + ": must have timestep and run");
    const ScriptGrains::Template& first = grains_.first();
    Section top(""), domain("[domain]"), grain("[grain]"), contact("[contact]"), time("[time]"), out("[out]");
    top.set("title", file_.filename().string());
    if (!(gravity_ == Vec3d{0, 0, -9.81})) top.set("gravity", gravity_);
    domain.set("min", box_.min).set("max", box_.max);
    if (periodic_[0] || periodic_[1] || periodic_[2])
      domain.raw("periodic", fmt::format("[{}, {}, {}]", periodic_[0], periodic_[1], periodic_[2]));
    grain.raw("d", number_text(2 * first.radius), "m").raw("rho", number_text(first.density), "kg/m3");
    const int t = first.type;
    if (const auto E = materials_.value("youngsModulus", t, t)) grain.raw("E", number_text(*E), "Pa");
    if (const auto nu = materials_.value("poissonsRatio", t, t)) grain.set("nu", *nu);
    if (const auto mu = frictionless_ ? std::optional(0.0) : materials_.value("coefficientFriction", t, t))
      grain.set("mu", *mu);
    if (const auto mu_r = materials_.value("coefficientRollingFriction", t, t)) grain.set("mu_r", *mu_r);
    if (const auto e = materials_.value("coefficientRestitution", t, t)) grain.set("e", *e);
    if (rolling_ != "epsd") contact.set("rolling", rolling_);
    if (const auto damping = materials_.value("coefficientRollingViscousDamping", 1, 1);
        damping && rolling_damping_ != 0)
      rolling_damping_ = *damping;
    if (rolling_ == "epsd" && rolling_damping_ >= 0) contact.set("eta_r", rolling_damping_);
    const ScriptWalls::Text walls = walls_.text(materials_, t, name, left_);
    if (dt_ > 0)
      left_.push_back(
          name + ": timestep: the step of the grains follows from their stiffness; time.dt_dem fixes it");
    time.raw("end", number_text(end_), "s");
    out.raw("every", number_text(every_ > 0 ? every_ : end_ / 100), "s");
    std::string result = top.text() + '\n' + domain.text() + '\n' + grain.text() + '\n' + grains_.shapes() +
                         walls.shapes + grains_.fills() + grains_.inlets();
    if (!contact.empty()) result += contact.text() + '\n';
    result += walls.bodies + time.text() + '\n' + out.text() + '\n' + walls.probes;
    while (result.ends_with("\n\n")) result.pop_back();
    return result;
  }

  const std::filesystem::path& file_;
  std::filesystem::path folder_;
  ScriptVariables variables_;
  ScriptMaterials materials_;
  ScriptGrains grains_;
  ScriptWalls walls_;
  ScriptBox box_;
  std::vector<std::string> left_;
  std::string rolling_ = "none";
  double rolling_damping_ = -1, dt_ = 0, end_ = 0, every_ = 0;
  bool periodic_[3] = {}, frictionless_ = false;
  Vec3d gravity_{0, 0, -9.81};
};

}  // namespace

Conversion from_liggghts(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return Script(file, folder).convert();
}

}  // namespace bedload
