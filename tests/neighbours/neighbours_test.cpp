// Every neighbour structure against all-pairs search.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "bedload/neighbours/for_each_tile.hpp"
#include "bedload/neighbours/tile_search.hpp"
#include "kernels/smoothing/registry.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
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
  for (const auto& p : x) out.push_back(pair_position(f, p, Real(1)));
  return out;
}

/// A cloud in the order of the cells of a grid, on the device.
struct SortedCloud {
  Frame frame;
  CellGrid grid;
  std::vector<Vec3d> x;
  Buffer<Vec3d> place;
  Buffer<PairPosition> p;

  SortedCloud(const Cloud& c, double cell)
      : frame(c.frame), grid(frame, frame.origin, frame.origin + frame.length, cell), x(sorted(c, grid)) {
    place.assign(x);
    p.assign(packed(frame, x));
  }
  Index size() const { return Index(x.size()); }
  PairSeparation separation() const { return {frame, p, p}; }
  SphNear<Vec3d> near(double range) const { return {frame, place, p, p, range, true}; }
  SphNear<Vec3d> near(double range, const HalfSkins& skins) const {
    return {frame, place, p, p, range, true, skins, skins};
  }
#if BL_CUDA
  void build(TileList& tiles, double range, const HalfSkins& skins, unsigned bits) {
    tiles.build(size(), grid, frame, Span<const Vec3d>(place), Span<const PairPosition>(p), range, skins,
                bits);
  }
#endif
};

struct CountRow {
  Span<std::uint32_t> count;
  BL_HD std::uint32_t start(Index) const { return 0; }
  BL_HD auto sources() const { return sources_of(); }
  BL_HD void pair(std::uint32_t& n, const Real3&, Real, Real) const { ++n; }
  BL_HD void merge(std::uint32_t& n, std::uint32_t other) const { n += other; }
  BL_HD void finish(Index i, std::uint32_t n) const { count[i] = n; }
};

/// Records the rows of a list, each ended by kNone.
struct RowPass {
  Span<const Index> place;
  Span<Index> out;
  Index width;
  struct Sum {
    Index next;
  };
  BL_HD Sum start(Index i) const { return {i * width}; }
  BL_HD auto sources() const { return sources_of(place); }
  BL_HD void pair(Sum& s, const Real3&, Real, Real, Index j) const { out[s.next++] = j; }
  BL_HD void finish(Index, Sum s) const { out[s.next] = kNone; }
};

/// Rows of a list as passes meet their entries.
template <class List>
std::vector<std::vector<Index>> ordered_rows_of(const List& list, const PairSeparation& separation,
                                                double range) {
  const Index n = list.rows(), width = n + 1;
  std::vector<std::vector<Index>> found(n);
  std::vector<Index> places(n);
  std::iota(places.begin(), places.end(), Index(0));
  Buffer<Index> place, rows(std::size_t(n) * width);
  place.assign(places);
  for_each_pair({0, n}, list, separation, range, RowPass{place, rows, width});
  const auto host = rows.to_host();
  for (Index i = 0; i < n; ++i)
    for (std::size_t k = std::size_t(i) * width; host[k] != kNone; ++k) found[i].push_back(host[k]);
  return found;
}

template <class List>
std::vector<std::set<Index>> rows_of(const List& list, const PairSeparation& separation, double range) {
  std::vector<std::set<Index>> found;
  for (const auto& row : ordered_rows_of(list, separation, range)) {
    found.emplace_back(row.begin(), row.end());
    EXPECT_EQ(found.back().size(), row.size()) << "twice";
  }
  return found;
}

class Neighbours : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(Neighbours, ListAndCellsMatchAllPairs) {
  const auto [mask, range] = GetParam();
  SortedCloud c(cloud(700, mask & 1, mask & 2, mask & 4, {0.5, 0.31, 0.42}, 3), range);
  const std::vector<Vec3d>& x = c.x;

  std::vector<std::set<Index>> expected(x.size());
  for (Index i = 0; i < x.size(); ++i)
    for (Index j = 0; j < x.size(); ++j)
      if (i != j && norm(c.frame.separation(x[i], x[j])) < range) expected[i].insert(j);

