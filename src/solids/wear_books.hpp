#pragma once
// Wear of wall bodies by patches. Each rank has the sums over its own grains; frames and checkpoints, those
// of all.

#include <vector>

#include "bedload/host_data.hpp"
#include "bedload/parallel/buffer.hpp"
#include "kernels/contact/wear.hpp"
#include "src/solids/parameters.hpp"

namespace BL_SOLVER {

class WearBooks {
 public:
  explicit WearBooks(const SolidParameters& parameters);

  WallWear view() const { return {device_maps_.data(), unit_}; }
  /// Begins anew.
  void forget();
  /// Patches of a body that grains have met, where it is now: arrays position, id, force_path, normal_energy,
  /// shear_energy, contact_time, cutting_energy, wear_volume, wear_depth.
  HostStore frame(int body, const std::string& name, const RigidMotion& pose) const;
  /// Adds a store "wear" of all bodies.
  void save(std::vector<HostStore>& stores) const;
  /// Of a checkpoint without it: begins anew. Throws FileError for other patches.
  void load(const std::vector<HostStore>& stores);

 private:
  std::vector<WearGrid> grids_;
  double unit_ = 0;  ///< J
  std::vector<Buffer<WearSums>> sums_;
  std::vector<WearMap> maps_;
  Buffer<WearMap> device_maps_;
};

}  // namespace BL_SOLVER
