#pragma once
// Sums over the particles of a plane shear flow, in layers across its gradient and in blocks of time.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "bedload/host_data.hpp"
#include "src/viscometer/plane_flow.hpp"

namespace bedload {

/// [3 i + j]: component i of a force or velocity times component j of a distance or velocity.
using Tensor = std::array<double, 9>;

/// Of particles of one kind, over all samples: mass (kg), momentum (kg m/s), M v v (J).
struct MotionSums {
  double mass = 0;
  Vec3d momentum;
  Tensor flow{};

  void add(double m, const Vec3d& v);
  void add(const MotionSums& other);
  /// Sum of M v' v' about their mean velocity, J.
  Tensor fluctuation() const;
};

/// One layer during one block.
struct LayerSums {
  MotionSums fluid, grains;
  double volume = 0;             ///< mixture volume of the fluid particles, m3
  double grain_volume = 0;       ///< m3
  double place = 0, place2 = 0;  ///< fluid mass times s and s^2, kg; s = distance from the lower end / gap
  double drive = 0;              ///< force along the flow by gravity and drive, N
  std::map<std::string, Tensor> parts;  ///< virial of the pair forces by part, J

  void add(const LayerSums& other);
};

/// One block of time.
struct Block {
  std::vector<LayerSums> layers;
  int samples = 0;
  double stress = 0;  ///< shear stress on the walls, mean of both, summed over the samples, Pa
  // Over the fluid farther than one h from reversals or walls; in reverse flow s and the velocity u are
  // mapped to the lower half:
  std::array<double, 5> s{};  ///< M s^k, kg
  std::array<double, 3> u{};  ///< M u s^k, kg m/s
};

class Layers {
 public:
  /// Layers of equal height; h: excluded at reversals and walls (not at images), m.
  Layers(const PlaneFlow& flow, double h, int layers, int blocks);

  /// One sample, from Simulation::rheology; wall_stress: mean shear stress on the walls, Pa.
  void add(int block, const HostStore& fluid, const HostStore& grains, double wall_stress);

  const PlaneFlow& flow() const { return flow_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  int count() const { return layers_; }
  /// Middle of a layer, m.
  double middle(int layer) const { return flow_.low + (layer + 0.5) * height(); }
  double height() const { return (flow_.high - flow_.low) / layers_; }
  double h() const { return h_; }
  /// Whether the middle of a layer is farther than `distance` (m) from every reversal and wall.
  bool inside(int layer, double distance) const;

 private:
  PlaneFlow flow_;
  double h_;
  int layers_;
  std::vector<Block> blocks_;
};

}  // namespace bedload
