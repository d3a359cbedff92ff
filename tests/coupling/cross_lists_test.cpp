// Neighbour lists across the phases against a search over all pairs.
#include <gtest/gtest.h>

#include <algorithm>

#include "bedload/neighbours/verlet_list.hpp"
#include "tests/support/coupled_box.hpp"

namespace BL_SOLVER {
namespace {

using Rows = std::vector<std::vector<Index>>;

Rows rows_of(const VerletList& list) {
  const HostVerletList host(list);
  Rows rows(list.rows());
  for (Index i = 0; i < list.rows(); ++i) {
    for (std::uint32_t k = 0; k < host.count[i]; ++k) rows[i].push_back(host.entry[host.view().slot(i, k)]);
    std::sort(rows[i].begin(), rows[i].end());
  }
  return rows;
}

Rows all_pairs(const Frame& frame, const std::vector<Vec3d>& a, const std::vector<Real>& skin_a,
               const std::vector<Vec3d>& b, const std::vector<Real>& skin_b, double range) {
  Rows rows(a.size());
  for (Index i = 0; i < a.size(); ++i)
    for (Index j = 0; j < b.size(); ++j) {
      const double reach = range + double(skin_a[i]) + double(skin_b[j]);
      if (norm2(frame.separation(a[i], b[j])) < reach * reach) rows[i].push_back(j);
    }
  return rows;
}

/// Half skins between a quarter of the most and the most, m.
std::vector<Real> half_skins(std::size_t n, double most, std::mt19937_64& random) {
  std::uniform_real_distribution<double> of(most / 4, most);
  std::vector<Real> skins(n);
  for (Real& skin : skins) skin = Real(of(random));
  return skins;
}

struct Case {
  bool px, py, pz;
  double cell, range;
};
class CrossLists : public testing::TestWithParam<Case> {};

TEST_P(CrossLists, HoldEveryPairInRangeOnce) {
  const Case c = GetParam();
  const Vec3d min{-1, 0, 2}, max{1, 1.3, 3};
  const Frame frame(min, max, c.px, c.py, c.pz);
  std::mt19937_64 random(3);
  Buffer<FluidPosition> fluid;
  std::vector<FluidPosition> packed;
  for (const Vec3d& x : random_points(500, min, max, random))
    packed.push_back(as_position<FluidPosition>(frame, x));
  Buffer<Vec3d> grains;
  grains.assign(random_points(70, min, max, random));
  fluid.assign(packed);

  CellGrid fluid_grid(frame, min, max, c.cell), grain_grid(frame, min, max, 1.7 * c.cell);
  const auto sorted = [&](auto& x, CellGrid& grid) {
    using P = std::remove_pointer_t<decltype(x.data())>;
    Buffer<Index> order;
    grid.sort(frame, Span<const P>(x), order);
    const auto from = x.to_host();
    std::vector<P> to;
    for (Index i : order.to_host()) to.push_back(from[i]);
    x.assign(to);
  };
  sorted(fluid, fluid_grid);
  sorted(grains, grain_grid);
  std::vector<Vec3d> fluid_at;
  for (const auto& x : fluid.to_host()) fluid_at.push_back(coordinates(frame, x));
  const auto grains_at = grains.to_host();
  const double most = 0.2 * c.range;
  const std::vector<Real> fluid_skins = half_skins(500, most, random), grain_skins(70, Real(most / 2));
  Buffer<Real> skins;
  skins.assign(fluid_skins);
  const HalfSkins of_fluid(skins, most), of_grains(most / 2);

  VerletList list;
  const CrossNear<FluidPosition, Vec3d> grains_of_fluid{
      .frame = frame, .a = fluid, .b = grains, .range = c.range, .skin_a = of_fluid, .skin_b = of_grains};
  const CrossNear<Vec3d, FluidPosition> fluid_of_grains{
      .frame = frame, .a = grains, .b = fluid, .range = c.range, .skin_a = of_grains, .skin_b = of_fluid};
  const Rows by_fluid = all_pairs(frame, fluid_at, fluid_skins, grains_at, grain_skins, c.range);
  const Rows by_grain = all_pairs(frame, grains_at, grain_skins, fluid_at, fluid_skins, c.range);
  for (unsigned bits = 0; bits <= kSliceBits; ++bits) {  // whatever number of lanes shares a row
    list.build(500, grain_grid.view(), grains_of_fluid, bits);
    EXPECT_EQ(rows_of(list), by_fluid) << bits;
    list.build(500, grain_grid.view().for_reach(2 * c.range), grains_of_fluid, bits);
    EXPECT_EQ(rows_of(list), by_fluid) << bits;
    list.build(70, fluid_grid.view(), fluid_of_grains, bits);
    EXPECT_EQ(rows_of(list), by_grain) << bits;
    list.build(70, fluid_grid.view().for_reach(2 * c.range), fluid_of_grains, bits);
    EXPECT_EQ(rows_of(list), by_grain) << bits;
  }
}

INSTANTIATE_TEST_SUITE_P(Small, CrossLists,
                         testing::Values(Case{false, false, false, 0.2, 0.21},
                                         Case{true, false, true, 0.2, 0.21},
                                         Case{true, true, true, 0.07, 0.4}, Case{true, true, true, 0.6, 0.1},
                                         Case{false, true, false, 0.35, 0.6}));

}  // namespace
}  // namespace BL_SOLVER
