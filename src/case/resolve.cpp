#include "resolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>

#include "bedload/case/grain_sizes.hpp"
#include "bedload/case/lattice_step.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/body.hpp"
#include "bedload/geometry/build_shape.hpp"
#include "bedload/geometry/depth.hpp"
#include "shortened.hpp"
#include "src/motion/formula_breaks.hpp"
#include "src/motion/inlet_flow.hpp"
#include "src/motion/survey.hpp"
#include "src/motion/table.hpp"
#include "src/motion/wave_maker.hpp"

namespace bedload {
namespace {

void check_sieve(const SizeClass& s, const Value& root, const std::string& path) {
  const auto fail = [&](const char* list, const std::vector<double>& values, const std::string& must) {
    reject(root, path + list, fmt::format("[{}]", fmt::join(values, ", ")), must);
  };
  if (s.openings.size() < 2) fail(".openings", s.openings, "must hold two openings or more");
  if (s.passing.size() != s.openings.size())
    fail(".passing", s.passing,
         fmt::format("must hold a fraction for each of the {} openings", s.openings.size()));
  if (std::adjacent_find(s.openings.begin(), s.openings.end(), std::greater_equal<>()) != s.openings.end())
    fail(".openings", s.openings, "must rise from each to the next");
  if (!std::is_sorted(s.passing.begin(), s.passing.end()))
    fail(".passing", s.passing, "must not fall from the finer mesh to the coarser");
  if (s.passing.front() != 0 || s.passing.back() != 1)
    fail(".passing", s.passing,
         "must begin with 0 and end with 1; add the meshes that stop and pass everything");
}

/// What a wall body may be.
constexpr const char* kWallShapes = "must be tank, box, plane or the name of a [[shape]]";

bool built_in(const std::string& shape) { return ChosenOrNamed<WallShape>(shape).choice().has_value(); }

}  // namespace

Vec3d direction(const Vec3d& v, const Value& root, const std::string& path) {
  const double n = norm(v);
  if (n == 0) reject(root, path, "[0, 0, 0]", "must not be zero");
  return std::abs(n - 1) < 1e-12 ? v : Vec3d{v.x / n, v.y / n, v.z / n};
}

[[noreturn]] void missing(const Value& root, const std::string& key, const char* what) {
  throw CaseError(
      fmt::format("{}: {} must be given ({})", nearest_value(root, key).place(), key_of(key), what));
}

Solid shape_named(const Config& c, const std::string& name, const Value& root, const std::string& path,
                  const char* must) {
  std::string names;
  for (const ShapeConfig& shape : c.shapes) {
    if (shape.name == name) return shape.solid;
    names += (names.empty() ? "" : ", ") + shape.name;
  }
  reject(root, path, fmt::format("\"{}\"", name),
         fmt::format("{}; this case has {}", must, names.empty() ? "none" : names));
}

void check_shape_names(const Config& c, const Value& root) {
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i)
    if (const auto& shape = c.wall.bodies[i].shape; !shape.choice())
      (void)shape_named(c, shape.name(), root, fmt::format("wall.body.{}.shape", i), kWallShapes);
}

void default_sizes(const Config& c, std::vector<SizeClass>& sizes, const Value& root) {
  if (!sizes.empty()) return;
  if (c.grain.d == 0) missing(root, "grain.d", "diameter, m, where a grain.fill or grain_inlet has no sizes");
  sizes = {{.d = c.grain.d, .number_fraction = 1}};
}

namespace {

/// Completes one of the sizes of grains at `path` and widens grain.d_min, d_max to it.
void resolve_size(Config& c, SizeClass& s, const Value& root, const std::string& path,
                  const ClumpConfig* clump) {
  if (s.kind == SizeKind::sieve) check_sieve(s, root, path);
  if (s.kind == SizeKind::log_normal) {  // its ends lie 3 sigma from the median
    if (s.d_min == 0) s.d_min = s.median * std::exp(-3 * s.sigma);
    if (s.d_max == 0) s.d_max = s.median * std::exp(3 * s.sigma);
  }
  const auto [smallest, largest] = size_range(s);
  const std::vector<ClumpSphere> one{{0, 0, 0, 0.5}};
  for (const ClumpSphere& part : clump ? clump->shape.spheres : one) {
    c.grain.d_min = std::min(c.grain.d_min, 2 * part[3] * smallest);
    c.grain.d_max = std::max(c.grain.d_max, 2 * part[3] * largest);
  }
}

}  // namespace

