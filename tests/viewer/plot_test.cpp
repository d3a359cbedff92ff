#include "src/viewer/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bedload::test {
namespace {

int pixels_of(const Image& image, const Colour& colour, int from, int to) {
  int count = 0;
  for (int y = 100; y < image.height(); ++y)  // below the legend
    for (int x = from; x < to; ++x) {
      const Colour& c = image.at(x, y);
      count += c.r == colour.r && c.g == colour.g && c.b == colour.b;
    }
  return count;
}

TEST(Plot, DrawsPointsAndLines) {
  const Colour red{1, 0, 0}, blue{0, 0, 1};
  const Curve points{"points", {0, 1, 2}, {0, std::nan(""), 4}, red};
  const Curve line{"line", {0, 2}, {0, 4}, blue, true};
  const Image image = draw({{"one", "x [m]", "y [m]", {points}}, {"two", "x [m]", "y [m]", {line}}});
  EXPECT_NEAR(pixels_of(image, red, 0, 900), 2 * M_PI * 25, 30);  // what is no number is left out
  EXPECT_EQ(pixels_of(image, red, 900, 1800), 0);
  EXPECT_GT(pixels_of(image, blue, 900, 1800), 1500);
}

TEST(Plot, TakesCurvesOfOnePoint) {
  const Colour red{1, 0, 0};
  EXPECT_GT(pixels_of(draw({{"", "", "", {{"", {3}, {3}, red}}}}), red, 0, 900), 50);
  EXPECT_EQ(pixels_of(draw({{"", "", "", {{"", {}, {}, red}}}}), red, 0, 900), 0);
}

}  // namespace
}  // namespace bedload::test
