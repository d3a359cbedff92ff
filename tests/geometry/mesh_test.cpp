#include "bedload/geometry/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <random>

#include "geometry/triangle.hpp"
#include "mesh_support.hpp"

namespace bedload::test {
namespace {

constexpr double kRound = 1e-12;  // m, on bodies of about 1 m

TEST(MeshFile, EveryKindGivesTheSameSolid) {
  const TemporaryFolder folder;
  const TriangleSoup soup = l_prism();
  write_stl(folder / "a.stl", soup);
  write_ascii_stl(folder / "b.STL", soup);
  write_obj(folder / "c.obj", soup);
  write_ply(folder / "d.ply", soup);
  for (const char* name : {"a.stl", "b.STL", "c.obj", "d.ply"}) {
    SCOPED_TRACE(name);
    const auto mesh = read_mesh(folder / name);
    EXPECT_EQ(mesh->vertices().size(), 12u);
    EXPECT_EQ(mesh->triangles().size(), 20u);
    EXPECT_NEAR(mesh->volume(), 3, kRound);
    EXPECT_EQ(mesh->bounds().max, (Vec3d{2, 2, 1}));
    EXPECT_NEAR(mesh->distance({1.5, 1.5, 0.5}), 0.5, kRound);
  }
}

/// Text as it comes from other programs.
TEST(MeshFile, ReadsTextInEveryDialect) {
  const TemporaryFolder folder;
  const TriangleSoup soup = l_prism();
  const auto text_of = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  write_ascii_stl(folder / "a.stl", soup);
  write_obj(folder / "a.obj", soup);
  write_ply(folder / "a.ply", soup);
  const std::string stl = text_of("a.stl");
  const auto replaced = [](std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
      text.replace(at, what.size(), by);
    return text;
  };
  std::string capitals = stl, one_line = replaced(stl, "\n", " ");
  for (char& c : capitals) c = char(std::toupper(c));
  one_line = replaced(replaced(one_line, "endfacet", "endfacet\n"), "facet normal", "\nfacet normal");
  const std::pair<const char*, std::string> texts[] = {
      {"a.stl", stl},
      {"a.stl", " " + stl},
      {"a.stl", "\t\n" + stl},
      {"a.stl", "\xef\xbb\xbf" + stl},
      {"a.stl", replaced(stl, "\n", "\r\n")},
      {"a.stl", capitals},
      {"a.stl", replaced(replaced(stl, "endloop", "end loop"), "endfacet", "end facet")},
      {"a.stl", one_line},
      {"a.stl", "Solid vertex 1 2 3" + stl.substr(stl.find('\n'))},
      {"a.obj", "\xef\xbb\xbf" + text_of("a.obj")},
      {"a.ply", "\xef\xbb\xbf" + text_of("a.ply")},
      {"a.ply", replaced(text_of("a.ply"), "\n", "\r\n")},
  };
  for (const auto& [name, text] : texts) {
    SCOPED_TRACE(text.substr(0, 60));
    std::ofstream(folder / name, std::ios::binary) << text;
    EXPECT_NEAR(read_mesh(folder / name)->volume(), 3, kRound);
  }
  std::ofstream(folder / "a.stl", std::ios::binary) << replaced(stl, "endsolid", "");
  EXPECT_THROW(read_mesh(folder / "a.stl"), FileError);
}

TEST(MeshFile, SplitsPolygons) {
  const TemporaryFolder folder;
  std::ofstream(folder / "cube.obj")
      << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  EXPECT_EQ(read_mesh(folder / "cube.obj")->triangles().size(), 12u);
}

/// An L of six corners and depth 1 as two polygons and six quads.
TEST(MeshFile, SplitsPolygonsThatAreNotConvex) {
  const TemporaryFolder folder;
  std::ofstream(folder / "l.obj")
      << "# L\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
         "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1 # the last\n"
         "f -7/1/1 -8 -9 -10 \\\n -11 -12\r\nf 9//2 10 11 12 7 8\n"
         "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
  const auto mesh = read_mesh(folder / "l.obj");
  EXPECT_EQ(mesh->triangles().size(), 20u);
  EXPECT_NEAR(mesh->volume(), 3, kRound);
  EXPECT_NEAR(mesh->distance({1.5, 1.5, 0.5}), 0.5, kRound);
}

TEST(MeshFile, ReadsBinaryPly) {
  const TemporaryFolder folder;
  for (const bool big : {false, true}) {
    std::ofstream(folder / "cube.ply", std::ios::binary) << binary_ply(big);
    const auto mesh = read_mesh(folder / "cube.ply");
    EXPECT_EQ(mesh->triangles().size(), 12u);
    EXPECT_NEAR(mesh->volume(), 1, kRound);
  }
}

TEST(MeshFile, IsPlaced) {
  const TemporaryFolder folder;
  write_stl(folder / "l.stl", l_prism());
  MeshOptions options;
  options.placement = {0.001, Quat<double>::from_rotation({0, 0, M_PI / 2}), {1, 0, 0}};  // mm; x to y
  const auto mesh = read_mesh(folder / "l.stl", options);
  expect_near(mesh->bounds().min, {0.998, 0, 0}, kRound);
  expect_near(mesh->bounds().max, {1, 0.002, 0.001}, kRound);
  EXPECT_NEAR(mesh->volume(), 3e-9, 1e-18);
}

TEST(MeshFile, SaysWhatItCannotRead) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name) {
    const std::string text = error_in<std::runtime_error>([&] { read_mesh(folder / name); });
    const std::string path = (folder / name).string();
    EXPECT_TRUE(text.starts_with(path)) << text;
    return text.substr(path.size());
  };
  EXPECT_EQ(error("none.stl"), ": cannot read: no such file");
  std::ofstream(folder / "part.step") << "ISO-10303-21;";
  EXPECT_EQ(error("part.step"), ": must be an STL, OBJ or PLY file");
  std::ofstream(folder / "empty.stl");
  EXPECT_EQ(error("empty.stl"), ": is empty");
  std::ofstream(folder / "noise.ply") << "not a mesh at all";
  EXPECT_EQ(error("noise.ply"), ": is no PLY file: it does not begin with ply");
  std::ofstream(folder / "cut.ply") << "ply\nformat ascii 1.0\nelement vertex 4000000000\n";
  EXPECT_EQ(error("cut.ply"), ": is cut off: its header has no end_header");
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices";
  const std::string places = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  std::ofstream(folder / "joined.ply") << head << places << "3 0 1 2\n";  // the importer would never return
  EXPECT_EQ(error("joined.ply"), ": is cut off: its header has no end_header");
  std::ofstream(folder / "far.ply") << head << '\n' << places << "3 0 1 7\n";
  EXPECT_EQ(error("far.ply"), ": face 0 names vertex 7, the mesh has 3 (from 0)");
  std::ofstream(folder / "short.ply") << head << '\n' << places << "3 0 1\n";
  EXPECT_EQ(error("short.ply"), ": is cut off: it ends before its last element");
  std::ofstream(folder / "word.ply") << head << '\n' << places << "3 0 one 2\n";
  EXPECT_EQ(error("word.ply"), ": line 13: \"one\" must be a number");
  std::ofstream(folder / "many.ply") << head << "\nelement edge 99999\nproperty int a\n"
                                     << places << "3 0 1 2\n";
  EXPECT_EQ(error("many.ply"), ": is cut off: it ends before its last element");
  std::ofstream(folder / "minus.ply") << head << '\n' << places << "-3 0 1 2\n";
  EXPECT_EQ(error("minus.ply"), ": face 0 has a list of -3 numbers; at most 4096 corners");
  std::ofstream(folder / "cube.ply", std::ios::binary) << binary_ply(true).substr(0, 300);
  EXPECT_EQ(error("cube.ply"), ": is cut off: it ends before its last element");
  std::ofstream(folder / "early.obj") << "v 0 0 0\nv 1 0 0\nf 1 2 3\nv 0 1 0\n";
  EXPECT_EQ(error("early.obj"), ": line 3: a face names vertex 3; 2 stand before it (from 1)");
  std::ofstream(folder / "zero.obj") << "v 0 0 0\n\nf 1 0 -1\n";
  EXPECT_EQ(error("zero.obj"), ": line 3: a face names vertex 0; 1 stand before it (from 1)");
  std::ofstream(folder / "flat.obj") << "v 0 0\n";
  EXPECT_EQ(error("flat.obj"), ": line 1: a vertex must have three coordinates");
  std::ofstream(folder / "far.obj") << "v 0 1e999 0\n";
  EXPECT_EQ(error("far.obj"), ": line 1: \"1e999\" must be a number");
  std::ofstream(folder / "two.stl") << "solid\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendsolid\n";
  EXPECT_EQ(error("two.stl"), ": line 4: a facet must have three vertices");
  write_stl(folder / "cut.stl", cube());
  std::filesystem::resize_file(folder / "cut.stl", 300);
  const std::string cut = error("cut.stl");
  EXPECT_TRUE(cut == ": is cut off: it has no endsolid" ||
              cut == ": is cut off: its 12 triangles take 684 bytes, and it has 300")
      << cut;
  std::ofstream(folder / "line.obj") << "v 0 0 0\nv 1 0 0\nl 1 2\n";
  EXPECT_EQ(error("line.obj"), ": holds no triangles");
  TriangleSoup soup = cube();
  soup.triangles.pop_back();
  write_stl(folder / "open.stl", soup);
  EXPECT_TRUE(error("open.stl").starts_with(": 3 edges are open"));
}

