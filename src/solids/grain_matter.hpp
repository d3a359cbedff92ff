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
    std::vector<double> volumes, in_contact;
    for (const GrainMaterial& m : materials) {
      per_r3_.push_back(4.0 / 3.0 * M_PI * m.rho);
      volumes.push_back(kSphere * m.fullness);
      in_contact.push_back(per_r3_.back() * m.contact_mass);
      clumped_ |= m.fullness != 1 || m.contact_mass != 1;
    }
    each_.assign(per_r3_);
    volumes_.assign(volumes);
    in_contact_.assign(in_contact);
  }
  std::uint32_t materials() const { return std::uint32_t(per_r3_.size()); }
  /// For the grains of a store, which must outlive the result.
  MassPerR3 of(const GrainStore& grains) const {
    if (materials() == 1) return {per_r3_[0]};
    return {per_r3_[0], grains.material, each_};
  }
  /// Those with which contacts damp: of a clump's grains what their clump resists with.
  MassPerR3 in_contact(const GrainStore& grains) const {
    if (!clumped_) return of(grains);
    return {per_r3_[0], grains.material, in_contact_};
  }
  /// That of the fluid that they displace.
  VolumePerR3 volume_of(const GrainStore& grains) const {
    if (!clumped_) return {kSphere};
    return {kSphere, grains.material, volumes_};
  }
  /// kg/m3, for the host.
  double per_r3(std::uint32_t material) const { return per_r3_[material]; }

 private:
  static constexpr double kSphere = 4.0 / 3 * M_PI;
  std::vector<double> per_r3_;
  bool clumped_ = false;
  Buffer<double> each_, volumes_, in_contact_;
};

}  // namespace BL_SOLVER
