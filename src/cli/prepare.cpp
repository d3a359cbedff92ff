#include "prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bedload/case/lattice_step.hpp"
#include "bedload/case/limits.hpp"
#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/body.hpp"
#include "bedload/geometry/grain_source.hpp"
#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/geometry/setup.hpp"
#include "bedload/geometry/shape.hpp"
#include "bedload/motion/law.hpp"
#include "bedload/output/output.hpp"
#include "room.hpp"
#include "src/device.hpp"
#include "src/geometry/rough_size.hpp"
#include "src/motion/inlet_flow.hpp"
#include "src/team/processes.hpp"
#include "src/viscometer/plane_flow.hpp"

namespace bedload {

namespace {

Counts counts_of(const Setup& setup) {
  return {std::int64_t(setup.fluid.x.size() + setup.nodes.solid.size()), std::int64_t(setup.walls.x.size()),
          std::int64_t(setup.grains.x.size())};
}

Counts counts_of(const SavedState& state) {
  const auto count = [&](const std::string& name) {
    for (const HostStore& store : state.stores)
      if (store.name == name) return std::int64_t(store.count);
    return std::int64_t(0);
  };
  return {count("fluid"), count("walls"), count("grains")};
}

/// Particles that an inlet adds between two times, s.
double inflow(const InletConfig& inlet, const Config& c, double from, double to) {
  InletFlow flow(inlet, c.fluid.dx, c.domain);
  flow.resume(from, 0, 0);
  constexpr int pieces = 1000;
  for (int k = 1; k <= pieces; ++k) flow.advance(from + (to - from) * k / pieces);
  return flow.counted() / c.domain.cell_volume(c.fluid.dx);
}

/// Rough particle count of a part of the case.
struct Expected {
  std::string key, text;  ///< key in the case; beginning of a message
  Counts counts;
  const char* what;
};

std::string sides_text(const Vec3d& min, const Vec3d& max) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g} m", max.x - min.x, max.y - min.y, max.z - min.z);
}

std::int64_t whole(double count) { return std::int64_t(std::min(count, 1e15)); }

Expected expected_fluid(const Config& c) {
  double volume = 0;
  const auto box = [](const Vec3d& side) { return side.x * side.y * side.z; };
  if (c.fluid.lattice()) volume = box(c.domain.max - c.domain.min);
  for (const FluidFill& fill : c.fluid.fills) {
    const Vec3d side = fill.max - fill.min;
    if (c.fluid.lattice()) break;  // it fills the domain
    if (fill.solid.shape)
      volume += rough_size(*fill.solid.shape, c.domain).volume;
    else if (fill.file.empty())
      volume += box(side);
  }
  return {"fluid.dx",
          fmt::format("fluid.dx = {}", c.fluid.dx),
          {.fluid = whole(volume / c.domain.cell_volume(c.fluid.dx))},
          c.fluid.lattice() ? "nodes" : "fluid particles"};
}

Expected expected_wall(const Config& c, std::size_t index) {
  const WallBody& body = c.wall.bodies[index];
  const double spacing = c.wall.spacing(body), depth = body.single_layer() ? spacing : c.fluid.reach();
  return {fmt::format("wall.body.{}", index),
          fmt::format("wall.body \"{}\"{} with particles {:g} m apart", body.name,
                      body.shape == WallShape::plane ? "" : ", " + sides_text(body.min, body.max) + " large,",
                      spacing),
          {.walls = whole(expected_places(body, spacing, depth, c.domain))},
          "wall particles"};
}

Expected expected_grains(const Config& c, std::size_t index) {
  const GrainFill& fill = c.grain.fills[index];
  const Vec3d side = fill.max - fill.min;
  const double d = c.grain.largest(), each = std::numbers::pi / 6 * d * d * d;
  const double count = fill.count > 0  ? double(fill.count)
                       : fill.mass > 0 ? fill.mass / (c.grain.rho * each)
                       : fill.solid.shape || c.domain.two_d
                           ? 0
                           : fill.packing_fraction * side.x * side.y * side.z / each;
  return {fmt::format("grain.fill.{}", index),
          fmt::format("grain.fill {}", index + 1),
          {.grains = whole(count)},
          "grains"};
}

