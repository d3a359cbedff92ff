#include "bedload/particles/field.hpp"

#include "bedload/parallel/loops.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

template <class T>
struct GatherPass {
  Span<const T> from;
  Span<const Index> order;
  Span<T> to;
  BL_HD void operator()(Index i) const { to[i] = from[order[i]]; }
};

}  // namespace

template <class T>
void Field<T>::gather(Span<const Index> order) {
  static Buffer<T> spare;  // one a type: a gather swaps it with the field
  spare.reserve_and_resize(order.size);
  for_each({0, order.size}, GatherPass<T>{data_, order, spare});
  data_.swap(spare);
}

template void Field<std::uint32_t>::gather(Span<const Index>);
template void Field<float>::gather(Span<const Index>);
template void Field<Vec3<float>>::gather(Span<const Index>);
template void Field<Vec4<float>>::gather(Span<const Index>);
template void Field<double>::gather(Span<const Index>);
template void Field<Vec3<double>>::gather(Span<const Index>);
template void Field<Vec4<double>>::gather(Span<const Index>);
template void Field<PackedPosition>::gather(Span<const Index>);
template void Field<PairPosition>::gather(Span<const Index>);
template void Field<WallMemory>::gather(Span<const Index>);

}  // namespace bedload::inline BL_VARIANT
