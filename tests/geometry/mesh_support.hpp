#pragma once
// Triangle meshes made for tests.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <utility>

#include "bedload/geometry/mesh.hpp"
#include "shape_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::test {

/// What a polygon (x, y), counter-clockwise, sweeps from z = 0 to `height`; `split` lists its triangles.
inline TriangleSoup prism(const std::vector<std::pair<double, double>>& polygon,
                          const std::vector<Triangle>& split, double height) {
  TriangleSoup soup;
  const std::uint32_t n = std::uint32_t(polygon.size());
  for (const double z : {0.0, height})
    for (const auto& [x, y] : polygon) soup.vertices.push_back({x, y, z});
  for (const Triangle& t : split) {
    soup.triangles.push_back({t[0], t[2], t[1]});
    soup.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    soup.triangles.push_back({k, next, next + n});
    soup.triangles.push_back({k, next + n, k + n});
  }
  return soup;
}

/// About z from 0 to `height`.
inline TriangleSoup faceted_cylinder(double radius, double height, int facets) {
  std::vector<std::pair<double, double>> circle;
  std::vector<Triangle> split;
  for (int k = 0; k < facets; ++k) {
    const double angle = 2 * M_PI * k / facets;
    circle.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    if (k >= 2) split.push_back({0, std::uint32_t(k - 1), std::uint32_t(k)});
  }
  return prism(circle, split, height);
}

/// From 0 to `side`.
inline TriangleSoup cube(double side = 1) {
  return prism({{0, 0}, {side, 0}, {side, side}, {0, side}}, {{0, 1, 2}, {0, 2, 3}}, side);
}

/// 2 m along x and y, 1 m high, without its quarter at large x and y.
inline TriangleSoup l_prism() {
  return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}},
               1);
}

/// Of radius 1 about the origin: an octahedron, each triangle split into four `splits` times.
inline TriangleSoup ball(int splits) {
  TriangleSoup soup{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int n = 0; n < splits; ++n) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [place, is_new] =
          middles.try_emplace(std::minmax(i, j), std::uint32_t(soup.vertices.size()));
      if (is_new) {
        const Vec3d x = soup.vertices[i] + soup.vertices[j];
        soup.vertices.push_back(x / norm(x));
      }
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [i, j, k] : soup.triangles) {
      const std::uint32_t a = middle(i, j), b = middle(j, k), c = middle(k, i);
      finer.insert(finer.end(), {{i, a, c}, {a, j, b}, {c, b, k}, {a, b, c}});
    }
    soup.triangles = finer;
  }
  return soup;
}

inline TriangleSoup moved(TriangleSoup soup, const Vec3d& by) {
  for (Vec3d& x : soup.vertices) x += by;
  return soup;
}

inline TriangleSoup inside_out(TriangleSoup soup) {
  for (Triangle& t : soup.triangles) std::swap(t[0], t[1]);
  return soup;
}

inline TriangleSoup together(TriangleSoup a, const TriangleSoup& b) {
  const std::uint32_t n = std::uint32_t(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return a;
}

inline void write_ascii_stl(const std::filesystem::path& file, const TriangleSoup& soup) {
  std::ofstream out(file);
  out.precision(9);
  out << "solid test\n";
  for (const Triangle& t : soup.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t)
      out << "vertex " << soup.vertices[v].x << " " << soup.vertices[v].y << " " << soup.vertices[v].z
          << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid test\n";
}

inline void write_stl(const std::filesystem::path& file, const TriangleSoup& soup) {
  std::ofstream out(file, std::ios::binary);
  char header[80] = "binary";
  const std::uint32_t count = std::uint32_t(soup.triangles.size());
  out.write(header, 80).write(reinterpret_cast<const char*>(&count), 4);
  for (const Triangle& t : soup.triangles) {
    std::array<float, 12> numbers{};  // a normal of zeros, then the corners
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) numbers[3 + 3 * c + k] = float(soup.vertices[t[c]][k]);
    out.write(reinterpret_cast<const char*>(numbers.data()), 48).write("\0\0", 2);
  }
}

inline void write_obj(const std::filesystem::path& file, const TriangleSoup& soup) {
  std::ofstream out(file);
  for (const Vec3d& x : soup.vertices) out << "v " << x.x << " " << x.y << " " << x.z << "\n";
  for (const Triangle& t : soup.triangles)
    out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
}

inline void write_ply(const std::filesystem::path& file, const TriangleSoup& soup) {
  std::ofstream out(file);
  out << "ply\nformat ascii 1.0\nelement vertex " << soup.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << soup.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& x : soup.vertices) out << x.x << " " << x.y << " " << x.z << "\n";
  for (const Triangle& t : soup.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
}

/// A cube in numbers of several types, with an element and lists that are not wanted.
inline std::string binary_ply(bool big) {
  std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                    "_endian 1.0\ncomment cube\nelement note 1\nproperty list uchar short what\n"
                    "element vertex 8\nproperty uchar red\nproperty double x\nproperty float y\n"
                    "property short z\nelement face 6\nproperty list uint8 uint32 vertex_index\nend_header\n";
  const auto put = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
  };
  put(std::uint8_t(2)), put(std::int16_t(-7)), put(std::int16_t(8));
  for (int v = 0; v < 8; ++v)
    put(std::uint8_t(255)), put(double(v & 1)), put(float(v >> 1 & 1)), put(std::int16_t(v >> 2));
  for (const auto& face :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}) {
    put(std::uint8_t(4));
    for (const int v : face) put(std::uint32_t(v));
  }
  return out;
}

}  // namespace bedload::test