std::string defect(const TriangleSoup& soup, const MeshOptions& options = {}) {
  return error_in([&] { TriangleMesh(soup, "m.stl", options); });
}

MeshOptions repaired() {
  MeshOptions options;
  options.repair = true;
  return options;
}

TEST(MeshCheck, AcceptsClosedSurfaces) {
  EXPECT_EQ(defect(cube()), "");
  EXPECT_EQ(defect(l_prism()), "");
  EXPECT_EQ(defect(ball(3)), "");
  EXPECT_EQ(defect(together(cube(), moved(cube(), {1.5, 0, 0}))), "");
}

TEST(MeshCheck, WeldsOnlyEqualVertices) {
  // Details a millionth of the whole in size, each triangle with vertices of its own as in STL files.
  TriangleSoup fine = ball(2), loose;
  for (Vec3d& x : fine.vertices) x *= 1e-3;
  const TriangleSoup soup = together(fine, moved(cube(1000), {1, 1, 1}));
  for (const Triangle& t : soup.triangles) {
    const std::uint32_t n = std::uint32_t(loose.vertices.size());
    for (const std::uint32_t v : t) loose.vertices.push_back(soup.vertices[v]);
    loose.triangles.push_back({n, n + 1, n + 2});
  }
  EXPECT_EQ(TriangleMesh(loose, "m.stl").vertices().size(), soup.vertices.size());
}

