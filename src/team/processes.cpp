#include "src/team/processes.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <initializer_list>
#include <numeric>

#include "bedload/core/error.hpp"
#include "bedload/parallel/rank_record.hpp"
#include "src/team/packed.hpp"

namespace bedload {
namespace {

constexpr char kPlugin[] = "libbedload_mpi.so";
constexpr double kGrace = 5;  ///< s, for those that wait for one that has failed

Processes* the_joined = nullptr;

const BedloadMpi& load() {
  // its symbols are also for what MPI itself loads
  void* const library = dlopen(kPlugin, RTLD_NOW | RTLD_GLOBAL);
  if (!library)
    throw DeviceError(
        fmt::format("--mpi: {}; the plug-in is built where CMake finds MPI and lies in lib/ beside "
                    "the program",
                    dlerror()));
  const auto table = reinterpret_cast<decltype(&bedload_mpi)>(dlsym(library, "bedload_mpi"));
  if (!table || table()->version != kMpiTable)
    throw DeviceError(fmt::format("--mpi: {} is of another version of Bedload", kPlugin));
  return *table();
}

/// Processes that were started together according to who started them; 0: unknown.
int started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (const char* text = std::getenv(name)) return std::atoi(text);
  return 0;
}

std::vector<BedloadMpiPiece> pieces(std::span<const Piece> of) {
  std::vector<BedloadMpiPiece> to;
  for (const Piece& p : of) to.push_back({p.rank, p.data, p.bytes});
  return to;
}

/// What an error is in an answer.
enum class Kind : int { fault, key, input, file, device, lost, other };

HostBytes packed_error(const std::exception_ptr& error) {
  const auto all = [](Kind kind, const std::string& text, const std::string& key = "") {
    return packed(kind, text, key);
  };
  try {
    std::rethrow_exception(error);
  } catch (const SimulationFault& e) {
    return all(Kind::fault, e.what());
  } catch (const KeyError& e) {
    return all(Kind::key, e.what(), e.key);
  } catch (const CaseError& e) {
    return all(Kind::input, e.what());
  } catch (const FileError& e) {
    return all(Kind::file, e.what());
  } catch (const DeviceError& e) {
    return all(Kind::device, e.what());
  } catch (const RankLost& e) {
    return all(Kind::lost, e.what());
  } catch (const std::bad_alloc&) {
    return all(Kind::device, "out of memory; run `bedload check` for the memory estimate");
  } catch (const std::exception& e) {
    return all(Kind::other, e.what());
  }
}

[[noreturn]] void throw_packed(const HostBytes& bytes, int rank) {
  Unpacker of(bytes);
  const Kind kind = of.next<Kind>();
  const auto text = of.next<std::string>(), key = of.next<std::string>();
  switch (kind) {
    case Kind::fault:
      throw SimulationFault(text);
    case Kind::key:
      throw KeyError(key, text);
    case Kind::input:
      throw CaseError(text);
    case Kind::file:
      throw FileError(text);
    case Kind::lost:
      throw RankLost(text);
    case Kind::device:
    case Kind::other:
      break;
  }
  throw DeviceError(fmt::format("process {}: {}", rank, text));
}

bool is_lost(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const RankLost&) {
    return true;
  } catch (...) {
    return false;
  }
}

}  // namespace

class Processes::OwnLink final : public HostLink {
 public:
  explicit OwnLink(Processes& all) : all_(all) {}
  int rank() const override { return all_.rank_; }
  int size() const override { return all_.size_; }
  void all_gather(const void* own, void* all, std::size_t bytes) override {
    waiting([&] { return all_.mpi_.all_gather(own, all, bytes, kTimeout); });
  }
  void exchange(std::span<const Piece> out, std::span<const Piece> in) override {
    const auto from = pieces(out), to = pieces(in);
    waiting([&] {
      return all_.mpi_.exchange(kMpiData, from.data(), from.size(), to.data(), to.size(), kTimeout);
    });
  }
  bool takes_device_memory() const override { return all_.nccl_; }
  void exchange_there(std::span<const Piece> out, std::span<const Piece> in, void* queue,
                      int (*done)(void*)) override {
    const auto from = pieces(out), to = pieces(in);
    const BedloadMpiResult result =
        all_.mpi_.exchange_there(from.data(), from.size(), to.data(), to.size(), queue, done, kTimeout);
    if (result == kMpiFailed)
      throw RankLost(all_.lost_ = fmt::format("{}; --mpi-data host does without NCCL", all_.mpi_.error()));
    all_.check(result, kTimeout);
  }

