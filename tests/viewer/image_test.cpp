#include "src/viewer/image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bedload/core/error.hpp"
#include "tests/output/fake_simulation.hpp"
#include "src/viewer/font.hpp"
#include "src/viewer/render.hpp"

namespace bedload::testing {
namespace {

constexpr Colour kWhite{1, 1, 1}, kRed{1, 0, 0}, kBlue{0, 0, 1}, kBlack{};

TEST(Image, ComesBackFromItsFile) {
  Image image(3, 2, kWhite);
  image.set(2, 0, kRed);
  image.set(0, 1, {0, 0.5f, 2});
  image.set(3, 0, kBlack);  // outside
  const test::TemporaryFolder folder;
  image.write_png(folder / "p.png");

  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&png, (folder / "p.png").c_str()));
  png.format = PNG_FORMAT_RGB;
  std::vector<png_byte> bytes(PNG_IMAGE_SIZE(png));
  ASSERT_TRUE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
  EXPECT_EQ(png.width, 3u);
  EXPECT_EQ(bytes, (std::vector<png_byte>{255, 255, 255, 255, 255, 255, 255, 0, 0,  //
                                          0, 128, 255, 255, 255, 255, 255, 255, 255}));
}

TEST(Image, NamesAFileThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  try {
    Image(1, 1, kWhite).write_png(folder / "none" / "p.png");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("none/p.png: cannot write: No such file"), std::string::npos)
        << error.what();
  }
}

TEST(Image, WritesText) {
  Image image(40, 12, kWhite);
  image.text(1, 1, "-I", kBlack, 1);
  EXPECT_EQ(image.at(2, 5).r, 0);  // the bar of the minus
  EXPECT_EQ(image.at(2, 4).r, 1);
  EXPECT_EQ(image.at(9, 4).r, 0);  // the stem of the I
  EXPECT_EQ(text_width("-I", 1), 12);
}

TEST(Font, HasLettersDigitsAndMarks) {
  const std::string all = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.,:-+=/()[]_%";
  std::vector<std::string> shapes;
  for (const char c : all) {
    std::string shape;
    for (int n = 0; n < kGlyphWidth * kGlyphHeight; ++n)
      shape += glyph_dot(c, n % kGlyphWidth, n / kGlyphWidth) ? '#' : '.';
    EXPECT_NE(shape.find('#'), shape.npos) << c;
    EXPECT_EQ(std::count(shapes.begin(), shapes.end(), shape), 0) << c;
    shapes.push_back(shape);
  }
  EXPECT_FALSE(glyph_dot(' ', 2, 3));
}

/// The middle pixel of a scene seen from z+.
Colour middle(Scene scene) {
  scene.min = {-1, -1, -1}, scene.max = {1, 1, 1};
  View view{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}};
  fit(view, scene, 21, 21);
  return render(scene, view, 21, 21, kWhite).at(10, 10);
}

TEST(Render, TheNearerGrainHidesTheFarther) {
  const Sphere red{{0, 0, 0.5}, 0.4, kRed}, blue{{0, 0, -0.5}, 0.4, kBlue};
  for (const auto& grains : {std::vector{red, blue}, {blue, red}}) {
    const Colour c = middle({.grains = grains, .fluid = {}, .walls = {}, .min = {}, .max = {}});
    EXPECT_GT(c.r, 0.5);
    EXPECT_LT(c.b, 0.1);
  }
}

TEST(Render, FluidVeilsGrainsTheMoreTheDeeperTheyLie) {
  const auto seen = [](double z) {
    return middle({.grains = {{{0, 0, z}, 0.1, kRed}},
                   .fluid = {{{0, 0, 0.5}, 0.1, kBlue}},
                   .walls = {},
                   .min = {},
                   .max = {}});
  };
  EXPECT_GT(seen(0.4).r, seen(-0.5).r + 0.1);
  EXPECT_GT(seen(-0.5).r, 0.1);  // still there
  EXPECT_LT(seen(0.8).b, 0.1);   // in front of the fluid
}

TEST(Render, WallsAreSeeThroughUnlessSeenAlongTheirLength) {
  std::vector<Sphere> face, edge;
  for (int n = 0; n < 400; ++n) {
    const double a = -0.95 + 0.1 * (n % 20), b = -0.95 + 0.1 * (n / 20);
    face.push_back({{a, b, 0.9}, 0.05, kBlack});
    edge.push_back({{0, a, b}, 0.05, kBlack});
  }
  const std::vector<Sphere> grain{{{0, 0, 0}, 0.3, kRed}};
  const auto seen = [](const std::vector<Sphere>& grains, const std::vector<Sphere>& walls) {
    return middle({.grains = grains, .fluid = {}, .walls = walls, .min = {}, .max = {}}).r;
  };
  EXPECT_NEAR(seen({}, face), std::exp(-0.13), 0.03);
  EXPECT_LT(seen({}, edge), 0.4);
  EXPECT_GT(seen(grain, face), 0.8 * seen(grain, {}));
  EXPECT_GT(seen(grain, edge), 0.6 * seen(grain, {}));
}

TEST(View, FitsTheSceneInPerspectiveToo) {
  Scene scene;
  scene.min = {-1, -2, 0}, scene.max = {3, 2, 1};
  for (const double distance : {0.0, 8.0}) {
    View view{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0.5}, distance};
    fit(view, scene, 200, 100);
    double left = 1e9, right = -1e9;
    for (int n = 0; n < 8; ++n) {
      const Spot at = view.place({n & 1 ? 3.0 : -1.0, n & 2 ? 2.0 : -2.0, n & 4 ? 1.0 : 0.0});
      left = std::min(left, at.x), right = std::max(right, at.x);
      EXPECT_GE(at.y, -1e-9);
      EXPECT_LE(at.y, 100 + 1e-9);
    }
    EXPECT_NEAR(left, 0, 1e-9);
    EXPECT_NEAR(right, 200, 1e-9);
  }
}

}  // namespace
}  // namespace bedload::testing
