#include "bedload/geometry/depth.hpp"

#include "support.hpp"

namespace bedload::test {
namespace {

TEST(DepthInColumns, IsThatOfABoxForALattice) {
  std::vector<Vec3d> x;
  for (int n = 0; n < 6 * 6 * 10; ++n)
    x.push_back({0.01 * (n % 6 + 0.5), 0.01 * (n / 6 % 6 + 0.5), 0.01 * (n / 36 + 0.5)});
  const auto depth = depth_in_columns(x, {0, 0, 1}, 0.01);
  for (std::size_t a = 0; a < x.size(); ++a) EXPECT_NEAR(depth[a], 0.1 - x[a].z, 1e-15);
}

TEST(DepthInColumns, FollowsASlopingSurface) {
  std::vector<Vec3d> x;
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k <= i; ++k) x.push_back({0.01 * (i + 0.5), 0.005, 0.01 * (k + 0.5)});
  const auto depth = depth_in_columns(x, {0, 0, 1}, 0.01);
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double exact = x[a].x + 0.005 - x[a].z;
    EXPECT_GE(depth[a], exact - 1e-12);
    EXPECT_LE(depth[a], exact + 0.01 + 1e-12);  // a column is two spacings wide
  }
}

TEST(DepthInColumns, DropsDoNotWeighOnThePoolBelow) {
  const auto depth = depth_in_columns({{0, 0, 0.1}, {0, 0, 0.01}, {0, 0, 0.02}}, {0, 0, 1}, 0.01);
  EXPECT_NEAR(depth[0], 0.005, 1e-15);
  EXPECT_NEAR(depth[1], 0.015, 1e-15);
  EXPECT_NEAR(depth[2], 0.005, 1e-15);
}

TEST(DepthInColumns, GoesAlongAnyDirection) {
  const Vec3d up{0.6, 0, 0.8};
  std::vector<Vec3d> x;
  for (int k = 0; k < 5; ++k) x.push_back(up * (0.01 * k) + Vec3d{0.003, 0.004, 0.001});
  const auto depth = depth_in_columns(x, up, 0.01);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(depth[k], 0.045 - 0.01 * k, 1e-15);
}

}  // namespace
}  // namespace bedload::test