TEST(MeshCheck, Empty) { EXPECT_EQ(defect({}), "m.stl: holds no triangles"); }

TEST(MeshCheck, BadNumbers) {
  TriangleSoup soup = cube();
  soup.vertices[2].y = NAN;
  EXPECT_EQ(defect(soup), "m.stl: vertex 3 = (1, nan, 0) must be within 1e100 of the origin");
  soup.vertices[2].y = 1e150;
  EXPECT_EQ(defect(soup), "m.stl: vertex 3 = (1, 1e+150, 0) must be within 1e100 of the origin");
  soup = cube();
  soup.triangles[1][2] = 8;
  EXPECT_EQ(defect(soup), "m.stl: triangle 2 names vertex 9, there are only 8");
}

TEST(MeshCheck, DegenerateTriangles) {
  TriangleSoup soup = cube();
  soup.vertices.push_back({0.25, 0, 0});
  soup.triangles.push_back({0, 8, 1});
  soup.triangles.push_back({2, 2, 1});
  EXPECT_EQ(defect(soup),
            "m.stl: 2 degenerate triangles, the first at (0.416667, 0, 0) m: each must have an area");
  EXPECT_EQ(defect(soup, repaired()), "");
}

TEST(MeshCheck, OpenEdges) {
  TriangleSoup soup = cube();
  soup.triangles.erase(soup.triangles.begin() + 1);  // of the top
  const std::string text =
      "m.stl: 3 edges are open, the first at (0.5, 0.5, 1) m: the surface must be watertight";
  EXPECT_EQ(defect(soup), text);
  EXPECT_EQ(defect(soup, repaired()), text);
}

TEST(MeshCheck, EdgesOfMoreThanTwoTriangles) {
  TriangleSoup soup = together(cube(), moved(cube(), {1, 1, 0}));  // share one edge
  const std::string text =
      "m.stl: 1 edges belong to more than two triangles, the first at (1, 1, 0.5) m: the surface must be a "
      "manifold";
  EXPECT_EQ(defect(soup), text);
  EXPECT_EQ(defect(soup, repaired()), text);
}

