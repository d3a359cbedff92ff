#pragma once
// Case files for Python: dicts, and the place of each value.

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/section.hpp"

namespace bedload {

/// A case that was read: its configuration, and the tree with the places of its values.
struct ReadCase {
  Config config;
  Value tree;
  std::vector<std::string> warnings;
};

/// f() whose errors about a key get its place in the case.
template <class F>
auto placed(const Value& tree, F&& f) {
  try {
    return f();
  } catch (const KeyError& error) {
    throw CaseError(nearest_value(tree, error.key).place() + ": " + error.what());
  }
}

/// Adds functions that read and write cases to the module.
void bind_cases(nanobind::module_& m);

}  // namespace bedload
