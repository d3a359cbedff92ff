#pragma once
// Which plane shear flow a case is, and between what.

#include <string>

#include "bedload/case/config.hpp"
#include "bedload/core/error.hpp"

namespace bedload {

/// reverse_poiseuille: periodic, driven one way below, the other way above; poiseuille: driven between
/// resting walls; couette: between walls of which one or both move along; lees_edwards: between images that
/// do.
enum class PlaneFlowKind { reverse_poiseuille, poiseuille, couette, lees_edwards };

struct PlaneFlow {
  PlaneFlowKind kind = PlaneFlowKind::reverse_poiseuille;
  int along = 0, gradient = 2;  ///< axes of the velocity and of its gradient: 0, 1, 2
  double low = 0, high = 0;     ///< ends along the gradient: of the domain, or surfaces of the walls, m
  int lower = -1, upper = -1;   ///< wall bodies with those surfaces, by their index; -1: none
  double area = 0;              ///< of such a surface, m2
  double relative_speed = 0;    ///< of the walls, or what an image moves by: upper less lower, m/s
  double fastest = 0;           ///< of the walls, m/s

  bool walled() const { return kind == PlaneFlowKind::poiseuille || kind == PlaneFlowKind::couette; }
  /// Driven one way below the middle, the other way above.
  bool reversed() const { return kind == PlaneFlowKind::reverse_poiseuille; }
  /// By what moves at its ends; else by a force within.
  bool sheared() const { return kind == PlaneFlowKind::couette || kind == PlaneFlowKind::lees_edwards; }
  int across() const { return 3 - along - gradient; }  ///< axis of the vorticity
  /// Between flips of the drive, walls, or images, m.
  double gap() const { return (reversed() ? 0.5 : 1) * (high - low); }
  /// Time in which the flow comes e times closer to being steady, s; nu: kinematic viscosity, m2/s.
  double relaxation(double nu) const;
  /// "reverse Poiseuille".
  std::string name() const;
};

/// A case that is none of them.
struct NoPlaneFlow : KeyError {
  using KeyError::KeyError;
};

/// Throws NoPlaneFlow where the case is none of them, KeyError where something would be measured along with
/// the viscosity, or the flow is too narrow.
PlaneFlow plane_flow_of(const Config& config);

/// What is left out at the start, in times in which the flow comes e times closer to being steady: over ten
/// more of them what is missing then takes 0.2 % of the mean.
inline constexpr int kStart = 4;
inline constexpr int kLeastBlocks = 10, kMostBlocks = 50;  ///< of such a time or longer that are measured

/// How many are measured until `end` (s) in fluid of viscosity nu (m2/s). Throws KeyError for fewer than
/// kLeastBlocks.
int blocks_until(const PlaneFlow& flow, double nu, double end);

}  // namespace bedload
