#pragma once
// Which plane shear flow a case is, and between what.

#include <string>

#include "bedload/case/config.hpp"

namespace bedload {

/// reverse_poiseuille: periodic, driven one way below, the other way above; poiseuille: driven between
/// resting walls; couette: between walls of which one or both move along.
enum class PlaneFlowKind { reverse_poiseuille, poiseuille, couette };

struct PlaneFlow {
  PlaneFlowKind kind = PlaneFlowKind::reverse_poiseuille;
  int along = 0, gradient = 2;  ///< axes of the velocity and of its gradient: 0, 1, 2
  double low = 0, high = 0;     ///< ends along the gradient: of the domain, or surfaces of the walls, m
  int lower = -1, upper = -1;   ///< wall bodies with those surfaces, by their index; -1: none
  double area = 0;              ///< of such a surface, m2
  double relative_speed = 0;    ///< of the walls: upper less lower, m/s

  bool walled() const { return kind != PlaneFlowKind::reverse_poiseuille; }
  int across() const { return 3 - along - gradient; }  ///< axis of the vorticity
  /// Between flips of the drive, or walls, m.
  double gap() const { return (walled() ? 1 : 0.5) * (high - low); }
  /// "reverse Poiseuille".
  std::string name() const;
};

/// Throws KeyError where the case is none of them, or where something would be measured along with the
/// viscosity.
PlaneFlow plane_flow_of(const Config& config);

}  // namespace bedload
