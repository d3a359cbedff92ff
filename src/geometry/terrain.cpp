// Floors from height maps and open meshes: read, and closed below.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh.hpp"
#include "bedload/output/files.hpp"
#include "geometry/mesh_topology.hpp"
#include "geometry/text.hpp"

namespace bedload {
namespace {

std::string at(const Vec3d& x) { return fmt::format("({:g}, {:g}, {:g}) m", x.x, x.y, x.z); }

// -- ESRI ASCII grids ----------------------------------------------------------

struct GridHeader {
  long columns = 0, rows = 0;
  double x = NAN, y = NAN;  // of the corner or the centre of the lowest cell, m
  bool x_centre = false, y_centre = false;
  double dx = NAN, dy = NAN;  // m
  double none = -9999;        // stands where there is no height
};

/// Reads a line of the header; false if its first word is a number.
bool read_line(GridHeader& h, const Text& text, std::string_view key, std::string_view value) {
  const std::string word = lower(key);
  const auto number = [&] { return text.number<double>(value); };
  if (word == "ncols") return h.columns = text.number<long>(value), true;
  if (word == "nrows") return h.rows = text.number<long>(value), true;
  const bool centre = word.ends_with("llcenter");
  if (word == "xllcorner" || word == "xllcenter") return h.x = number(), h.x_centre = centre, true;
  if (word == "yllcorner" || word == "yllcenter") return h.y = number(), h.y_centre = centre, true;
  if (word == "cellsize") return h.dx = h.dy = number(), true;
  if (word == "dx") return h.dx = number(), true;
  if (word == "dy") return h.dy = number(), true;
  if (word == "nodata_value") return h.none = number(), true;
  if (std::isalpha(static_cast<unsigned char>(word[0])) && word != "nan" && word != "inf")
    text.fail(
        "its header must have ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize and "
        "perhaps nodata_value, a number behind each");
  return false;
}

void check(const GridHeader& h, const std::string& name, std::size_t bytes) {
  constexpr long most = 100000000;
  for (const auto& [key, given] : {std::pair{"ncols", h.columns > 0},
                                   {"nrows", h.rows > 0},
                                   {"xllcorner or xllcenter", std::isfinite(h.x)},
                                   {"yllcorner or yllcenter", std::isfinite(h.y)},
                                   {"cellsize", std::isfinite(h.dx) && std::isfinite(h.dy)}})
    if (!given) throw FileError(fmt::format("{}: its header has no {}", name, key));
  if (h.columns < 2 || h.rows < 2 || h.columns > most / h.rows)
    throw FileError(fmt::format("{}: {} columns and {} rows must be at least 2 each and {} heights at most",
                                name, h.columns, h.rows, most));
  if (!(h.dx > 0 && h.dy > 0))
    throw FileError(fmt::format("{}: cellsize = {:g} m must be above 0", name, std::min(h.dx, h.dy)));
  if (std::size_t(h.columns * h.rows) > bytes)
    throw FileError(fmt::format("{}: is cut off: it has no {} heights", name, h.columns * h.rows));
}

}  // namespace

TriangleSoup read_heights(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (!std::filesystem::is_regular_file(file)) throw FileError(name + ": cannot read: no such file");
  const std::string bytes = read_file(file);
  Text text(name, without_mark(bytes, name));
  GridHeader h;
  std::string_view word;
  while (text.next_line()) {
    word = text.word();
    if (word.empty()) continue;
    if (Text line = text; !read_line(h, text, word, line.word())) break;
    word = {};
  }
  check(h, name, bytes.size());

  const double x0 = h.x + (h.x_centre ? 0 : h.dx / 2), y0 = h.y + (h.y_centre ? 0 : h.dy / 2);
  TriangleSoup soup;
  soup.vertices.reserve(std::size_t(h.columns * h.rows));
  for (long row = 0; row < h.rows; ++row)
    for (long column = 0; column < h.columns; ++column) {
      while (word.empty() && text.next_line()) word = text.word();
      if (word.empty())
        throw FileError(fmt::format("{}: is cut off: it ends in row {} of {}, column {} of {}", name, row + 1,
                                    h.rows, column + 1, h.columns));
      const double z = text.number<double>(word);
      if (z == h.none)
        throw FileError(
            fmt::format("{}: row {}, column {} has no height ({:g}); cut the map or fill its gaps", name,
                        row + 1, column + 1, z));
      soup.vertices.push_back({x0 + double(column) * h.dx, y0 + double(h.rows - 1 - row) * h.dy, z});
      word = text.word();
    }
  while (word.empty() && text.next_line()) word = text.word();
  if (!word.empty()) text.fail(fmt::format("there must be {} heights; there are more", h.columns * h.rows));

  const auto vertex = [&](long row, long column) { return std::uint32_t(row * h.columns + column); };
  for (long row = 0; row + 1 < h.rows; ++row)  // from north to south
    for (long column = 0; column + 1 < h.columns; ++column) {
      const std::uint32_t nw = vertex(row, column), ne = nw + 1, sw = vertex(row + 1, column), se = sw + 1;
      soup.triangles.push_back({sw, se, ne});
      soup.triangles.push_back({sw, ne, nw});
    }
  return soup;
}

namespace {

/// All triangles counter-clockwise from above.
void turn_upward(TriangleSoup& soup, const std::string& name) {
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Corners corners = detail::corners_of(soup, t);
    const Vec3d n = unit_normal(corners);
    if (std::abs(n.z) < 1e-6)
      throw CaseError(
          fmt::format("{}: the triangle at {} is vertical; a terrain must have one height at each place",
                      name, at((corners[0] + corners[1] + corners[2]) / 3)));
    if (n.z < 0) std::swap(soup.triangles[t][1], soup.triangles[t][2]);
  }
}

/// From each vertex of the outline to the next, the surface to the left.
std::map<std::uint32_t, std::uint32_t> outline_of(const TriangleSoup& soup, const std::string& name) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : soup.triangles)
    for (int k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  if (const auto fold = std::adjacent_find(edges.begin(), edges.end()); fold != edges.end())
    throw CaseError(
        fmt::format("{}: the surface overhangs at {}; a terrain must have one height at each place", name,
                    at(soup.vertices[fold->first])));
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [a, b] : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::pair{b, a}) && !next.emplace(a, b).second)
      throw CaseError(
          fmt::format("{}: the outline of the surface touches itself at {}", name, at(soup.vertices[a])));

  std::set<std::uint32_t> seen;  // a surface whose triangles all face upward has an outline
  for (std::uint32_t v = next.begin()->first; seen.insert(v).second;) v = next.at(v);
  for (const auto& [a, b] : next)
    if (!seen.count(a))
      throw CaseError(
          fmt::format("{}: the surface must be one piece without holes; it has another outline, at {}", name,
                      at(soup.vertices[a])));
  return next;
}

}  // namespace

