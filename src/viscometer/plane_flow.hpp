#pragma once
// Recognises plane shear flows for the viscometer.

#include <string>

#include "bedload/case/config.hpp"
#include "bedload/core/error.hpp"

namespace bedload {

/// reverse_poiseuille: periodic, driven in opposite directions in the lower and upper half; poiseuille:
/// driven between fixed walls; couette: sheared by one or two moving walls; lees_edwards: sheared by moving
/// images.
enum class PlaneFlowKind { reverse_poiseuille, poiseuille, couette, lees_edwards };

struct PlaneFlow {
  PlaneFlowKind kind = PlaneFlowKind::reverse_poiseuille;
  int along = 0, gradient = 2;  ///< axes of the velocity and of its gradient: 0, 1, 2
  double low = 0, high = 0;     ///< ends along the gradient, sides of the domain or wall surfaces, m
  int lower = -1, upper = -1;   ///< indices of the wall bodies there; -1: none
  double area = 0;              ///< of a wall surface, m2
  double relative_speed = 0;    ///< upper minus lower, of walls or images, m/s
  double fastest = 0;           ///< of the walls, m/s

  bool walled() const { return kind == PlaneFlowKind::poiseuille || kind == PlaneFlowKind::couette; }
  /// Driven in opposite directions in the two halves.
  bool reversed() const { return kind == PlaneFlowKind::reverse_poiseuille; }
  /// Driven by moving boundaries, not by a body force.
  bool sheared() const { return kind == PlaneFlowKind::couette || kind == PlaneFlowKind::lees_edwards; }
  int across() const { return 3 - along - gradient; }  ///< axis of the vorticity
  /// Distance between reversals of the drive, walls or images, m.
  double gap() const { return (reversed() ? 0.5 : 1) * (high - low); }
  /// e-folding time towards the steady state, s; nu: kinematic viscosity, m2/s.
  double relaxation(double nu) const;
  /// "reverse Poiseuille".
  std::string name() const;
};

/// The case is none of these flows.
struct NoPlaneFlow : KeyError {
  using KeyError::KeyError;
};

/// Fluid this close to reversals and walls is left out, m: a smoothing length, of a lattice a node.
double left_out(const FluidConfig& fluid);

/// Throws NoPlaneFlow if the case is none of these flows, KeyError if something would add to the measured
/// viscosity or the flow is too narrow.
PlaneFlow plane_flow_of(const Config& config);

/// Start of the average, in relaxation times: the remaining transient changes the mean over ten more of them
/// by 0.2 %.
inline constexpr int kStart = 4;
inline constexpr int kLeastBlocks = 10, kMostBlocks = 50;  ///< of at least one relaxation time each

/// Number of blocks until `end` (s) at viscosity nu (m2/s). Throws KeyError for fewer than kLeastBlocks.
int blocks_until(const PlaneFlow& flow, double nu, double end);

}  // namespace bedload
