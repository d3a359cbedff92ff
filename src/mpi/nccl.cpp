#include "src/mpi/nccl.hpp"

#include <dlfcn.h>

#include <type_traits>

namespace bedload {
namespace {

constexpr char kLibrary[] = "libnccl.so.2";
constexpr int kSuccess = 0, kInProgress = 7, kBytes = 1;  // ncclSuccess, ncclInProgress, ncclUint8

/// What this uses of the interface of NCCL 2, which keeps it; a communicator is a pointer, an enumeration an
/// int.
struct Functions {
  int (*version)(int*);
  int (*make_id)(BedloadNcclId*);
  int (*start)(void** communicator, int ranks, BedloadNcclId, int rank);
  int (*end)(void*);
  int (*abort)(void*);
  int (*state)(void*, int* status);
  const char* (*text)(int status);
  int (*begin_group)();
  int (*end_group)();
  int (*send)(const void*, std::size_t count, int type, int rank, void* communicator, void* queue);
  int (*receive)(void*, std::size_t count, int type, int rank, void* communicator, void* queue);
} nccl;

}  // namespace

bool Nccl::open() {
  void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    problem_ = dlerror();
    return false;
  }
  const char* missing = nullptr;
  const auto find = [&](auto& function, const char* name) {
    void* const there = dlsym(library, name);
    if (!there) missing = name;
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(there);
  };
  find(nccl.version, "ncclGetVersion");
  find(nccl.make_id, "ncclGetUniqueId");
  find(nccl.start, "ncclCommInitRank");
  find(nccl.end, "ncclCommDestroy");
  find(nccl.abort, "ncclCommAbort");
  find(nccl.state, "ncclCommGetAsyncError");
  find(nccl.text, "ncclGetErrorString");
  find(nccl.begin_group, "ncclGroupStart");
  find(nccl.end_group, "ncclGroupEnd");
  find(nccl.send, "ncclSend");
  find(nccl.receive, "ncclRecv");
  if (missing) {
    problem_ = std::string(kLibrary) + " has no " + missing + ", which NCCL 2.9 and later have";
    return false;
  }
  if (!good(nccl.version(&version_))) return false;
  if (version_ < 20900) problem_ = std::string(kLibrary) + " is older than NCCL 2.9";
  return version_ >= 20900;
}

bool Nccl::good(int status) {
  if (status == kSuccess || status == kInProgress) return true;
  problem_ = std::string("NCCL: ") + nccl.text(status);
  return false;
}

bool Nccl::make_id(BedloadNcclId& id) { return good(nccl.make_id(&id)); }

bool Nccl::start(const BedloadNcclId& id, int rank, int ranks, void*& communicator,
                 std::string& problem) const {
  const int status = nccl.start(&communicator, ranks, id, rank);
  if (status != kSuccess) problem = std::string("NCCL: ") + nccl.text(status);
  return status == kSuccess;
}

bool Nccl::exchange(std::span<const BedloadMpiPiece> out, std::span<const BedloadMpiPiece> in, void* queue) {
  if (!communicator_) {
    problem_ = "NCCL has been ended";
    return false;
  }
  if (!good(nccl.begin_group())) return false;
  bool all = true;
  for (const BedloadMpiPiece& p : out)
    all = all && good(nccl.send(p.data, p.bytes, kBytes, p.rank, communicator_, queue));
  for (const BedloadMpiPiece& p : in)
    all = all && good(nccl.receive(p.data, p.bytes, kBytes, p.rank, communicator_, queue));
  const int ended = nccl.end_group();
  return all && good(ended);
}

bool Nccl::well() {
  int status = kSuccess;
  return good(nccl.state(communicator_, &status)) && good(status);
}

void Nccl::abort() {
  if (communicator_) nccl.abort(communicator_);
  communicator_ = nullptr;
}

void Nccl::end() {
  if (communicator_) nccl.end(communicator_);
  communicator_ = nullptr;
}

}  // namespace bedload
