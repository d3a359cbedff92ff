// How sizes are divided into levels.

#include "bedload/neighbours/size_levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace BL_SOLVER {
namespace {

SizeLevels levels_of(const std::vector<Real>& radius) {
  const Real largest = *std::max_element(radius.begin(), radius.end());
  SizeLevels levels(Frame({0, 0, 0}, {1, 1, 1}, true, true, false));
  levels.choose(radius, largest, 3e-4);
  return levels;
}

std::vector<double> borders(const SizeLevels& levels) {
  std::vector<double> all;
  for (int l = 0; l < levels.count(); ++l) all.push_back(levels.largest(l));
  return all;
}

struct KeyPass {
  CellGridView cells;
  Span<const Vec3d> x;
  std::uint32_t* key;
  BL_HD void operator()(Index i) const { key[i] = cells.key(x[i]); }
};

std::vector<Real> two_sizes(int small, int large, Real ratio) {
  std::vector<Real> radius(std::size_t(small), Real(1e-3));
  radius.insert(radius.end(), std::size_t(large), ratio * Real(1e-3));
  return radius;
}

TEST(SizeLevels, OneSizeIsOneLevelAndTwoAreTwo) {
  EXPECT_EQ(levels_of(two_sizes(1000, 0, 1)).count(), 1);
  EXPECT_EQ(levels_of(two_sizes(1000, 500, Real(1.5))).count(), 1);
  for (const int ratio : {3, 5, 20, 100, 1000})
    EXPECT_EQ(borders(levels_of(two_sizes(1000, 10, Real(ratio)))),
              (std::vector<double>{double(Real(ratio) * Real(1e-3)), double(Real(1e-3))}));
}

TEST(SizeLevels, OfAWideDistributionAreAtLeastAFactorOfTwoApart) {
  std::vector<Real> radius;
  for (int k = 0; k < 20000; ++k) radius.push_back(Real(1e-3 * std::pow(2e-3 + k / 20000.0, -1.0 / 3)));
  for (int k = 0; k < 20; ++k) radius.push_back(Real(0.01 * (k + 1)));
  const auto found = borders(levels_of(radius));
  EXPECT_GE(found.size(), 3u);
  EXPECT_LE(found.size(), std::size_t(SizeLevels::kMost));
  for (std::size_t l = 1; l < found.size(); ++l) EXPECT_GE(found[l - 1], 2 * found[l]);
  std::shuffle(radius.begin(), radius.end(), std::mt19937(1));
  EXPECT_EQ(borders(levels_of(radius)), found) << "in whatever order";
}

TEST(SizeLevels, SortBySizeAndThenByCell) {
  std::vector<Real> radius = two_sizes(900, 100, 10);
  std::mt19937 random(2);
  std::shuffle(radius.begin(), radius.end(), random);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Vec3d> at;
  for (std::size_t i = 0; i < radius.size(); ++i) at.push_back({u(random), u(random), u(random)});
  SizeLevels levels = levels_of(radius);
  Buffer<Vec3d> x;
  Buffer<Real> r;
  Buffer<Index> order;
  x.assign(at), r.assign(radius);
  levels.sort(x.span(), r.span(), order);
  const auto found = order.to_host();
  ASSERT_EQ(levels.particles(0).size(), 100u);
  ASSERT_EQ(levels.particles(1).end, 1000u);
  std::vector<Index> all = found;
  std::sort(all.begin(), all.end());
  for (Index i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i);
  for (int l = 0; l < 2; ++l) {
    const auto [begin, end] = levels.particles(l);
    Buffer<std::uint32_t> keys;
    keys.resize(at.size());
    for_each({0, Index(at.size())}, KeyPass{levels.grid(l).view(), x.span(), keys.data()});
    const std::vector<std::uint32_t> key = keys.to_host();
    for (Index k = begin; k < end; ++k) {
      EXPECT_EQ(radius[found[k]] > Real(5e-3), l == 0);
      if (k > begin) {
        EXPECT_LE(key[found[k - 1]], key[found[k]]);
      }
    }
  }
}

}  // namespace
}  // namespace BL_SOLVER
