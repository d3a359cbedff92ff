#pragma once
#include "src/fluid/fluid_solver.hpp"

namespace BL_SOLVER {

/// Locally averaged WCSPH, with its stabilising terms; no fields besides those of all fluids.
struct Wcsph {
  static constexpr FluidModel model = FluidModel::wcsph;
  static std::unique_ptr<FluidSolver> make(const FluidParameters& parameters, const Frame& frame,
                                           const WallGeometry& walls, FluidStore& fluid);
};

}  // namespace BL_SOLVER
