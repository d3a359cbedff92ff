// Floors from height maps and open meshes.

#include <fmt/format.h>

#include <fstream>

#include "bedload/case/read.hpp"
#include "bedload/geometry/setup.hpp"
#include "mesh_support.hpp"

namespace bedload::test {
namespace {

constexpr double kRound = 1e-12;  // m, on surfaces of a few m

/// Three columns 2 m apart and two rows, the northern one first.
const char* const kMap =
    "ncols 3\nnrows 2\nxllcenter 10\nyllcenter 20\ncellsize 2\nNODATA_value -9999\n3 4 6\n1 2 3\n";

void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

std::string with(const std::string& from, const std::string& to) {
  std::string text = kMap;
  return text.replace(text.find(from), from.size(), to);
}

TEST(Terrain, RunsThroughTheHeightsOfItsMap) {
  const TemporaryFolder folder;
  write(folder / "map.asc", kMap);
  const auto floor = read_terrain(folder / "map.asc", {.thickness = 0.5});
  for (const Vec3d& x : {Vec3d{10, 20, 1}, {12, 20, 2}, {14, 20, 3}, {10, 22, 3}, {12, 22, 4}, {14, 22, 6}})
    EXPECT_NEAR(floor->distance(x), 0, kRound);
  EXPECT_LT(floor->distance({11, 21, 2.4}), 0) << "2.5 m high in the middle of a cell";
  EXPECT_GT(floor->distance({11, 21, 2.6}), 0);
  EXPECT_GT(floor->distance({11, 21, 1.9}), 0) << "below";
  EXPECT_NEAR(floor->volume(), 0.5 * 4 * 2, kRound) << "as thick everywhere along the vertical";
}

TEST(Terrain, IsSolidDownToALevel) {
  const TemporaryFolder folder;
  write(folder / "map.asc", kMap);
  const auto floor = read_terrain(folder / "map.asc", {.below = 0.5});
  EXPECT_NEAR(floor->volume(), 2 * (7 + 8 + 11 + 12) / 3.0 - 0.5 * 8, kRound)
      << "of four prisms, down to z = 0.5";
  EXPECT_LT(floor->distance({11, 21, 0.6}), 0);
  EXPECT_NEAR(floor->bounds().min.z, 0.5, kRound);
}

TEST(Terrain, GridsBeginAtACornerOrACentre) {
  const TemporaryFolder folder;
  write(folder / "map.asc", kMap);
  const Bounds centre = read_terrain(folder / "map.asc", {.thickness = 1})->bounds();
  expect_near(centre.min, {10, 20, 0}, kRound);
  expect_near(centre.max, {14, 22, 6}, kRound);
  write(folder / "map.ASC", with("xllcenter 10\nyllcenter 20", "XLLCORNER 10\r\nyllcorner 20"));
  expect_near(read_terrain(folder / "map.ASC", {.thickness = 1})->bounds().min, {11, 21, 0}, kRound);
  write(folder / "map.asc", with("cellsize 2", "dx 1\ndy 3"));
  expect_near(read_terrain(folder / "map.asc", {.thickness = 1})->bounds().max, {12, 23, 6}, kRound);
  write(folder / "map.asc", with("3 4 6\n1 2 3\n", "3\n4 6 1\n\n2 3"));  // rows may be broken anywhere
  EXPECT_EQ(read_terrain(folder / "map.asc", {.thickness = 1})->vertices().size(), 12u);
}

TEST(Terrain, OpenMeshesGiveTheSameFloor) {
  const TemporaryFolder folder;
  write(folder / "map.asc", kMap);
  const TriangleSoup soup = read_heights(folder / "map.asc");
  write_stl(folder / "map.stl", soup);              // corners as often as triangles meet there
  write_obj(folder / "map.obj", inside_out(soup));  // and facing downward
  const auto floor = read_terrain(folder / "map.asc", {.thickness = 1});
  for (const char* name : {"map.stl", "map.obj"}) {
    SCOPED_TRACE(name);
    const auto mesh = read_terrain(folder / name, {.thickness = 1});
    EXPECT_NEAR(mesh->volume(), floor->volume(), 1e-6) << "floats";
    RandomPoints points(floor->bounds().grown(1));
    for (int n = 0; n < 100; ++n) {
      const Vec3d x = points();
      EXPECT_NEAR(mesh->distance(x), floor->distance(x), 1e-6);
    }
  }
}

TEST(Terrain, SaysWhatIsWrongWithAMap) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& from, const std::string& to) {
    write(folder / "map.asc", with(from, to));
    const std::string text = error_in<FileError>([&] { read_terrain(folder / "map.asc", {.thickness = 1}); });
    const std::string path = (folder / "map.asc").string();
    EXPECT_TRUE(text.starts_with(path)) << text;
    return text.substr(std::min(path.size(), text.size()));
  };
  EXPECT_EQ(error("cellsize 2\n", ""), ": its header has no cellsize");
  EXPECT_EQ(error("xllcenter 10\n", ""), ": its header has no xllcorner or xllcenter");
  EXPECT_EQ(error("ncols 3", "ncols 1"),
            ": 1 columns and 2 rows must be at least 2 each and 100000000 heights at most");
  EXPECT_EQ(error("ncols 3", "ncols 9000000000"),
            ": 9000000000 columns and 2 rows must be at least 2 each and 100000000 heights at most");
  EXPECT_EQ(error("ncols 3", "ncols 30000"), ": is cut off: it has no 60000 heights");
  EXPECT_EQ(error("cellsize 2", "cellsize 0"), ": cellsize = 0 m must be above 0");
  EXPECT_EQ(error("2 3\n", "2\n"), ": is cut off: it ends in row 2 of 2, column 3 of 3");
  EXPECT_EQ(error("1 2 3", "1 2 3 4"), ": line 8: there must be 6 heights; there are more");
  EXPECT_EQ(error("1 2 3", "1 -9999 3"),
            ": row 2, column 2 has no height (-9999); cut the map or fill its gaps");
  EXPECT_EQ(error("1 2 3", "1 two 3"), ": line 8: \"two\" must be a number");
  EXPECT_EQ(error("nrows 2", "rows 2").substr(0, 30), ": line 2: its header must have");
  write(folder / "map.tif", "II*");
  EXPECT_NE(error_in([&] {
              read_terrain(folder / "map.tif", {.thickness = 1});
            }).find("must be an STL, OBJ or PLY file"),
            std::string::npos);
}

