// Every neighbour structure against all-pairs search.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "bedload/neighbours/for_each_pair.hpp"
#include "tests/support/tolerance.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

struct Cloud {
  Frame frame;
  std::vector<Vec3d> x;
};

/// n points in a box of unequal sides, some of them outside on open axes; `periodic` per axis.
Cloud cloud(int n, bool px, bool py, bool pz, const Vec3d& size, unsigned seed) {
  Cloud c{Frame({-0.1, 0.2, 0.05}, Vec3d{-0.1, 0.2, 0.05} + size, px, py, pz), {}};
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> u(-0.02, 1.02);
  for (int i = 0; i < n; ++i) {
    Vec3d x = c.frame.origin + Vec3d{u(rng) * size.x, u(rng) * size.y, u(rng) * size.z};
    c.x.push_back(c.frame.wrap(x));
  }
  return c;
}

std::vector<Vec3d> sorted(const Cloud& c, CellGrid& grid) {
  Buffer<Vec3d> x;
  x.assign(c.x);
  Buffer<Index> order;
  grid.sort(c.frame, Span<const Vec3d>(x), order);
  std::vector<Vec3d> out;
  for (Index i : order.to_host()) out.push_back(c.x[i]);
  return out;
}

std::vector<PairPosition> packed(const Frame& f, const std::vector<Vec3d>& x) {
  std::vector<PairPosition> out;
  for (const auto& p : x) out.push_back(as_position<PairPosition>(f, p));
  return out;
}

struct CountRow {
  Span<std::uint32_t> count;
  BL_HD std::uint32_t start(Index) const { return 0; }
  BL_HD void pair(std::uint32_t& n, Index, Index, const Real3&, Real) const { ++n; }
  BL_HD void finish(Index i, std::uint32_t n) const { count[i] = n; }
};

/// Records the rows of a list, each ended by kNone.
struct RowPass {
  Span<Index> out;
  Index width;
  struct Sum {
    Index n;
  };
  BL_HD Sum start(Index) const { return {0}; }
  BL_HD void pair(Sum& s, Index i, Index j, const Real3&, Real) const { out[i * width + s.n++] = j; }
  BL_HD void finish(Index i, Sum s) const { out[i * width + s.n] = kNone; }
};

class Neighbours : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(Neighbours, ListAndCellsMatchAllPairs) {
  const auto [mask, range] = GetParam();
  const Cloud c = cloud(700, mask & 1, mask & 2, mask & 4, {0.5, 0.31, 0.42}, 3);
  CellGrid grid(c.frame, c.frame.origin, c.frame.origin + c.frame.length, range);
  const auto x = sorted(c, grid);
  Buffer<Vec3d> device;
  device.assign(x);
  Buffer<PairPosition> p;
  p.assign(packed(c.frame, x));

  std::vector<std::set<Index>> expected(x.size());
  for (Index i = 0; i < x.size(); ++i)
    for (Index j = 0; j < x.size(); ++j)
      if (i != j && norm(c.frame.separation(x[i], x[j])) < range) expected[i].insert(j);

  VerletList list;
  list.build(Index(x.size()), grid.view(), SphNear<Vec3d>{c.frame, device, p, p, range, true});
  // read the rows back through a pass that records them
  std::vector<std::set<Index>> found(x.size());
  {
    const Index width = Index(x.size()) + 1;
    Buffer<Index> rows(std::size_t(x.size()) * width);
    for_each_pair({0, Index(x.size())}, list, SphSeparation{c.frame, p, p}, range, RowPass{rows, width});
    const auto host = rows.to_host();
    for (Index i = 0; i < x.size(); ++i)
      for (Index k = i * width; host[k] != kNone; ++k) EXPECT_TRUE(found[i].insert(host[k]).second) << "twice";
  }
  for (Index i = 0; i < x.size(); ++i) EXPECT_EQ(found[i], expected[i]) << "particle " << i;

  Buffer<std::uint32_t> count(x.size());
  for_each_pair({0, Index(x.size())}, grid.view(), SphNear<Vec3d>{c.frame, device, p, p, range, true},
                SphSeparation{c.frame, p, p}, range, CountRow{count});
  const auto counts = count.to_host();
  for (Index i = 0; i < x.size(); ++i) EXPECT_EQ(counts[i], expected[i].size());
}

// ranges from well below to half the smallest period; 0.131 leaves a thin last layer of cells
INSTANTIATE_TEST_SUITE_P(Boxes, Neighbours,
                         testing::Combine(testing::Values(0, 1, 6, 7), testing::Values(0.03, 0.08, 0.131, 0.154)));

TEST(SmallNeighbours, ListAndCellsMatchAllPairs) {
  const Cloud c = cloud(60, true, false, true, {0.5, 0.31, 0.42}, 5);
  CellGrid grid(c.frame, c.frame.origin, c.frame.origin + c.frame.length, 0.1);
  const auto x = sorted(c, grid);
  Buffer<Vec3d> device;
  device.assign(x);
  VerletList list;
  list.build(Index(x.size()), grid.view(), CrossNear<Vec3d, Vec3d>{c.frame, device, device, 0.1});
  Buffer<std::uint32_t> count(x.size());
  for_each_pair({0, Index(x.size())}, list, CrossSeparation<Vec3d, Vec3d>{c.frame, device, device}, 0.1,
                CountRow{count});
  const auto counts = count.to_host();
  for (Index i = 0; i < x.size(); ++i) {
    std::uint32_t n = 0;
    for (Index j = 0; j < x.size(); ++j) n += norm(c.frame.separation(x[i], x[j])) < 0.1;
    EXPECT_EQ(counts[i], n);
  }
}

TEST(Frame, PackedPositionsKeepPlaceAndSeparation) {
  const Frame f({-3, 0, 1}, {20, 0.6, 1.6}, false, true, false);
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = f.origin + Vec3d{u(rng) * 23, u(rng) * 0.6, u(rng) * 0.6};
    const Vec3d b = f.wrap(a + Vec3d{0.01 * u(rng), 0.01 * u(rng), 0.01 * u(rng)});
    const auto pa = f.pack(a), pb = f.pack(b);
    EXPECT_LT(norm(f.unpack(pa) - a), 4e-9);
    EXPECT_LT(norm(Vec3d(f.separation(pa, pb)) - f.separation(a, b)), 1e-8);
  }
}

TEST(CellGrid, CurveVisitsEachCellOnceAndStepsToNeighbours) {
  const Frame f({0, 0, 0}, {8, 8, 8}, false, false, false);
  CellGrid grid(f, {0, 0, 0}, {8, 8, 8}, 1.0);
  std::vector<Vec3d> x;
  for (int k = 0; k < 512; ++k) x.push_back({k % 8 + 0.5, k / 8 % 8 + 0.5, k / 64 + 0.5});
  const auto path = sorted({f, x}, grid);
  for (std::size_t k = 1; k < path.size(); ++k) EXPECT_NEAR(norm(path[k] - path[k - 1]), 1, 1e-12);
}

}  // namespace
}  // namespace bedload::inline BL_VARIANT