std::shared_ptr<const TriangleMesh> read_terrain(const std::filesystem::path& file, const FloorDepth& depth,
                                                 const MeshOptions& options) {
  const std::string name = file.string();
  TriangleSoup soup = lower(file.extension().string()) == ".asc" ? read_heights(file) : read_triangles(file);
  Bounds bounds;
  for (const Vec3d& x : soup.vertices) bounds.add(x);
  const double diagonal = norm(bounds.max - bounds.min);
  detail::weld(soup, !options.repair ? 0 : options.weld > 0 ? options.weld : 1e-6 * diagonal);
  detail::drop_degenerate(soup, 1e-9 * diagonal, options.repair, name);
  if (soup.triangles.empty()) throw CaseError(name + ": holds no triangles");
  turn_upward(soup, name);
  const auto outline = outline_of(soup, name);

  const std::uint32_t below = std::uint32_t(soup.vertices.size());
  const std::size_t triangles = soup.triangles.size();
  const double level = bounds.min.z - (depth.below > 0 ? depth.below : diagonal / 50);
  for (std::uint32_t v = 0; v < below; ++v) {
    Vec3d x = soup.vertices[v];
    x.z = depth.thickness > 0 ? x.z - depth.thickness : level;
    soup.vertices.push_back(x);
  }
  for (std::size_t k = 0; k < triangles; ++k) {
    const Triangle t = soup.triangles[k];
    soup.triangles.push_back({t[0] + below, t[2] + below, t[1] + below});
  }
  for (std::uint32_t a = 0; a < below; ++a) {
    const auto found = outline.find(a);
    if (found == outline.end()) continue;
    const std::uint32_t b = found->second;
    soup.triangles.push_back({b, a, a + below});
    soup.triangles.push_back({b, a + below, b + below});
  }
  return std::make_shared<const TriangleMesh>(std::move(soup), name, options);
}

}  // namespace bedload
