// Parameters against each other.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bedload/case/formula.hpp"
#include "bedload/case/grain_sizes.hpp"
#include "bedload/case/limits.hpp"
#include "bedload/case/materials.hpp"
#include "bedload/case/normal_laws.hpp"
#include "bedload/case/parameters.hpp"
#include "bedload/case/particle_file.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/body.hpp"
#include "bedload/geometry/depth.hpp"
#include "bedload/geometry/shape.hpp"
#include "resolve.hpp"
#include "src/motion/survey.hpp"

namespace bedload {
namespace {

std::string to_text(const Vec3d& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

class Checks {
 public:
  Checks(const Config& config, const Value& root, std::vector<std::string>& warnings)
      : c(config), root_(root), warnings_(warnings) {}

  void domain() const {
    box("domain", c.domain.min, c.domain.max);
    if (!c.fluid.present && !c.grain.present && c.wall.free_bodies() == 0)
      throw CaseError(root_.place() + ": nothing to compute; give [fluid], [grain] or both");
    for (int k = 0; k < 3; ++k) {
      if (!c.domain.periodic[k]) continue;
      if (c.drive.rate[k] != 0)
        fail("drive.rate", to_text(c.drive.rate),
             fmt::format("must be 0 along {}, which is periodic and has no centre", "xyz"[k]));
      if (c.domain.flat(k)) continue;
      period(k, 2 * c.fluid.reach(), c.fluid.variable_h ? "4 kappa h" : "2 kappa h", c.fluid.present);
      period(k, 2 * c.fluid.kappa() * c.couple.hc, "2 kappa h_c", coupled());
      period(k, 2 * c.grain.d_max, "4 R", c.grain.present);
    }
    if (c.domain.two_d) check_plane(c, root_);
  }

  void fluid() const {
    const FluidConfig& f = c.fluid;
    double particles = 0;
    for (std::size_t i = 0; i < f.fills.size(); ++i) {
      const std::string path = fmt::format("fluid.fill.{}", i);
      if (!f.fills[i].file.empty()) continue;  // its particles are checked one by one
      box(path, f.fills[i].min, f.fills[i].max);
      if (!f.fills[i].solid.shape) {
        inside_domain(path + ".min", f.fills[i].min);
        inside_domain(path + ".max", f.fills[i].max);
      }
      const Vec3d side = f.fills[i].max - f.fills[i].min;
      particles += side.x * side.y * side.z / c.domain.cell_volume(f.dx);
      initial_speed(f.fills[i]);
    }
    if (particles >= 2147483648.0)
      fail("fluid.dx", f.dx,
           fmt::format("must be larger; it makes {:.3g} fluid particles of at most 2147483647", particles));
    const double fall = height(std::vector<DomainConfig>{c.domain}, c.gravity);
    if (const double v = std::sqrt(2 * norm(c.gravity) * fall); !c.inlets.empty() && v > f.vmax * (1 + 1e-9))
      warn(
          "fluid.vmax = {:.3g} m/s sets the sound speed; fluid from an inlet that stands or falls as high as "
          "the domain, {:.3g} m, reaches {:.3g} m/s",
          f.vmax, fall, v);
    falling_grains();
    if (f.c < 10 * f.vmax * (1 - 1e-9))
      warn(
          "fluid.c_factor: sound is only {:.3g} times as fast as the flow (Mach {:.2g}); density will vary "
          "by more "
          "than 1 %",
          f.c / f.vmax, f.vmax / f.c);
    if (coupled() && f.mu == 0) fail("fluid.mu", f.mu, "must be > 0 with grains; drag needs mu");
    if (f.sdpd()) sdpd();
    if (!f.species.empty()) species();
    if (c.visc.collision && c.sdpd.kT > 0)
      fail("visc.collision", "true",
           "must be false with sdpd.kT > 0, since collisions take out what noise brings");
    if (c.drive.factor != DriveConfig().factor) drive();
    if (!c.grain.present && c.drive.on != DrivenPhase::fluid)
      fail("drive.on", quoted(c.drive.on.name()), "must be \"fluid\" without [grain]");
    if (f.variable_h) variable_h();
  }

  /// Meshes in mm that are taken for m lie far outside the domain, or are lost in it.
  void meshes() const {
    const auto largest = [](const Vec3d& side) { return std::max({side.x, side.y, side.z}); };
    const Vec3d extent = c.domain.max - c.domain.min;
    for (const ShapeConfig& shape : c.shapes) {
      if (shape.kind != "mesh") continue;
      const Bounds bounds = shape.solid.shape->bounds();
      const Vec3d side = bounds.max - bounds.min;
      const double times = largest(side) / largest(extent);
      if (times > 20 || times < 1e-3)
        warn(
            "shape \"{}\": its mesh is {:.3g} x {:.3g} x {:.3g} m large, the domain {:.3g} x {:.3g} x {:.3g} "
            "m; does it need another scale?",
            shape.name, side.x, side.y, side.z, extent.x, extent.y, extent.z);
    }
  }

  void walls() const {
    std::set<std::string> names;
    for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
      const WallBody& body = c.wall.bodies[i];
      const std::string path = fmt::format("wall.body.{}", i);
      file_name(path + ".name", body.name);
      if (!names.insert(body.name).second)
        fail(path + ".name", quoted(body.name), "must differ from other bodies'");
      if (body.shape != "plane") box(path, body.min, body.max);
      if (body.solid.shape) within_period(path + ".shape", body);
      countable(path + ".shape", body);
      if (!body.moves()) met(body);
    }
    if (!c.fluid.present) return;
    const double dx = c.fluid.dx;
    if (c.wall.dx < 0.25 * dx * (1 - 1e-9) || c.wall.dx > dx * (1 + 1e-9))
      fail("wall.dx", c.wall.dx,
           fmt::format("must be within {}..{}; a quarter of fluid.dx to fluid.dx", dx / 4, dx));
    if (c.wall.rep_r0 > dx * (1 + 1e-9))
      fail("wall.rep_r0", c.wall.rep_r0, fmt::format("must be at most fluid.dx = {}", dx));
    for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
      const WallBody& body = c.wall.bodies[i];
      const double spacing = c.wall.spacing(body), most = body.single_layer() ? dx / 2 : dx;
      if (spacing < 0.25 * dx * (1 - 1e-9) || spacing > most * (1 + 1e-9))
        fail(fmt::format("wall.body.{}.dx", i), spacing,
             fmt::format("must be within {}..{}; a quarter of fluid.dx to {}", dx / 4, most,
                         body.single_layer() ? "half of it for a single_layer" : "fluid.dx"));
      const double r0 = c.wall.layer_r0;
      if (body.single_layer() && (r0 < spacing * (1 - 1e-9) || r0 > dx * (1 + 1e-9)))
        fail("wall.layer_r0", r0,
             fmt::format("must be within {}..{}; the spacing of wall.body \"{}\" to fluid.dx", spacing, dx,
                         body.name));
    }
  }

