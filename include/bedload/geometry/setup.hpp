#pragma once
// From a checked case to the particles it starts with.

#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Initialises the fluid, the wall particles and the grains of `config`, each in the order
/// of its ids. The same case gives the same particles on every machine. Remarks the
/// user should read are appended to `warnings`, what is as it should be but may surprise to `notes`. Throws
/// CaseError if fluid or grains lie outside the domain or inside a wall, or do not fit.
Setup build_setup(const Config& config, std::vector<std::string>& warnings,
                  std::vector<std::string>* notes = nullptr);

/// Whether fluid begins next to space that nothing fills: no fluid, no wall particle, no side of the domain
/// that reflects what crosses it.
bool has_free_surface(const Config& config, const Setup& setup);

}  // namespace bedload
