#pragma once
// Insertion of grains during a run.

#include <cstdint>
#include <vector>

#include "bedload/case/config/openings.hpp"

namespace bedload {

struct Config;

/// One [[grain_inlet]]: when a grain is due, how large it is and where it may go. The n-th grain always has
/// the same size; each round of places is drawn anew. Depends on grain.seed alone.
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
  double radius() const { return radius_; }             ///< of the next grain, m
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
  std::uint32_t material_;
  double rho_;
  std::uint64_t seed_, stream_;
  std::vector<std::vector<double>> sizes_;  ///< diameters in rising order, equally frequent, of each entry
  double radius_;
};

}  // namespace bedload