  void motions() const {
    for (const WallBody& body : c.wall.bodies) {
      const std::vector<Vec3d> at = corners(body, c.domain);
      if (const double shift = initial_shift(body.motion, at); shift > 1e-9)
        warn("wall.body \"{}\": its motion begins {:.4g} m away from where fluid and grains start for it",
             body.name, shift);
      auto jumps = velocity_jumps(body.motion, at, c.time.end);
      std::erase_if(jumps, [&](const VelocityJump& jump) { return jump.time == 0 && steady(body.motion); });
      warn_of(jumps, fmt::format("wall.body \"{}\"", body.name), "");
    }
    const MotionConfig& frame = c.frame.motion;
    for_parts(frame, "frame.motion",
              [&](const MotionPart& m, const std::string& path) { translates(m, path); });
    auto jumps = velocity_jumps(frame, {Vec3d{}}, c.time.end);
    // what is inside begins at the frame's own velocity
    std::erase_if(jumps, [](const VelocityJump& jump) { return jump.time == 0; });
    warn_of(jumps, "frame.motion", "; it does not act on what is inside");
  }

  void grains() const {
    const GrainConfig& g = c.grain;
    if (g.d_max > 20 * g.d_min)
      fail("grain.fill", fmt::format("{:.4g}..{:.4g} m", g.d_min, g.d_max),
           "must span at most a factor of 20 in diameter");
    for (std::size_t i = 0; i < g.fills.size(); ++i) grain_fill(fmt::format("grain.fill.{}", i), g.fills[i]);
    if (c.contact.k == 0 && c.contact.normal == NormalLaw::linear)
      missing("contact.k", "spring, N/m, with contact.normal = \"linear\"");
    if (c.contact.normal == NormalLaw::democritus && c.contact.tangential == SlidingLaw::linear)
      fail("contact.tangential", "\"linear\"",
           "must be another with contact.normal = \"democritus\", whose damping would make energy with it");
    if (g.settle && norm(c.gravity) == 0) fail("grain.settle", "true", "must be false without gravity");
    if (g.settle && g.fixed) fail("grain.settle", "true", "must be false with grain.fixed");
    for (const auto& [key, given] :
         {std::pair{"grain.settle_time", g.settle_time > 0}, {"grain.settle_mu", std::isfinite(g.settle_mu)}})
      if (given && !g.settle) warn("{}: not used, since grain.settle = false", key);
    if (!c.contact.cap_rolling && c.contact.rolling == RollingLaw::cdt)
      warn("contact.cap_rolling = false: resting grains will buzz and heaps creep");
    if (c.contact.he_damping) warn("paper.he_damping: the restitution reached is below grain.e");
    softness();
    if (c.lubrication.acts()) lubrication();
    materials();
    if (!c.fluid.present && c.drive.on_fluid())
      fail("drive.on", quoted(c.drive.on.name()), "must be \"grains\" without [fluid]");
  }

