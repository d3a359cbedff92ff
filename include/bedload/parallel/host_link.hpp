#pragma once
// A link between ranks that cannot read one another's memory: processes, of one host or of many.

#include <cstddef>
#include <span>

#include "bedload/parallel/link.hpp"

namespace bedload {

/// Host memory that goes to a rank, or is filled by what comes from it.
struct Piece {
  int rank;
  void* data;
  std::size_t bytes;
};

/// Where the link of a rank is one, particles go as pieces of host memory; else ranks copy from each other.
class HostLink : public Link {
 public:
  /// Sends `out` and fills `in`. Pieces from one rank to another come in the order in which they are given;
  /// both know their lengths. Throws RankLost.
  virtual void exchange(std::span<const Piece> out, std::span<const Piece> in) = 0;
};

}  // namespace bedload
