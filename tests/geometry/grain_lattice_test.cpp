// Grains on sites of the fluid's lattice and in the places of fluid particles.
#include "support.hpp"

namespace bedload::test {
namespace {

/// 10 x 6 x 4 sites of 0.01 m, all of them fluid.
Config full_box() {
  Config c = empty_case({0.1, 0.06, 0.04});
  add_fill(c, {0, 0, 0}, {0.1, 0.06, 0.04});
  c.grain.present = true;
  GrainFill fill;
  fill.max = {0.1, 0.06, 0.04};
  fill.replaces_fluid = true;
  c.grain.fills = {fill};
  return c;
}

double total(const std::vector<double>& mass) {
  double sum = 0;
  for (const double m : mass) sum += m;
  return sum;
}

TEST(GrainLattice, EachSoManyAlongEveryAxis) {
  Config c = full_box();
  c.grain.fills[0].every = {5, 2, 1};
  c.grain.fills[0].spin = {0, 0, 7};
  const auto s = setup_of(c);
  ASSERT_EQ(s.grains.x.size(), 2u * 3 * 4);
  EXPECT_LT(norm(s.grains.x[0] - Vec3d{0.045, 0.015, 0.005}), 1e-12) << "four fluid particles, then a grain";
  EXPECT_EQ(s.grains.omega[23], (Vec3d{0, 0, 7}));
  EXPECT_EQ(s.fluid.x.size(), 240u - 24);
  for (const Vec3d& x : s.grains.x) EXPECT_GT(nearest(s.fluid.x, x), 0.0099);
  EXPECT_NEAR(total(s.fluid.mass), 1000 * 0.1 * 0.06 * 0.04, 1e-9) << "what is left shares the volume";
}

TEST(GrainLattice, EachSoManyOfAllSites) {
  Config c = full_box();
  c.grain.fills[0].every = {7};
  const auto s = setup_of(c);
  ASSERT_EQ(s.grains.x.size(), 240u / 7);
  EXPECT_LT(norm(s.grains.x[0] - Vec3d{0.065, 0.005, 0.005}), 1e-12);
  EXPECT_LT(norm(s.grains.x[1] - Vec3d{0.035, 0.015, 0.005}), 1e-12) << "on in the next row";
  EXPECT_LT(norm(s.grains.x[8] - Vec3d{0.025, 0.005, 0.015}), 1e-12) << "and in the next layer";
  EXPECT_EQ(s.fluid.x.size(), 240u - 34);
}

TEST(GrainLattice, RelativePlacesReplaceTheNearestFluid) {
  Config c = full_box();
  c.grain.fills[0].positions = {{0.5, 0.5, 0.5}, {0.149, 0.75, 0.6}};
  c.grain.fills[0].relative = true;
  const auto s = setup_of(c);
  ASSERT_EQ(s.grains.x.size(), 2u);
  EXPECT_LT(norm(s.grains.x[1] - Vec3d{0.0149, 0.045, 0.024}), 1e-12);
  EXPECT_EQ(s.fluid.x.size(), 238u);
  EXPECT_GT(nearest(s.fluid.x, {0.015, 0.045, 0.025}), 0.0099);
  EXPECT_EQ(s.fluid.fill, std::vector<std::uint32_t>(238, 0));
  c.grain.fills[0].replaces_fluid = false;
  EXPECT_EQ(setup_of(c).fluid.x.size(), 240u);
}

TEST(GrainLattice, RefusesGrainsWithoutFluidToReplace) {
  Config c = full_box();
  c.fluid.fills[0].max.x = 0.05;
  c.grain.fills[0].positions = {{0.08, 0.03, 0.02}};
  EXPECT_EQ(
      error_of(c),
      "grain.fill 1: no fluid particle lies within fluid.dx of its grain at (0.08, 0.03, 0.02) m that it "
      "could replace");
}

}  // namespace
}  // namespace bedload::test
