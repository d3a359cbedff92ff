#include "bedload/geometry/packing.hpp"

#include <algorithm>
#include <atomic>
#include <numbers>
#include <numeric>

#include "bedload/core/random.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

Config grain_case(const Vec3d& size) {
  Config config = empty_case(size);
  config.grain.present = true;
  GrainFill fill;
  fill.max = size;
  config.grain.fills = {fill};
  return config;
}

double closest_gap(const Setup::Grains& grains, const DomainConfig& domain) {
  double least = INFINITY;
  for (std::size_t i = 0; i < grains.x.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(
          least, closest_pair({grains.x[i], grains.x[j]}, domain) - grains.radius[i] - grains.radius[j]);
  return least;
}

void expect_inside(const Setup::Grains& grains, const Vec3d& min, const Vec3d& max) {
  for (std::size_t i = 0; i < grains.x.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(grains.x[i][k], min[k] + grains.radius[i] - 1e-9);
      EXPECT_LE(grains.x[i][k], max[k] - grains.radius[i] + 1e-9);
    }
}

TEST(GrainPacking, RandomPlacesAreClearOfEachOtherAndTheBox) {
  Config config = grain_case({0.12, 0.1, 0.1});
  config.grain.fills[0].count = 500;  // 22 % solid
  config.grain.fills[0].velocity = {0, 0, -0.5};
  const auto grains = setup_of(config).grains;
  ASSERT_EQ(grains.x.size(), 500u);
  EXPECT_EQ(grains.v[499], (Vec3d{0, 0, -0.5}));
  EXPECT_EQ(grains.radius, std::vector<double>(500, 0.005));
  EXPECT_GE(closest_gap(grains, config.domain), 0);
  expect_inside(grains, {0, 0, 0}, {0.12, 0.1, 0.1});
}

TEST(GrainPacking, SameSeedSamePlaces) {
  Config config = grain_case({0.1, 0.1, 0.1});
  config.grain.fills[0].count = 200;
  const auto once = setup_of(config).grains.x, again = setup_of(config).grains.x;
  EXPECT_EQ(once, again);
  config.grain.seed = 2;
  EXPECT_NE(setup_of(config).grains.x, once);
}

TEST(GrainPacking, TriesTheSamePlacesAsOneAfterTheOther) {
  Config config = grain_case({0.1, 0.1, 0.1});
  config.grain.fills[0].count = 480;  // 25 % solid: most places are taken
  const auto grains = setup_of(config).grains;
  CounterRandom random(config.grain.seed, 0);
  for (int n = 1; n < 480; ++n) random.bits();  // by mixing sizes
  std::vector<Vec3d> places;
  while (places.size() < 480) {
    Vec3d x;
    for (int k = 0; k < 3; ++k) x[k] = 0.005 + random.uniform() * ((0.1 - 0.005) - 0.005);
    const bool free = std::all_of(places.begin(), places.end(),
                                  [&](const Vec3d& y) { return norm2(x - y) >= 0.01 * 0.01; });
    if (free) places.push_back(x);
  }
  EXPECT_EQ(grains.x, places);
}

TEST(GrainPacking, PlacesSpreadEvenly) {
  Config config = grain_case({0.4, 0.2, 0.2});
  config.grain.fills[0].count = 3000;
  Vec3d mean;
  const auto grains = setup_of(config).grains;
  for (const Vec3d& x : grains.x) mean += x / 3000;
  // Uniform over a length L: the mean of N has the deviation L / sqrt(12 N).
  EXPECT_NEAR(mean.x, 0.2, 4 * 0.4 / std::sqrt(12 * 3000));
  EXPECT_NEAR(mean.y, 0.1, 4 * 0.2 / std::sqrt(12 * 3000));
  EXPECT_NEAR(mean.z, 0.1, 4 * 0.2 / std::sqrt(12 * 3000));
}

TEST(GrainPacking, CountsFromMassAndPackingFraction) {
  Config config = grain_case({0.05, 0.15, 0.1});
  config.grain.d = config.grain.d_max = 0.0027;
  config.grain.fills[0].mass = 0.2;
  EXPECT_EQ(setup_of(config).grains.x.size(), 7762u);
  config.grain.fills[0].mass = 0;
  config.grain.fills[0].packing_fraction = 0.1;
  EXPECT_EQ(setup_of(config).grains.x.size(),
            std::size_t(std::round(0.1 * 7.5e-4 / (std::numbers::pi / 6 * std::pow(0.0027, 3)))));
}

TEST(GrainPacking, DenseBoxesTakeALattice) {
  Config config = grain_case({0.1, 0.1, 0.1});
  for (const int count : {700, 999, 1000}) {  // up to all cells of a lattice one diameter wide
    config.grain.fills[0].count = count;
    const auto grains = setup_of(config).grains;
    ASSERT_EQ(grains.x.size(), std::size_t(count));
    EXPECT_GE(closest_gap(grains, config.domain), -1e-12);
    expect_inside(grains, {0, 0, 0}, {0.1, 0.1, 0.1});
  }
}

TEST(GrainPacking, LatticeIsShaken) {
  Config config = grain_case({0.1, 0.1, 0.1});
  config.grain.fills[0].count = 640;
  config.grain.d = config.grain.d_max = 0.0105;
  const auto places = setup_of(config).grains.x;
  std::vector<double> heights;
  for (const Vec3d& x : places) heights.push_back(x.z);
  std::sort(heights.begin(), heights.end());
  EXPECT_EQ(std::unique(heights.begin(), heights.end()) - heights.begin(), 640);
}

TEST(GrainPacking, SaysWhatDoesNotFit) {
  Config config = grain_case({0.1, 0.1, 0.1});
  config.grain.fills[0].count = 1001;
  EXPECT_EQ(error_of(config),
            "grain.fill 1: 1001 grains of 0.01 m need at least 0.001001 m3, the space of "
            "0.001 m3 holds 1000 of them; enlarge it and let the grains settle");
  config.grain.fills[0].count = 1;
  config.grain.fills[0].max.y = 0.008;
  EXPECT_EQ(error_of(config), "grain.fill 1: a grain of 0.01 m does not fit a box 0.008 m wide along y");
  config.grain.fills[0].max.y = 0.2;
  EXPECT_EQ(error_of(config),
            "grain.fill 1: its box runs from y = 0 to 0.2 m, the domain only from 0 to 0.1 m");
  config.grain.fills[0].max.y = 0.1;
  config.grain.fills[0].count = 0;
  EXPECT_EQ(error_of(config), "grain.fill 1: holds no grain; raise its count, mass or packing_fraction");
}

/// A shape that counts how often it is looked at.
class Counted final : public Shape {
 public:
  explicit Counted(ShapePtr shape) : shape_(std::move(shape)) {}
  SurfacePoint nearest(const Vec3d& x) const override {
    ++looks;
    return shape_->nearest(x);
  }
  Bounds bounds() const override { return shape_->bounds(); }
  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    return shape_->in_frame(origin, spacing);
  }
  void add_parts(std::vector<SurfacePart>& parts, const Placement& placement) const override {
    shape_->add_parts(parts, placement);
  }
  mutable std::atomic<std::int64_t> looks{0};

 private:
  ShapePtr shape_;
};