  void coupling() const {
    const double reach = c.fluid.kappa() * c.couple.hc, d = c.grain.d_max;
    if (c.couple.drag == DragLaw::table) drag_table();
    if (c.couple.S_wet <= c.couple.S_dry)
      fail("couple.S_wet", c.couple.S_wet, fmt::format("must be > couple.S_dry = {}", c.couple.S_dry));
    if (!coupled()) return;
    if (reach < 2 * d * (1 - 1e-9))
      fail("couple.hc", c.couple.hc,
           fmt::format("must be >= {}; unresolved coupling needs kappa h_c >= 2 d_max",
                       2 * d / c.fluid.kappa()));
    if (reach < 4 * d * (1 - 1e-9))
      warn(
          "couple.hc: the coupling reaches {:.3g} diameters of the largest grain, which feels its own wake "
          "below 4",
          reach / d);
  }

  void drag_table() const {
    const DragTable& t = c.couple.table;
    const auto nodes = [&](const char* key, const std::vector<double>& list, std::size_t least) {
      const auto say = [&](const std::string& must) {
        fail(key, fmt::format("[{}]", fmt::join(list, ", ")), must);
      };
      if (list.size() < least || list.size() > 1000) say(fmt::format("must hold {} to 1000 numbers", least));
      if (std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) != list.end())
        say("must rise from each to the next");
    };
    nodes("drag.porosity", t.porosity, 1);
    nodes("drag.reynolds", t.reynolds, 2);
    if (t.reynolds.front() != 0) fail("drag.reynolds", t.reynolds.front(), "must begin with 0");
    if (t.factor.size() != t.porosity.size() * t.reynolds.size())
      fail("drag.factor", fmt::format("[...] of {}", t.factor.size()),
           fmt::format("must hold {} numbers, {} Reynolds numbers for each of {} porosities",
                       t.porosity.size() * t.reynolds.size(), t.reynolds.size(), t.porosity.size()));
  }

