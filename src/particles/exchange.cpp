#include "bedload/particles/exchange.hpp"

#include "bedload/core/host_memory.hpp"
#include "bedload/parallel/host_link.hpp"
#include "bedload/parallel/rank_record.hpp"

namespace BL_SOLVER {
namespace {

/// Fields follow one another in an outbox, each from a multiple of so many bytes on.
constexpr std::size_t kAlign = 64;

std::size_t bytes_of(const FieldBase& field, Index entries) {
  return (entries * field.entry_bytes() + kAlign - 1) / kAlign * kAlign;
}

#if BL_CUDA
/// Memory of the host for what goes to other processes (0) and comes from them (1), kept from one exchange to
/// the next; page-locked.
std::byte* host_memory(int which, std::size_t bytes) {
  static thread_local std::array<HostBytes, 2> kept;
  HostBytes& memory = kept[std::size_t(which)];
  if (memory.size() < bytes) memory.clear(), memory.resize(bytes + bytes / 8);
  return memory.data();
}
#endif

/// Sends `out` and fills `in`, memory of the device, directly.
void exchange_there(HostLink& link, const std::vector<Piece>& out, const std::vector<Piece>& in) {
#if BL_CUDA
  const Context& context = Context::current();
  link.exchange_there(out, in, context.stream(), [](void* queue) {
    const bool busy = cudaStreamQuery(static_cast<cudaStream_t>(queue)) == cudaErrorNotReady;
    if (busy) (void)cudaGetLastError();
    return int(!busy);
  });
  context.wait();  // says what has failed
#else
  link.exchange_there(out, in, nullptr, [](void*) { return 1; });
#endif
}

/// The same by way of the host; `out`: pieces of an outbox of that length.
void exchange(HostLink& link, [[maybe_unused]] const Buffer<std::byte>& outbox, std::vector<Piece>& out,
              std::vector<Piece>& in) {
#if BL_CUDA
  std::size_t bytes = 0;
  std::byte* const sent = host_memory(0, outbox.size());
  copy_to_host(sent, outbox.data(), outbox.size());
  for (Piece& piece : out) piece.data = sent + (static_cast<std::byte*>(piece.data) - outbox.data());
  for (const Piece& piece : in) bytes += piece.bytes;
  std::byte* at = host_memory(1, bytes);
  std::vector<Piece> there = in;
  for (Piece& piece : there) piece.data = at, at += piece.bytes;
  link.exchange(out, there);
  for (std::size_t k = 0; k < in.size(); ++k) copy_on_device(in[k].data, there[k].data, in[k].bytes);
#else
  link.exchange(out, in);
#endif
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
  if (auto* const link = dynamic_cast<HostLink*>(context.link())) {
    const int own = context.rank();
    std::vector<Piece> out, in;
    const auto add = [](std::vector<Piece>& pieces, int rank, const FieldBase& field, void* data,
                        Index count) {
      if (count > 0) pieces.push_back({rank, data, count * field.entry_bytes()});
    };
    to = outbox.data();
    for (const FieldBase* field : fields) {
      for (int r = 0; r < ranks_; ++r)
        add(out, r, *field, to + of(own, r) * field->entry_bytes(), of(own, r + 1) - of(own, r));
      to += bytes_of(*field, outgoing(own));
    }
    for (int r = 0; r < ranks_; ++r) {
      const Index count = of(r, own + 1) - of(r, own);
      for (FieldBase* field : fields) add(in, r, *field, field->entry(first), count);
      first += count;
    }
    if (link->takes_device_memory()) return exchange_there(*link, out, in);
    context.wait();
    return exchange(*link, outbox, out, in);
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
