#pragma once
// Keys of a case against each other, by section of the case.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "bedload/case/parameters.hpp"
#include "bedload/core/error.hpp"
#include "resolve.hpp"
#include "src/motion/survey.hpp"

namespace bedload {

class Checks {
 public:
  Checks(const Config& config, const Value& root, std::vector<std::string>& warnings)
      : c(config), root_(root), warnings_(warnings) {}

  void domain() const;
  void fluid() const;
  void lattice() const;
  /// Meshes in mm that are taken for m lie far outside the domain, or are lost in it.
  void meshes() const;
  void walls() const;
  void motions() const;
  void grains() const;
  void contact_pairs() const;
  void grain_energy() const;
  void coupling() const;
  void openings() const;
  void time() const;
  void probes() const;
  void mixing(const std::string& path, const ProbeConfig& probe) const;
  void field(const std::string& path, const ProbeConfig& probe) const;

 private:
  // of all sections, and time: checks.cpp
  /// Density from former rates needs what one visit of each pair can find, and allows shorter steps only, by
  /// linear analysis: sound is damped up to a cfl of 0.6, density diffusion at its largest up to 0.39.
  void one_pass() const;
  /// Reflecting sides act on particles one by one, so not on rigid groups and clumps.
  void reflection() const;
  /// Lees-Edwards boundaries carry fluid alone, by what its pairs do.
  void shear() const;
  /// Frames hold floats, whose last digit grows with the distance from the origin.
  void written_positions() const;
  void box(const std::string& path, const Vec3d& lo, const Vec3d& hi) const;
  void period(int axis, double least, const char* name, bool applies) const;
  /// Whether a box shares space with the domain.
  bool in_sight(const Vec3d& lo, const Vec3d& hi) const;
  void inside_domain(const std::string& path, const Vec3d& x) const;
  /// The line along gravity through x must meet the domain.
  /// `along`: direction of the line through x, 0: upwards.
  void column_in_domain(const std::string& path, const Vec3d& x, const Vec3d& along) const;
  void file_name(const std::string& path, const std::string& name) const;
  void body_exists(const std::string& path, const std::string& name) const;

  // checks_fluid.cpp
  /// A number as the case gives it, in `unit`; infinity where it gives none.
  double given(const char* path, const char* unit) const;
  /// Gravity pulls the fluid out of the domain.
  bool unsupported() const;
  /// Several fluids.
  void species() const;
  void drive() const;
  /// What needs one smoothing length for all.
  void variable_h() const;
  /// What the fluid model needs and cannot do, by its traits; parts of it:
  void model() const;
  void smoothing(const std::string& with) const;
  void thermal(const std::string& with) const;
  void bulk_viscosity() const;
  void summation() const;
  /// Grains in air fall into the fluid faster than it flows by itself.
  void falling_grains() const;
  /// The formulas of a fill on a 5 x 5 x 5 raster.
  void initial_speed(const FluidFill& fill) const;

  // checks_lattice.cpp
  void lattice_step() const;
  void lattice_shear() const;
  void lattice_walls() const;
  void lattice_grains() const;

  // checks_grains.cpp
  void grain_fill(const std::string& path, const GrainFill& fill) const;
  void materials() const;
  /// What clumps do not work with.
  void clumps() const;
  /// Overlap at the bottom of the bed by its own weight.
  void softness() const;
  /// Drag laws are of grains smaller than what the fluid is averaged over; fluid flows around large ones.
  void resolution() const;
  void lubrication() const;
  void suspension_viscosity() const;
  void undisturbed() const;
  void drag_table() const;

  // checks_bodies.cpp
  /// The largest side of a body alone must not have more wall particles than there can be.
  void countable(const std::string& path, const WallBody& body) const;
  /// The balls by which a free body touches others are no more than can be looked at.
  void touchable(const std::string& path, const WallBody& body) const;
  /// Particles leave a domain before they meet a wall beyond it.
  void met(const WallBody& body) const;
  /// Splash over the rim of an open tank leaves a domain that ends there, unless fluid is at rest or the rim
  /// out of its reach.
  void rim(const WallBody& body) const;
  /// Fluid that spans a tank and is set in motion by nothing.
  bool still_in(const WallBody& tank, int up_axis) const;
  /// Shapes do not repeat.
  void within_period(const std::string& path, const WallBody& body) const;
  /// Particles of a plane repeat with the domain only along periods within it.
  void repeats(const std::string& path, const WallBody& plane) const;
  /// Moves as it does from the first: a jump at t = 0 is meant.
  static bool steady(const MotionConfig& m);
  /// The first jumps of a motion, and how many more there are.
  void warn_of(const std::vector<VelocityJump>& jumps, const std::string& of, const char* note) const;
  /// A turning frame would need centrifugal, Coriolis and Euler forces.
  void translates(const MotionPart& m, const std::string& path) const;

  // checks_boundaries.cpp
  void grain_inlet(const std::string& path, const GrainInletConfig& inlet) const;

  bool coupled() const { return c.fluid.present && c.grain.present && c.couple.mode != CouplingMode::off; }
  static std::string to_text(const Vec3d& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }
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

  const Config& c;
  const Value& root_;
  std::vector<std::string>& warnings_;
};

}  // namespace bedload