/// Estimated from areas and volumes before particles are placed, which itself takes time and memory.
void refuse_too_many(const Prepared& p) {
  const Config& c = p.config;
  std::vector<Expected> parts;
  if (c.fluid.present) {
    parts.push_back(expected_fluid(c));
    for (std::size_t k = 0; k < c.wall.bodies.size(); ++k)
      if (c.wall.bodies[k].stops_fluid() && !c.fluid.lattice()) parts.push_back(expected_wall(c, k));
  }
  for (std::size_t k = 0; c.grain.present && k < c.grain.fills.size(); ++k)
    parts.push_back(expected_grains(c, k));

  const auto bytes = [&](const Counts& n) { return double(p.memory.of(n)); };
  const auto less = [&](const Expected& a, const Expected& b) { return bytes(a.counts) < bytes(b.counts); };
  Counts all;
  for (const Expected& part : parts) {
    all.fluid += part.counts.fluid, all.walls += part.counts.walls, all.grains += part.counts.grains;
  }
  const double memory = double(p.device.memory), need = bytes(all);
  if (memory == 0 || need <= 1.2 * memory) return;  // a close estimate is settled by placing and counting
  const Expected& most = *std::max_element(parts.begin(), parts.end(), less);
  const Counts& n = most.counts;
  const bool several = p.device.ranks > 1;
  std::string text = fmt::format("{} gives {:.3g} {}, which need {}{}; {} has {} free{}{}", most.text,
                                 double(n.fluid + n.walls + n.grains), most.what,
                                 bytes_text(std::size_t(need)), several ? " on each" : "", p.device.text(),
                                 bytes_text(p.device.memory), several ? " on each" : "", room_text(p, all));
  if (n.fluid > 0)
    text += fmt::format("; use at least {:.3g} m",
                        c.fluid.dx * std::pow(need / memory, c.domain.two_d ? 1.0 / 2 : 1.0 / 3) * 1.001);
  for (const std::string& warning : p.warnings) text += "; " + warning;
  throw KeyError(most.key, text);
}

/// Motions are functions of the time since t = 0, so a wall with a modified motion may jump at the restart.
/// One clause per such wall.
std::vector<std::string> jumps_of_walls(const Config& then, const Config& now, double t) {
  std::vector<std::string> jumps;
  for (const WallBody& body : now.wall.bodies) {
    const auto former = std::find_if(then.wall.bodies.begin(), then.wall.bodies.end(),
                                     [&](const WallBody& b) { return b.name == body.name; });
    if (former == then.wall.bodies.end() || body.free.present || former->free.present) continue;
    const RigidMotion from = MotionLaw(former->motion, t).at(t), to = MotionLaw(body.motion, t).at(t);
    double farthest = 0;
    for (const Vec3d& x : corners(body, now.domain))
      farthest = std::max(farthest, norm(to.place(x) - from.place(x)));
    const double reach = norm(now.domain.max - now.domain.min);
    if (farthest > 1e-9 * reach)
      jumps.push_back(
          fmt::format("wall.body \"{}\" jumps {:.4g} m at t = {:.6g} s (its motion is a function of the time "
                      "since t = 0)",
                      body.name, farthest, t));
  }
  return jumps;
}

/// The case of the checkpoint; none if a file that it needs, such as a mesh, is missing now.
std::optional<Config> case_of(const std::filesystem::path& checkpoint, const std::string& text) {
  try {
    std::vector<std::string> none;
    return read_case_text(text, checkpoint.string(), {}, none, checkpoint);
  } catch (const CaseError&) {
  } catch (const FileError&) {
  }
  return {};
}

/// A restart must be of the same case, except with --allow-changes.
void refuse_changes(const Options& options, Prepared& p) {
  const std::string before = checkpoint_case(options.restart), now = resolved_toml(p.config);
  std::optional<Config> then = before == now ? p.config : case_of(options.restart, before);
  auto changes = changes_between(before, now);
  if (then && !changes.empty())
    for (std::string& jump : jumps_of_walls(*then, p.config, p.begin)) changes.push_back(std::move(jump));
  const std::string text = fmt::format("{}", fmt::join(changes, ", "));
  if (!changes.empty() && !options.allow_changes)
    throw CaseError(
        fmt::format("{}: the case differs from that of the checkpoint: {}; restart with a modified case by "
                    "--allow-changes",
                    options.restart.string(), text));
  if (!changes.empty()) p.warnings.push_back("modified since the checkpoint: " + text);
  std::error_code none;
  if (std::filesystem::equivalent(options.restart.parent_path(), options.out / "checkpoints", none))
    p.former = std::move(then);
}

