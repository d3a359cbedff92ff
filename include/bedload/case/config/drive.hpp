#pragma once
// What drives fluid and grains besides gravity.

#include <string>

#include "bedload/case/choices.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

/// What drives fluid and grains besides gravity.
struct DriveConfig {
  Vec3d f{0, 0, 0};                            ///< force per volume of space, N/m3; per mass, m/s2; per particle, N
  std::string factor = "1";                    ///< of f; formula in x, y, z, t
  Chosen<DriveMode> mode = DriveMode::volume;
  Chosen<DrivenPhase> on = DrivenPhase::fluid;
  Chosen<DriveReversal> opposed = DriveReversal::none;
  Vec3d rate{0, 0, 0};                         ///< pulls towards the centre: acceleration -rate^2 (r - centre), 1/s
  Vec3d centre{0, 0, 0};                       ///< m
  bool pulls() const { return rate != Vec3d{}; }
  bool on_fluid() const { return f != Vec3d{} && on != DrivenPhase::grains; }
  bool on_grains() const { return f != Vec3d{} && on != DrivenPhase::fluid; }
  bool operator==(const DriveConfig&) const = default;
};

}  // namespace bedload