/// Two small balls far apart: nearly all cells of the lattice are in neither.
TEST(GrainPacking, PassesOverWhereAShapeCannotBe) {
  Config config = grain_case({1, 1, 1});
  config.grain.d = config.grain.d_max = config.grain.d_min = 0.006;
  const auto counted = std::make_shared<Counted>(
      make_union({make_sphere({0.03, 0.03, 0.03}, 0.02), make_sphere({0.97, 0.97, 0.97}, 0.02)}));
  GrainFill& fill = config.grain.fills[0];
  fill.solid.shape = counted;
  fill.min = counted->bounds().min, fill.max = counted->bounds().max;
  fill.count = 100000;
  EXPECT_NE(error_of(config).find("enlarge it"), std::string::npos);
  EXPECT_LT(counted->looks, 10000000) << "100 million if each cell is looked at";
}

TEST(GrainPacking, SizesComeInTheirFractions) {
  Config config = grain_case({0.2, 0.2, 0.2});
  config.grain.d_max = 0.01;
  config.grain.fills[0].sizes = {{0.01, 1}, {0.006, 2}, {0.004, 1}};
  config.grain.fills[0].count = 400;
  const auto grains = setup_of(config).grains;
  EXPECT_EQ(std::count(grains.radius.begin(), grains.radius.end(), 0.005), 100);
  EXPECT_EQ(std::count(grains.radius.begin(), grains.radius.end(), 0.003), 200);
  EXPECT_EQ(std::count(grains.radius.begin(), grains.radius.end(), 0.002), 100);
  EXPECT_FALSE(std::is_sorted(grains.radius.rbegin(), grains.radius.rend()));
  EXPECT_GE(closest_gap(grains, config.domain), 0);
}