void resolve_sizes(Config& c, std::vector<SizeClass>& sizes, const Value& root, const std::string& path,
                   const ClumpConfig* clump) {
  for (std::size_t k = 0; k < sizes.size(); ++k)
    resolve_size(c, sizes[k], root, fmt::format("{}.{}", path, k), clump);
  const auto by_mass = [](const SizeClass& s) { return s.mass_fraction > 0; };
  if (std::none_of(sizes.begin(), sizes.end(), by_mass)) return;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    if (!by_mass(sizes[k]))
      missing(root, fmt::format("{}.{}.mass_fraction", path, k),
              "mass of its grains relative to the other entries, as those have one");
  double most = 0;
  for (SizeClass& s : sizes) {
    s.number_fraction = s.mass_fraction / mean_volume({s}, std::size_t(1e5));
    s.mass_fraction = 0;
    most = std::max(most, s.number_fraction);
  }
  for (SizeClass& s : sizes) s.number_fraction /= most;
}

void check_factor(const std::string& factor, double start, double end, const Value& root,
                  const std::string& path) {
  const auto fail = [&](const std::string& must) { reject(root, path, fmt::format("\"{}\"", factor), must); };
  std::optional<Formula> of_t;
  try {
    of_t.emplace(factor, "t");
  } catch (const CaseError& error) {
    fail(fmt::format("must be a formula in t: {}", error.what()));
  }
  constexpr int looks = 2000;
  const double span = std::max(0.0, end - start);
  for (int n = 0; n <= looks; ++n)
    if (const double s = span * n / looks; !std::isfinite((*of_t)(s)))
      fail(fmt::format("must be finite at all times; it is not at t = {:.4g} s", start + s));
}

namespace {

/// The default of a vessel: layers of wall particles as deep as the kernel reaches; without fluid the largest
/// grain.
double vessel_thickness(const Config& c) {
  if (c.fluid.present) {
    const double step = c.wall.dx > 0 ? c.wall.dx : c.fluid.dx;
    return step * std::ceil(c.fluid.reach() / step - 1e-6);
  }
  double d = c.grain.d;
  for (const GrainFill& fill : c.grain.fills)
    for (const SizeClass& size : fill.sizes) d = std::max(d, size.d);
  return d;
}

void resolve_copies(CopiesConfig& copies, const Value& root, const std::string& path) {
  const bool turn = norm(copies.about) > 0;
  if (!turn && norm(copies.along) == 0)
    throw CaseError(
        fmt::format("{}: shape.copies must have about, the direction of an axis, or along, the way to "
                    "the next copy",
                    nearest_value(root, path).place()));
  if (!turn && copies.angle != 0)
    reject(root, path + ".angle", fmt::format("{}", copies.angle),
           "must stand with shape.copies.about, the direction of an axis");
  if (turn && copies.angle == 0) copies.angle = 360 / double(copies.count);
}

void resolve_shapes(Config& c, const Value& root) {
  std::vector<ShapeConfig> done;
  for (std::size_t i = 0; i < c.shapes.size(); ++i) {
    ShapeConfig& shape = c.shapes[i];
    const std::string path = fmt::format("shape.{}", i), name = path + ".name";
    if (built_in(shape.name))
      reject(root, name, fmt::format("\"{}\"", shape.name), "must not be the name of a built-in shape");
    for (const ShapeConfig& other : done)
      if (other.name == shape.name)
        reject(root, name, fmt::format("\"{}\"", shape.name), "must differ from other shapes'");
    if (shape.thickness == 0 && (shape.kind == ShapeKind::hollow || shape.kind == ShapeKind::pipe))
      shape.thickness = vessel_thickness(c);
    if (shape.kind == ShapeKind::mesh || shape.kind == ShapeKind::terrain) {
      const auto folder = std::filesystem::absolute(c.file).parent_path();
      shape.file = (folder / shape.file).lexically_normal().string();
    }
    if (shape.copies.present) resolve_copies(shape.copies, root, path + ".copies");
    const auto fail = [&](const std::string& key, const std::exception& error) {
      throw CaseError(
          fmt::format("{}: shape \"{}\": {}", nearest_value(root, key).place(), shape.name, error.what()));
    };
    try {
      shape.solid.shape = build_shape(shape, done, vessel_thickness(c));
    } catch (const FileError& error) {
      fail(path + ".file", error);
    } catch (const CaseError& error) {
      fail(path, error);
    }
    done.push_back(shape);
  }
}

/// A shape without a surface that grains could meet makes no wall.
void check_surface(const WallBody& body, const Value& root, const std::string& path) {
  try {
    std::vector<SurfacePart> parts;
    body.solid.shape->add_parts(parts, {});
  } catch (const CaseError& error) {
    reject(root, path, fmt::format("\"{}\"", body.shape.name()),
           fmt::format("makes no wall: {}", error.what()));
  }
}

void resolve_walls(Config& c, const Value& root) {
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    WallBody& body = c.wall.bodies[i];
    const std::string path = fmt::format("wall.body.{}.", i);
    if (!body.shape.choice()) {
      body.solid = shape_named(c, body.shape.name(), root, path + "shape", kWallShapes);
      const Bounds bounds = body.solid.shape->bounds();
      body.min = bounds.min, body.max = bounds.max;
      check_surface(body, root, path + "shape");
    }
    if (body.shape == WallShape::plane) body.normal = direction(body.normal, root, path + "normal");
  }
}

