#pragma once
// Case files as Python sees them: dicts, and where each value was given.

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/section.hpp"

namespace bedload {

/// A case that was read: all its values, and the tree that tells where they stood.
struct ReadCase {
  Config config;
  Value tree;
  std::vector<std::string> warnings;
};

/// f(); to errors that name a key it adds where the case says so.
template <class F>
auto placed(const Value& tree, F&& f) {
  try {
    return f();
  } catch (const KeyError& error) {
    throw CaseError(nearest_value(tree, error.key).place() + ": " + error.what());
  }
}

/// Adds what a module needs to read and write cases.
void bind_cases(nanobind::module_& m);

}  // namespace bedload
