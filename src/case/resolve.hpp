#pragma once
// From what the user gave to what the solver needs.

#include <filesystem>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/section.hpp"

namespace bedload {

/// Fills in the defaults that follow from other parameters: sound speed, spacings,
/// coupling length, grain sizes, intervals. Throws CaseError for values it needs and lacks. What follows from
/// particles in files is read there, or from `checkpoint` if that is given.
void resolve(Config& config, const Value& root, const std::filesystem::path& checkpoint = {});

/// Fills in the boxes of fluid.fill that come from files: around the particles, half a spacing beyond them.
void resolve_listed_fluid(Config& config, const Value& root, const std::filesystem::path& checkpoint);

/// Fills in box and count of a grain.fill that comes from a file, and what its diameters mean for the case;
/// false if the file has no diameters.
bool resolve_listed_grains(Config& config, std::size_t index, const Value& root,
                           const std::filesystem::path& checkpoint);

/// Reads the spheres of clumps from their files and works out their shapes; CaseError for what is none.
void resolve_clumps(Config& config, const Value& root);

/// A shape and a body in place of each that free.scatter stands for.
void resolve_scattered_bodies(Config& config, const Value& root);

/// A free body in place of each grain of fills around which the fluid flows.
void resolve_large_grains(Config& config, const Value& root);

/// Mass, material, contacts and constraints of free bodies.
void resolve_free_bodies(Config& config, const Value& root);

/// Unit vectors, half widths and shapes of openings; checks that orifices are wide enough for fluid.dx.
void resolve_openings(Config& config, const Value& root);

/// The grains' sizes of [[grain_inlet]], and what they mean for the case.
void resolve_grain_inlets(Config& config, const Value& root);

/// Lets what bounds a plane flow run through its domain along y, where it is the same everywhere, and keeps
/// free bodies in its middle. CaseError for what would leave the plane.
void resolve_plane(Config& config, const Value& root);

/// CaseError for what no plane flow has.
void check_plane(const Config& config, const Value& root);

/// Intervals of probes, and the directions of patches on walls.
void resolve_probes(Config& config, const Value& root);

/// Unit vector along `v`, given at `path`; one that already is stays as it is, so that a resolved case reads
/// back unchanged. CaseError for zero.
Vec3d direction(const Vec3d& v, const Value& root, const std::string& path);

/// The [[shape]] of that name; CaseError with `must` if there is no such shape.
Solid shape_named(const Config& config, const std::string& name, const Value& root, const std::string& path,
                  const char* must);

/// Completes the sizes of grains at `path`, makes fractions of mass such of number, and widens grain.d_min,
/// d_max to them, or to the spheres of the clump of such sizes.
void resolve_sizes(Config& config, std::vector<SizeClass>& sizes, const Value& root, const std::string& path,
                   const ClumpConfig* clump = nullptr);

/// CaseError for a wall body whose shape is not defined.
void check_shape_names(const Config& config, const Value& root);

/// Sizes where none are given: grain.d.
void default_sizes(const Config& config, std::vector<SizeClass>& sizes, const Value& root);

/// CaseError: `key` must be given.
[[noreturn]] void missing(const Value& root, const std::string& key, const char* what);

/// CaseError if a factor, at `path`, is not a formula in t or not finite between the times `start` and `end`
/// (s). Its t counts from `start`.
void check_factor(const std::string& factor, double start, double end, const Value& root,
                  const std::string& path);

/// Checks parameters against each other. Throws CaseError; appends warnings.
void cross_check(const Config& config, const Value& root, std::vector<std::string>& warnings);

/// Largest speed of a wall body (m/s) up to the time `until` (s): an oscillation's peak, a rotation's
/// outermost corner, that of a free body at the start, otherwise sampled.
double wall_speed(const WallBody& body, const DomainConfig& domain, double until);

/// The motions of a case with the paths of their keys: f(motion, path). `C`: Config, const or not.
template <class C, class F>
void for_motions(C& config, const F& f) {
  f(config.frame.motion, std::string("frame.motion"));
  for (std::size_t i = 0; i < config.wall.bodies.size(); ++i)
    f(config.wall.bodies[i].motion, "wall.body." + std::to_string(i) + ".motion");
}

/// The parts of a motion with the paths of their keys: f(part, path).
template <class M, class F>
void for_parts(M& motion, const std::string& path, const F& f) {
  f(motion, path);
  for (std::size_t k = 0; k < motion.add.size(); ++k) f(motion.add[k], path + ".add." + std::to_string(k));
}

/// Height along gravity that boxes [min, max] span together, m; 0 without gravity.
template <class Fill>
double height(const std::vector<Fill>& fills, const Vec3d& gravity) {
  const double g = norm(gravity);
  if (g == 0 || fills.empty()) return 0;
  double lo = 1e300, hi = -1e300;
  for (const Fill& fill : fills) {
    double low = 0, high = 0;
    for (int k = 0; k < 3; ++k) {
      const double a = -gravity[k] / g * fill.min[k], b = -gravity[k] / g * fill.max[k];
      low += a < b ? a : b;
      high += a < b ? b : a;
    }
    lo = low < lo ? low : lo;
    hi = high > hi ? high : hi;
  }
  return hi - lo;
}

/// Of the box or shape to fill, m3.
double fill_volume(const GrainFill& fill);

/// Solid volume that a fill asks for, m3; from count, mass or packing fraction.
double solid_volume(const GrainFill& fill, double rho);

}  // namespace bedload
