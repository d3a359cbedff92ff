// What several ranks report, what they do about one that never responds, and cases that need more than one
// test.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/parallel/host_link.hpp"
#include "tests/support/team.hpp"
#include "tests/support/temporary_folder.hpp"

namespace BL_SOLVER {
namespace {

/// A lump that flies into blocks that were empty.
const std::string kFlight = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.6, 0.1, 0.1]
[fluid]
dx = 0.01
vmax = 2
[[fluid.fill]]
min = [0.05, 0.02, 0.02]
max = [0.2, 0.08, 0.08]
velocity = [2, 0, 0]
[run]
block = 1
[time]
end = 1
[out]
every = 1
)";

struct DividedCase {
  explicit DividedCase(const std::string& text) : config(read_case_text(text, "case.toml", {}, warnings)) {
    setup = build_setup(config, warnings);
  }
  std::vector<std::string> warnings;
  Config config;
  bedload::Setup setup;
};

TEST(RankReports, CountWhatRanksHaveAndSend) {
  const DividedCase c(kFlight);
  EXPECT_TRUE(make_coupled(c.config, c.setup)->ranks().empty());
  const std::size_t before = bytes_held();  // by scratch of this thread
  const auto s = make_divided(c.config, c.setup, 3);
  s->start();
  const std::vector<RankReport> from = s->ranks();
  while (s->time() < 0.1) s->step();
  const std::vector<RankReport> to = s->ranks();
  ASSERT_EQ(to.size(), 3u);
  std::int64_t fluid = 0, ghosts = 0, migrated = 0;
  std::size_t bytes = 0;
  for (std::size_t r = 0; r < to.size(); ++r) {
    fluid += to[r].own.fluid, ghosts += to[r].ghosts, migrated += to[r].migrated;
    bytes += to[r].bytes;
    EXPECT_EQ(to[r].exchanges, to[0].exchanges);
    EXPECT_GE(to[r].exchanges - from[r].exchanges, s->steps()) << "once a step at least";
    EXPECT_GT(to[r].waited, 0);
    // a ghost has 16 bytes at least of what its owner has sent
    EXPECT_GT(to[r].sent - from[r].sent, 16.0 * double(s->steps()));
  }
  EXPECT_EQ(fluid, s->counts().fluid);
  EXPECT_GT(ghosts, 0);
  EXPECT_GT(migrated, 0) << "fluid has gone to other blocks";
  EXPECT_EQ(bytes, s->bytes() - before) << "of all ranks";
}

/// A case may be larger than what one device holds: none ever has all particles.
TEST(RankMemory, IsThatOfOwnParticlesFromTheStart) {
  const DividedCase c(
      "gravity = [0, 0, 0]\n[domain]\nmin = [0, 0, 0]\nmax = [2, 0.06, 0.06]\n[fluid]\ndx = 0.01\nvmax = 2\n"
      "[[fluid.fill]]\nmin = [0, 0, 0]\nmax = [2, 0.06, 0.06]\n[run]\nblock = 1\n[time]\nend = 1\n[out]\n"
      "every = 1\n");
  const auto bytes_of = [&](const bedload::Setup& setup, int ranks, const SavedState* saved) {
    std::vector<std::int64_t> held(std::size_t(ranks), 0);
    const auto s = make_team({.ranks = ranks, .make = [&](Link& link) {
                                auto part = make_coupled(c.config, setup, &link);
                                if (saved) part->load(*saved);
                                held[std::size_t(link.rank())] = bytes_held_by_thread();
                                return part;
                              }});
    return *std::max_element(held.begin(), held.end());
  };
  EXPECT_LT(double(bytes_of(c.setup, 4, nullptr)), 0.4 * double(bytes_of(c.setup, 1, nullptr)));
  const auto s = make_coupled(c.config, c.setup);
  s->start();
  const SavedState saved = s->save();
  EXPECT_LT(double(bytes_of({}, 4, &saved)), 0.4 * double(bytes_of({}, 1, &saved))) << "with ghosts";
}

/// Columns of fluid that end in a surface: hydrostatic pressure comes from all particles above, on any rank.
TEST(RankCases, FluidOfAFileIsUnderThePressureOfAllAboveIt) {
  const test::TemporaryFolder folder;
  {
    std::ofstream table(folder / "fluid.csv");
    table << "x,y,z\n";
    for (int k = 0; k < 20; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 6; ++i)
          if (k < 10 + 2 * i)
            table << 0.01 * i + 0.005 << ',' << 0.01 * j + 0.005 << ',' << 0.01 * k + 0.005 << '\n';
  }
  const DividedCase c(
      "[domain]\nmin = [0, 0, 0]\nmax = [0.06, 0.04, 0.3]\n[fluid]\ndx = 0.01\nvmax = 2\n"
      "[[fluid.fill]]\nfile = \"" +
      (folder / "fluid.csv").string() +
      "\"\n"
      "[[wall.body]]\nname = \"tank\"\nshape = \"tank\"\nmin = [0, 0, 0]\n"
      "max = [0.06, 0.04, 0.3]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]\n"
      "[run]\nblock = 1\n[time]\nend = 1\n[out]\nevery = 1\n");
  const auto after = [&](int ranks) {
    const auto s = make_divided(c.config, c.setup, ranks);
    s->start();
    for (int n = 0; n < 20; ++n) s->step();
    return bits(*s);
  };
  const auto one = after(1);
  for (const int ranks : {2, 4}) EXPECT_TRUE(after(ranks) == one) << ranks << " ranks";
}

