#pragma once
// Rigid groups of grains: state, mass properties, motion.

#include <array>
#include <memory>
#include <vector>

#include "bedload/parallel/loops.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/bodies/grain_groups.hpp"
#include "src/solids/grain_matter.hpp"
#include "src/solids/parameters.hpp"

namespace BL_SOLVER {

class RigidGroups {
 public:
  /// Adds the fields of group membership to `grains`: construct before the store is filled or loaded.
  RigidGroups(const SolidParameters& parameters, const Frame& frame, GrainStore& grains);

  bool any() const { return !groups_.empty(); }
  /// For each grain 1 + its group, 0 without one; empty if no fill is rigid.
  Span<const std::uint32_t> of_grains() const {
    return group_ ? group_->span() : Span<const std::uint32_t>();
  }
  /// Assigns grains to groups at initialisation; `fill`: fill of each grain, by id.
  void bind(const GrainStore& grains, const std::vector<std::uint32_t>& fill);

  /// Moves the groups after every grain was kicked, and drifted by `drift` (s), on its own; the grains
  /// follow. Rest: low parts of the velocities, may be empty.
  void follow(GrainStore& grains, const Velocities<Real3>& rest, double drift);
  /// Sets the velocities of the groups to zero, as those of their grains are.
  void stop();

  /// Present motion of group k, with its centre as the reference point.
  RigidMotion motion(int k) const;
  /// Force and torque about its centre from the contacts of its grains.
  LoadSum by_contacts(int k, const GrainStore& grains) const;
  /// From the fluid; the torque on single grains is a mean over the last step dt (s).
  LoadSum by_fluid(int k, const GrainStore& grains, double dt) const;
  std::vector<const Store*> stores() const {
    if (!any()) return {};
    return {&store_};
  }
  void save(std::vector<HostStore>& stores) const;
  /// After `grains` has been loaded.
  void load(const HostStore& groups, const GrainStore& grains);

 private:
  GrainGroups view() const;
  void measure(const GrainStore& grains);

  struct GroupStore : Store {
    GroupStore() : Store("groups") {}
    Field<Vec3d> x{*this, "x", "m", Lifetime::kept};
    Field<Vec3d> v{*this, "v", "m/s", Lifetime::kept};
    Field<Vec3d> angular_momentum{*this, "angular_momentum", "kg m2/s", Lifetime::kept};
    Field<Vec4<double>> rotation{*this, "rotation", "-", Lifetime::kept};
  };

  std::vector<RigidGroup> groups_;
  bool plane_;  ///< they move in the xz plane
  Frame frame_;
  std::vector<RigidBody> bodies_;  ///< one per group, about their centres of mass
  GrainMatter matter_;
  std::unique_ptr<Field<std::uint32_t>> group_;
  std::unique_ptr<Field<Vec3d>> arm_;
  mutable GroupStore store_;
  Buffer<RigidBody> constants_;
  Buffer<LoadSum> gained_;
  std::array<double, 6> most_gained_{};  ///< by a grain in a substep, N s, N m s
};

}  // namespace BL_SOLVER