/// Whether anything sets the fluid in motion; sinking grains are too slow to matter.
bool is_driven(const Config& c) {
  const auto moves = [](const WallBody& body) { return body.moves() || norm(body.surface_velocity) > 0; };
  const auto flows = [](const FluidFill& fill) { return fill.velocity != FluidFill().velocity; };
  return c.frame.motion.moves() || norm(c.drive.f) > 0 || c.drive.pulls() ||
         std::any_of(c.wall.bodies.begin(), c.wall.bodies.end(), moves) ||
         std::any_of(c.fluid.fills.begin(), c.fluid.fills.end(), flows);
}

/// In a box filled to its lid the pressure becomes negative somewhere as soon as the fluid moves, and it
/// cavitates there. Plane shear flow is exempt: its pressure is uniform.
void warn_of_full_box(Prepared& p) {
  const Config& c = p.config;
  const auto walled = [](const WallBody& body) { return body.stops_fluid(); };
  if (!c.fluid.present || !c.fluid.model->smoothed || c.eos.type != EosType::tait || c.eos.background > 0 ||
      !c.inlets.empty() || !c.outlets.empty() ||
      std::none_of(c.wall.bodies.begin(), c.wall.bodies.end(), walled))
    return;
  try {
    (void)plane_flow_of(c);
    return;
  } catch (const KeyError&) {
  }
  if (has_free_surface(c, p.setup)) return;
  const std::string full = "the fluid fills the space between the walls, without a free surface: ";
  if (is_driven(c))
    p.warnings.push_back(
        full + fmt::format("it cavitates at negative pressure; set eos.background, the pressure at rest, to "
                           "about rho0 vmax^2 = {:.2g} Pa",
                           c.fluid.rho0 * c.fluid.vmax * c.fluid.vmax));
  else
    p.notes.push_back(full + "if it moves, it cavitates at negative pressure (see eos.background)");
}

/// Places the particles of the case or reads the checkpoint; p.device is known.
void place_particles(const Options& options, Prepared& p) {
  p.memory = estimate_memory(p.config, p.device);
  if (options.restart.empty()) {
    refuse_too_many(p);
    p.setup = build_setup(p.config, p.warnings, &p.notes);
    warn_of_full_box(p);
    p.counts = counts_of(p.setup);
  } else if (!Processes::joined() || Processes::joined()->rank() == 0) {  // which gives it to the others
    p.restart = read_checkpoint(options.restart, p.config);
    for (const Quantity& q : p.restart.scalars)
      if (q.name == "time")
        p.begin = q.value;
      else if (q.name == "last_dt")
        p.last_dt = q.value;
    refuse_changes(options, p);
    p.counts = counts_of(p.restart);
  }
}

void choose_device(const Options& options, Prepared& p) {
  const Processes* const all = Processes::joined();
  p.device = placed(p.config.places, [&] {
    return all ? find_own_device(options.backend, options.threads, p.config.simd, *all)
               : find_device(options.backend, options.threads, p.config.simd);
  });
  if (!all) divide_among(p.device, options.ranks, options.devices);
}

}  // namespace

Prepared prepare(const Options& options) {
  Prepared p;
  p.config = read_case(options.file, options.overrides, p.warnings, options.restart);
  choose_device(options, p);
  if (!options.quiet) {  // before particles are placed, which takes time
    fmt::print("{}", heading_text(p));
    if (const std::string why = p.device.cuda() ? "" : why_no_gpu(options.backend); !why.empty())
      fmt::print("           {}\n", why);
  }
  std::fflush(stdout);
  placed(p.config.places, [&] { place_particles(options, p); });
  return p;
}

void initialise(const Options& options, Prepared& p) {
  choose_device(options, p);
  placed(p.config.places, [&] { place_particles(options, p); });
}

