#include "bedload/neighbours/verlet_list.hpp"

namespace BL_SOLVER {
namespace {

/// Slots of each slice.
struct SliceSlotsPass {
  Span<const std::uint32_t> count;
  unsigned bits, row_bits;
  std::uint64_t* slots;
  BL_HD void operator()(Index slice) const {
    std::uint32_t longest = 0;
    const Index begin = slice << row_bits, end = min_of(count.size, begin + (1u << row_bits));
    for (Index i = begin; i < end; ++i) longest = max_of(longest, count[i]);
    slots[slice] = ((longest + (1u << bits) - 1) >> bits) * VerletListView::kTurn;
  }
};

}  // namespace

void VerletList::make_rows(const Buffer<std::uint32_t>& lengths, unsigned bits) {
  bits_ = bits;
  count_.resize(lengths.size());
  copy_on_device(count_.data(), lengths.data(), lengths.size() * sizeof(std::uint32_t));
  taken_.resize(slices());
  for_each({0, Index(slices())}, SliceSlotsPass{count_, bits, view().row_bits(), taken_.data()});
  slots_ = exclusive_scan(taken_, offset_);
  if (entry_.size() < slots_ + kBeyond) make_room(slots_);
}

}  // namespace BL_SOLVER
