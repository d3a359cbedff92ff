// Loops, reductions, sort and scan against the same by the standard library, and what a thread keeps for
// them.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "bedload/parallel/compact.hpp"
#include "bedload/parallel/overlap.hpp"

namespace BL_SOLVER {
namespace {

/// Nothing, one, and about what a block, a chunk and a level of partial results hold.
constexpr Index kSizes[] = {0, 1, 31, 127, 128, 129, 1023, 1025, (1u << 17) - 1, (1u << 17) + 1};

std::vector<std::uint32_t> random_below(std::uint32_t limit, std::size_t n) {
  std::mt19937 random(7);
  std::vector<std::uint32_t> all(n);
  for (auto& k : all) k = random() % limit;
  return all;
}

struct CountVisit {
  Span<std::uint32_t> visits;
  BL_HD void operator()(Index i) const { ++visits[i]; }
};

TEST(ForEach, VisitsAllOfItsRangeOnceAndNothingElse) {
  for (const Index n : kSizes)
    for (const bool early : {false, true}) {
      Buffer<std::uint32_t> visits(n + 7);
      const Range range{3, n + 3};
      early ? for_each_early(range, CountVisit{visits}) : for_each(range, CountVisit{visits});
      const auto seen = visits.to_host();
      for (Index i = 0; i < seen.size(); ++i)
        ASSERT_EQ(seen[i], std::uint32_t(i >= range.begin && i < range.end)) << i << " of " << n;
    }
}

/// And more than two levels of them.
std::vector<Index> reduced_sizes() {
  std::vector<Index> all(std::begin(kSizes), std::end(kSizes));
  all.push_back((1u << 20) + 1);
  return all;
}

/// Sums that know no rounding, and the greatest place.
struct Census {
  struct Value {
    std::uint64_t sum;
    std::uint32_t last;
  };
  Span<const std::uint32_t> of;
  BL_HD Value identity() const { return {0, 0}; }
  BL_HD Value operator()(Index i) const { return {of[i], i}; }
  BL_HD void combine(Value& into, const Value& v) const {
    into.sum += v.sum;
    into.last = max_of(into.last, v.last);
  }
};

TEST(Reduce, TakesAllOfItsRangeOnceAndNothingElse) {
  for (const Index n : reduced_sizes()) {
    const auto host = random_below(1u << 31, n + 7);
    Buffer<std::uint32_t> of;
    of.assign(host);
    const Range range{3, n + 3};
    const Census::Value all = reduce(range, Census{of});
    EXPECT_EQ(all.sum, std::accumulate(host.begin() + 3, host.begin() + 3 + n, std::uint64_t(0))) << n;
    EXPECT_EQ(all.last, n > 0 ? n + 2 : 0) << n;
    if (n == 0) continue;
    Buffer<Census::Value> there(2);
    reduce_into(there.data() + 1, range, Census{of});
    EXPECT_EQ(there.to_host()[1].sum, all.sum) << n;
    EXPECT_EQ(there.to_host()[0].sum, 0u) << "beside what it should write";
  }
}

struct Sum {
  using Value = double;
  Span<const double> of;
  BL_HD double identity() const { return 0; }
  BL_HD double operator()(Index i) const { return of[i]; }
  BL_HD void combine(double& into, const double& v) const { into += v; }
};

/// Sums that round are the same to the last bit, however often and on whatever thread they are asked for.
TEST(Reduce, RoundsInAnOrderOfItsOwn) {
  for (const Index n : reduced_sizes()) {
    std::vector<double> host;
    for (const std::uint32_t k : random_below(1u << 31, n)) host.push_back(1.0 / (1 + k));
    Buffer<double> of;
    of.assign(host);
    const double first = reduce({0, n}, Sum{of});
    double other = -1;
    std::thread([&] { other = reduce({0, n}, Sum{of}); }).join();
    EXPECT_EQ(other, first) << n;
    EXPECT_EQ(reduce({0, n}, Sum{of}), first) << n;
    // each of n additions rounds by half a unit in the last place of the sum at most
    const double plain = std::accumulate(host.begin(), host.end(), 0.0);
    EXPECT_NEAR(first, plain, n * std::numeric_limits<double>::epsilon() * plain) << n;
  }
}

TEST(SortKeys, IsStableAndTellsWhereEachCameFrom) {
  for (const Index n : kSizes)
    for (const int bits : {1, 5, 17, 32}) {
      const auto host = random_below(bits == 32 ? kNone : 1u << bits, n);
      std::vector<Index> expected(n);
      std::iota(expected.begin(), expected.end(), Index(0));
      std::stable_sort(expected.begin(), expected.end(), [&](Index a, Index b) { return host[a] < host[b]; });
      Buffer<std::uint32_t> keys;
      Buffer<Index> order;
      keys.assign(host);
      sort_keys(keys, order, bits);
      ASSERT_EQ(order.to_host(), expected) << n << " of " << bits << " bits";
      const auto sorted = keys.to_host();
      for (Index i = 0; i < n; ++i) ASSERT_EQ(sorted[i], host[expected[i]]) << i << " of " << n;
    }
}

template <class T>
void expect_scanned(std::uint32_t limit) {
  Buffer<T> in, out;
  for (const Index n : {1025u, 0u, 1u, 31u, (1u << 17) + 1}) {  // what was there before is of no account
    const auto random = random_below(limit, n);
    const std::vector<T> host(random.begin(), random.end());
    std::vector<T> expected(1, 0);
    for (const T k : host) expected.push_back(expected.back() + k);
    in.assign(host);
    EXPECT_EQ(exclusive_scan(in, out), expected.back()) << n;
    EXPECT_EQ(out.to_host(), expected) << n;
    EXPECT_EQ(in.to_host(), host) << "the input was changed";
  }
}

TEST(ExclusiveScan, HoldsTheSumsBeforeEachAndTheTotal) {
  expect_scanned<std::uint32_t>(1u << 14);
  expect_scanned<std::uint64_t>(kNone);  // beyond 32 bits
}

struct IsOdd {
  Span<const std::uint32_t> of;
  BL_HD bool operator()(Index i) const { return of[i] % 2 == 1; }
};

TEST(FindAll, ListsWhatIsToBeKeptInOrder) {
  Buffer<Index> kept;
  for (const Index n : {1025u, 1u, 0u, 129u, (1u << 17) + 1})
    for (const std::uint32_t limit : {1u, 2u, 1u << 20}) {  // none, and half of them
      const auto host = random_below(limit, n);
      std::vector<Index> expected;
      for (Index i = 0; i < n; ++i)
        if (host[i] % 2 == 1) expected.push_back(i);
      Buffer<std::uint32_t> of;
      of.assign(host);
      find_all(n, IsOdd{of}, kept);
      EXPECT_EQ(kept.to_host(), expected) << n << " below " << limit;
    }
}

TEST(Context, LendsABufferForEachTypeNumberAndThread) {
  Context& here = Context::current();
  EXPECT_EQ(&Context::current(), &here);
  Buffer<double>& first = here.scratch<double>();
  first.assign({1, 2, 3});
  EXPECT_EQ(&here.scratch<double>(0), &first) << "the same until another is asked for";
  EXPECT_EQ(first.size(), 3u);
  EXPECT_NE(&here.scratch<double>(1), &first);
  EXPECT_NE(static_cast<void*>(&here.scratch<float>()), static_cast<void*>(&first));
  const Context* there = nullptr;
  Buffer<double>* of_other = nullptr;
  std::thread([&] {
    there = &Context::current();
    of_other = &Context::current().scratch<double>();
    EXPECT_EQ(of_other->size(), 0u);
  }).join();
  EXPECT_NE(there, &here);
  EXPECT_NE(of_other, &first);
  here.wait();
}

TEST(Buffer, IsCountedKeepsWhatFitsAndFillsTheRestWithZero) {
  const std::size_t before = bytes_held();
  {
    Buffer<std::uint32_t> b;
    b.assign({1, 2, 3});
    EXPECT_EQ(bytes_held() - before, 12u);
    b.grow(5);
    EXPECT_EQ(b.to_host(), (std::vector<std::uint32_t>{1, 2, 3, 0, 0}));
    b.resize(2);
    b.grow(4);
    EXPECT_EQ(b.to_host(), (std::vector<std::uint32_t>{1, 2, 0, 0})) << "what had been dropped came back";
    const std::size_t held = bytes_held();
    b.grow(20);  // within what the first growth left room for
    EXPECT_EQ(bytes_held(), held);
    EXPECT_EQ(b.to_host()[1], 2u);
    b.resize(1000);
    EXPECT_EQ(b.to_host(), std::vector<std::uint32_t>(1000));
    b.reserve_and_resize(1001);
    const std::size_t roomy = bytes_held();
    b.reserve_and_resize(1100);
    EXPECT_EQ(bytes_held(), roomy) << "it has room to spare";
    Buffer<std::uint32_t> other = std::move(b);
    EXPECT_EQ(other.size(), 1100u);
    EXPECT_EQ(bytes_held(), roomy);
  }
  EXPECT_EQ(bytes_held(), before);
}

}  // namespace
}  // namespace BL_SOLVER