void check_fixed_steps(Prepared& p, Simulation& simulation) {
  const auto check = [&](const char* key, double dt, const std::vector<StepLimit>& limits) {
    for (const StepLimit& limit : limits) {
      if (dt <= limit.seconds * (1 + 1e-9)) continue;
      if (!p.config.time.force_dt)
        throw KeyError(key, fmt::format("{} = {} must be <= {:.4g} s; limited by {}", key, dt, limit.seconds,
                                        with_key(limit.limit)));
      p.warnings.push_back(fmt::format("{} = {} s exceeds its limit of {:.4g} s, {}", key, dt, limit.seconds,
                                       with_key(limit.limit)));
    }
  };
  if (p.config.time.dt > 0) check("time.dt", p.config.time.dt, simulation.limits());
  if (p.config.time.dt_dem == 0) return;
  std::vector<StepLimit> substeps = simulation.substep_limits();
  // limits of contacts and films between grains were checked when the case was read
  std::erase_if(substeps, [](const StepLimit& l) { return l.limit < Limit::grain_drag; });
  check("time.dt_dem", p.config.time.dt_dem, substeps);
}

Counts with_inflow(const Prepared& p) {
  const Config& c = p.config;
  const double from = p.begin, to = c.time.end;
  const Vec3d size = c.domain.max - c.domain.min;
  const auto add = [&](std::int64_t& count, double more, double spacing) {
    const double fits = size.x * size.y * size.z / c.domain.cell_volume(spacing);
    if (more > 0) count = std::max<std::int64_t>(count, std::llround(std::min(double(count) + more, fits)));
  };
  double fluid = 0, grains = 0;
  for (const InletConfig& inlet : c.inlets) fluid += inflow(inlet, c, from, to);
  for (std::size_t k = 0; k < c.grain_inlets.size(); ++k) {
    const GrainSource source(c, k);
    grains += (source.pending(to) - source.pending(from)) * double(source.spheres().size());
  }
  Counts counts = p.counts;
  add(counts.fluid, fluid, c.fluid.dx);
  add(counts.grains, grains, c.grain.d_min);
  return counts;
}

std::string grouped(std::int64_t number) {
  std::string text = fmt::format("{}", number);
  for (int at = int(text.size()) - 3; at > (number < 0 ? 1 : 0); at -= 3) text.insert(at, " ");
  return text;
}

std::string bytes_text(std::size_t bytes) {
  if (bytes < 1000000) return fmt::format("{:.3g} kB", double(bytes) / 1e3);
  if (bytes < 1000000000) return fmt::format("{:.3g} MB", double(bytes) / 1e6);
  return fmt::format("{:.3g} GB", double(bytes) / 1e9);
}

std::string heading_text(const Prepared& p) {
  const Config& c = p.config;
  std::string out = fmt::format("case       {}{}\n", c.file, c.title.empty() ? "" : " (" + c.title + ")");
  out +=
      fmt::format("device     {}, {}; precision {}\n", p.device.backend, p.device.text(), c.precision.name());
  for (const ShapeConfig& shape : c.shapes) {
    if (shape.kind != ShapeKind::mesh) continue;
    const Bounds bounds = shape.solid.shape->bounds();
    out += fmt::format("mesh       {}: {}\n", shape.name, sides_text(bounds.min, bounds.max));
  }
  return out;
}

