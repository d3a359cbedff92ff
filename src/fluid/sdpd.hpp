#pragma once
#include "kernels/sdpd/pair_law.hpp"
#include "src/fluid/fluid_solver.hpp"

namespace BL_SOLVER {

/// Smoothed dissipative particle dynamics [espanol03]: friction and noise of pairs make up the viscosity.
struct Sdpd {
  static constexpr FluidModel model = FluidModel::sdpd;
  static constexpr bool spins = false;
  static FrictionCoefficients coefficients(double eta, double zeta) {
    return {5.0 / 3 * eta - zeta, 10.0 / 3 * eta + 4 * zeta};
  }
  static std::unique_ptr<FluidSolver> make(const FluidParameters& parameters, const Frame& frame,
                                           const WallGeometry& walls, FluidStore& fluid);
};

/// SDPD+a [mueller15]: particles spin, so that friction across the line of centres keeps angular momentum.
/// Adds the spin and its rate.
struct SpinningSdpd {
  static constexpr FluidModel model = FluidModel::sdpd_a;
  static constexpr bool spins = true;
  static FrictionCoefficients coefficients(double eta, double zeta) {
    return {20.0 / 3 * eta - 4 * zeta, 6 * zeta};
  }
  static std::unique_ptr<FluidSolver> make(const FluidParameters& parameters, const Frame& frame,
                                           const WallGeometry& walls, FluidStore& fluid);
};

}  // namespace BL_SOLVER