 private:
  template <class F>
  void waiting(const F& call) {
    const auto from = std::chrono::steady_clock::now();
    const BedloadMpiResult result = call();
    rank_record().waited += std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
    all_.check(result, kTimeout);
  }
  Processes& all_;
};

/// Before each command or answer.
struct Processes::Head {
  std::size_t bytes;
  bool is_error;
};

Processes& Processes::join() {
  static Processes all(load());
  the_joined = &all;
  return all;
}

Processes* Processes::joined() { return the_joined; }

Processes::Processes(const BedloadMpi& mpi) : mpi_(mpi), link_(std::make_unique<OwnLink>(*this)) {
  if (mpi_.begin(&rank_, &size_, &rank_here_, &size_here_) != kMpiDone)
    throw DeviceError(fmt::format("--mpi: {}", mpi_.error()));
  if (size_ == 1 && started() > 1)
    throw DeviceError(fmt::format(
        "--mpi: {} processes were started, of which MPI knows one; start them with the mpirun or srun "
        "of the MPI that {} was built with",
        started(), kPlugin));
}

void Processes::leave(int code) {
  if (!the_joined) return;
  Processes& all = *the_joined;
  if (all.rank_ == 0) {
    try {
      if (all.unheard_ && all.lost_.empty()) all.hear(nullptr, 0);
    } catch (const std::runtime_error&) {  // this one has said why it ends
    }
    try {
      all.tell({});
    } catch (const std::runtime_error&) {
      return all.mpi_.abort(code);
    }
  } else if (!all.ended_) {
    return all.mpi_.abort(code);
  }
  all.mpi_.end();
}

void Processes::check(BedloadMpiResult result, double limit) {
  if (result == kMpiDone) return;
  lost_ = "another process has failed";
  if (result == kMpiFailed) lost_ = fmt::format("MPI: {}", mpi_.error());
  if (result == kMpiLate) {
    const RankRecord& record = rank_record();
    const char* const stage = record.stage;
    lost_ = (mpi_.late() < 0 ? "another process" : fmt::format("process {}", mpi_.late())) +
            fmt::format(" has not responded for {:.3g} s", limit) +
            (stage ? fmt::format(", in {} of step {}", stage, record.steps + 1) : "");
  }
  throw RankLost(lost_);
}

void Processes::connect(const OwnGpu& gpu, GpuData wanted) {
  if (size_ == 1) return;
  std::string why = "--mpi-data says";
  if (wanted != GpuData::host) why = start_nccl(gpu);
  nccl_ = why.empty();
  if (!nccl_ && wanted == GpuData::nccl) throw DeviceError("--mpi-data nccl: " + why);
  if (!nccl_) gpu_data_ = "host memory, as " + why;
}

std::string Processes::start_nccl(const OwnGpu& gpu) {
  struct Own {
    bool on_gpu, late;
    std::array<char, 16> id;
    int version;
    std::array<char, 256> problem;  ///< with it, empty: none
  } own{.on_gpu = gpu.number >= 0, .late = false, .id = gpu.id, .version = 0, .problem = {}};
  std::vector<Own> all(std::size_t(size_), own);
  const auto note = [&](const std::string& text) {
    own.problem = {};
    text.copy(own.problem.data(), own.problem.size() - 1);
  };
  const auto result_of = [&](BedloadMpiResult result) {
    own.late = result == kMpiLate || result == kMpiAlarmed;
    note(result == kMpiDone ? "" : result == kMpiFailed ? mpi_.error() : "NCCL waits for another process");
    return result == kMpiDone;
  };
  const auto first = [&](const auto& each) -> std::string {
    for (int r = 0; r < size_; ++r)
      if (const std::string why = each(all[std::size_t(r)]); !why.empty())
        return fmt::format("process {}{}", r, why);
    return "";
  };
  const auto gather = [&] { link_->all_gather(&own, all.data(), sizeof own); };
  /// Of one that waits only where no other has any.
  const auto gather_problems = [&] {
    gather();
    const auto problem = [](const Own& of) {
      return of.problem[0] ? ": " + std::string(of.problem.data()) : "";
    };
    const std::string why = first([&](const Own& of) { return of.late ? "" : problem(of); });
    return why.empty() ? first(problem) : why;
  };

  if (own.on_gpu) result_of(mpi_.find_nccl(&own.version));
  gather();
  std::string why = first([](const Own& of) { return of.on_gpu ? "" : " computes on the CPU"; });
  if (why.empty()) why = gather_problems();
  if (why.empty())
    why = first([&](const Own& of) {
      return std::ranges::count(all, of.id, &Own::id) > 1 ? " shares its GPU with another"
             : of.version != all[0].version               ? " has another version of NCCL than process 0"
                                                          : "";
    });
  if (!why.empty()) return why;

  BedloadNcclId id{};
  if (rank_ == 0) result_of(mpi_.make_nccl_id(&id));
  if (why = gather_problems(); !why.empty()) return why;
  std::vector<BedloadNcclId> ids(std::size_t(size_), id);
  link_->all_gather(&id, ids.data(), sizeof id);
  result_of(mpi_.start_nccl(ids.data(), gpu.bind, gpu.number, kTimeout / 2));
  why = gather_problems();
  if (why.empty()) {
    const auto exchange = [&](std::span<const Piece> out, std::span<const Piece> in, void* queue,
                              int (*done)(void*)) {
      const auto from = pieces(out), to = pieces(in);
      return result_of(
          mpi_.exchange_there(from.data(), from.size(), to.data(), to.size(), queue, done, kTimeout / 2));
    };
    if (!gpu.try_out(exchange, rank_, size_) && !own.problem[0])
      note("what NCCL brings is not what was sent");
    why = gather_problems();
  }
  if (!why.empty()) {
    mpi_.drop_nccl();
    return why;
  }
  const int v = own.version;
  gpu_data_ = fmt::format("NCCL {}.{}.{}", v / 10000, v / 100 % 100, v % 100);
  return "";
}

