#pragma once
// A case before it runs, drawn.

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "bedload/output/image.hpp"

namespace bedload {

/// One layer of particles below the surface of every wall body, `at_least` m apart and no finer than a
/// picture shows.
Setup::Walls wall_surfaces(const Config& config, double at_least);

/// Views from the front, from above and in perspective, with axes and a legend.
Image picture_of(const Config& config, const Setup& setup);

}  // namespace bedload
