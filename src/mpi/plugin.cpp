// libbedload_mpi.so: the only file that knows MPI. NCCL: nccl.hpp.

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "src/mpi/nccl.hpp"
#include "src/team/mpi_table.hpp"

namespace bedload {
namespace {

constexpr std::size_t kMost = std::size_t(1) << 30;  ///< bytes of a message, whose length is an int
constexpr double kGrace = 1;                         ///< s, for what is going on as another process fails

MPI_Comm channels[kMpiChannels];
int own_rank = 0, ranks = 1, late_rank = -1;
std::string problem;
Nccl nccl;

bool failed(int status) {
  if (status == MPI_SUCCESS) return false;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(status, text, &length);
  problem.assign(text, std::size_t(length));
  return true;
}

constexpr int kShort = 1000;  ///< turns of most waits

/// Until test(turns, done) says that it is done; it returns false if something has failed.
template <class F>
BedloadMpiResult wait_until(const F& test, bool heeds_alarms, double limit) {
  using Clock = std::chrono::steady_clock;
  late_rank = -1;
  const auto began = Clock::now();
  auto alarmed = Clock::time_point::max();
  for (int turns = 0;; ++turns) {
    int done = 0;
    if (!test(turns, done)) return kMpiFailed;
    if (done) return kMpiDone;
    if (turns < kShort) continue;
    const auto now = Clock::now();
    const double waited = std::chrono::duration<double>(now - began).count();
    if (heeds_alarms && alarmed == Clock::time_point::max()) {
      int there = 0;
      if (failed(MPI_Iprobe(MPI_ANY_SOURCE, 0, channels[kMpiAlarm], &there, MPI_STATUS_IGNORE)))
        return kMpiFailed;
      if (there) alarmed = now;
    }
    if (now > alarmed && std::chrono::duration<double>(now - alarmed).count() > kGrace) return kMpiAlarmed;
    if (limit > 0 && waited > limit) return kMpiLate;
    waited < 1e-2 ? std::this_thread::yield() : std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

/// Waits for the requests. The first receive, `from` these ranks, and are given up where not all end.
BedloadMpiResult wait(std::vector<MPI_Request>& requests, const std::vector<int>& from, bool heeds_alarms,
                      double limit) {
  const BedloadMpiResult result = wait_until(
      [&](int, int& done) {
        return !failed(MPI_Testall(int(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE));
      },
      heeds_alarms, limit);
  if (result == kMpiDone || result == kMpiFailed) return result;
  for (std::size_t k = 0; k < from.size(); ++k) {
    int done = 0;
    MPI_Test(&requests[k], &done, MPI_STATUS_IGNORE);
    if (done) continue;
    if (late_rank < 0) late_rank = from[k];
    MPI_Cancel(&requests[k]);
    MPI_Wait(&requests[k], MPI_STATUS_IGNORE);
  }
  return result;
}

BedloadMpiResult begin(int* rank, int* size, int* rank_here, int* size_here) {
  int level = 0;
  MPI_Comm here;
  if (failed(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level))) return kMpiFailed;
  if (level < MPI_THREAD_SERIALIZED) {
    problem = "this MPI allows no threads";
    return kMpiFailed;
  }
  for (MPI_Comm& channel : channels) {
    if (failed(MPI_Comm_dup(MPI_COMM_WORLD, &channel))) return kMpiFailed;
    MPI_Comm_set_errhandler(channel, MPI_ERRORS_RETURN);
  }
  MPI_Comm_rank(channels[kMpiData], &own_rank);
  MPI_Comm_size(channels[kMpiData], &ranks);
  if (failed(MPI_Comm_split_type(channels[kMpiData], MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here)))
    return kMpiFailed;
  MPI_Comm_rank(here, rank_here);
  MPI_Comm_size(here, size_here);
  MPI_Comm_free(&here);
  *rank = own_rank, *size = ranks;
  return kMpiDone;
}

BedloadMpiResult all_gather(const void* own, void* all, std::size_t bytes, double limit) {
  if (bytes > kMost) {
    problem = "more than 1 GiB to gather";
    return kMpiFailed;
  }
  // never freed, as MPI may still use them, where not all ranks come
  static std::vector<char> from, to;
  from.assign(static_cast<const char*>(own), static_cast<const char*>(own) + bytes);
  to.resize(bytes * std::size_t(ranks));
  std::vector<MPI_Request> requests(1);
  if (failed(MPI_Iallgather(from.data(), int(bytes), MPI_BYTE, to.data(), int(bytes), MPI_BYTE,
                            channels[kMpiData], requests.data())))
    return kMpiFailed;
  const BedloadMpiResult result = wait(requests, {}, own_rank == 0, limit);
  if (result == kMpiDone && bytes > 0) std::memcpy(all, to.data(), to.size());
  return result;
}

BedloadMpiResult exchange(BedloadMpiChannel channel, const BedloadMpiPiece* out, std::size_t n_out,
                          const BedloadMpiPiece* in, std::size_t n_in, double limit) {
  std::vector<MPI_Request> requests;
  std::vector<int> from;
  const MPI_Comm with = channels[channel];
  bool good = true;
  const auto each_part = [&](const BedloadMpiPiece& piece, const auto& start) {
    std::size_t at = 0;
    do {
      const std::size_t part = std::min(piece.bytes - at, kMost);
      MPI_Request request = MPI_REQUEST_NULL;
      good = good && !failed(start(static_cast<char*>(piece.data) + at, int(part), piece.rank, &request));
      requests.push_back(request);
      at += part;
    } while (at < piece.bytes);
  };
  for (std::size_t k = 0; k < n_in; ++k)
    each_part(in[k], [&](void* data, int bytes, int rank, MPI_Request* request) {
      from.push_back(rank);
      return MPI_Irecv(data, bytes, MPI_BYTE, rank, 0, with, request);
    });
  for (std::size_t k = 0; k < n_out; ++k)
    each_part(out[k], [&](const void* data, int bytes, int rank, MPI_Request* request) {
      return MPI_Isend(data, bytes, MPI_BYTE, rank, 0, with, request);
    });
  if (!good) return kMpiFailed;
  return wait(requests, from, channel == kMpiData && own_rank == 0, limit);
}

BedloadMpiResult of_nccl(bool good) {
  if (!good) problem = nccl.problem();
  return good ? kMpiDone : kMpiFailed;
}

BedloadMpiResult find_nccl(int* version) {
  const BedloadMpiResult result = of_nccl(nccl.open());
  *version = nccl.version();
  return result;
}

/// By a thread of its own, which is left behind where others do not come.
BedloadMpiResult start_nccl(const BedloadNcclId* id, void (*bind)(int gpu), int gpu, double limit) {
  struct Start {
    std::atomic<bool> done{false};
    bool good = false;
    void* communicator = nullptr;
    std::string problem;
  };
  const auto start = std::make_shared<Start>();
  std::thread([start, bind, gpu, id = *id, rank = own_rank, size = ranks] {
    bind(gpu);
    start->good = nccl.start(id, rank, size, start->communicator, start->problem);
    start->done = true;
  }).detach();
  const BedloadMpiResult result = wait_until(
      [&](int, int& done) {
        done = start->done;
        return true;
      },
      own_rank == 0, limit);
  if (result != kMpiDone) return result;
  if (!start->good) {
    problem = start->problem;
    return kMpiFailed;
  }
  nccl.take(start->communicator);
  return kMpiDone;
}

BedloadMpiResult exchange_there(const BedloadMpiPiece* out, std::size_t n_out, const BedloadMpiPiece* in,
                                std::size_t n_in, void* queue, int (*done)(void*), double limit) {
  if (n_out + n_in == 0) return kMpiDone;
  BedloadMpiResult result = of_nccl(nccl.exchange({out, n_out}, {in, n_in}, queue));
  if (result == kMpiDone)
    result = wait_until(
        [&](int turns, int& ended) {
          ended = done(queue);
          return ended || turns < kShort || of_nccl(nccl.well()) == kMpiDone;
        },
        own_rank == 0, limit);
  if (result != kMpiDone) nccl.abort();  // else the GPU waits on
  return result;
}

void end() {
  nccl.end();
  for (MPI_Comm& channel : channels) MPI_Comm_free(&channel);
  MPI_Finalize();
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const BedloadMpi* bedload_mpi() {
  static const BedloadMpi table{kMpiTable,
                                begin,
                                all_gather,
                                exchange,
                                find_nccl,
                                [](BedloadNcclId* id) { return of_nccl(nccl.make_id(*id)); },
                                start_nccl,
                                [] { nccl.abort(); },
                                exchange_there,
                                [] { return late_rank; },
                                [] { return problem.c_str(); },
                                end,
                                [](int code) { MPI_Abort(MPI_COMM_WORLD, code); }};
  return &table;
}

}  // namespace bedload