/// The rows of a table, from its file or given in the case.
void resolve_table(MotionPart& m, const std::string& path, const std::string& case_file, const Value& root) {
  if (m.file.empty() == m.rows.empty())
    throw CaseError(fmt::format("{}: {} must have one of file and rows with kind = \"table\"",
                                nearest_value(root, path + ".kind").place(), key_of(path)));
  if (!m.file.empty()) {
    const auto file = std::filesystem::path(case_file).parent_path() / m.file;
    if (std::error_code unknown; !std::filesystem::is_regular_file(file, unknown))
      reject(root, path + ".file", fmt::format("\"{}\"", m.file),
             fmt::format("must name a table; there is no file {}", shortened(file.string())));
    m.rows = read_motion_table(file);
    m.file.clear();
    return;
  }
  const Value& given = nearest_value(root, path + ".rows");
  check_rows(m.rows, fmt::format("{}: {}.rows", given.place(), key_of(path)), [&](std::size_t i) {
    return fmt::format("{}: {}.rows, row {}", given.place(), key_of(path), i + 1);
  });
}

/// A part of a motion without a finite place, velocity or acceleration at some time.
void refuse_gaps(const MotionPart& m, const std::string& path, double until, const Value& root) {
  const auto look = [&](MotionConfig alone, const std::string& key) {
    const double t = alone.moves() ? first_gap(alone, until) : INFINITY;
    if (std::isfinite(t))
      reject(root, path + key, nearest_value(root, path + key).text(),
             fmt::format("must be finite at all times, as must its rates; it is not at t = {:.4g} s", t));
  };
  MotionConfig alone;
  static_cast<MotionPart&>(alone) = m;
  if (m.kind == MotionKind::formula) {
    MotionConfig shift = alone, turn = alone;
    shift.rotation = turn.displacement = MotionPart().rotation;
    look(shift, ".displacement");
    look(turn, ".rotation");
  } else {
    look(alone, m.kind == MotionKind::velocity      ? ".velocity"
                : m.kind == MotionKind::oscillation ? ".amplitude"
                : m.kind == MotionKind::rotation    ? ".rate"
                                                    : ".kind");
  }
}

/// What jumps from place to place passes through what is between.
void refuse_jumps(const MotionPart& m, const std::string& path, double until, const Value& root) {
  const double span = std::min(m.stop, until) - m.start;
  if (m.kind != MotionKind::formula || !(span > 0)) return;
  for (const auto& [key, texts, unit] :
       {std::tuple{".displacement", &m.displacement, "m"}, {".rotation", &m.rotation, "deg"}})
    for (const std::string& text : *texts)
      for (const Break& b : breaks_of(Formula(text, "t"), span))
        if (b.jump != 0)
          reject(root, path + key, nearest_value(root, path + key).text(),
                 fmt::format("must not jump; \"{}\" does by {:.4g} {} at t = {:.4g} s", text, b.jump, unit,
                             m.start + b.time));
}

