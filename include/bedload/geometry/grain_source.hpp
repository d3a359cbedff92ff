#pragma once
// Insertion of grains during a run.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bedload/case/config/openings.hpp"

namespace bedload {

struct Config;

/// One [[grain_inlet]]: when a grain, or a clump, is due, how large it is and where it may go. The n-th
/// always has the same size and rotation; each round of places is drawn anew. Depends on grain.seed alone.
class GrainSource {
 public:
  GrainSource(const Config& config, std::size_t index);

  /// State for a restart.
  struct State {
    double count = 0;   ///< grains dropped so far
    double mass = 0;    ///< of them, kg
    double rounds = 0;  ///< of places tried
    double asked = 0;   ///< grains due when space was last looked for
  };
  State state;

  const std::string& name() const { return inlet_.name; }
  double radius() const { return radius_; }  ///< of the next grain, or of the sphere of its volume, m
  const ClumpShape* shape() const { return shape_ ? &*shape_ : nullptr; }  ///< null: a sphere
  Quat<double> rotation() const;                                           ///< of the next clump
  /// Places from its centre, and radii, of the spheres of the next grain, m.
  std::vector<std::pair<Vec3d, double>> spheres() const;
  double reach() const { return shape_ ? 2 * shape_->reach * radius_ : radius_; }  ///< of all of them, m
  std::uint32_t material() const { return material_; }  ///< place in GrainConfig::all_materials
  Vec3d velocity() const { return inlet_.velocity; }
  /// The next grain is due.
  bool due(double t) const { return pending(t) > 0; }
  /// Another grain has become due since space was last looked for.
  bool news(double t) const { return state.count + pending(t) > state.asked; }
  /// Grains due but not yet dropped.
  double pending(double t) const;

  /// A new round of random places for the next grain, m.
  std::vector<Vec3d> places();
  void dropped();
  /// Continues from a restored state.
  void resume() { radius_ = next_radius(); }

 private:
  double next_radius() const;
  double mass_of(double radius) const;

  GrainInletConfig inlet_;
  std::optional<ClumpShape> shape_;
  std::uint32_t material_;
  double rho_;  ///< of a clump, that of the union of its spheres
  std::uint64_t seed_, stream_;
  std::vector<std::vector<double>> sizes_;  ///< diameters in rising order, equally frequent, of each entry
  double radius_;
};

}  // namespace bedload