/// A link between threads that exchange as processes do.
class PieceLink final : public HostLink {
 public:
  PieceLink(Link& link, bool there) : link_(link), there_(there) {}
  int rank() const override { return link_.rank(); }
  int size() const override { return link_.size(); }
  void all_gather(const void* own, void* all, std::size_t bytes) override {
    link_.all_gather(own, all, bytes);
  }
  void exchange(std::span<const Piece> out, std::span<const Piece> in) override {
    EXPECT_FALSE(there_);
    copy(out, in, [](void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); });
  }
  bool takes_device_memory() const override { return there_; }
  void exchange_there(std::span<const Piece> out, std::span<const Piece> in, void* queue,
                      int (*done)(void*)) override {
    EXPECT_TRUE(there_);
    while (!done(queue)) std::this_thread::yield();
    copy(out, in, [](void* to, const void* from, std::size_t bytes) {
      copy_on_device(to, from, bytes);
      Context::current().wait();
    });
  }
  std::size_t received = 0;

 private:
  template <class F>
  void copy(std::span<const Piece> out, std::span<const Piece> in, const F& one) {
    const std::span<const Piece>* const own = &out;
    std::vector<const std::span<const Piece>*> all(static_cast<std::size_t>(size()));
    link_.all_gather(&own, all.data(), sizeof own);
    std::vector<std::size_t> next(all.size(), 0);
    for (const Piece& piece : in) {
      const std::span<const Piece> from = *all[std::size_t(piece.rank)];
      std::size_t& k = next[std::size_t(piece.rank)];
      while (from[k].rank != rank()) ++k;
      EXPECT_EQ(from[k].bytes, piece.bytes);
      one(piece.data, from[k++].data, piece.bytes);
      received += piece.bytes;
    }
    link_.all_gather(nullptr, nullptr, 0);  // all have what they were sent
  }

  Link& link_;
  bool there_;
};

/// Of the host, or directly.
TEST(RankCases, ParticlesGoAsPiecesOfMemory) {
  const DividedCase c(kFlight);
  const auto run = [](Simulation& s) {
    s.start();
    while (s.time() < 0.02) s.step();
    return bits(s);
  };
  const auto one = run(*make_coupled(c.config, c.setup));
  for (const bool there : {false, true}) {
    std::vector<std::unique_ptr<PieceLink>> links(3);
    const auto several = make_team({.ranks = 3, .make = [&](Link& link) {
                                      auto& own = links[std::size_t(link.rank())];
                                      own = std::make_unique<PieceLink>(link, there);
                                      return make_coupled(c.config, c.setup, own.get());
                                    }});
    EXPECT_TRUE(run(*several) == one) << there;
    for (const auto& link : links) EXPECT_GT(link->received, 0u);
  }
}

/// A link to others over which rank 1 falls asleep once.
class SleepyLink final : public Link {
 public:
  explicit SleepyLink(Link& link) : link_(link) {}
  int rank() const override { return link_.rank(); }
  int size() const override { return link_.size(); }
  void all_gather(const void* own, void* all, std::size_t bytes) override {
    if (rank() == 1 && ++calls_ == 200) std::this_thread::sleep_for(std::chrono::seconds(6));
    link_.all_gather(own, all, bytes);
  }

 private:
  Link& link_;
  int calls_ = 0;
};

TEST(RankSilence, OfOneThatNeverRespondsEndsTheRun) {
  const DividedCase c(kFlight);
  static std::vector<std::unique_ptr<SleepyLink>> links(3);  // its thread is left behind
  auto s = make_team(
      {.ranks = 3, .timeout = 0.3, .names = {"GPU 4 (H)", "GPU 5 (H)", "GPU 6 (H)"}, .make = [&](Link& link) {
         auto& own = links[std::size_t(link.rank())];
         own = std::make_unique<SleepyLink>(link);
         return make_coupled(c.config, c.setup, own.get());
       }});
  const auto from = std::chrono::steady_clock::now();
  const auto said = [&](const auto& call) -> std::string {
    try {
      call();
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "nothing";
  };
  const std::string first = said([&] {
    s->start();
    for (int n = 0; n < 1000; ++n) s->step();
  });
  EXPECT_TRUE(first.starts_with("GPU 5 (H) has not responded for 0.3 s, in ")) << first;
  EXPECT_EQ(said([&] { s->diagnostics(); }), first);
  s.reset();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
  EXPECT_LT(took.count(), 5) << "it sleeps for longer";
}

}  // namespace
}  // namespace BL_SOLVER
