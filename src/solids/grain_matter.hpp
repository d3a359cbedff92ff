#pragma once
// Materials of the grains, as passes read them.

#include <cmath>

#include "bedload/case/config/grains.hpp"
#include "bedload/parallel/buffer.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/contact/grain_mass.hpp"

namespace BL_SOLVER {

class GrainMatter {
 public:
  explicit GrainMatter(const std::vector<GrainMaterial>& materials) {
    for (const GrainMaterial& m : materials) per_r3_.push_back(4.0 / 3.0 * M_PI * m.rho);
    each_.assign(per_r3_);
  }
  std::uint32_t materials() const { return std::uint32_t(per_r3_.size()); }
  /// For the grains of a store, which must outlive the result.
  MassPerR3 of(const GrainStore& grains) const {
    if (materials() == 1) return {per_r3_[0]};
    return {per_r3_[0], grains.material, each_};
  }
  /// kg/m3, for the host.
  double per_r3(std::uint32_t material) const { return per_r3_[material]; }

 private:
  std::vector<double> per_r3_;
  Buffer<double> each_;
};

}  // namespace BL_SOLVER
