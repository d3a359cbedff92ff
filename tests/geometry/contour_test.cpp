// Triangles on the surfaces of solids.

#include "geometry/contour.hpp"

#include "mesh_support.hpp"

namespace bedload::test {
namespace {

/// The triangles as a mesh: closed, outward, nowhere through themselves.
TriangleMesh meshed(const Shape& shape, double size) {
  MeshOptions options;
  options.repair = true;
  return TriangleMesh(contour(shape, size), "contour", options);
}

/// How far vertices and middles of triangles lie from the surface at most, m.
double farthest(const TriangleMesh& mesh, const Shape& shape) {
  double far = 0;
  for (const Vec3d& x : mesh.vertices()) far = std::max(far, std::abs(shape.distance(x)));
  for (const Triangle& t : mesh.triangles()) {
    const auto& v = mesh.vertices();
    far = std::max(far, std::abs(shape.distance((v[t[0]] + v[t[1]] + v[t[2]]) / 3)));
  }
  return far;
}

TEST(Contour, KeepsEdgesAndCorners) {
  const auto box = make_box({0, 0, 0}, {0.3, 0.2, 0.1});
  const TriangleMesh straight = meshed(*box, 0.013);
  EXPECT_LT(farthest(straight, *box), 1e-9);
  EXPECT_NEAR(straight.volume(), 0.006, 1e-9);
  const auto turned = make_placed(box, {1, Quat<double>::from_rotation({0.3, 0.5, -0.2}), {}});
  const TriangleMesh askew = meshed(*turned, 0.013);
  EXPECT_LT(farthest(askew, *turned), 0.5 * 0.013) << "cut off where the raster sees two sheets in a cell";
  EXPECT_NEAR(askew.volume() / 0.006, 1, 2e-3);
}

TEST(Contour, FollowsCurvedSurfacesAndRims) {
  const auto plate = make_difference(make_box({0, 0, 0}, {0.2, 0.2, 0.02}),
                                     make_cylinder({0.1, 0.1, -1}, {0.1, 0.1, 1}, 0.03));
  const double size = 0.004;
  const TriangleMesh mesh = meshed(*plate, size);
  // chords of the bore sag by size^2 / 8 r
  EXPECT_LT(farthest(mesh, *plate), 0.15 * size);
  EXPECT_NEAR(mesh.volume() / (0.02 * (0.04 - M_PI * 9e-4)), 1, 1e-3);
  const TriangleMesh ball = meshed(*make_sphere({1, 2, 3}, 0.1), 0.01);
  EXPECT_NEAR(ball.volume() / (4.0 / 3 * M_PI * 1e-3), 1, 5e-3);
}

TEST(Contour, ClosesHoweverTheSolidLies) {
  const auto solid = make_difference(make_difference(make_box({0, 0, 0}, {0.2, 0.15, 0.05}),
                                                     make_cylinder({0.08, 0.07, -1}, {0.08, 0.07, 1}, 0.03)),
                                     make_sphere({0.2, 0.15, 0.05}, 0.06));
  RandomPoints random({{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}});
  double least = 1, most = 0;
  for (int n = 0; n < 15; ++n) {
    const auto turned = make_placed(solid, {1, Quat<double>::from_rotation(random()), random()});
    const double volume = meshed(*turned, 0.006).volume();
    least = std::min(least, volume), most = std::max(most, volume);
  }
  EXPECT_NEAR(most / least, 1, 5e-3);
}

TEST(Contour, RefusesWhatTakesTooManyCells) {
  EXPECT_EQ(
      error_in([] {
        contour(*make_box({0, 0, 0}, {1, 1, 1}), 1e-4);
      }),
      "facets of 0.0001 m on a shape of 1 x 1 x 1 m take too many cells; give a larger facet or a mesh");
}

TEST(Difference, HasASurfaceOfTriangles) {
  const auto box = make_box({0, 0, 0}, {0.2, 0.2, 0.02});
  const auto bore = make_cylinder({0.1, 0.1, -1}, {0.1, 0.1, 1}, 0.03);
  std::vector<SurfacePart> parts;
  make_difference(box, bore, 0.005)->add_parts(parts, {});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].kind, SurfacePart::Kind::mesh);
  EXPECT_NE(error_in([&] {
              make_difference(box, bore, 1e-5)->add_parts(parts, {});
            }).find("difference: with a facet of 1e-05 m, facets of 1e-05 m on a shape of"),
            std::string::npos);
}

}  // namespace
}  // namespace bedload::test
