#pragma once
// What the plug-in for MPI (src/mpi/plugin.cpp) offers the program, which loads it only for --mpi. Plain C,
// so that neither C++ types nor exceptions go from one to the other.

#include <cstddef>

namespace bedload {

extern "C" {

/// As Piece of host_link.hpp.
struct BedloadMpiPiece {
  int rank;
  void* data;
  std::size_t bytes;
};

/// As ncclUniqueId.
struct BedloadNcclId {
  char bytes[128];
};

/// Messages of one channel do not meet those of another.
enum BedloadMpiChannel { kMpiData, kMpiControl, kMpiAlarm, kMpiChannels };

enum BedloadMpiResult {
  kMpiDone,
  kMpiFailed,   ///< error() says why
  kMpiLate,     ///< the time is over; late() is the rank for which this one waits
  kMpiAlarmed,  ///< in the data channel of process 0: another process has sent something by the alarm channel
};

struct BedloadMpi {
  int version;  ///< kMpiTable of the program that it was built with
  /// Number of this process, of all, and the same among those of its host.
  BedloadMpiResult (*begin)(int* rank, int* size, int* rank_here, int* size_here);
  /// limit: s, for all waits; 0: none.
  BedloadMpiResult (*all_gather)(const void* own, void* all, std::size_t bytes, double limit);
  BedloadMpiResult (*exchange)(BedloadMpiChannel, const BedloadMpiPiece* out, std::size_t n_out,
                               const BedloadMpiPiece* in, std::size_t n_in, double limit);
  // --- NCCL, for memory of GPUs, where there is one ---
  BedloadMpiResult (*find_nccl)(int* version);
  BedloadMpiResult (*make_nccl_id)(BedloadNcclId*);
  /// By all, each with the GPU that `bind` gives to the thread that calls it.
  BedloadMpiResult (*start_nccl)(const BedloadNcclId*, void (*bind)(int gpu), int gpu, double limit);
  /// Where not all have started it.
  void (*drop_nccl)();
  /// As exchange, of memory of the GPU, after what is in its queue; done(queue): whether the queue is empty.
  BedloadMpiResult (*exchange_there)(const BedloadMpiPiece* out, std::size_t n_out, const BedloadMpiPiece* in,
                                     std::size_t n_in, void* queue, int (*done)(void* queue), double limit);

  int (*late)();  ///< -1: unknown
  const char* (*error)();
  void (*end)();            ///< by all
  void (*abort)(int code);  ///< ends all processes
};

/// The one function of the plug-in.
const BedloadMpi* bedload_mpi();
}

inline constexpr int kMpiTable = 2;

}  // namespace bedload
