#pragma once
// NCCL, which copies between GPUs of several processes; found at run time.

#include <cstddef>
#include <span>
#include <string>

#include "src/team/mpi_table.hpp"

namespace bedload {

/// One communicator of all processes. Where a call returns false, problem() says why.
class Nccl {
 public:
  /// Finds the library and all that is needed of it.
  bool open();
  int version() const { return version_; }  ///< 22703 is 2.27.3
  /// What all need to start(); asked for by one.
  bool make_id(BedloadNcclId& id);
  /// By all, each with another GPU, the one of the calling thread. Waits for all. The communicator is kept by
  /// take(), as the thread may be one for which nobody waits any more.
  bool start(const BedloadNcclId& id, int rank, int ranks, void*& communicator, std::string& problem) const;
  void take(void* communicator) { communicator_ = communicator; }
  /// Queues sends and receives of memory of the GPU.
  bool exchange(std::span<const BedloadMpiPiece> out, std::span<const BedloadMpiPiece> in, void* queue);
  /// Whether what has been queued goes well so far.
  bool well();
  /// Ends what is queued, though others do not come.
  void abort();
  /// By all.
  void end();
  const std::string& problem() const { return problem_; }

 private:
  bool good(int status);

  void* communicator_ = nullptr;
  int version_ = 0;
  std::string problem_;
};

}  // namespace bedload