TEST(MeshCheck, SharedVertices) {
  EXPECT_EQ(defect(together(cube(), moved(cube(), {1, 1, 1}))),
            "m.stl: the surface touches itself at the vertex (1, 1, 1) m: it must be a manifold");
}

TEST(MeshCheck, Orientation) {
  TriangleSoup soup = cube();
  std::swap(soup.triangles[1][0], soup.triangles[1][1]);
  EXPECT_EQ(
      defect(soup),
      "m.stl: the orientation changes across 3 edges, the first at (0.5, 0, 1) m: all triangles must list "
      "their corners counter-clockwise seen from outside");
  const TriangleMesh mesh(soup, "m.stl", repaired());
  EXPECT_NEAR(mesh.volume(), 1, kRound);
}

TEST(MeshCheck, InsideOut) {
  const TriangleSoup soup = inside_out(cube());
  EXPECT_EQ(
      defect(soup),
      "m.stl: the surface at (1, 1, 0) m is inside out (volume -1 m3): its triangles must list their corners "
      "counter-clockwise seen from outside the solid");
  EXPECT_NEAR(TriangleMesh(soup, "m.stl", repaired()).volume(), 1, kRound);
  // One of two bodies, whatever the sum of volumes.
  EXPECT_NE(
      defect(together(cube(3), moved(inside_out(cube()), {4, 0, 0}))).find("at (5, 1, 0) m is inside out"),
      std::string::npos);
}

TEST(MeshCheck, CavitiesFaceInward) {
  const TriangleSoup hollow = together(cube(3), moved(inside_out(cube()), {1, 1, 1}));
  const TriangleMesh mesh(hollow, "m.stl");
  EXPECT_NEAR(mesh.volume(), 26, 1e-11);
  EXPECT_NEAR(mesh.distance({1.5, 1.5, 1.5}), 0.5, kRound);
  EXPECT_NEAR(mesh.distance({0.5, 1.5, 1.5}), -0.5, kRound);
  const TriangleSoup wrong = together(cube(3), moved(cube(), {1, 1, 1}));
  EXPECT_NE(defect(wrong).find("at (1, 1, 1) m is inside out (volume 1 m3)"), std::string::npos);
  EXPECT_NEAR(TriangleMesh(wrong, "m.stl", repaired()).volume(), 26, 1e-11);
  // A body within the cavity faces outward again.
  EXPECT_EQ(defect(together(hollow, moved(cube(0.5), {1.2, 1.2, 1.2}))), "");
}

TEST(MeshCheck, Intersections) {
  const auto expect_crossing = [](const TriangleSoup& soup) {
    for (const MeshOptions& options : {MeshOptions{}, repaired()}) {
      const std::string text = defect(soup, options);
      EXPECT_NE(text.find("pairs of triangles intersect, the first at ("), std::string::npos) << text;
    }
  };
  expect_crossing(together(cube(), moved(cube(), {0.31, 0.42, 0.53})));
  expect_crossing(together(cube(), moved(cube(), {0.5, 0.5, 0.5})));  // corner on a diagonal
  expect_crossing(together(cube(), moved(cube(), {0.5, 0.5, 1})));    // sides lie on each other
  expect_crossing(together(cube(), moved(cube(0.5), {0.25, 0.25, -0.25})));
}

TEST(MeshCheck, FindsOneVertexPushedThrough) {
  TriangleSoup soup = ball(3);
  const auto top = std::find(soup.vertices.begin(), soup.vertices.end(), Vec3d{0, 0, 1});
  ASSERT_NE(top, soup.vertices.end());
  top->z = -0.999;  // short of the other side
  EXPECT_EQ(defect(soup), "");
  top->z = -1.001;
  EXPECT_NE(defect(soup).find("pairs of triangles intersect, the first at ("), std::string::npos);
}

