// What a step spends its time on.

#include <gtest/gtest.h>

#include <chrono>

#include "bedload/parallel/loops.hpp"
#include "bedload/parallel/stopwatch.hpp"

namespace BL_SOLVER {
namespace {

/// Keeps one thread busy.
struct Busy {
  Span<double> out;
  int rounds;
  BL_HD void operator()(Index i) const {
    double x = out[i];
    for (int k = 0; k < rounds; ++k) x = x * 0.999999 + 1e-7;
    out[i] = x;
  }
};

TEST(SmallStopwatch, CountsEachLapForItsPart) {
  Buffer<double> work;
  work.resize(32);
  work.zero();
  const auto from = std::chrono::steady_clock::now();
  Stopwatch watch;
  for (int step = 0; step < 2; ++step) {
    watch.start();
    for_each({0, 32}, Busy{work, 400000});
    watch.lap(1);
    for_each({0, 32}, Busy{work, 100});
    watch.lap(0);
    for_each({0, 32}, Busy{work, 400000});
    watch.lap(1);
    watch.stop();
    for_each({0, 32}, Busy{work, 800000});  // belongs to no part
  }
  (void)work.to_host();  // waits for a GPU
  const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  EXPECT_GT(watch.seconds(0), 0);
  EXPECT_GT(watch.seconds(1), 10 * watch.seconds(0));
  EXPECT_LT(watch.seconds(0) + watch.seconds(1), 0.8 * all);
  EXPECT_EQ(watch.seconds(2), 0);
}

}  // namespace
}  // namespace BL_SOLVER
