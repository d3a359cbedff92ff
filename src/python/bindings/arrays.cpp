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

nb::object window_on(const FieldView& v) {
  const Layout l(v.count, v.components, v.stride, v.type);
  const nb::ndarray<nb::numpy, nb::ro> array(v.data, l.axes, l.shape, keep(v.memory), l.strides,
                                             type_of(v.type));
  return nb::cast(array);
}

nb::object device_window_on(const FieldView& v) {
  const Layout l(v.count, v.components, v.stride, v.type);
  const nb::ndarray<> array(const_cast<void*>(v.data), l.axes, l.shape, keep(v.memory), l.strides,
                            type_of(v.type), nb::device::cuda::value);
  nb::list shape, strides;
  for (std::size_t k = 0; k < l.axes; ++k) {
    shape.append(l.shape[k]);
    strides.append(l.strides[k] * std::int64_t(size_of(v.type)));
  }
  const bool real = v.type == Scalar::f32 || v.type == Scalar::f64;
  const std::string type = (real ? "<f" : "<u") + std::to_string(size_of(v.type));
  return nb::make_tuple(array, reinterpret_cast<std::uintptr_t>(v.data), nb::tuple(shape), nb::tuple(strides),
                        type);
}

nb::object array_of(HostArray a) {
  const Layout l(a.count(), a.components, a.components * size_of(a.type), a.type);
  const auto type = type_of(a.type);
  auto* bytes = new std::vector<std::byte>(std::move(a.bytes));
  const nb::capsule owner(bytes, [](void* p) noexcept { delete static_cast<std::vector<std::byte>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy>(bytes->data(), l.axes, l.shape, owner, l.strides, type));
}

}  // namespace bedload
