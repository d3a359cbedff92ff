#pragma once
// The processes of an MPI job, each a rank, of which this is one.

#include <array>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bedload/host_data.hpp"
#include "bedload/parallel/host_link.hpp"
#include "src/team/mpi_table.hpp"

namespace bedload {

/// As HostLink::exchange_there; false: something has failed.
using ExchangeThere =
    std::function<bool(std::span<const Piece>, std::span<const Piece>, void* queue, int (*done)(void*))>;

/// The GPU of a process.
struct OwnGpu {
  int number = -1;                  ///< -1: it computes on the CPU
  std::array<char, 16> id{};        ///< no other GPU has it
  void (*bind)(int gpu) = nullptr;  ///< gives it to the thread that calls
  /// Sends to the next rank, receives from the one before; whether that came as it was sent.
  bool (*try_out)(const ExchangeThere&, int rank, int ranks) = nullptr;
};

/// How values go from GPU to GPU.
enum class GpuData : int { automatic, nccl, host };

/// Process 0 tells the others what to do; all do it, by link() to one another; the others answer.
class Processes {
 public:
  /// Loads the plug-in and joins the others. Throws DeviceError where there is none, or no MPI.
  static Processes& join();
  /// Of which this is one; null: it has not joined any.
  static Processes* joined();
  /// At the end of the program: sends the others the end, or ends them where they do not listen. `code`: exit
  /// code of this one.
  static void leave(int code);

  int rank() const { return rank_; }
  int size() const { return size_; }
  int rank_here() const { return rank_here_; }  ///< among those of this host
  int size_here() const { return size_here_; }
  HostLink& link() { return *link_; }
  /// By all: link() also takes memory of GPUs, unless `wanted` is host or something is in the way, which
  /// gpu_data() then says. Throws DeviceError where `wanted` is nccl.
  void connect(const OwnGpu& gpu, GpuData wanted);
  /// "NCCL 2.27.3", or "host memory, as ...".
  const std::string& gpu_data() const { return gpu_data_; }

  // --- of process 0 ---

  /// An empty command ends them. Throws DeviceError if one has been lost before.
  void tell(const HostBytes& command);
  /// What the others answer to the last command, or first to the call of the program. Throws `own`, what this
  /// one has thrown, or what another has, the lowest that did not only lose one. limit: s that they may take
  /// longer; 0: any.
  std::vector<HostBytes> hear(const std::exception_ptr& own, double limit = kTimeout);

  // --- of the others ---

  /// The next command. Throws DeviceError if there is none for long after another process was lost.
  HostBytes next();
  void answer(const HostBytes& result);
  void answer(const std::exception_ptr& error);

  static constexpr double kTimeout = 60;  ///< s that a process waits for another

 private:
  class OwnLink;
  struct Head;
  explicit Processes(const BedloadMpi& mpi);
  /// Throws RankLost unless all went well.
  void check(BedloadMpiResult result, double limit);
  /// Why NCCL cannot be used; empty: all have started it.
  std::string start_nccl(const OwnGpu& gpu);
  void send(const std::vector<int>& ranks, const HostBytes& bytes, bool is_error);
  HostBytes receive(int rank, double limit);

  const BedloadMpi& mpi_;
  int rank_ = 0, size_ = 1, rank_here_ = 0, size_here_ = 1;
  bool nccl_ = false;  ///< is used
  std::string gpu_data_;
  std::string lost_;     ///< how one was lost; empty: none
  bool unheard_ = true;  ///< answers are still to come
  bool ended_ = false;   ///< by process 0
  std::unique_ptr<HostLink> link_;
};

}  // namespace bedload