  VerletList list;
  list.build(c.size(), c.grid.view(), c.near(range));
  auto found = rows_of(list, c.separation(), range);
  for (Index i = 0; i < x.size(); ++i) EXPECT_EQ(found[i], expected[i]) << "particle " << i;
#if BL_CUDA
  TileList tiles;
  for (unsigned bits : {0, 2}) {
    c.build(tiles, range, {}, bits);
    found = rows_of(tiles, c.separation(), range);
    for (Index i = 0; i < x.size(); ++i) EXPECT_EQ(found[i], expected[i]) << "tiles, particle " << i;
  }
#endif

  Buffer<std::uint32_t> count(x.size());
  for_each_pair({0, c.size()}, c.grid.view(), c.near(range), c.separation(), range, CountRow{count});
  const auto counts = count.to_host();
  for (Index i = 0; i < x.size(); ++i) EXPECT_EQ(counts[i], expected[i].size());
}

/// Each row holds all that come within the range while everyone keeps to a half skin of its own, and no more.
TEST(SmallNeighbours, ListsReachAsFarAsHalfSkinsSay) {
  const double range = 0.06, most = 0.02;
  for (const bool periodic : {false, true}) {
    SortedCloud c(cloud(400, periodic, false, periodic, {0.5, 0.31, 0.42}, 4), range + 2 * most);
    const std::vector<Vec3d>& x = c.x;
    const Index n = c.size();
    std::vector<Real> skin;
    for (Index i = 0; i < n; ++i) skin.push_back(Real(i % 7 == 0 ? most : 0.001 * (i % 5)));
    Buffer<Real> own;
    own.assign(skin);
    std::vector<std::set<Index>> expected(n);
    std::size_t uniform = 0, listed = 0;
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const double r = norm(c.frame.separation(x[i], x[j]));
        if (i != j && r < range + double(skin[i]) + double(skin[j])) expected[i].insert(j), ++listed;
        uniform += i != j && r < range + 2 * most;
      }
    EXPECT_LT(listed, 2 * uniform / 3);
    const HalfSkins skins(own, most);
    VerletList list;
    list.build(n, c.grid.view(), c.near(range, skins));
    auto found = rows_of(list, c.separation(), range + 2 * most);
    for (Index i = 0; i < n; ++i) EXPECT_EQ(found[i], expected[i]) << "particle " << i;
#if BL_CUDA
    TileList tiles;
    for (unsigned bits : {0, 2}) {
      c.build(tiles, range, skins, bits);
      found = rows_of(tiles, c.separation(), range + 2 * most);
      for (Index i = 0; i < n; ++i) EXPECT_EQ(found[i], expected[i]) << "tiles, particle " << i;
    }
#endif
  }
}

// ranges from well below to half the smallest period; 0.131 leaves a thin last layer of cells
INSTANTIATE_TEST_SUITE_P(Boxes, Neighbours,
                         testing::Combine(testing::Values(0, 1, 6, 7),
                                          testing::Values(0.03, 0.08, 0.131, 0.154)));

/// A list that is built again holds what it should, however much more or less than before that is.
TEST(SmallNeighbours, ListsGrowFromNothingAndShrink) {
  SortedCloud c(cloud(700, true, true, false, {0.5, 0.31, 0.42}, 6), 0.15);
  const std::vector<Vec3d>& x = c.x;
  const Index n = c.size();
  const PairSeparation separation = c.separation();
  VerletList list;
  Buffer<std::uint32_t> count(n);
#if BL_CUDA
  TileList tiles;
#endif
  std::size_t most = 0;
  for (const double range : {1e-6, 0.03, 0.15, 0.05, 0.15}) {
    list.build(n, c.grid.view(), c.near(range));
    std::vector<std::set<Index>> expected(n);
    std::size_t pairs = 0;
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j)
        if (i != j && norm(c.frame.separation(x[i], x[j])) < range) expected[i].insert(j), ++pairs;
    EXPECT_EQ(rows_of(list, separation, range), expected) << range;
    for_each_pair({0, n}, list, separation, range, CountRow{count});  // by lanes, which read ahead
    const auto counts = count.to_host();
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::size_t(0)), pairs) << range;
    EXPECT_GE(list.slots(), pairs);
    EXPECT_GE(list.bytes(), std::max(most, pairs) * sizeof(Index)) << "memory is kept";
    most = std::max(most, pairs);
