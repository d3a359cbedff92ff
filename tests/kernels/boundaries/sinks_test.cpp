// Which particles leave and through which side, what is clear of a new grain, and where an orifice is.

#include <gtest/gtest.h>

#include "bedload/parallel/loops.hpp"
#include "kernels/boundaries/drop.hpp"
#include "kernels/boundaries/orifice.hpp"
#include "kernels/boundaries/sinks.hpp"
#include "src/walls/wall_geometry.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

const Frame kOpen{{0, 0, 0}, {1, 2, 3}, false, false, false};

template <class T>
Span<T> all(std::vector<T>& of) {
  return {of.data(), Index(of.size())};
}

TEST(Sides, AreNumberedInOrderAndOfSeveralTheFarthestCounts) {
  const Vec3d middle{0.5, 1, 1.5};
  EXPECT_EQ(beyond_side(kOpen, middle), 0u);
  for (std::uint32_t side = 0; side < 6; ++side) {
    const int k = int(side / 2);
    Vec3d x = middle;
    x[k] = side % 2 ? kOpen.length[k] + 0.01 : -0.01;
    EXPECT_EQ(beyond_side(kOpen, x), 1 + side);
  }
  EXPECT_EQ(beyond_side(kOpen, {-0.1, 2.3, 1}), 4u);
  EXPECT_EQ(beyond_side(kOpen, {-0.3, 2.1, 1}), 1u);
  EXPECT_EQ(beyond_side(kOpen, {0.5, 2 + kPackedRounding, 1}), 0u) << "packed positions are rounded";
  EXPECT_EQ(beyond_side(kOpen, {0.5, 2 + 4 * kPackedRounding, 1}), 4u);
  EXPECT_TRUE(outside(kOpen, {0.5, std::nan(""), 1}));
  const Frame tube{{0, 0, 0}, {1, 2, 3}, true, false, false};
  EXPECT_FALSE(outside(tube, {-0.5, 1, 1}));
}

TEST(Sinks, TakeWhatIsBeyondASideOrWithinAnOutlet) {
  const DomainConfig domain;
  const WallGeometry outlets(
      {test::body("box", {0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}), test::body("box", {0.6, 0, 0}, {1.5, 2, 3})},
      domain);
  std::vector<Vec3d> x{{0.1, 1, 1}, {0.3, 0.3, 0.3}, {0.7, 1, 1}, {1.2, 1, 1}, {0.5, 1, -0.2}, {0.5, 1, 3.1}};
  Buffer<Vec3d> places;
  places.assign(x);
  Buffer<std::uint32_t> sink(x.size());
  const auto mark = [&](bool sides) {
    for_each({0, Index(x.size())}, SinkPass<Vec3d>{kOpen, outlets.view(), sides, places, sink});
    return sink.to_host();
  };
  using Marks = std::vector<std::uint32_t>;
  EXPECT_EQ(mark(true), (Marks{kStays, kOutlet, kOutlet + 1, kOutlet + 1, kLeftDomain + 4, kLeftDomain + 5}));
  EXPECT_EQ(mark(false), (Marks{kStays, kOutlet, kOutlet + 1, kOutlet + 1, kStays, kStays}));
}

TEST(Sinks, AreTalliedByTheWayOut) {
  std::vector<std::uint32_t> sink{kStays,          kLeftDomain + 1, kOutlet,
                                  kLeftDomain + 5, kLeftDomain + 1, kOutlet + 1};
  std::vector<Real> mass{1, 2, 4, 8, 16, 32};
  double leaving = 0, sides[2 * kSides] = {}, outlet[2] = {};
  for (Index i = 0; i < sink.size(); ++i) {
    double one = 0, way[2 * kSides] = {}, through[2] = {};
    LeavingBody{all(sink)}(i, &one);
    SideTally<FluidMass>{all(sink), {all(mass)}}(i, way);
    SinkTally<FluidMass>{all(sink), kOutlet, {all(mass)}, {}}(i, through);
    leaving += one;
    for (std::uint32_t k = 0; k < 2 * kSides; ++k) sides[k] += way[k];
    for (int k = 0; k < 2; ++k) outlet[k] += through[k];
  }
  EXPECT_EQ(leaving, 5);
  for (std::uint32_t k = 0; k < kSides; ++k) {
    EXPECT_EQ(sides[2 * k], k == 1 ? 2 : k == 5 ? 1 : 0) << k;
    EXPECT_EQ(sides[2 * k + 1], k == 1 ? 18 : k == 5 ? 8 : 0) << k;
  }
  EXPECT_EQ(outlet[0], 1);
  EXPECT_EQ(outlet[1], 4);
}

/// A grain that has left through x- and then drifts past y+ is still one that left through x-.
TEST(Sinks, KnowThroughWhichSideAGrainLeftUntilItIsBack) {
  std::vector<Vec3d> x{{-0.1, 2.5, 1}, {-0.1, 2.5, 1}, {0.5, 1, 1}};
  std::vector<std::uint32_t> known{1, 0, 1};
  std::vector<Real> radius{2, 2, 2};
  MassPerR3 per_r3{};
  per_r3.one = 0.5;
  const LeftThrough side{kOpen, all(x), all(known)};
  EXPECT_EQ(side(0), 1u);
  EXPECT_EQ(side(1), 4u);
  EXPECT_EQ(side(2), 0u);
  double out[2 * kSides] = {};
  GrainSideTally<GrainMass>{side, {per_r3, all(radius)}}(1, out);
  for (std::uint32_t k = 0; k < 2 * kSides; ++k) EXPECT_EQ(out[k], k == 6 ? 1 : k == 7 ? 4 : 0) << k;
}

TEST(Drop, FindsThePlacesThatTouchAGrain) {
  const Frame tube{{0, 0, 0}, {1, 1, 1}, true, false, false};
  std::vector<Vec3d> x{{0.05, 0.5, 0.5}};
  std::vector<Real> radius{Real(0.1)};
  const ClearanceBody<4> space{
      .frame = tube,
      .place = {{0.34, 0.5, 0.5}, {0.36, 0.5, 0.5}, {0.76, 0.5, 0.5}, {0.74, 0.5, 0.5}},
      .radius = 0.2,
      .x = all(x),
      .radii = all(radius)};
  double touches[4] = {};
  space(0, touches);
  EXPECT_EQ(touches[0], 1);
  EXPECT_EQ(touches[1], 0);
  EXPECT_EQ(touches[2], 1) << "across the period";
  EXPECT_EQ(touches[3], 0);
}

TEST(Orifice, ARectangleIsAsFarAsItsNearestPoint) {
  Orifice o{};
  o.direction = {0, 0, 1};
  o.axis[0] = {1, 0, 0}, o.axis[1] = {0, 1, 0};
  o.half[0] = 0.5, o.half[1] = 0.25;
  EXPECT_DOUBLE_EQ(o.along({0.3, 0.1, -2}), -2);
  EXPECT_EQ(o.beside({0.4, -0.2, 7}), 0);
  EXPECT_DOUBLE_EQ(o.beside({-0.8, 0.2, 7}), 0.3);
  EXPECT_DOUBLE_EQ(o.beside({0.2, 0.45, 7}), 0.2);
  EXPECT_DOUBLE_EQ(o.beside({0.8, -0.65, 7}), 0.5);
  EXPECT_DOUBLE_EQ(o.distance({0.8, -0.65, 1.2}), 1.3);
  EXPECT_DOUBLE_EQ(o.distance({0.1, 0.1, -1.5}), 1.5);
}

}  // namespace
}  // namespace BL_SOLVER