  void openings() const {
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
      finite_factor(path + ".factor", c.inlets[i].factor);
    }
    for (std::size_t i = 0; i < c.outlets.size(); ++i) {
      const OutletConfig& outlet = c.outlets[i];
      const std::string path = fmt::format("outlet.{}", i);
      if (c.grain.present && outlet.takes("grains") && !c.grain.rigid_fills().empty())
        fail(path + ".phase", quoted(outlet.phase), "must be \"fluid\" where grains form rigid groups");
      named(path, outlet.name);
      if (outlet.shape == "box") box(path, outlet.min, outlet.max);
      if (outlet.shape != "plane" && !in_sight(outlet.min, outlet.max))
        fail(path + ".shape", quoted(outlet.shape), "must reach into the domain");
      if (outlet.phase != "both" && !(outlet.phase == "fluid" ? c.fluid.present : c.grain.present))
        fail(path + ".phase", quoted(outlet.phase),
             fmt::format("must name something in this case; it has no {}", outlet.phase));
    }
    for (std::size_t i = 0; i < c.grain_inlets.size(); ++i) {
      named(fmt::format("grain_inlet.{}", i), c.grain_inlets[i].name);
      grain_inlet(fmt::format("grain_inlet.{}", i), c.grain_inlets[i]);
    }
  }

  void time() const {
    for (const StepLimit& limit : grain_limits(c)) {
      if (c.time.dt_dem <= limit.seconds * (1 + 1e-9)) continue;
      if (!c.time.force_dt)
        fail("time.dt_dem", c.time.dt_dem,
             fmt::format("must be <= {:.4g}; limited by {}", limit.seconds, limit.name));
      warn("time.dt_dem = {} is above its limit {:.4g} ({})", c.time.dt_dem, limit.seconds, limit.name);
    }
    if (c.time.integrator == TimeIntegrator::ab3) one_pass();
    if (c.time.integrator == TimeIntegrator::euler)
      warn("time.integrator = \"euler\" is first order in time");
  }

  /// Density from former rates goes with what one visit of each pair can find, and bears shorter steps, by
  /// linear analysis: sound is damped up to a cfl of 0.6, density diffusion at its largest up to 0.39.
  void one_pass() const {
    if (c.time.cfl > 0.3) fail("time.cfl", c.time.cfl, "must be <= 0.3 with time.integrator = \"ab3\"");
    const auto frozen = [](const WallBody& body) { return body.type == WallType::frozen; };
    for (const auto& [there, what] :
         {std::pair{coupled() && c.couple.mode == CouplingMode::two_way, "grains that the fluid feels"},
          {std::any_of(c.wall.bodies.begin(), c.wall.bodies.end(), frozen), "frozen walls"},
          {c.tensile > 0, "tensile > 0"},
          {c.xsph > 0, "xsph > 0"}})
      if (there) fail("time.integrator", "\"ab3\"", fmt::format("must be \"kdk\" with {}", what));
  }

  void probes() const {
    std::set<std::string> names;
    for (std::size_t i = 0; i < c.out.probes.size(); ++i) {
      const ProbeConfig& probe = c.out.probes[i];
      const std::string path = fmt::format("probe.{}", i);
      file_name(path + ".name", probe.name);
      if (!names.insert(probe.name).second)
        fail(path + ".name", quoted(probe.name), "must differ from other probes'");
      if (probe.type == "box") {
        box(path, probe.min, probe.max);
        if (!in_sight(probe.min, probe.max))
          fail(path + ".min", to_text(probe.min), "must have a part of the domain in its box");
      }
      if (probe.type == "point" || probe.type == "wall_pressure") inside_domain(path + ".at", probe.at);
      if (probe.type == "height") column_in_domain(path + ".at", probe.at);
      const bool has_phase = probe.type == "front" || probe.type == "box";
      const std::string phase = has_phase ? probe.phase : "fluid";
      if (probe.type != "force" && !(phase == "fluid" ? c.fluid.present : c.grain.present))
        fail(path + (has_phase ? ".phase" : ".type"), quoted(has_phase ? phase : probe.type),
             fmt::format("must name something in this case; it has no {}", phase));
      if (probe.type == "force" || !probe.body.empty()) body_exists(path + ".body", probe.body);
    }
  }

 private:
  void lubrication() const {
    const LubricationConfig& l = c.lubrication;
    const auto refuse = [&](const char* with) {
      fail("lubrication.forces", quoted(l.forces.name()), fmt::format("must be \"none\" {}", with));
    };
    if (!coupled()) refuse("without [fluid] to which grains are coupled");
    if (c.contact.normal == NormalLaw::none) refuse("with contact.normal = \"none\"");
    if (c.wall.free_bodies() > 0) refuse("with wall bodies that move freely");
    if (l.least_gap >= l.cut_off)
      fail("lubrication.least_gap", l.least_gap,
           fmt::format("must be below lubrication.cut_off = {}", l.cut_off));
  }
  void materials() const {
    std::set<std::string> names;
    std::string all;
    for (std::size_t k = 0; k < c.grain.materials.size(); ++k) {
      const std::string& name = c.grain.materials[k].name;
      if (!names.insert(name).second)
        fail(fmt::format("grain.material.{}.name", k), quoted(name), "must differ from other materials'");
      all += (all.empty() ? "" : ", ") + name;
    }
    const auto known = [&](const std::string& path, const std::string& name) {
      if (!name.empty() && !names.contains(name))
        fail(path + ".material", quoted(name),
             "must name a grain.material; this case has " + (all.empty() ? "none" : all));
    };
    for (std::size_t i = 0; i < c.grain.fills.size(); ++i)
      known(fmt::format("grain.fill.{}", i), c.grain.fills[i].material);
    for (std::size_t i = 0; i < c.grain_inlets.size(); ++i)
      known(fmt::format("grain_inlet.{}", i), c.grain_inlets[i].material);
  }
  /// Several fluids.
  void species() const {
    const FluidConfig& f = c.fluid;
    std::set<std::string> names;
    std::string all;
    for (std::size_t k = 0; k < f.species.size(); ++k) {
      if (!names.insert(f.species[k].name).second)
        fail(fmt::format("fluid.species.{}.name", k), quoted(f.species[k].name),
             "must differ from other species'");
      all += (all.empty() ? "" : ", ") + f.species[k].name;
    }
    for (std::size_t i = 0; i < f.fills.size(); ++i)
      if (const std::string& name = f.fills[i].species; !name.empty() && !names.contains(name))
        fail(fmt::format("fluid.fill.{}.species", i), quoted(name),
             "must name a fluid.species; this case has " + all);
    for (const auto& [there, what] :
         {std::pair{coupled(), "grains that the fluid acts on"},
          {!c.inlets.empty(), "[[inlet]]"},
          {c.time.integrator == TimeIntegrator::ab3, "time.integrator = \"ab3\""}})
      if (there)
        fail("fluid.species", fmt::format("{} fluids", f.species.size()),
             fmt::format("must be none with {}", what));
  }
  void drive() const {
    const Formula factor(c.drive.factor, "xyzt");
    const Vec3d side = c.domain.max - c.domain.min;
    for (int n = 0; n < 1000; ++n) {
      const double t = c.time.end * (n / 125) / 7.0;
      const Vec3d s{(n % 5) / 4.0, (n / 5 % 5) / 4.0, (n / 25 % 5) / 4.0};
      const Vec3d x{c.domain.min.x + s.x * side.x, c.domain.min.y + s.y * side.y,
                    c.domain.min.z + s.z * side.z};
      if (!std::isfinite(factor(x, t)))
        fail("drive.factor", quoted(c.drive.factor),
             fmt::format("must be a finite number; it is none at {} m, t = {:.4g} s", to_text(x), t));
    }
  }
  /// What needs one smoothing length for all.
  void variable_h() const {
    const std::string with = "with fluid.variable_h";
    if (c.fluid.sdpd()) fail("fluid.model", quoted(c.fluid.model.name()), "must be \"wcsph\" " + with);
    if (c.fluid.kernel == KernelFunction::lucy)
      fail("fluid.kernel", "\"lucy\"", "must be wendland_c2 or cubic " + with);
    if (c.time.integrator == TimeIntegrator::ab3)
      fail("time.integrator", "\"ab3\"", "must be \"kdk\" or \"euler\" " + with);
    for (const auto& [key, value] : {std::pair{"shift.A", c.shift}, {"xsph", c.xsph}, {"tensile", c.tensile}})
      if (value != 0) fail(key, value, "must be 0 " + with);
    if (!c.fluid.species.empty())
      fail("fluid.species", fmt::format("{} fluids", c.fluid.species.size()), "must be none " + with);
    if (c.visc.collision) fail("visc.collision", "true", "must be false " + with);
    for (std::size_t i = 0; i < c.wall.bodies.size(); ++i)
      if (const WallBody& body = c.wall.bodies[i];
          body.type == WallType::frozen || body.type == WallType::mdbc)
        fail(fmt::format("wall.body.{}.type", i), quoted(body.type.name()),
             "must be adami, single_layer, grains_only or fluid_only " + with);
  }
  /// What SDPD needs, and what of WCSPH's it leaves out.
  void sdpd() const {
    const FluidConfig& f = c.fluid;
    const SdpdConfig& s = c.sdpd;
    const std::string with = fmt::format("with fluid.model = \"{}\"", f.model.name());
    if (c.domain.two_d) fail("domain.two_d", "true", "must be false " + with);
    for (const auto& [key, value] : {std::pair{"shift.A", c.shift},
                                     {"xsph", c.xsph},
                                     {"tensile", c.tensile},
                                     {"density.delta", c.density.delta},
                                     {"density.void_relaxation", c.density.void_relaxation},
                                     {"visc.alpha", c.visc.alpha},
                                     {"visc.beta", c.visc.beta}})
      if (value != 0) fail(key, value, fmt::format("must be 0 {}, whose noise would set it off", with));
    if (c.visc.model != ViscosityModel::none)
      fail("visc.model", quoted(c.visc.model.name()),
           fmt::format("must be \"none\" {}, which brings its own viscosity", with));
    if (c.time.integrator != TimeIntegrator::kdk)
      fail("time.integrator", quoted(c.time.integrator.name()), "must be \"kdk\" " + with);
    for (std::size_t i = 0; i < c.wall.bodies.size(); ++i)
      if (const WallBody& body = c.wall.bodies[i]; body.stops_fluid() && body.type != WallType::adami)
        fail(fmt::format("wall.body.{}.type", i), quoted(body.type.name()), "must be \"adami\" " + with);
    const bool tensor = s.noise == NoiseForm::tensor && f.model == FluidModel::sdpd_a && s.kT > 0;
    const double most = 5.0 / 3 * f.mu, least = tensor ? 40.0 / 51 * f.mu : 0;
    if (f.zeta > most * (1 + 1e-9) || f.zeta < least * (1 - 1e-9))
      fail("fluid.zeta", f.zeta,
           fmt::format("must be within {:.6g}..{:.6g}, {}..5/3 of fluid.mu{}", least, most,
                       tensor ? "40/51" : "0", tensor ? " with sdpd.noise = \"tensor\"" : ""));
    if (s.force_scale.size() != 4)
      fail("sdpd.force_scale", fmt::format("[{}]", fmt::join(s.force_scale, ", ")),
           "must be four numbers: pressure, friction, friction of spins, noise");
    const double thermal = std::sqrt(3 * s.kT / (f.rho0 * c.domain.cell_volume(f.dx)));
    if (thermal > 0.3 * f.c)
      warn("sdpd.kT: particles move at {:.3g} m/s by heat alone, sound at {:.3g}; density will vary widely",
           thermal, f.c);
    if (c.density.reinit_every > 0 && c.density.method != DensityMethod::continuity)
      fail("density.reinit_every", c.density.reinit_every,
           "must be 0 unless density.method = \"continuity\"");
  }
  /// Moves as it does from the first: a jump at t = 0 is meant.
  static bool steady(const MotionConfig& m) {
    return m.add.empty() && (m.kind == "velocity" || m.kind == "rotation");
  }
  /// The first jumps of a motion, and how many more there are.
  void warn_of(const std::vector<VelocityJump>& jumps, const std::string& of, const char* note) const {
    constexpr std::size_t few = 4;
    for (std::size_t k = 0; k < jumps.size() && (k < few || jumps.size() == few + 1); ++k)
      warn("{}: its velocity jumps by {:.4g} m/s at t = {:.4g} s{}", of, jumps[k].size, jumps[k].time, note);
    if (jumps.size() > few + 1)
      warn("{}: its velocity jumps {} times more until t = {:.4g} s", of, jumps.size() - few,
           jumps.back().time);
  }
  /// A turning frame would need centrifugal, Coriolis and Euler forces.
  void translates(const MotionPart& m, const std::string& path) const {
    const char* must = "must not turn; a frame can only be translated";
    if (m.kind == "rotation") fail(path + ".kind", quoted(m.kind), must);
    if (m.rotation != MotionPart().rotation)
      fail(path + ".rotation", fmt::format("[{}]", fmt::join(m.rotation, ", ")), must);
    for (const MotionRow& row : m.rows)
      if (row[4] != 0 || row[5] != 0 || row[6] != 0)
        fail(path + ".kind", fmt::format("a table with rx, ry, rz = {}, {}, {} deg", row[4], row[5], row[6]),
             must);
  }
  bool coupled() const { return c.fluid.present && c.grain.present && c.couple.mode != CouplingMode::off; }

  static std::string quoted(const std::string& text) { return fmt::format("\"{}\"", text); }
  template <class T>
  [[noreturn]] void fail(const std::string& path, const T& value, const std::string& must) const {
    reject(root_, path, fmt::format("{}", value), must);
  }
  [[noreturn]] void missing(const std::string& key, const std::string& what) const {
    throw CaseError(fmt::format("{}: {} must be given ({})", nearest_value(root_, key).place(), key, what));
  }
  template <class... Args>
  void warn(fmt::format_string<Args...> text, Args&&... args) const {
    warnings_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }

  void box(const std::string& path, const Vec3d& lo, const Vec3d& hi) const {
    for (int k = 0; k < 3; ++k)
      if (!(hi[k] > lo[k]))
        fail(path + ".max", to_text(hi),
             fmt::format("must exceed {}.min = {} on every axis", key_of(path), to_text(lo)));
  }
  void period(int axis, double least, const char* name, bool applies) const {
    const double length = c.domain.max[axis] - c.domain.min[axis];
    if (applies && length <= least)
      fail("domain.periodic", fmt::format("{} m along {}", length, "xyz"[axis]),
           fmt::format("must be a period > {} = {}; enlarge the domain or refine", name, least));
  }
  /// Grains in air fall into the fluid faster than it flows by itself.
  void falling_grains() const {
    if (!c.grain.present || c.grain.settle || c.grain.fixed) return;
    std::vector<DomainConfig> all;
    for (const FluidFill& fill : c.fluid.fills) all.push_back({.min = fill.min, .max = fill.max});
    const std::size_t fluid = all.size();
    for (const GrainFill& fill : c.grain.fills)
      if (fill.file.empty() && fill.positions.empty()) all.push_back({.min = fill.min, .max = fill.max});
    if (fluid == 0 || all.size() == fluid) return;
    const double fall = height(all, c.gravity), v = std::sqrt(2 * norm(c.gravity) * fall);
    if (v > c.fluid.vmax * (1 + 1e-9))
      warn(
          "fluid.vmax = {:.3g} m/s sets the sound speed; grains that fall {:.3g} m into the fluid reach "
          "{:.3g} m/s",
          c.fluid.vmax, fall, v);
  }
  /// Whether a box shares space with the domain.
  bool in_sight(const Vec3d& lo, const Vec3d& hi) const {
    for (int k = 0; k < 3; ++k)
      if (!c.domain.periodic[k] && (hi[k] < c.domain.min[k] || lo[k] > c.domain.max[k])) return false;
    return true;
  }
  /// The largest side of a body alone must not have more wall particles than there can be.
  void countable(const std::string& path, const WallBody& body) const {
    if (!c.fluid.present || body.shape == "plane" || !body.stops_fluid()) return;
    const Vec3d side = body.max - body.min;
    const double spacing = c.wall.spacing(body);
    const double layer = std::max({side.x * side.y, side.y * side.z, side.z * side.x}) / (spacing * spacing);
    if (layer >= 2147483648.0)
      fail(path, quoted(body.shape),
           fmt::format(
               "must be smaller; at {:.3g} x {:.3g} x {:.3g} m a layer of wall particles {} m apart has "
               "{:.3g} of at most 2147483647",
               side.x, side.y, side.z, spacing, layer));
  }
  /// Particles leave a domain before they meet a wall beyond it.
  void met(const WallBody& body) const {
    const Vec3d &lo = c.domain.min, &hi = c.domain.max;
    const double rounding = 1e-9 * norm(hi - lo);
    if (body.shape == "plane") {
      double nearest = 1e300;  // of the domain's corners, before the plane
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3d at{corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z};
        nearest = std::min(nearest, dot(at - body.point, body.normal));
      }
      if (nearest > rounding)
        warn("wall.body \"{}\" lies {:.3g} m outside the domain, so particles leave before they meet it",
             body.name, nearest);
    } else if (body.shape == "tank") {
      for (int face = 0; face < 6; ++face) {
        const int k = face / 2;
        const double beyond = face % 2 ? body.max[k] - hi[k] : lo[k] - body.min[k];
        if (body.faces[face] && !c.domain.periodic[k] && beyond > rounding)
          warn(
              "face {} of wall.body \"{}\" lies {:.3g} m outside the domain, so particles leave before they "
              "meet it",
              kFaces[face], body.name, beyond);
      }
    } else if (!in_sight(body.min, body.max)) {
      warn("wall.body \"{}\" lies outside the domain, so particles leave before they meet it", body.name);
    }
  }
  void finite_factor(const std::string& path, const std::string& text) const {
    const Formula factor(text, "t");
    constexpr int looks = 1000;
    for (int n = 0; n <= looks; ++n) {
      const double t = c.time.end * n / looks;
      if (!std::isfinite(factor({t, 0, 0})))
        fail(path, quoted(text),
             fmt::format("must be a finite number at all times; it is none at t = {:.4g} s", t));
    }
  }
  /// Shapes do not repeat.
  void within_period(const std::string& path, const WallBody& body) const {
    for (int k = 0; k < 3; ++k)
      if (c.domain.periodic[k] && !c.domain.flat(k) &&
          (body.min[k] < c.domain.min[k] || body.max[k] > c.domain.max[k]))
        fail(
            path, quoted(body.shape),
            fmt::format("must lie within the period along {}, {}..{} m; only tank, box and plane run through",
                        "xyz"[k], c.domain.min[k], c.domain.max[k]));
  }
  void inside_domain(const std::string& path, const Vec3d& x) const {
    const Vec3d &lo = c.domain.min, &hi = c.domain.max;
    for (int k = 0; k < 3; ++k) {
      const double slack = 1e-9 * (hi[k] - lo[k]);
      if (x[k] < lo[k] - slack || x[k] > hi[k] + slack)
        fail(path, to_text(x), fmt::format("must lie in the domain {}..{}", to_text(lo), to_text(hi)));
    }
  }
  /// The line along gravity through x must meet the domain.
  void column_in_domain(const std::string& path, const Vec3d& x) const {
    const auto [from, to] = line_in_box(x, upwards(c.gravity), c.domain.min, c.domain.max);
    if (from > to)
      fail(path, to_text(x),
           fmt::format("must have a part of the domain {}..{} above or below it", to_text(c.domain.min),
                       to_text(c.domain.max)));
  }
  void file_name(const std::string& path, const std::string& name) const {
    const auto plain = [](unsigned char ch) {
      return std::isalnum(ch) || ch == '_' || ch == '-' || ch == '.';
    };
    if (!std::all_of(name.begin(), name.end(), plain) || name[0] == '.')
      fail(path, quoted(name), "must consist of letters, digits, '_', '-' and '.'");
  }
  void body_exists(const std::string& path, const std::string& name) const {
    std::string all;
    for (const WallBody& body : c.wall.bodies) {
      if (body.name == name) return;
      all += (all.empty() ? "" : ", ") + body.name;
    }
    fail(path, quoted(name), "must name a wall.body; this case has " + (all.empty() ? "none" : all));
  }
  /// The formulas of a fill on a 5 x 5 x 5 raster.
  void initial_speed(const FluidFill& fill) const {
    const Formula u(fill.velocity[0]), v(fill.velocity[1]), w(fill.velocity[2]);
    double fastest = 0;
    for (int i = 0; i < 125; ++i) {
      const Vec3d s{(i % 5) / 4.0, (i / 5 % 5) / 4.0, (i / 25) / 4.0}, side = fill.max - fill.min;
      const Vec3d x{fill.min.x + s.x * side.x, fill.min.y + s.y * side.y, fill.min.z + s.z * side.z};
      fastest = std::max(fastest, norm(Vec3d{u(x), v(x), w(x)}));
    }
    if (fastest > c.fluid.vmax * (1 + 1e-9))
      warn(
          "fluid.fill.velocity reaches {:.3g} m/s, above fluid.vmax = {:.3g}, from which the sound speed "
          "follows",
          fastest, c.fluid.vmax);
  }
  void grain_inlet(const std::string& path, const GrainInletConfig& inlet) const {
    double d = 0;
    for (const SizeClass& size : inlet.sizes) d = std::max(d, size_range(size).second);
    if (c.grain.fixed) fail("grain.fixed", "true", "must be false with grain_inlet");
    if (inlet.shape == "disc") {
      inside_domain(path + ".centre", inlet.centre);
      if (2 * inlet.radius < d)
        fail(path + ".radius", inlet.radius,
             fmt::format("must be at least {}, for the largest grain", d / 2));
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
  void grain_fill(const std::string& path, const GrainFill& fill) const {
    if (fill.file.empty())
      for (const Vec3d& x : listed_grains(fill, c.domain).x) inside_domain(path + ".positions", x);
    for (const auto& [key, list] : {std::pair{".velocities", &fill.velocities}, {".spins", &fill.spins}})
      if (!list->empty() && list->size() != fill.positions.size())
        fail(path + key, fmt::format("{} vectors", list->size()),
             fmt::format("must be as many as positions, {}", fill.positions.size()));
    if (fill.replaces_fluid && (!c.fluid.present || c.grain.settle))
      fail(path + ".replaces_fluid", "true", "must be false without [fluid], and with grain.settle");
    if (fill.rigid.present && (fill.spin != Vec3d{} || !fill.spins.empty() || !fill.velocities.empty()))
      fail(path + ".rigid", "[grain.fill.rigid]",
           "must be left out where grains have spins or velocities of their own");
    if (!fill.every.empty()) {
      const bool whole =
          std::all_of(fill.every.begin(), fill.every.end(), [](double n) { return n == std::round(n); });
      if (fill.every.size() != 3 || !whole)
        fail(path + ".every", fmt::format("[{}]", fmt::join(fill.every, ", ")),
             "must be three whole numbers");
      if (!c.fluid.present)
        fail(path + ".every", "given", "must be left out without [fluid], whose lattice it counts");
    }
    if (!fill.positions.empty() || !fill.file.empty()) return;
    box(path, fill.min, fill.max);
    if (!fill.solid.shape) {
      inside_domain(path + ".min", fill.min);
      inside_domain(path + ".max", fill.max);
    }
    if (!fill.every.empty()) return;
    if ((fill.count > 0) + (fill.mass > 0) + (fill.packing_fraction > 0) != 1)
      throw CaseError(fmt::format("{}: grain.fill must have exactly one of count, mass and packing_fraction",
                                  nearest_value(root_, path).place()));
    const double fraction =
        solid_volume(fill, c.grain.all_materials()[c.grain.material(fill.material)].rho) / fill_volume(fill);
    if (fraction > 0.64) {
      const bool by_mass = fill.mass > 0;
      fail(path + (by_mass ? ".mass" : ".count"), fmt::format("{}", by_mass ? fill.mass : double(fill.count)),
           fmt::format(
               "must fit the space to fill; it takes {:.0f} % where 64 % is the densest random packing",
               100 * fraction));
    }
  }
  /// Overlap at the foot of the bed by its own weight.
  void softness() const {
    const GrainConfig& g = c.grain;
    const double R = g.d_max / 2, layers = std::max(1.0, height(g.fills, c.gravity) / g.d_max);
    const double weight = 4.18879 * R * R * R * g.rho * norm(c.gravity) * layers;
    const double overlap = overlap_under(c.contact, weight, R / 2, 0.5 / ElasticCompliance(g.E, g.nu).normal);
    if (overlap > 0.01 * R)
      warn(
          "{}: grains at the foot of the bed will overlap by about {:.2g} % of their radius; stiffer is more "
          "accurate",
          takes_moduli(c.contact.normal) ? "grain.E" : "contact.k", 100 * overlap / R);
  }

  const Config& c;
  const Value& root_;
  std::vector<std::string>& warnings_;
};

}  // namespace

void cross_check(const Config& config, const Value& root, std::vector<std::string>& warnings) {
  const Checks checks(config, root, warnings);
  checks.domain();
  if (config.fluid.present) checks.fluid();
  checks.meshes();
  checks.walls();
  checks.motions();
  if (config.grain.present) checks.grains();
  checks.openings();
  checks.coupling();
  checks.time();
  checks.probes();
}

}  // namespace bedload
