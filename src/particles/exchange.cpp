#include "bedload/particles/exchange.hpp"

#include "bedload/parallel/rank_record.hpp"

namespace BL_SOLVER {
namespace {

/// Fields follow one another in an outbox, each from a multiple of so many bytes on.
constexpr std::size_t kAlign = 64;

std::size_t bytes_of(const FieldBase& field, Index entries) {
  return (entries * field.entry_bytes() + kAlign - 1) / kAlign * kAlign;
}

}  // namespace

void Exchange::plan(const std::vector<Index>& of_rank, Span<const Index> places) {
  const Context& context = Context::current();
  ranks_ = context.ranks();
  begin_.assign(std::size_t(ranks_) * (ranks_ + 1), 0);
  context.link()->all_gather(of_rank.data(), begin_.data(), of_rank.size() * sizeof(Index));
  incoming_ = 0;
  for (int r = 0; r < ranks_; ++r) incoming_ += of(r, context.rank() + 1) - of(r, context.rank());
  places_.reserve_and_resize(places.size);
  copy_on_device(places_.data(), places.data, places.size * sizeof(Index));
}

void Exchange::run(const std::vector<FieldBase*>& fields, Index first) {
  const Context& context = Context::current();
  Buffer<std::byte>& outbox = outbox_[turn_];
  turn_ = 1 - turn_;
  const auto outgoing = [&](int rank) { return of(rank, ranks_); };
  std::size_t bytes = 0;
  for (const FieldBase* field : fields) bytes += bytes_of(*field, outgoing(context.rank()));
  outbox.reserve_and_resize(bytes);
  ++rank_record().exchanges;
  rank_record().sent += double(bytes);
  std::byte* to = outbox.data();
  for (const FieldBase* field : fields) {
    field->collect(places_, to);
    to += bytes_of(*field, outgoing(context.rank()));
  }
  context.wait();
  const std::vector<std::byte*> outboxes = all_gather(outbox.data());
  for (int r = 0; r < ranks_; ++r) {
    const Index begin = of(r, context.rank()), count = of(r, context.rank() + 1) - begin;
    if (count == 0) continue;
    const std::byte* from = outboxes[std::size_t(r)];
    for (FieldBase* field : fields) {
      const std::size_t each = field->entry_bytes();
      copy_on_device(field->entry(first), from + begin * each, count * each);
      from += bytes_of(*field, outgoing(r));
    }
    first += count;
  }
}

}  // namespace BL_SOLVER