TEST(Terrain, SaysWhatIsWrongWithASurface) {
  const TemporaryFolder folder;
  const auto error = [&](const TriangleSoup& soup) {
    write_obj(folder / "floor.obj", soup);
    return error_in([&] { read_terrain(folder / "floor.obj", {.thickness = 1}); });
  };
  const TriangleSoup flat{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(error(flat), "");
  EXPECT_NE(error(together(flat, moved(flat, {3, 0, 0}))).find("must be one piece without holes"),
            std::string::npos);
  EXPECT_NE(error(together(flat, moved(flat, {0.3, 0.2, 0.5}))).find("another outline"), std::string::npos);
  EXPECT_NE(error(cube()).find("is vertical; a terrain must have one height at each place"),
            std::string::npos);
  TriangleSoup fold = flat;
  fold.vertices[3] = {0.8, 0.1, 1};  // beyond the diagonal
  EXPECT_NE(error(fold).find("overhangs at"), std::string::npos);
  const TriangleSoup bow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_NE(error(bow).find("touches itself at (0, 0, 0) m"), std::string::npos);
  TriangleSoup ramp;  // once around and over its own beginning: no two triangles that meet overlap
  for (int k = 0; k <= 10; ++k) {
    const double angle = 0.75 * k;
    for (const double r : {1.0, 2.0})
      ramp.vertices.push_back({r * std::cos(angle), r * std::sin(angle), 0.5 * k});
    const std::uint32_t n = std::uint32_t(2 * k);
    if (k < 10) ramp.triangles.insert(ramp.triangles.end(), {{n, n + 1, n + 3}, {n, n + 3, n + 2}});
  }
  EXPECT_EQ(error(ramp), "") << "a spiral is no height map, but a solid as long as its turns lie apart";
}

/// A slope of 30 degrees: fluid above it, wall particles in it as deep as the kernel reaches.
TEST(Terrain, IsAFloorOfACase) {
  const TemporaryFolder folder;
  std::string map = "ncols 5\nnrows 3\nxllcenter 0\nyllcenter 0\ncellsize 0.03\n";
  for (int n = 0; n < 15; ++n) map += fmt::format("{} ", 0.03 * (n % 5) * std::tan(M_PI / 6));
  write(folder / "slope.asc", map);
  std::vector<std::string> warnings;
  const Config c = read_case_text(R"(
[domain]
min = [0, 0, -0.05]
max = [0.12, 0.06, 0.15]
[domain.reflect]
slip = ["x-", "x+", "y-", "y+"]
[[shape]]
name = "slope"
kind = "terrain"
file = "slope.asc"
[[wall.body]]
name = "slope"
shape = "slope"
[fluid]
dx = 0.005
[[fluid.fill]]
min = [0, 0, 0]
max = [0.12, 0.06, 0.08]
[time]
end = 1
[out]
every = 1
)",
                                  (folder / "slope.toml").string(), {}, warnings);
  EXPECT_NEAR(c.shapes[0].solid.shape->bounds().min.z, -0.015, kRound) << "as deep as the kernel reaches";
  Config again = read_case_text(resolved_toml(c), c.file, {}, warnings);
  again.file = c.file;
  EXPECT_EQ(again, c);
  const auto setup = build_setup(c, warnings);
  EXPECT_EQ(warnings, std::vector<std::string>());
  const auto height = [](const Vec3d& x) { return (x.z - x.x * std::tan(M_PI / 6)) * std::cos(M_PI / 6); };
  ASSERT_GT(setup.walls.x.size(), 3 * 24 * 12u);
  std::size_t near = 0;
  for (const Vec3d& x : setup.walls.x) {
    EXPECT_LT(height(x), -0.4 * c.fluid.dx);
    near += height(x) > -0.51 * c.fluid.dx;
  }
  EXPECT_NEAR(double(near) * c.fluid.dx * c.fluid.dx, 0.12 * 0.06 / std::cos(M_PI / 6), 0.05 * 0.12 * 0.06)
      << "the first layer is as large as the slope";
  double volume = 0;
  for (const double m : setup.fluid.mass) volume += m / c.fluid.rho0;
  EXPECT_NEAR(volume, 0.12 * 0.06 * (0.08 - 0.06 * std::tan(M_PI / 6)), 0.04 * 0.12 * 0.06 * 0.08);
  for (const Vec3d& x : setup.fluid.x) EXPECT_GT(height(x), 0.4 * c.fluid.dx);
}

}  // namespace
}  // namespace bedload::test
