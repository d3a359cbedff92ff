#pragma once
// Copies arrays of a store to the host.

#include "bedload/parallel/loops.hpp"
#include "bedload/particles/field.hpp"

namespace bedload::inline BL_VARIANT {

template <class P>
struct PointPass {
  Frame frame;
  Span<const P> x;
  Span<Real3> out;
  BL_HD void operator()(Index i) const { out[i] = Real3(coordinates(frame, x[i])); }
};

struct VelocityPass {
  Span<const Real4> v_rho;
  Span<Real3> out;
  BL_HD void operator()(Index i) const { out[i] = v_rho[i].xyz(); }
};

template <class T>
HostArray array_of(const char* name, const char* unit, const Buffer<T>& buffer) {
  HostArray a{name, unit, FileType<T>::scalar, FileType<T>::components, {}};
  a.bytes.resize(buffer.size() * sizeof(T));
  copy_to_host(a.bytes.data(), buffer.data(), a.bytes.size());
  return a;
}

template <class T>
HostArray renamed(const Field<T>& field, const char* name) {
  HostArray a = field.to_host();
  a.name = name;
  return a;
}

template <class T, class Pass, class... Args>
HostArray made(const char* name, const char* unit, Range range, Args... args) {
  Buffer<T> out(range.size());
  for_each(range, Pass{args..., out.span()});
  return array_of(name, unit, out);
}

}  // namespace bedload::inline BL_VARIANT
