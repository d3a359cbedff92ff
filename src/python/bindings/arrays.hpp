#pragma once
// Arrays of the solver for NumPy and DLPack.

#include <nanobind/nanobind.h>

#include "bedload/host_data.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// A read-only zero-copy NumPy view of the solver's memory.
nanobind::object view_of(const FieldView& view);
/// A field in the memory of a GPU.
struct DeviceField {
  FieldView view;
  Device device;
};
/// Adds DeviceField to the module.
void bind_arrays(nanobind::module_& m);
/// A NumPy array that takes over the bytes of `array`.
nanobind::object array_of(HostArray array);

}  // namespace bedload
