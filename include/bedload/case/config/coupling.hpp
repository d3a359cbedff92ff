#pragma once
// What fluid and grains do to each other.

#include <vector>

#include "bedload/case/choices.hpp"

namespace bedload {

/// drag.law = table: drag on a grain over its Stokes drag, by porosity and superficial Reynolds number.
struct DragTable {
  std::vector<double> porosity, reynolds;      ///< rising; reynolds from 0
  std::vector<double> factor;                  ///< K / (3 pi mu d), a row over reynolds for each porosity
  bool operator==(const DragTable&) const = default;
};

struct CouplingConfig {
  Chosen<CouplingMode> mode = CouplingMode::two_way;
  double hc = 0;                               ///< m (default max(h, 2 d 2/kappa), d being d_max, or d_min with own lengths)
  double eps_min = 0.25;
  Chosen<CouplingKernel> kernel = CouplingKernel::fluid;  ///< of averages over fluid and grains
  bool wall_normalise = true;                  ///< a grain's volume is normalised by the kernel's fraction outside walls
  double spreading = 0.01;                     ///< rate at which fluid that overfills its volume becomes denser, c/h
  bool undisturbed = false;                    ///< drag follows the flow without the grain's own wake and volume
  bool own_hc = true;                          ///< in a mix of sizes each grain has its own, not below hc
  Chosen<BetweenSizes> between = BetweenSizes::refuse;  ///< grains of four to eight fluid.dx
  double S_dry = 0.05, S_wet = 0.95;
  bool torque = true;
  bool angmom = true;
  Chosen<DragSlip> slip = DragSlip::mean;      ///< that drag follows
  Chosen<SuspensionLaw> suspension = SuspensionLaw::none;  ///< viscosity of fluid with grains
  double phi_max = 0.64;                       ///< volume fraction at which that is infinite
  Chosen<DragLaw> drag = DragLaw::di_felice;
  DragTable table;                             ///< of law = table
  Chosen<DragIntegrator> integrator = DragIntegrator::exponential;
  /// Whether grains of diameters d_min..d_max (m) have averaging lengths of their own.
  bool own_lengths(double d_min, double d_max) const { return own_hc && d_min > 0 && d_max >= 2 * d_min; }
  /// Support of the kernel around the largest of them, m.
  double farthest(double kappa, double d_min, double d_max) const {
    const double least = kappa * hc, own = 4 * d_max;
    return own_lengths(d_min, d_max) && own > least ? own : least;
  }
  bool operator==(const CouplingConfig&) const = default;
};

}  // namespace bedload