TEST(MeshCheck, IntersectionCountsPairs) {
  // A needle through one side of the cube: its three sides pierce one triangle.
  TriangleSoup needle{{{0.7, 0.3, 0.5}, {0.71, 0.3, 1.5}, {0.7, 0.31, 1.5}, {0.69, 0.29, 1.5}},
                      {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
  EXPECT_EQ(defect(together(cube(), needle)).substr(0, 41), "m.stl: 3 pairs of triangles intersect, th");
}

TEST(MeshRepair, WeldsNearVertices) {
  TriangleSoup soup = cube();
  soup.vertices.push_back({1, 1, 1 + 1e-5});
  soup.triangles[1][1] = soup.triangles[1][1] == 6 ? 8 : soup.triangles[1][1];
  soup.triangles[1][2] = soup.triangles[1][2] == 6 ? 8 : soup.triangles[1][2];
  EXPECT_NE(defect(soup).find("edges are open"), std::string::npos);
  EXPECT_NE(defect(soup, repaired()).find("edges are open"),
            std::string::npos);  // beyond 1e-6 of the diagonal
  MeshOptions options = repaired();
  options.weld = 1e-4;
  EXPECT_EQ(defect(soup, options), "");
  soup.vertices.back() = {1, 1, 1 + 1e-6};
  EXPECT_EQ(defect(soup, repaired()), "");
}

TEST(MeshRepair, RefusesSurfacesWithOneSide) {
  // A Klein bottle made of a torus' grid, one seam of which is glued mirrored; welded only by its indices.
  TriangleSoup soup;
  const std::uint32_t n = 6, m = 5;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const double u = 2 * M_PI * i / n, v = 2 * M_PI * j / m;
      soup.vertices.push_back(
          {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
    }
  const auto index = [&](std::uint32_t i, std::uint32_t j) {
    return i < n ? i * m + j % m : (m - j % m) % m;
  };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      soup.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      soup.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  const std::string text = defect(soup, repaired());
  EXPECT_NE(text.find("the surface must have two sides"), std::string::npos) << text;
}

// Distances.

/// How many times the surface goes round x, by solid angles: 1 inside, 0 outside.
double winding_number(const TriangleMesh& mesh, const Vec3d& x) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles()) {
    const Vec3d a = mesh.vertices()[t[0]] - x, b = mesh.vertices()[t[1]] - x, c = mesh.vertices()[t[2]] - x;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum +=
        2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * M_PI);
}

Corners corners(const TriangleMesh& mesh, std::size_t t) {
  const Triangle& triangle = mesh.triangles()[t];
  return {mesh.vertices()[triangle[0]], mesh.vertices()[triangle[1]], mesh.vertices()[triangle[2]]};
}

/// Against all triangles one by one; the sign against the winding number.
void expect_all_triangles_agree(const TriangleMesh& mesh, const Vec3d& x) {
  double least2 = INFINITY;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t)
    least2 = std::min(least2, nearest_on(corners(mesh, t), x).distance2);
  const SurfacePoint s = mesh.nearest(x);
  EXPECT_NEAR(std::abs(s.distance), std::sqrt(least2), kRound);
  // at an edge or a corner one of several
  EXPECT_NEAR(std::sqrt(nearest_on(corners(mesh, mesh.nearest_triangle(x)), x).distance2), std::sqrt(least2),
              kRound);
  EXPECT_NEAR(norm(x - s.point), std::abs(s.distance), kRound);
  if (std::abs(s.distance) > 1e-9) {
    EXPECT_EQ(s.distance<0, winding_number(mesh, x)> 0.5) << x.x << " " << x.y << " " << x.z;
    expect_near(s.normal, (x - s.point) / s.distance, 1e-6);
  }
}

TEST(TrianglePoint, MatchesASampleOfTheTriangle) {
  RandomPoints random({{-1, -1, -1}, {1, 1, 1}});
  std::array<int, 3> features{};
  for (int n = 0; n < 300; ++n) {
    const Corners t{0.5 * random(), 0.5 * random(), 0.5 * random()};
    const Vec3d x = random();
    const TrianglePoint p = nearest_on(t, x);
    ++features[int(p.feature)];
    EXPECT_NEAR(std::sqrt(p.distance2), norm(x - p.point), kRound);
    double least = INFINITY;
    const int steps = 60;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j)
        least = std::min(least, norm(x - (t[0] + (double(i) / steps) * (t[1] - t[0]) +
                                          (double(j) / steps) * (t[2] - t[0]))));
    EXPECT_LE(std::sqrt(p.distance2), least + kRound);
    EXPECT_GE(std::sqrt(p.distance2), least - 2.0 / steps);
    // It belongs to the triangle: weights of the area are positive and add up.
    const Vec3d area = area_vector(t);
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double weight = dot(cross(t[(k + 1) % 3] - t[k], p.point - t[k]), area) / norm2(area);
      EXPECT_GE(weight, -1e-9);
      sum += weight;
    }
    EXPECT_NEAR(sum, 1, 1e-9);
    if (p.feature == Feature::vertex) {
      EXPECT_EQ(p.point, t[p.index]);
    }
  }
  for (const int count : features) EXPECT_GT(count, 10);
}

