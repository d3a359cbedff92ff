#pragma once
// Arrays of the solver as NumPy and DLPack see them.

#include <nanobind/nanobind.h>

#include "bedload/host_data.hpp"

namespace bedload {

/// A read-only NumPy array on the solver's own memory.
nanobind::object window_on(const FieldView& view);
/// The same of device memory: (DLPack exporter, address, shape, strides in bytes, type as NumPy writes it).
nanobind::object device_window_on(const FieldView& view);
/// A NumPy array that takes over the bytes of `array`.
nanobind::object array_of(HostArray array);

}  // namespace bedload
