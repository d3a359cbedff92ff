#include "bedload/geometry/bisect.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace bedload {
namespace {

std::vector<std::array<int, 3>> box(int nx, int ny, int nz) {
  std::vector<std::array<int, 3>> places;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) places.push_back({x, y, z});
  return places;
}

std::vector<double> loads_of(const std::vector<std::uint16_t>& owner, const std::vector<double>& load, int ranks) {
  std::vector<double> sum(std::size_t(ranks), 0.0);
  for (std::size_t b = 0; b < owner.size(); ++b) sum.at(owner[b]) += load[b];
  return sum;
}

TEST(Bisect, HalvesLoadsToWithinABlock) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto n = [&](int most) { return int(random() % unsigned(most)) + 1; };
    const auto places = box(n(12), n(12), n(12));
    const int ranks = n(9);
    std::vector<double> load;
    for (std::size_t b = 0; b < places.size(); ++b) load.push_back(random() % 3 ? double(random() % 1000) : 0);
    const auto owner = bisect(places, load, ranks);
    ASSERT_EQ(owner.size(), places.size());
    double all = 0, largest = 0;
    for (const double l : load) all += l, largest = std::max(largest, l);
    // each of the cuts that lead to a rank is off by at most half of a block
    for (const double l : loads_of(owner, load, ranks)) EXPECT_LE(std::abs(l - all / ranks), 2 * largest);
  }
}

TEST(Bisect, CutsALongBoxAcrossItsLength) {
  const auto places = box(16, 4, 4);
  const auto owner = bisect(places, std::vector<double>(places.size(), 1), 4);
  for (std::size_t b = 0; b < places.size(); ++b) EXPECT_EQ(owner[b], places[b][0] / 4);
}

TEST(Bisect, KeepsALayerOfWaterInVerticalCuts) {
  const auto places = box(8, 8, 8);
  std::vector<double> load;
  for (const auto& at : places) load.push_back(at[2] == 0 ? 100 : 0);
  const auto owner = bisect(places, load, 4);
  for (const double l : loads_of(owner, load, 4)) EXPECT_EQ(l, 1600);
}

TEST(Bisect, DividesBlocksWithoutLoadAsWell) {
  const auto places = box(4, 4, 4);
  const auto owner = bisect(places, std::vector<double>(places.size(), 0), 4);
  for (std::uint16_t r = 0; r < 4; ++r) EXPECT_EQ(std::count(owner.begin(), owner.end(), r), 16);
}

}  // namespace
}  // namespace bedload
