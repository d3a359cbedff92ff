#include "geometry/mesh_topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "bedload/core/error.hpp"

namespace bedload::detail {
namespace {

constexpr std::uint32_t kNone = ~0u;

std::string at(const Vec3d& x) { return fmt::format("({:g}, {:g}, {:g}) m", x.x, x.y, x.z); }

/// Start of edge `e` = 3 * triangle + edge, as index of a vertex.
std::uint32_t start_of(const TriangleSoup& soup, std::uint32_t e) { return soup.triangles[e / 3][e % 3]; }
std::uint32_t end_of(const TriangleSoup& soup, std::uint32_t e) {
  return soup.triangles[e / 3][(e % 3 + 1) % 3];
}

Vec3d middle_of(const TriangleSoup& soup, std::uint32_t e) {
  return 0.5 * (soup.vertices[start_of(soup, e)] + soup.vertices[end_of(soup, e)]);
}

void turn(Triangle& t) { std::swap(t[1], t[2]); }

/// Solid angle of a triangle seen from the origin, over 4 pi, after van Oosterom and Strackee (1983).
double solid_angle_fraction(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = norm(a), lb = norm(b), lc = norm(c);
  const double over = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return std::atan2(dot(a, cross(b, c)), over) / (2 * std::numbers::pi);
}

}  // namespace

Corners corners_of(const TriangleSoup& soup, std::size_t triangle) {
  const Triangle& t = soup.triangles[triangle];
  return {soup.vertices[t[0]], soup.vertices[t[1]], soup.vertices[t[2]]};
}

void weld(TriangleSoup& soup, double distance) {
  Bounds bounds;
  for (const Vec3d& v : soup.vertices) bounds.add(v);
  const double width = std::max({distance, 1e-6 * norm(bounds.max - bounds.min), 1e-300});
  const auto cell = [&](double x, int k) { return std::int64_t(std::floor((x - bounds.min[k]) / width)); };
  const auto key = [](std::int64_t i, std::int64_t j, std::int64_t k) {
    return std::uint64_t(i & 0x1fffff) << 42 | std::uint64_t(j & 0x1fffff) << 21 |
           std::uint64_t(k & 0x1fffff);
  };

  std::vector<Vec3d> kept;
  std::vector<std::uint32_t> index(soup.vertices.size(), kNone);
  std::unordered_map<std::uint64_t, std::uint32_t> first_in_cell;  // then next_in_cell from vertex to vertex
  std::vector<std::uint32_t> next_in_cell;
  const auto find = [&](const Vec3d& x) {
    // Only cells that the sphere of radius `distance` reaches.
    std::int64_t lo[3], hi[3];
    for (int k = 0; k < 3; ++k) lo[k] = cell(x[k] - distance, k), hi[k] = cell(x[k] + distance, k);
    for (std::int64_t i = lo[0]; i <= hi[0]; ++i)
      for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
        for (std::int64_t k = lo[2]; k <= hi[2]; ++k) {
          const auto found = first_in_cell.find(key(i, j, k));
          if (found == first_in_cell.end()) continue;
          for (std::uint32_t v = found->second; v != kNone; v = next_in_cell[v])
            if (norm2(kept[v] - x) <= distance * distance) return v;
        }
    return kNone;
  };
  for (Triangle& triangle : soup.triangles)
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& v = index[corner];
      const Vec3d& x = soup.vertices[corner];
      if (v == kNone) v = find(x);
      if (v == kNone) {
        v = std::uint32_t(kept.size());
        kept.push_back(x);
        const auto [place, is_new] =
            first_in_cell.try_emplace(key(cell(x.x, 0), cell(x.y, 1), cell(x.z, 2)), v);
        next_in_cell.push_back(is_new ? kNone : std::exchange(place->second, v));
      }
      corner = v;
    }
  soup.vertices = std::move(kept);
}

void drop_degenerate(TriangleSoup& soup, double height, bool repair, const std::string& name) {
  std::vector<Triangle> kept;
  std::size_t count = 0, first = 0;
  for (std::size_t t = soup.triangles.size(); t-- > 0;)
    if (least_height(corners_of(soup, t)) <= height) ++count, first = t;
  if (count == 0) return;
  if (!repair) {
    const Corners t = corners_of(soup, first);
    throw CaseError(fmt::format("{}: {} degenerate triangles, the first at {}: each must have an area", name,
                                count, at((t[0] + t[1] + t[2]) / 3)));
  }
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    if (least_height(corners_of(soup, t)) > height) kept.push_back(soup.triangles[t]);
  soup.triangles = std::move(kept);
}

std::vector<std::uint32_t> match_edges(const TriangleSoup& soup, const std::string& name) {
  struct Edge {
    std::uint32_t lower, upper, index;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * soup.triangles.size());
  for (std::uint32_t e = 0; e < 3 * soup.triangles.size(); ++e) {
    const auto [lower, upper] = std::minmax({start_of(soup, e), end_of(soup, e)});
    edges.push_back({lower, upper, e});
  }
  std::sort(edges.begin(), edges.end());

  std::vector<std::uint32_t> across(edges.size());
  std::size_t open = 0, crowded = 0;
  std::uint32_t first_open = kNone, first_crowded = kNone;
  for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
    for (end = begin + 1; end < edges.size() && edges[end].lower == edges[begin].lower &&
                          edges[end].upper == edges[begin].upper;)
      ++end;
    const std::uint32_t e = edges[begin].index;
    if (end - begin == 1) ++open, first_open = std::min(first_open, e);
    if (end - begin > 2) ++crowded, first_crowded = std::min(first_crowded, e);
    if (end - begin == 2) across[e] = edges[begin + 1].index, across[edges[begin + 1].index] = e;
  }
  if (crowded > 0)
    throw CaseError(
        fmt::format("{}: {} edges belong to more than two triangles, the first at {}: the surface must "
                    "be a manifold",
                    name, crowded, at(middle_of(soup, first_crowded))));
  if (open > 0)
    throw CaseError(fmt::format("{}: {} edges are open, the first at {}: the surface must be watertight",
                                name, open, at(middle_of(soup, first_open))));
  return across;
}