TEST(GrainPacking, DistributionsAreMixedAndMeetTheMass) {
  Config config = grain_case({0.1, 0.1, 0.1});
  SizeClass size;
  size.kind = "uniform", size.d_min = 0.003, size.d_max = 0.009;
  config.grain.d_min = 0.003, config.grain.d_max = 0.009;
  config.grain.fills[0].sizes = {size};
  config.grain.fills[0].mass = 0.5;
  const auto grains = setup_of(config).grains;
  double mass = 0;
  for (const double r : grains.radius) mass += 2500 * 4.0 / 3 * std::numbers::pi * r * r * r;
  EXPECT_NEAR(mass, 0.5, 4e-4);  // a mean grain weighs 0.35 g
  EXPECT_FALSE(std::is_sorted(grains.radius.begin(), grains.radius.end()));
  EXPECT_GE(closest_gap(grains, config.domain), 0);
  EXPECT_EQ(setup_of(config).grains.radius, grains.radius);
  std::vector<double> radii = grains.radius;
  std::sort(radii.begin(), radii.end());
  EXPECT_NEAR(radii[radii.size() / 2], 0.003, 1e-5);
}

TEST(GrainPacking, LargeGrainsFindTheirPlacesFirst) {
  Config config = grain_case({0.1, 0.1, 0.1});
  SizeClass size;
  size.kind = "log_normal", size.median = 0.004, size.sigma = 0.35, size.d_min = 0.002, size.d_max = 0.012;
  config.grain.d_min = 0.002, config.grain.d_max = 0.012;  // a lattice of such cells holds 512
  config.grain.fills[0].sizes = {size};
  config.grain.fills[0].packing_fraction = 0.28;
  const auto grains = setup_of(config).grains;
  EXPECT_GT(grains.x.size(), 4000u);
  EXPECT_GE(closest_gap(grains, config.domain), 0);
}

/// Denser than random places of one size are, where a lattice of the largest holds 27.
TEST(GrainPacking, FineGrainsFillTheVoidsOfCoarseOnes) {
  Config config = grain_case({0.03, 0.03, 0.03});
  config.grain.d_min = 0.002, config.grain.d_max = 0.01;
  config.grain.fills[0].sizes = {{0.01, 0.007}, {0.002, 0.993}};  // half of the volume each
  config.grain.fills[0].packing_fraction = 0.42;
  const auto grains = setup_of(config).grains;
  EXPECT_GT(grains.x.size(), 1000u);
  EXPECT_GE(closest_gap(grains, config.domain), 0);
  expect_inside(grains, {0, 0, 0}, {0.03, 0.03, 0.03});
  config.grain.fills[0].packing_fraction = 0.61;
  EXPECT_NE(
      error_of(config).find("grains of 0.002 to 0.01 m find no places at random in the space of 2.7e-05 m3; "
                            "enlarge it and let the grains settle"),
      std::string::npos)
      << error_of(config);
}

