// Holes of filters against the grains that they are to stop.

#include "bedload/geometry/filter.hpp"

#include <cmath>

#include "support.hpp"

namespace bedload::test {
namespace {

/// A square plate of 0.2 m at z = 0 with 2 x 2 round holes of `width`, cut by cylinders of half length
/// `reach`.
ShapePtr sieve(double width, double reach = 0.1) {
  ShapePtr plate = make_box({-0.1, -0.1, -0.01}, {0.1, 0.1, 0.01});
  for (const double x : {-0.05, 0.05})
    for (const double y : {-0.05, 0.05})
      plate = make_difference(plate, make_cylinder({x, y, -reach}, {x, y, reach}, width / 2));
  return plate;
}

Passages ways(ShapePtr shape, double d) {
  return find_passages([&](const Vec3d& x) { return shape->distance(x); }, shape->bounds().grown(d), d);
}

TEST(Passages, AreHolesWiderThanTheSphere) {
  EXPECT_EQ(ways(sieve(0.03), 0.02).count, 4);
  const double width = ways(sieve(0.03), 0.02).width;
  EXPECT_GT(width, 0.9 * 0.03 - 0.0025) << "a tenth and a cell of the raster too small";
  EXPECT_LE(width, 0.03);
  EXPECT_EQ(ways(sieve(0.03), 0.032).count, 0);
  EXPECT_TRUE(ways(sieve(0.03), 0.032).seen);
  EXPECT_EQ(ways(make_sphere({}, 0.1), 0.03).count, 0);
  EXPECT_EQ(ways(make_hollow(make_sphere({}, 0.1), 0.02), 0.03).count, 0) << "a cavity is no way";
  EXPECT_EQ(ways(make_union({make_sphere({-0.1, 0, 0}, 0.05), make_sphere({0.1, 0, 0}, 0.05)}), 0.03).count,
            0)
      << "between two pieces there is a gap, but nothing to pass through";
  EXPECT_FALSE(ways(sieve(0.03), 1e-4).seen);
}

TEST(Filters, AreComparedWithTheSmallestGrain) {
  const auto warnings_of = [](ShapePtr shape, double d, bool tank) {
    Config config = empty_case({1, 1, 1});
    config.grain.present = true;
    config.grain.d = config.grain.d_min = config.grain.d_max = d;
    WallBody filter = body("filter", shape->bounds().min, shape->bounds().max);
    filter.type = "grains_only";
    filter.solid.shape = shape;
    config.wall.bodies = {filter};
    if (tank) config.wall.bodies.push_back(body("tank", {-0.1, -0.1, -0.5}, {0.1, 0.1, 0.5}));
    std::vector<std::string> warnings;
    check_filters(config, warnings);
    return warnings;
  };
  const auto holes = warnings_of(sieve(0.04), 0.02, true);
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_TRUE(
      holes[0].starts_with("wall.body \"filter\": grains of 0.02 m pass through it or past it, by 4 "
                           "openings up to 0.0"))
      << holes[0];
  EXPECT_EQ(warnings_of(sieve(0.015), 0.02, true).size(), 0u);
  // cut by tools that are hardly longer than the plate is thick
  const auto short_cut = warnings_of(sieve(0.04, 0.011), 0.02, true);
  ASSERT_EQ(short_cut.size(), 1u);
  EXPECT_NE(short_cut[0].find("by 4 openings up to 0.03"), std::string::npos) << short_cut[0];
  // a plate that fits, one with a gap to one side of the tank, one with a gap all around
  EXPECT_EQ(warnings_of(make_box({-0.1, -0.1, 0}, {0.1, 0.1, 0.02}), 0.02, true).size(), 0u);
  EXPECT_EQ(warnings_of(make_box({-0.1, -0.1, 0}, {0.07, 0.1, 0.02}), 0.02, true).size(), 1u);
  EXPECT_EQ(warnings_of(make_box({-0.07, -0.07, 0}, {0.07, 0.07, 0.02}), 0.02, true).size(), 1u);
  const auto unseen = warnings_of(make_box({-0.1, -0.1, 0}, {0.1, 0.1, 0.02}), 1e-4, true);
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_NE(unseen[0].find("not searched for openings"), unseen[0].npos) << unseen[0];
  // the bore of a ring counts unless something fills it
  EXPECT_EQ(warnings_of(make_pipe({0, 0, 0}, {0, 0, 0.02}, 0.03, 0.08, PipeEnds::open), 0.02, false).size(),
            1u);
}

}  // namespace
}  // namespace bedload::test