/// The stroke of a piston or flap, as formulas of its displacement or rotation.
void resolve_waves(const Config& c, MotionPart& m, const std::string& path, const Value& root) {
  WaveConfig& w = m.wave;
  const double g = norm(c.gravity);
  if (!(g > 0)) reject(root, path + ".kind", fmt::format("\"{}\"", m.kind.name()), "needs gravity");
  const WaterWave wave{.height = w.height, .period = w.period, .depth = w.depth, .gravity = g};
  const double wavelengths = w.order == 2 ? 3 : 10,
               deepest = wavelengths * g * w.period * w.period / (2 * std::numbers::pi);
  if (!(w.depth <= deepest))
    reject(root, path + ".wave_depth", fmt::format("{}", w.depth),
           fmt::format("must be at most {:.4g} m, {} wavelengths, with wave_order = {}", deepest, wavelengths,
                       w.order));
  if (const double longest = 1000 * std::sqrt(w.depth / g); !(w.period <= longest))
    reject(root, path + ".wave_period", fmt::format("{}", w.period),
           fmt::format("must be at most {:.4g} s at this depth, waves of a thousand depths", longest));
  const auto limit = [&](double most, const std::string& why) {
    if (w.height >= most)
      reject(root, path + ".wave_height", fmt::format("{}", w.height),
             fmt::format("must be below {:.4g} m, {}; the wave is {:.4g} m long", most, why, wave.length()));
  };
  limit(wave.breaking_height(), "where such waves break");
  if (w.order == 2)
    limit(wave.second_order_height(),
          "up to which second-order theory holds; wave_order = 1 has no such limit");
  const Vec3d up = upwards(c.gravity), level = w.direction - dot(w.direction, up) * up;
  if (norm(level) < 1e-6 * norm(w.direction) || norm(w.direction) == 0)
    reject(root, path + ".wave_direction",
           fmt::format("[{}, {}, {}]", w.direction.x, w.direction.y, w.direction.z), "must not be vertical");
  w.direction = direction(level, root, path + ".wave_direction");
  const auto along = [](const Vec3d& v, const std::string& text) {
    std::array<std::string, 3> out{"0", "0", "0"};
    for (int k = 0; k < 3; ++k)
      if (std::abs(v[k]) > 1e-12) out[std::size_t(k)] = fmt::format("{:.15g}*({})", v[k], text);
    return out;
  };
  if (m.kind == MotionKind::piston)
    m.displacement = along(w.direction, piston_stroke(wave, int(w.order), w.ramp * w.period));
  else
    m.rotation = along(cross(up, w.direction), flap_angle(wave, int(w.order), w.ramp * w.period));
}

void resolve_motions(Config& c, const Value& root) {
  for_motions(c, [&](MotionConfig& motion, const std::string& path) {
    for_parts(motion, path, [&](MotionPart& m, const std::string& at) {
      if (m.kind == MotionKind::rotation) m.axis = direction(m.axis, root, at + ".axis");
      if (m.kind == MotionKind::table) resolve_table(m, at, c.file, root);
      if (m.kind == MotionKind::piston || m.kind == MotionKind::flap) resolve_waves(c, m, at, root);
      if (m.scaled()) check_factor(m.factor, m.start, std::min(m.stop, c.time.end), root, at + ".factor");
      refuse_gaps(m, at, c.time.end, root);
    });
    if (const double t = motion.moves() ? first_gap(motion, c.time.end) : INFINITY; std::isfinite(t))
      throw CaseError(fmt::format("{}: {} must be finite at all times; it is not at t = {:.4g} s",
                                  nearest_value(root, path).place(), key_of(path), t));
    for_parts(motion, path,
              [&](const MotionPart& m, const std::string& at) { refuse_jumps(m, at, c.time.end, root); });
  });
}

/// What the moving frame adds: the largest acceleration, how far gravity g H reaches while it acts
/// askew, and how fast contents that stayed behind would seem.
struct FrameEffects {
  double acceleration = 0, gH = 0, speed = 0;  ///< m/s2, m2/s2, m/s

  explicit FrameEffects(const Config& c) {
    const EffectiveGravity effective(c.gravity, c.frame.motion, c.time.end);
    const MotionLaw law(c.frame.motion, c.time.end);
    const Vec3d start = law.at(0).v;
    for (const double t : survey_times(c.frame.motion, c.time.end)) {
      const Vec3d g = effective.at(t);
      acceleration = std::max(acceleration, norm(g - c.gravity));
      gH = std::max(gH, norm(g) * height(c.fluid.fills, g));
      speed = std::max(speed, norm(law.at(t).v - start));
    }
  }
};