void Processes::send(const std::vector<int>& ranks, const HostBytes& bytes, bool is_error) {
  Head head{bytes.size(), is_error};
  std::vector<BedloadMpiPiece> pieces, alarms;
  for (const int rank : ranks) {
    pieces.push_back({rank, &head, sizeof head});
    if (!bytes.empty()) pieces.push_back({rank, const_cast<std::byte*>(bytes.data()), bytes.size()});
    if (is_error) alarms.push_back({rank, nullptr, 0});
  }
  check(mpi_.exchange(kMpiAlarm, alarms.data(), alarms.size(), nullptr, 0, 0), 0);
  check(mpi_.exchange(kMpiControl, pieces.data(), pieces.size(), nullptr, 0, 0), 0);
}

HostBytes Processes::receive(int rank, double limit) {
  Head head{};
  const auto take = [&](BedloadMpiChannel channel, void* data, std::size_t bytes, double wait) {
    const BedloadMpiPiece piece{rank, data, bytes};
    check(mpi_.exchange(channel, nullptr, 0, &piece, 1, wait), wait);
  };
  take(kMpiControl, &head, sizeof head, limit);
  HostBytes bytes(head.bytes);
  if (head.bytes > 0) take(kMpiControl, bytes.data(), bytes.size(), 0);
  if (!head.is_error) return bytes;
  take(kMpiAlarm, nullptr, 0, 0);
  throw_packed(bytes, rank);
}

void Processes::tell(const HostBytes& command) {
  if (!lost_.empty()) throw DeviceError(lost_);
  std::vector<int> others(std::size_t(size_ - 1));
  std::iota(others.begin(), others.end(), 1);
  send(others, command, false);
  unheard_ = !command.empty();
}

std::vector<HostBytes> Processes::hear(const std::exception_ptr& own, double limit) {
  std::vector<HostBytes> out;
  std::exception_ptr first = own;
  bool only_lost = own && is_lost(own);
  unheard_ = false;
  for (int r = 1; r < size_; ++r) try {
      out.push_back(receive(r, first || !lost_.empty() ? kGrace : limit));
    } catch (...) {
      const std::exception_ptr error = std::current_exception();
      if (!first || (only_lost && !is_lost(error))) first = error, only_lost = is_lost(error);
    }
  try {
    if (first) std::rethrow_exception(first);
  } catch (const RankLost& lost) {
    throw DeviceError(lost.what());
  }
  return out;
}

HostBytes Processes::next() {
  try {
    HostBytes command = receive(0, lost_.empty() ? 0 : kTimeout);
    ended_ = command.empty();
    return command;
  } catch (const RankLost& lost) {
    throw DeviceError(lost.what());
  }
}

void Processes::answer(const HostBytes& result) { send({0}, result, false); }
void Processes::answer(const std::exception_ptr& error) { send({0}, packed_error(error), true); }

}  // namespace bedload
