#pragma once
// How the lattice Boltzmann equation is solved, with fluid.model = "lattice".

#include <cstdint>

#include "bedload/case/choices.hpp"

namespace bedload {

struct LatticeConfig {
  Chosen<LatticeCollision> collision = LatticeCollision::trt;
  double magic = 3.0 / 16;                     ///< trt: where walls lie; 3/16: half-way between nodes
  double velocity = 0.05;                      ///< of fluid.vmax, in nodes a step
  double tau_max = 1;                          ///< largest relaxation time, steps
  double tau = 0;                              ///< relaxation time, steps; 0: by velocity and tau_max
  std::int64_t mass_every = 100;               ///< steps after which the mass is restored; 0: never
  bool operator==(const LatticeConfig&) const = default;
};

}  // namespace bedload