/// Fluid on nodes: nothing falls or flows in, so that walls alone set a speed.
void resolve_lattice(Config& c, const Value& root) {
  FluidConfig& f = c.fluid;
  for (const WallBody& body : c.wall.bodies)
    f.vmax = std::max(f.vmax, wall_speed(body, c.domain, c.time.end) + norm(body.surface_velocity));
  f.vmax = std::max(f.vmax, 0.5 * std::abs(c.domain.shear_rate) * (c.domain.max.z - c.domain.min.z));
  if (f.vmax == 0) missing(root, "fluid.vmax", "m/s; no wall sets a speed here");
  if (!(f.mu > 0))
    reject(root, "fluid.mu", fmt::format("{}", f.mu), "must be > 0 with fluid.model = \"lattice\"");
  if (c.drive.factor != DriveConfig().factor)
    check_factor(c.drive.factor, 0, c.time.end, root, "drive.factor");
  f.c = lattice_step(c).sound;
  c.wall.dx = f.dx;
  c.couple.mode = CouplingMode::off;  // fluid flows around grains
}

void resolve_fluid(Config& c, const Value& root, const std::filesystem::path& checkpoint) {
  FluidConfig& f = c.fluid;
  if (f.fills.empty() && c.inlets.empty())
    missing(root, "fluid.fill", "[[fluid.fill]] with min and max, or [[inlet]]");
  resolve_listed_fluid(c, root, checkpoint);
  const double g = norm(c.gravity);
  for (std::size_t i = 0; i < f.fills.size(); ++i) {
    FluidFill& fill = f.fills[i];
    if (fill.shape.empty()) continue;
    const std::string path = fmt::format("fluid.fill.{}.", i);
    fill.solid = shape_named(c, fill.shape, root, path + "shape", "must be the name of a [[shape]]");
    Bounds bounds = fill.solid.shape->bounds();
    if (std::isfinite(fill.level)) {
      if (g == 0)
        reject(root, path + "level", fmt::format("{}", fill.level), "must be left out without gravity");
      for (int k = 0; k < 3; ++k) {  // where gravity runs along an axis the level is a side of the box
        const double up = -c.gravity[k] / g;
        if (std::abs(up) > 1 - 1e-12) (up > 0 ? bounds.max : bounds.min)[k] = up * fill.level;
      }
    }
    fill.min = bounds.min, fill.max = bounds.max;
    for (int k = 0; k < 3; ++k)
      if (!(fill.max[k] > fill.min[k]))
        reject(root, path + "level", fmt::format("{}", fill.level),
               fmt::format("must lie above the bottom of shape \"{}\"", fill.shape));
  }
  double gH = norm(c.gravity) * (f.depth = height(f.fills, c.gravity)), vmax = f.vmax;
  if (c.frame.motion.moves()) {
    const FrameEffects frame(c);
    gH = std::max(gH, frame.gH);
    vmax = std::max(vmax, frame.speed);
  }
  vmax = std::max(vmax, std::sqrt(2 * gH));
  for (const WallBody& body : c.wall.bodies)
    vmax = std::max(vmax, wall_speed(body, c.domain, c.time.end) + norm(body.surface_velocity));
  for (const InletConfig& inlet : c.inlets)
    vmax = std::max(vmax, inlet_speed(inlet, f.dx, c.domain, c.time.end));
  if (vmax == 0) missing(root, "fluid.vmax", "m/s; neither gravity nor a wall or inlet sets a speed here");
  f.vmax = vmax;
  for (std::size_t k = 0; k < f.species.size(); ++k)
    f.mu = k > 0 ? std::max(f.mu, f.species[k].mu) : f.species[k].mu;
  if (f.model->own_viscosity && std::isinf(f.zeta)) f.zeta = 20.0 / 21 * f.mu;
  switch (c.eos.type) {
    case EosType::tait:
      f.c = f.c_factor * vmax;
      break;
    case EosType::democritus:
      f.c = std::sqrt(c.eos.alpha * c.eos.p0 / f.rho0);
      break;
  }
  for (InletConfig& inlet : c.inlets)
    if (inlet.ramp == 0) inlet.ramp = 10 * f.h() / f.c;
  if (c.wall.dx == 0) c.wall.dx = f.dx;
  if (c.wall.rep_D == 0) c.wall.rep_D = gH > 0 ? 5 * gH : vmax * vmax;
  if (c.wall.rep_r0 == 0) c.wall.rep_r0 = 0.5 * f.dx;
  if (c.wall.layer_r0 == 0) c.wall.layer_r0 = f.dx;
  for (WallBody& body : c.wall.bodies)
    if (body.single_layer() && body.dx == 0) body.dx = std::min(c.wall.dx, 0.5 * f.dx);
}

