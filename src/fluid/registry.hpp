#pragma once
// The fluid models that a case may name. A new one is an include and its place in the list.

#include <algorithm>

#include "bedload/core/first_look.hpp"
#include "src/fluid/sdpd.hpp"
#include "src/fluid/wcsph.hpp"

namespace BL_SOLVER {

template <class... Models>
struct FluidModelList {
  static constexpr bool holds(FluidModel model) { return ((model == Models::model) || ...); }
  static std::unique_ptr<FluidSolver> make(const FluidParameters& parameters, const Frame& frame,
                                           const WallGeometry& walls, FluidStore& fluid) {
    std::unique_ptr<FluidSolver> solver;
    (void)((parameters.fluid.model == Models::model &&
            (solver = Models::make(parameters, frame, walls, fluid))) ||
           ...);
    if (kFirstLook && !solver) not_in_first_look("fluid.model", "wcsph alone");
    return solver;
  }
};

#if BL_FIRST_LOOK
using FluidModels = FluidModelList<Wcsph>;
#else
using FluidModels = FluidModelList<Wcsph, Sdpd, SpinningSdpd>;
#endif

static_assert(kFirstLook || std::all_of(kNames<FluidModel>.begin(), kNames<FluidModel>.end(),
                                        [](const auto& row) {
                                          return row.nodes || FluidModels::holds(row.value);
                                        }),
              "a fluid model that a case may name is missing in FluidModels");

}  // namespace BL_SOLVER