TEST(MeshDistance, MatchesAllTrianglesAndTheWindingNumber) {
  for (const TriangleSoup& soup :
       {cube(), l_prism(), ball(2), together(cube(3), moved(inside_out(cube()), {1, 1, 1}))}) {
    const TriangleMesh mesh(soup, "m");
    RandomPoints random(mesh.bounds().grown(0.5)), direction({{-1, -1, -1}, {1, 1, 1}});
    for (int n = 0; n < 1000; ++n) expect_all_triangles_agree(mesh, random());
    // Close to vertices and edges, on either side, where the nearest face alone would give wrong signs.
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t)
      for (int k = 0; k < 3; ++k)
        for (int n = 0; n < 10; ++n) {
          const Corners c = corners(mesh, t);
          expect_all_triangles_agree(mesh, c[k] + 0.1 * direction());
          expect_all_triangles_agree(mesh,
                                     c[k] + (0.05 + 0.09 * n) * (c[(k + 1) % 3] - c[k]) + 0.1 * direction());
        }
  }
}

TEST(MeshDistance, SharpVertexNeedsTheAngleWeights) {
  // A thin spike: below its tip's face planes, beside the tip. Many slim triangles on one side outweigh the
  // other in a plain mean of normals.
  TriangleSoup spike{{{0, 0, 1}}, {}};
  const std::uint32_t n = 20;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = k < n - 2 ? 0.05 * k : 2.0 + 2.0 * (k - (n - 2));
    spike.vertices.push_back({0.3 * std::cos(angle), 0.3 * std::sin(angle), 0});
  }
  for (std::uint32_t k = 0; k < n; ++k) spike.triangles.push_back({0, 1 + k, 1 + (k + 1) % n});
  for (std::uint32_t k = 1; k + 1 < n; ++k) spike.triangles.push_back({1, 2 + k, 1 + k});
  const TriangleMesh mesh(spike, "m");
  RandomPoints direction({{-1, -1, -1}, {1, 1, 1}});
  for (int k = 0; k < 2000; ++k) expect_all_triangles_agree(mesh, Vec3d{0, 0, 1} + 0.1 * direction());
}

TEST(MeshDistance, IsThatOfTheSphereItApproaches) {
  const TriangleMesh mesh(ball(5), "m");
  RandomPoints random({{-2, -2, -2}, {2, 2, 2}});
  const double sagitta = 1 - std::cos(0.5 * M_PI / 2 / 32 * 1.5);  // edges are at most 1.5 of the mean long
  for (int n = 0; n < 1000; ++n) {
    const Vec3d x = random();
    EXPECT_LE(mesh.distance(x), norm(x) - 1 + 2 * sagitta);
    EXPECT_GE(mesh.distance(x), norm(x) - 1 - kRound);
  }
}

TEST(MeshDistance, IsExact) {
  expect_exact(TriangleMesh(l_prism(), "m"));
  expect_exact(*make_placed(std::make_shared<TriangleMesh>(cube(), "m"),
                            {0.3, Quat<double>::from_rotation({1, 2, 0.5}), {1, -1, 2}}));
}

TEST(MeshDistance, OnTheSurfaceTheNormalIsThatOfTheFeature) {
  const TriangleMesh mesh(cube(), "m");
  expect_near(mesh.nearest({0.3, 0.4, 1}).normal, {0, 0, 1}, kRound);
  expect_near(mesh.nearest({1, 0.4, 1}).normal, Vec3d{1, 0, 1} / std::sqrt(2), kRound);
  expect_near(mesh.nearest({1, 1, 1}).normal, Vec3d{1, 1, 1} / std::sqrt(3), kRound);
}

}  // namespace
}  // namespace bedload::test
