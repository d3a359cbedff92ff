#pragma once
// What several ranks can compute.

namespace bedload {

struct Config;

/// Throws KeyError for the first thing of a case that cannot be divided among ranks yet.
void refuse_undivided(const Config& config);

}  // namespace bedload