#if BL_CUDA
    c.build(tiles, range, {}, 2);
    EXPECT_EQ(rows_of(tiles, separation, range), expected) << "tiles, " << range;
#endif
  }
  EXPECT_GT(most, 60u * n) << "the test means it to grow";
  const std::size_t held = list.bytes();
  list.build(0, c.grid.view(), c.near(0.15));
  EXPECT_EQ(list.rows(), 0u);
  EXPECT_EQ(list.slots(), 0u);
  EXPECT_EQ(list.bytes(), held);
}

#if BL_CUDA
/// What the searches before were for, which differs between ranks and after a restart, decides how much
/// memory a search takes, and must not decide the order of entries. Here y has two cells.
TEST(SmallNeighbours, OrderOfTilesDoesNotDependOnSearchesBefore) {
  const double range = 0.07, most = 0.015;
  SortedCloud c(cloud(2000, false, true, false, {0.6, 0.21, 0.4}, 7), range + 2 * most),
      few(cloud(60, false, true, false, {0.6, 0.21, 0.4}, 8), range + 2 * most);
  std::vector<Real> skin;  // only at one end far more than elsewhere
  for (const auto& at : c.x) skin.push_back(Real(at.x < c.frame.origin.x + 0.05 ? most : 0.001));
  Buffer<Real> own;
  own.assign(skin);

  const PairSeparation separation = c.separation();
  for (unsigned bits : {0, 2}) {
    TileList tiles, after_few;
    const auto build = [&](TileList& list) { c.build(list, range, HalfSkins(own, most), bits); };
    build(tiles);
    build(after_few);  // so that it has capacity for all
    few.build(after_few, range, {most}, bits);
    build(after_few);
    EXPECT_EQ(ordered_rows_of(tiles, separation, range + 2 * most),
              ordered_rows_of(after_few, separation, range + 2 * most));
  }
}
#endif

/// A pass that the CPU takes in packs, with every kind of gather; `constant` must come through unchanged.
template <class W>
struct MomentPass {
  W w;
  Span<const Real> one;
  Span<const Real3> three;
  Span<const Real4> four;
  Span<Real4> out;

  template <class N = Real>
  struct Sum {
    N constant, weight;
    Vec3<N> moment;
  };
  BL_HD Sum<> start(Index i) const { return {Real(i), 0, {}}; }
  BL_HD auto sources() const { return sources_of(one, three, four); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N weight, N a, const Vec3<N>& b,
                  const Vec4<N>& c) const {
    const N d = root(r2);
    const N factor = select(b.x < c.w, a * w.W(d), 2 * c.x * square(w.h) * w.F(d));
    sum.weight += weight * factor;
    sum.moment += weight * factor * (r + w.h * cross(b, c.xyz()));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.weight += other.weight;
    into.moment += other.moment;
  }
  BL_HD void finish(Index i, const Sum<>& sum) const {
    out[i] = {sum.moment, sum.constant == Real(i) ? sum.weight : Real(-1)};
  }
};

