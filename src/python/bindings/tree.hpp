#pragma once
// Case files for Python: dicts, and the place of each value.

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "bedload/case/config.hpp"

namespace bedload {

/// A case that was read: its configuration, and the tree with the places of its values.
struct ReadCase {
  Config config;
  std::vector<std::string> warnings;
};

/// Adds functions that read and write cases to the module.
void bind_cases(nanobind::module_& m);

}  // namespace bedload