std::vector<std::uint32_t> orient_alike(TriangleSoup& soup, std::vector<std::uint32_t>& across, bool repair,
                                        const std::string& name) {
  const std::uint32_t triangles = std::uint32_t(soup.triangles.size());
  std::vector<std::uint32_t> surface(triangles, kNone), due;
  std::vector<char> turned(triangles, 0);
  std::size_t against = 0;
  std::uint32_t first_against = kNone, surfaces = 0;
  for (std::uint32_t seed = 0; seed < triangles; ++seed) {
    if (surface[seed] != kNone) continue;
    surface[seed] = surfaces;
    due.assign(1, seed);
    while (!due.empty()) {
      const std::uint32_t t = due.back();
      due.pop_back();
      for (std::uint32_t e = 3 * t; e < 3 * t + 3; ++e) {
        const std::uint32_t u = across[e] / 3;
        const bool same_direction = start_of(soup, e) == start_of(soup, across[e]);
        if (surface[u] == kNone) {
          surface[u] = surfaces;
          turned[u] = repair ? char(turned[t] ^ same_direction) : char(0);
          due.push_back(u);
        }
        // Each edge is met from both sides.
        if (e < across[e] && (turned[t] ^ turned[u]) != same_direction)
          ++against, first_against = std::min(first_against, e);
      }
    }
    ++surfaces;
  }
  if (against > 0)
    throw CaseError(
        fmt::format("{}: the orientation changes across {} edges, the first at {}: {}", name, against,
                    at(middle_of(soup, first_against)),
                    repair ? "the surface must have two sides"
                           : "all triangles must list their corners counter-clockwise seen from outside"));
  if (std::count(turned.begin(), turned.end(), 1) > 0) {
    for (std::uint32_t t = 0; t < triangles; ++t)
      if (turned[t]) turn(soup.triangles[t]);
    across = match_edges(soup, name);
  }
  return surface;
}

void check_vertices(const TriangleSoup& soup, const std::vector<std::uint32_t>& across,
                    const std::string& name) {
  std::vector<char> corner_seen(across.size(), 0), vertex_seen(soup.vertices.size(), 0);
  for (std::uint32_t corner = 0; corner < across.size(); ++corner) {
    if (corner_seen[corner]) continue;
    char& seen = vertex_seen[start_of(soup, corner)];
    if (seen)
      throw CaseError(fmt::format("{}: the surface touches itself at the vertex {}: it must be a manifold",
                                  name, at(soup.vertices[start_of(soup, corner)])));
    seen = 1;
    for (std::uint32_t c = corner; !corner_seen[c];) {  // around the vertex, from triangle to triangle
      corner_seen[c] = 1;
      const std::uint32_t e = across[c];
      c = e / 3 * 3 + (e % 3 + 1) % 3;
    }
  }
}

bool orient_outward(TriangleSoup& soup, const std::vector<std::uint32_t>& surface, bool repair,
                    const std::string& name) {
  struct Surface {
    Bounds bounds;
    double volume = 0;  // m3
    std::vector<std::uint32_t> triangles;
    bool wrong = false;
  };
  std::vector<Surface> surfaces(1 + *std::max_element(surface.begin(), surface.end()));
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    Surface& s = surfaces[surface[t]];
    s.triangles.push_back(t);
    for (const Vec3d& corner : corners_of(soup, t)) s.bounds.add(corner);
  }
  for (Surface& s : surfaces) {
    const Vec3d from = soup.vertices[soup.triangles[s.triangles[0]][0]];
    for (const std::uint32_t t : s.triangles) {
      const Corners c = corners_of(soup, t);
      s.volume += dot(c[0] - from, cross(c[1] - from, c[2] - from)) / 6;
    }
  }

  const auto is_within = [&](const Vec3d& x, const Surface& s) {
    for (int k = 0; k < 3; ++k)
      if (x[k] < s.bounds.min[k] || x[k] > s.bounds.max[k]) return false;
    double turns = 0;
    for (const std::uint32_t t : s.triangles) {
      const Corners c = corners_of(soup, t);
      turns += solid_angle_fraction(c[0] - x, c[1] - x, c[2] - x);
    }
    return std::abs(turns) > 0.5;
  };
  bool any = false;
  for (Surface& s : surfaces) {
    const Vec3d x = soup.vertices[soup.triangles[s.triangles[0]][0]];
    bool cavity = false;
    for (const Surface& other : surfaces)
      if (&other != &s && is_within(x, other)) cavity = !cavity;
    s.wrong = cavity ? s.volume > 0 : s.volume < 0;
    if (s.wrong && !repair)
      throw CaseError(
          fmt::format("{}: the surface at {} is inside out (volume {:g} m3): its triangles must list their "
                      "corners counter-clockwise seen from outside the solid",
                      name, at(x), s.volume));
    any |= s.wrong;
  }
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    if (surfaces[surface[t]].wrong) turn(soup.triangles[t]);
  return any;
}

}  // namespace bedload::detail