template <class W>
void expect_lists_and_cells_agree(bool periodic, int many = 700) {
  const double range = 0.08, h = range / W::kappa;
  const Vec3d size = many > 700 ? Vec3d{0.25, 0.25, 0.25} : Vec3d{0.5, 0.31, 0.42};
  // rows of 0 to 50 entries, or of hundreds
  SortedCloud c(cloud(many, periodic, periodic, false, size, 9), 1.2 * range);
  const Index n = c.size();
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(0.5, 1);
  const auto random = [&] { return Real(u(rng)); };
  std::vector<Real> one;
  std::vector<Real3> three;
  std::vector<Real4> four;
  for (Index i = 0; i < n; ++i) {
    one.push_back(random());
    three.push_back({random(), random(), random()});
    four.push_back({random(), random(), random(), random()});
  }
  Buffer<Real> ones;
  Buffer<Real3> threes;
  Buffer<Real4> fours, by_list(n), by_cells(n);
  ones.assign(one);
  threes.assign(three);
  fours.assign(four);

  const SphNear<Vec3d> near = c.near(1.2 * range);
  const PairSeparation separation = c.separation();
  const W w(h);
  const double scale = w.W(Real(0.5 * h)),
               bound = (many > 700 ? 30 : 1) * tolerance(1e-13, 2e-6, 2e-6);  // sums of as many more
  for_each_pair({0, n}, c.grid.view(), near, separation, range,
                MomentPass<W>{w, ones, threes, fours, by_cells});
  const auto b = by_cells.to_host();
  const auto expect_same = [&](const auto& list, const std::string& which, double bound) {
    for_each_pair({0, n}, list, separation, range, MomentPass<W>{w, ones, threes, fours, by_list});
    const auto a = by_list.to_host();
    double most = 0;
    for (Index i = 0; i < n; ++i) {
      EXPECT_NEAR(a[i].w, b[i].w, 30 * scale * bound) << which << i;
      EXPECT_LT(norm(Vec3d(a[i].xyz() - b[i].xyz())), 30 * scale * range * bound) << which << i;
      EXPECT_GE(a[i].w, 0) << which << "what stays the same along a row was changed";
      most = std::max(most, double(a[i].w));
    }
    EXPECT_GT(most, scale);
  };
  VerletList list;
  list.build(n, c.grid.view(), near);
  expect_same(list, "list, ", bound);
#if BL_CUDA
  TileList tiles;
  for (unsigned bits : {0, 1, 3, 5}) {
    c.build(tiles, 1.2 * range, {}, bits);
    // places rounded to 2^-24 of a tile that is as wide as the box, six times the range
    expect_same(tiles, "tiles of " + std::to_string(1 << bits) + " lanes, ", 2 * bound);
  }
#endif
}

TEST(NeighbourPasses, ListsAndCellsGiveTheSameSums) {
  for (bool periodic : {false, true}) {
    expect_lists_and_cells_agree<WendlandC2>(periodic);
    expect_lists_and_cells_agree<CubicSpline>(periodic);
    expect_lists_and_cells_agree<Lucy>(periodic);
  }
}

// more around a row than a block's shared memory holds
TEST(NeighbourPasses, CrowdsGiveTheSameSums) { expect_lists_and_cells_agree<WendlandC2>(true, 6000); }

TEST(SmallNeighbours, ListAndCellsMatchAllPairs) {
  const Cloud c = cloud(60, true, false, true, {0.5, 0.31, 0.42}, 5);
  CellGrid grid(c.frame, c.frame.origin, c.frame.origin + c.frame.length, 0.1);
  const auto x = sorted(c, grid);
  Buffer<Vec3d> device;
  device.assign(x);
  VerletList list;
  list.build(Index(x.size()), grid.view(), CrossNear<Vec3d, Vec3d>{c.frame, device, device, 0.1});
  Buffer<std::uint32_t> count(x.size());
  Buffer<PairPosition> packed(x.size());
  for_each({0, Index(x.size())}, PackPass<Vec3d>{c.frame, device, packed});
  for_each_pair({0, Index(x.size())}, list, PairSeparation{c.frame, packed, packed}, 0.1, CountRow{count});
  const auto counts = count.to_host();
  for (Index i = 0; i < x.size(); ++i) {
    std::uint32_t n = 0;
    for (Index j = 0; j < x.size(); ++j) n += norm(c.frame.separation(x[i], x[j])) < 0.1;
    EXPECT_EQ(counts[i], n);
  }
}

TEST(Frame, PackedAndFixedPositionsKeepPlaceAndSeparation) {
  const Frame f({-3, 0, 1}, {20, 0.6, 1.6}, false, true, false, 0.1);
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = f.origin + Vec3d{u(rng) * 23, u(rng) * 0.6, u(rng) * 0.6};
    const Vec3d b = f.wrap(a + Vec3d{0.01 * u(rng), 0.01 * u(rng), 0.01 * u(rng)});
    EXPECT_LT(norm(f.unpack(f.pack(a)) - a), 4e-9);
    EXPECT_LT(norm(Vec3d(f.separation(f.fixed(a), f.fixed(b))) - f.separation(a, b)), 2e-8);
  }
}

