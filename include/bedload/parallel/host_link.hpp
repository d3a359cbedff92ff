#pragma once
// A link between ranks that cannot read one another's memory: processes, of one host or of many.

#include <cstddef>
#include <span>

#include "bedload/parallel/link.hpp"

namespace bedload {

/// Memory that goes to a rank, or is filled by what comes from it.
struct Piece {
  int rank;
  void* data;
  std::size_t bytes;
};

/// Where the link of a rank is one, particles go as pieces of memory; else ranks copy from each other.
class HostLink : public Link {
 public:
  /// Sends `out` and fills `in`, memory of the host. Pieces from one rank to another come in the order in
  /// which they are given; both know their lengths. Throws RankLost.
  virtual void exchange(std::span<const Piece> out, std::span<const Piece> in) = 0;
  /// Whether it also takes memory of the device, by exchange_there; for all ranks the same.
  virtual bool takes_device_memory() const { return false; }
  /// The same with memory of the device, after what is in its queue. done(queue): whether the queue is empty,
  /// or has failed; then it returns.
  virtual void exchange_there(std::span<const Piece>, std::span<const Piece>, void* /*queue*/,
                              int (*)(void* queue) /*done*/) {}
};

}  // namespace bedload
