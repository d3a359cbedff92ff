#include "bedload/particles/field.hpp"

#include "bedload/parallel/loops.hpp"
#include "kernels/contact/film_energy.hpp"

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

template <class T>
void Field<T>::collect(Span<const Index> places, void* to) const {
  for_each({0, places.size}, GatherPass<T>{data_, places, {static_cast<T*>(to), places.size}});
}

#define BL_FIELD(...)                                                      \
  template void Field<__VA_ARGS__>::gather(Span<const Index>, FieldBase*); \
  template void Field<__VA_ARGS__>::collect(Span<const Index>, void*) const;
BL_FIELD(std::uint32_t)
BL_FIELD(float)
BL_FIELD(Vec3<float>)
BL_FIELD(Vec4<float>)
BL_FIELD(double)
BL_FIELD(Vec3<double>)
BL_FIELD(Vec4<double>)
BL_FIELD(VelocityDensity<>)
BL_FIELD(EosState<>)
BL_FIELD(WallState<>)
BL_FIELD(NoSlip<>)
BL_FIELD(PackedPosition)
BL_FIELD(PairPosition)
BL_FIELD(WallMemory)
BL_FIELD(ContactHistory)
BL_FIELD(OpenContact)
BL_FIELD(WallLosses)
BL_FIELD(WallPeaks)
BL_FIELD(FilmAction)
#undef BL_FIELD

}  // namespace BL_SOLVER