namespace {

/// The nodes of a case, and its units on them.
std::string lattice_text(const Config& c, std::int64_t grains) {
  const LatticeStep step = lattice_step(c);
  std::string out = fmt::format(
      "nodes      {} x {} x {}, {:.4g} m apart\n"
      "lattice    step {:.4g} s, relaxation time {:.4g} steps, vmax {:.4g} m/s = {:.3g} nodes a "
      "step, sound {:.4g} m/s\n",
      cells_along(c, 0), cells_along(c, 1), cells_along(c, 2), c.fluid.dx, step.dt, step.tau, c.fluid.vmax,
      step.vmax, step.sound);
  if (c.grain.present)
    out += fmt::format("grains     {}, {:.3g} nodes across the smallest\n", grouped(grains),
                       c.grain.d_min / c.fluid.dx);
  return out;
}

/// Grains of about one size.
struct SizeGroup {
  double least = 0, most = 0;  ///< diameter, m
  std::int64_t count = 0;
};

/// From the smallest to the largest: of one diameter each where they are few, else within a factor of two.
std::vector<SizeGroup> size_groups(const Prepared& p) {
  constexpr std::size_t kMost = 8;
  std::vector<double> d;
  for (const double radius : p.setup.grains.radius) d.push_back(2 * radius);
  for (const HostStore& store : p.restart.stores)
    if (const HostArray* radius = store.name == "grains" ? store.find("radius") : nullptr)
      for (std::size_t i = 0; i < store.count; ++i)
        d.push_back(2 * (radius->type == Scalar::f64 ? radius->as<double>()[i] : radius->as<float>()[i]));
  std::sort(d.begin(), d.end());
  for (const double factor : {1 + 1e-6, 2.0}) {
    std::vector<SizeGroup> groups;
    for (const double one : d) {
      if (groups.empty() || one > factor * groups.back().least) groups.push_back({one, one, 0});
      groups.back().most = one, ++groups.back().count;
    }
    if (groups.size() <= kMost || factor == 2) return groups;
  }
  return {};
}

/// The coupling, and how grains of each size take part in it.
std::string coupling_text(const Prepared& p) {
  const Config& c = p.config;
  const double kappa = c.fluid.kappa(), dx = c.fluid.dx;
  std::string out =
      fmt::format("coupling   {}, {}, h_c {:.4g} m", c.couple.mode.name(), c.couple.drag.name(), c.couple.hc);
  out += c.farthest_average() > kappa * c.couple.hc
             ? fmt::format(" to {:.4g} m, each grain its own\n", c.farthest_average() / kappa)
             : fmt::format(" = {:.3g} d_max\n", c.couple.hc / c.grain.d_max);
  for (const SizeGroup& g : size_groups(p)) {
    const double least = kappa * c.couple.hc, times = g.most / dx,
                 range = c.own_lengths() ? std::max(least, 4 * g.most) : least;
    const std::string size = g.most > g.least * (1 + 1e-6) ? fmt::format("{:.4g} to {:.4g}", g.least, g.most)
                                                           : fmt::format("{:.4g}", g.most);
    out += fmt::format(
        "           {} {} of {} m: {:.3g} times fluid.dx, h_c {:.3g} d, {} fluid particles per kernel, "
        "{}\n",
        grouped(g.count), g.count == 1 ? "grain" : "grains", size, times, range / kappa / g.most,
        grouped(std::llround(4 * std::numbers::pi / 3 * std::pow(range / dx, 3))),
        times <= kAveraged * (1 + 1e-3) ? "by the drag law" : "too large for drag laws");
  }
  return out;
}

}  // namespace

std::string summary_text(const Prepared& p) {
  const Config& c = p.config;
  const Counts& n = p.counts;
  if (c.fluid.lattice()) return lattice_text(c, n.grains);
  std::string out = fmt::format("particles  fluid {}, walls {}, grains {}\n", grouped(n.fluid),
                                grouped(n.walls), grouped(n.grains));
  const Counts later = with_inflow(p);
  if (later.fluid > n.fluid)
    out += fmt::format("           up to {} fluid particles with inflow\n", grouped(later.fluid - n.fluid));
  if (later.grains > n.grains)
    out += fmt::format("           up to {} grains with inflow\n", grouped(later.grains - n.grains));
  if (c.fluid.present) {
    out += fmt::format("fluid      dx {} m, h {:.4g} m, vmax {:.4g} m/s, sound {:.4g} m/s\n", c.fluid.dx,
                       c.fluid.h(), c.fluid.vmax, c.fluid.c);
    if (c.visc.alpha > 0) {
      const double nu = c.visc.alpha * c.fluid.h() * c.fluid.c / 20;  // [monaghan92], approaching pairs only
      const double physical = c.visc.model == ViscosityModel::none ? 0 : c.fluid.mu / c.fluid.rho0;
      out +=
          fmt::format("           visc.alpha is equivalent to a kinematic viscosity of {:.3g} m2/s{}\n", nu,
                      physical > 0 ? fmt::format(", {:.3g} times the physical one", nu / physical) : "");
    }
  }
  for (const InletConfig& inlet : c.inlets)
    out += fmt::format("inlet      {}: {} particles per layer, up to {:.4g} m/s\n", inlet.name,
                       orifice_layer(inlet, c.fluid.dx, c.domain).points.size(),
                       inlet_speed(inlet, c.fluid.dx, c.domain, c.time.end));
  if (c.fluid.present && c.grain.present && c.couple.mode != CouplingMode::off) out += coupling_text(p);
  return out;
}

std::string notes_text(const Prepared& p) {
  std::string out;
  for (const std::string& note : p.notes) out += fmt::format("note       {}\n", note);
  return out;
}

}  // namespace bedload