TEST(GrainPacking, KeepsClearAcrossThePeriod) {
  Config config = grain_case({0.045, 0.045, 0.1});
  config.domain.periodic = {true, true, false};
  config.grain.fills[0].count = 100;
  const auto grains = setup_of(config).grains;
  EXPECT_GE(closest_gap(grains, config.domain), 0);
  double nearest_side = 1;
  for (const Vec3d& x : grains.x) nearest_side = std::min({nearest_side, x.x, x.y});
  EXPECT_LT(nearest_side, 0.003);  // places straddle the seam
}

TEST(GrainPacking, FillsKeepClearOfEachOtherAndOfSolids) {
  for (const int count : {150, 420}) {  // random places, lattice
    Config config = grain_case({0.1, 0.1, 0.1});
    config.wall.bodies = {body("box", {0.04, 0, 0}, {0.06, 0.1, 0.03})};
    config.grain.fills[0].count = count;
    config.grain.fills.push_back(config.grain.fills[0]);
    config.grain.fills[1].count = 60;
    const auto grains = setup_of(config).grains;
    ASSERT_EQ(grains.x.size(), std::size_t(count) + 60);
    EXPECT_GE(closest_gap(grains, config.domain), -1e-12);
    for (const Vec3d& x : grains.x) {
      const Vec3d beyond{std::max({0.04 - x.x, x.x - 0.06, 0.0}), 0, std::max(x.z - 0.03, 0.0)};
      EXPECT_GE(norm(beyond), 0.005 - 1e-7);
    }
  }
}

TEST(GrainPacking, TakesGivenPlaces) {
  Config config = grain_case({0.1, 0.1, 0.1});
  config.wall.bodies = {body("tank", {0, 0, 0}, {0.1, 0.1, 0.1})};
  config.grain.fills[0].positions = {{0.05, 0.05, 0.005}, {0.05, 0.05, 0.015}};
  EXPECT_EQ(setup_of(config).grains.x, config.grain.fills[0].positions);
  config.grain.fills[0].positions[1].z = 0.01;
  EXPECT_EQ(error_of(config), "grain.fill 1: grain 2 at (0.05, 0.05, 0.01) m lies inside another grain");
  config.grain.fills[0].positions[1] = {0.098, 0.05, 0.05};
  EXPECT_EQ(error_of(config), "grain.fill 1: grain 2 at (0.098, 0.05, 0.05) m lies inside a wall");
  config.grain.fills[0].positions[1] = {0.05, 0.05, 0.2};
  EXPECT_EQ(error_of(config), "grain.fill 1: grain 2 at (0.05, 0.05, 0.2) m lies outside the domain");
}

TEST(GrainPacking, GrainsOfARigidGroupMayOverlapEachOtherAlone) {
  Config config = grain_case({0.1, 0.1, 0.1});
  GrainFill& group = config.grain.fills[0];
  group.positions = {{0.05, 0.05, 0.05}, {0.05, 0.05, 0.053}, {0.055, 0.05, 0.05}};
  EXPECT_EQ(error_of(config), "grain.fill 1: grain 2 at (0.05, 0.05, 0.053) m lies inside another grain");
  group.rigid.present = true;
  EXPECT_EQ(setup_of(config).grains.x, group.positions);
  for (const bool rigid : {false, true}) {  // a later fill overlaps none of the group's
    config.grain.fills.resize(2);
    config.grain.fills[1] = {};
    config.grain.fills[1].positions = {{0.05, 0.05, 0.058}};
    config.grain.fills[1].rigid.present = rigid;
    EXPECT_EQ(error_of(config), "grain.fill 2: grain 1 at (0.05, 0.05, 0.058) m lies inside another grain");
  }
}

}  // namespace
}  // namespace bedload::test