TEST(Frame, FixedPositionsTellApartWhatIsBeyondTheDomain) {
  const Frame f({0, 0, 0}, {1, 1, 1}, false, true, false, 0.25);
  const auto apart = [&](const Vec3d& a, const Vec3d& b) {
    return Vec3d(f.separation(f.fixed(a), f.fixed(b)));
  };
  EXPECT_NEAR(apart({-0.2, 0, 0}, {1.2, 0, 0}).x, -1.4, 1e-6);
  EXPECT_NEAR(apart({-7, 0, 0}, {0, 0, 0}).x, -0.25, 1e-6) << "as far as it can be told";
  EXPECT_NEAR(apart({0, 0, -7}, {0, 0, 8}).z, -1.5, 1e-6);
  EXPECT_NEAR(apart({0, 0.9, 0}, {0, 3.1, 0}).y, -0.2, 1e-6);
}

TEST(CellGrid, CurveVisitsEachCellOnceAndStepsToNeighbours) {
  const Frame f({0, 0, 0}, {8, 8, 8}, false, false, false);
  CellGrid grid(f, {0, 0, 0}, {8, 8, 8}, 1.0);
  std::vector<Vec3d> x;
  for (int k = 0; k < 512; ++k) x.push_back({k % 8 + 0.5, k / 8 % 8 + 0.5, k / 64 + 0.5});
  const auto path = sorted({f, x}, grid);
  for (std::size_t k = 1; k < path.size(); ++k) EXPECT_NEAR(norm(path[k] - path[k - 1]), 1, 1e-12);
}

/// A vast domain costs little where there are no particles.
/// How many particles are in the cell of each place, and whether any are near.
struct CellsOfPass {
  CellGridView cells;
  Span<const Vec3d> x;
  Span<std::uint32_t> count, near;
  BL_HD void operator()(Index i) const {
    const std::uint32_t key = cells.key(x[i]);
    count[i] = cells.last(key) - cells.first(key);
    near[i] = cells.any_near(x[i], 1);
  }
};

TEST(CellGrid, TakesMemoryForBlocksWithParticles) {
  const std::size_t before = bytes_held();
  const Frame f({0, 0, 0}, {1000, 1000, 1000}, false, false, false);
  CellGrid grid(f, {0, 0, 0}, {1000, 1000, 1000}, 1.0);
  const std::vector<Vec3d> places{{500, 500, 500}, {2, 2, 2}, {700, 20, 300}, {499, 500, 500}};
  Buffer<Vec3d> x;
  x.assign(places);
  Buffer<std::uint32_t> count(places.size()), near(places.size());
  const auto look = [&] {
    for_each({0, Index(places.size())}, CellsOfPass{grid.view(), x, count, near});
    return std::pair(count.to_host(), near.to_host());
  };
  using Counts = std::vector<std::uint32_t>;
  EXPECT_EQ(look(), std::pair(Counts(4), Counts(4)));

  sorted({f, {{500, 500, 500}, {2, 2, 2}, {2.5, 2.5, 2.5}}}, grid);
  EXPECT_EQ(grid.view().n[0], 1000) << "cells are not coarser than asked for";
  EXPECT_LT(bytes_held() - before, 64u << 20);
  EXPECT_EQ(look(), std::pair(Counts({1, 2, 0, 0}), Counts({1, 1, 0, 1}))) << "the last is near the first";
}

/// Within a cell particles are in the order of their ids, however they came.
TEST(CellGrid, SortsByIdWithinCells) {
  const Frame f({0, 0, 0}, {8, 8, 8}, false, false, false);
  CellGrid grid(f, {0, 0, 0}, {8, 8, 8}, 1.0);
  const std::vector<Vec3d> x{{3.5, 3.5, 3.5}, {0.5, 0.5, 0.5}, {3.1, 3.2, 3.3}, {3.9, 3.9, 3.9}};
  const std::vector<Id> id{7, 1, 9, 2};
  Buffer<Vec3d> places;
  Buffer<Id> ids;
  Buffer<Index> order;
  places.assign(x), ids.assign(id);
  grid.sort(f, Span<const Vec3d>(places), order, ids);
  std::vector<Id> sorted_ids;
  for (const Index k : order.to_host()) sorted_ids.push_back(id[k]);
  EXPECT_EQ(sorted_ids, (std::vector<Id>{1, 2, 7, 9}));
}

}  // namespace
}  // namespace BL_SOLVER
