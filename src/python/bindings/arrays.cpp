#include "arrays.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <utility>

namespace nb = nanobind;

namespace bedload {
namespace {

nb::dlpack::dtype type_of(Scalar scalar) {
  const bool real = scalar == Scalar::f32 || scalar == Scalar::f64;
  const auto code = real ? nb::dlpack::dtype_code::Float : nb::dlpack::dtype_code::UInt;
  return {std::uint8_t(code), std::uint8_t(8 * size_of(scalar)), 1};
}

/// Shape and strides of an array: one axis for the particles, and one for components if they are several.
struct Layout {
  std::size_t axes;
  std::size_t shape[2];
  std::int64_t strides[2];  ///< in scalars

  Layout(std::size_t count, int components, std::size_t stride, Scalar scalar)
      : axes(components > 1 ? 2 : 1),
        shape{count, std::size_t(components)},
        strides{std::int64_t(stride / size_of(scalar)), 1} {}
};

/// Keeps `what` for as long as an array needs it.
template <class T>
nb::capsule keep(T what) {
  return nb::capsule(new T(std::move(what)), [](void* p) noexcept { delete static_cast<T*>(p); });
}

}  // namespace

nb::object view_of(const FieldView& v) {
  const Layout l(v.count, v.components, v.stride, v.type);
  const nb::ndarray<nb::numpy, nb::ro> array(v.data, l.axes, l.shape, keep(v.memory), l.strides,
                                             type_of(v.type));
  return nb::cast(array);
}

nb::object array_of(HostArray a) {
  const Layout l(a.count(), a.components, a.components * size_of(a.type), a.type);
  const auto type = type_of(a.type);
  auto* bytes = new HostBytes(std::move(a.bytes));
  const nb::capsule owner(bytes, [](void* p) noexcept { delete static_cast<HostBytes*>(p); });
  return nb::cast(nb::ndarray<nb::numpy>(bytes->data(), l.axes, l.shape, owner, l.strides, type));
}

namespace {

Layout layout_of(const FieldView& v) { return {v.count, v.components, v.stride, v.type}; }

/// The axes of `l` in a tuple, each multiplied by `unit`.
template <class T>
nb::tuple axes(const Layout& l, const T (&values)[2], std::size_t unit = 1) {
  nb::list out;
  for (std::size_t k = 0; k < l.axes; ++k) out.append(values[k] * T(unit));
  return nb::tuple(out);
}

}  // namespace

void bind_arrays(nb::module_& m) {
  nb::class_<DeviceField>(m, "DeviceField", "An array in the memory of a GPU.")
      .def_prop_ro("pointer",
                   [](const DeviceField& f) { return reinterpret_cast<std::uintptr_t>(f.view.data); })
      .def_prop_ro("shape",
                   [](const DeviceField& f) {
                     const Layout l = layout_of(f.view);
                     return axes(l, l.shape);
                   })
      .def_prop_ro(
          "strides",
          [](const DeviceField& f) {
            const Layout l = layout_of(f.view);
            return axes(l, l.strides, size_of(f.view.type));
          },
          "Bytes.")
      .def_prop_ro(
          "kind",
          [](const DeviceField& f) {
            const bool real = f.view.type == Scalar::f32 || f.view.type == Scalar::f64;
            return (real ? "<f" : "<u") + std::to_string(size_of(f.view.type));
          },
          "Type, as NumPy writes it.")
      .def(
          "exporter",
          [](const DeviceField& f) {
            const Layout l = layout_of(f.view);
            return nb::ndarray<nb::array_api, nb::ro>(f.view.data, l.axes, l.shape, keep(f.view.memory),
                                                      l.strides, type_of(f.view.type),
                                                      nb::device::cuda::value);
          },
          "DLPack capsule.")
      .def(
          "copy",
          [](const DeviceField& f) {
            HostArray copied;
            {
              const nb::gil_scoped_release release;
              copied = host_copy(f.view, f.device);
            }
            return array_of(std::move(copied));
          },
          "A NumPy copy of the current values.");
}

}  // namespace bedload
