// Sums that do not depend on how their terms are divided.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <thread>

#include "bedload/parallel/reductions.hpp"
#include "src/team/thread_team.hpp"

namespace BL_SOLVER {
namespace {

struct Terms {
  Span<const double> x;
  BL_HD void operator()(Index i, double* out) const { out[0] = x[i], out[1] = x[i] * x[i]; }
};

std::vector<double> terms(std::size_t n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> sign(-1, 1), exponent(-30, 3);
  std::vector<double> x;
  for (std::size_t k = 0; k < n; ++k) x.push_back(sign(random) * std::pow(10, exponent(random)));
  return x;
}

TEST(Sums, DoNotDependOnTheOrder) {
  std::vector<double> x = terms(10000);
  const auto sum = [&] {
    Buffer<double> there;
    there.assign(x);
    return sum_over<2>({0, Index(x.size())}, Terms{there});
  };
  const auto before = sum();
  std::reverse(x.begin(), x.end());
  std::shuffle(x.begin(), x.end(), std::mt19937(5));
  const auto after = sum();
  EXPECT_EQ(before.v[0], after.v[0]);
  EXPECT_EQ(before.v[1], after.v[1]);
  double by_hand = 0;
  for (const double v : x) by_hand += v;
  EXPECT_NEAR(before.v[0], by_hand, 1e-11);
}

TEST(Sums, AreTheSameOnAnyNumberOfRanks) {
  const std::vector<double> x = terms(5000);
  const auto of_ranks = [&](int ranks) {
    ThreadTeam team(ranks);
    std::vector<double> sums(static_cast<std::size_t>(ranks));
    std::vector<std::thread> threads;
    for (int r = 0; r < ranks; ++r)
      threads.emplace_back([&, r] {
        Context::current().join(&team.link(r));
        const std::size_t begin = x.size() * std::size_t(r) / std::size_t(ranks),
                          end = x.size() * std::size_t(r + 1) / std::size_t(ranks);
        Buffer<double> there;
        there.assign({x.begin() + std::ptrdiff_t(begin), x.begin() + std::ptrdiff_t(end)});
        sums[std::size_t(r)] = sum_over<2>({0, Index(end - begin)}, Terms{there}).v[0];
      });
    for (std::thread& thread : threads) thread.join();
    for (const double sum : sums) EXPECT_EQ(sum, sums[0]);
    return sums[0];
  };
  const double one = of_ranks(1);
  EXPECT_EQ(of_ranks(2), one);
  EXPECT_EQ(of_ranks(7), one);
}

TEST(Sums, ShowWhatIsNoNumber) {
  std::vector<double> x = terms(100);
  x[17] = std::nan("");
  Buffer<double> there;
  there.assign(x);
  EXPECT_TRUE(std::isnan(sum_over<2>({0, 100}, Terms{there}).v[0]));
  EXPECT_EQ(sum_over<2>({0, 0}, Terms{there}).v[0], 0);
}

}  // namespace
}  // namespace BL_SOLVER
