#include "bedload/particles/field.hpp"

#include "bedload/parallel/loops.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace BL_SOLVER {
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
void Field<T>::gather(Span<const Index> order, FieldBase* by) {
  auto* const lender = dynamic_cast<Field<T>*>(by);
  Buffer<T>& room = lender ? lender->data_ : Context::current().scratch<T>();
  room.reserve_and_resize(order.size);
  for_each({0, order.size}, GatherPass<T>{data_, order, room});
  data_.swap(room);
}

template void Field<std::uint32_t>::gather(Span<const Index>, FieldBase*);
template void Field<float>::gather(Span<const Index>, FieldBase*);
template void Field<Vec3<float>>::gather(Span<const Index>, FieldBase*);
template void Field<Vec4<float>>::gather(Span<const Index>, FieldBase*);
template void Field<double>::gather(Span<const Index>, FieldBase*);
template void Field<Vec3<double>>::gather(Span<const Index>, FieldBase*);
template void Field<Vec4<double>>::gather(Span<const Index>, FieldBase*);
template void Field<VelocityDensity<>>::gather(Span<const Index>, FieldBase*);
template void Field<EosState<>>::gather(Span<const Index>, FieldBase*);
template void Field<WallState<>>::gather(Span<const Index>, FieldBase*);
template void Field<NoSlip<>>::gather(Span<const Index>, FieldBase*);
template void Field<PackedPosition>::gather(Span<const Index>, FieldBase*);
template void Field<PairPosition>::gather(Span<const Index>, FieldBase*);
template void Field<WallMemory>::gather(Span<const Index>, FieldBase*);

}  // namespace BL_SOLVER