void resolve_grains(Config& c, const Value& root, const std::filesystem::path& checkpoint) {
  GrainConfig& g = c.grain;
  if (g.fills.empty() && c.grain_inlets.empty())
    missing(root, "grain.fill", "[[grain.fill]] with a box or positions, or [[grain_inlet]]");
  g.seed = c.seed;
  for (GrainMaterial& m : g.materials) m = g.completed(m);
  resolve_clumps(c, root);
  g.d_min = 1e300;
  for (std::size_t i = 0; i < g.fills.size(); ++i) {
    GrainFill& fill = g.fills[i];
    if (!fill.file.empty() && resolve_listed_grains(c, i, root, checkpoint)) continue;
    default_sizes(c, fill.sizes, root);
    if (!fill.positions.empty()) fill.count = std::int64_t(fill.positions.size());
    if (!fill.shape.empty()) {
      fill.solid = shape_named(c, fill.shape, root, fmt::format("grain.fill.{}.shape", i),
                               "must be the name of a [[shape]]");
      const Bounds bounds = fill.solid.shape->bounds();
      fill.min = bounds.min, fill.max = bounds.max;
    }
    resolve_sizes(c, fill.sizes, root, fmt::format("grain.fill.{}.sizes", i), g.clump_of(fill));
  }
  for (std::size_t i = 0; i < g.fills.size(); ++i)
    if (RigidConfig& rigid = g.fills[i].rigid; rigid.present)
      rigid.axis = direction(rigid.axis, root, fmt::format("grain.fill.{}.rigid.axis", i));
  resolve_grain_inlets(c, root);
  const double fall = height(std::vector<DomainConfig>{c.domain}, c.gravity);
  if (g.settle && g.settle_time == 0 && fall > 0) g.settle_time = 20 * std::sqrt(2 * fall / norm(c.gravity));
}

}  // namespace

double wall_speed(const WallBody& body, const DomainConfig& domain, double until) {
  const MotionConfig& m = body.motion;
  const std::vector<Vec3d> at = corners(body, domain);
  if (body.free.present)
    return norm(body.free.velocity) + 0.5 * norm(body.free.spin) * norm(at.back() - at.front());
  if (m.add.empty()) {
    if (m.kind == MotionKind::velocity && !m.scaled()) return norm(m.velocity);
    if (m.kind == MotionKind::oscillation) return 2 * std::numbers::pi * m.frequency * norm(m.amplitude);
  }
  return top_speed(m, at, until);
}

double fill_volume(const GrainFill& fill) {
  const Vec3d side = fill.max - fill.min;
  if (!fill.solid.shape) return side.x * side.y * side.z;
  const double step = std::cbrt(side.x * side.y * side.z / 1e6);
  return volume_below(*fill.solid.shape, {0, 0, 1}, Bounds::kInfinity, step);
}

double solid_volume(const GrainFill& fill, double rho) {
  if (fill.packing_fraction > 0) return fill.packing_fraction * fill_volume(fill);
  if (fill.mass > 0) return fill.mass / rho;
  return double(fill.count) * mean_volume(fill.sizes, std::size_t(fill.count));
}

void resolve(Config& c, const Value& root, const std::filesystem::path& checkpoint) {
  resolve_shapes(c, root);
  resolve_scattered_bodies(c, root);
  resolve_large_grains(c, root);
  resolve_walls(c, root);
  if (c.domain.two_d) resolve_plane(c, root);
  resolve_motions(c, root);
  resolve_free_bodies(c, root);
  resolve_openings(c, root);
  if (c.frame.motion.moves()) c.frame.acceleration = FrameEffects(c).acceleration;
  if (c.fluid.present && c.fluid.lattice()) resolve_lattice(c, root);
  if (c.fluid.present && !c.fluid.lattice()) resolve_fluid(c, root, checkpoint);
  if (c.grain.present) resolve_grains(c, root, checkpoint);
  if (c.fluid.present && c.grain.present && c.couple.hc == 0)
    c.couple.hc =
        std::max(c.fluid.h(), 4 * (c.own_lengths() ? c.grain.d_min : c.grain.d_max) / c.fluid.kappa());
  if (c.out.diagnostics_every == 0) c.out.diagnostics_every = c.out.every;
  resolve_probes(c, root);
}

}  // namespace bedload
