#pragma once
// How ranks talk to one another. A rank is a host thread with a device of its own, or a part of the processor;
// several of them run one simulation, each with a part of its particles. All take the same steps in the same
// order, so a call of one is a call of all.

#include <cstddef>
#include <stdexcept>

namespace bedload {

/// Another rank has failed or does not respond; what the others were doing is given up.
struct RankLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Link {
 public:
  virtual ~Link() = default;
  virtual int rank() const = 0;  ///< 0 .. size() - 1
  virtual int size() const = 0;
  /// `all` gets `bytes` bytes of every rank, in the order of ranks. Returns when all ranks have called it.
  /// Throws RankLost.
  virtual void all_gather(const void* own, void* all, std::size_t bytes) = 0;
};

}  // namespace bedload
