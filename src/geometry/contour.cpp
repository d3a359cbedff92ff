#include "geometry/contour.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "bedload/core/error.hpp"
#include "bedload/parallel/host_loop.hpp"

namespace bedload {
namespace {

constexpr double kMostCells = 5e7;
constexpr double kSharp = 0.05;  // fraction of the largest eigenvalue from which two planes make an edge
constexpr double kClear = 0.01;  // of a cell, that vertices keep from what is not theirs

class Contour {
 public:
  Contour(const Shape& shape, double size) : shape_(shape), size_(size) {
    const Bounds box = shape.bounds();
    // planes of the solid hardly ever lie in those of the raster then
    start_ = box.min - size * Vec3d{1.37, 1.41, 1.43};
    double cells = 1;
    Vec3d count;
    for (int k = 0; k < 3; ++k) {
      count[k] = std::ceil((box.max[k] - start_[k]) / size) + 2;
      cells *= count[k];
    }
    if (!(cells <= kMostCells))
      throw CaseError(
          fmt::format("facets of {:g} m on a shape of {:g} x {:g} x {:g} m take too many cells; "
                      "give a larger facet or a mesh",
                      size, box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z));
    for (int k = 0; k < 3; ++k) n_[k] = std::int64_t(count[k]);
  }

  TriangleSoup soup() {
    inside_.resize(std::size_t(n_[0]) * n_[1] * n_[2]);
    host_for_each(std::size_t(n_[2]), [&](std::size_t l) {
      for (std::int64_t j = 0; j < n_[1]; ++j)
        for (std::int64_t i = 0; i < n_[0]; ++i) {
          const Corner c{i, j, std::int64_t(l)};
          inside_[number(c)] = shape_.distance(place(c)) < 0;
        }
    });
    for (std::int64_t l = 0; l + 1 < n_[2]; ++l)
      for (std::int64_t j = 0; j + 1 < n_[1]; ++j)
        for (std::int64_t i = 0; i + 1 < n_[0]; ++i) add_cell({i, j, l});
    return std::move(soup_);
  }

 private:
  using Corner = std::array<std::int64_t, 3>;
  /// A vertex on an edge or side of the raster, and the plane that touches the surface there.
  struct Mark {
    std::uint32_t vertex;
    Vec3d x, normal;
  };
  /// Between the marks of two edges of a cell, on one of its sides.
  struct Segment {
    std::array<int, 2> edge;
    int axis;       ///< of the side
    bool straight;  ///< two of them share the side, and may not cross
  };

  std::size_t number(const Corner& c) const { return (std::size_t(c[2]) * n_[1] + c[1]) * n_[0] + c[0]; }
  Vec3d place(const Corner& c) const {
    return start_ + size_ * Vec3d{double(c[0]), double(c[1]), double(c[2])};
  }
  bool inside(const Corner& c) const { return inside_[number(c)] != 0; }
  /// Edge along axis k of a cell, at the far sides of the next axes that are 1.
  static int edge(int k, int next, int after) { return 4 * k + next + 2 * after; }

  std::uint32_t add_vertex(const Vec3d& x) {
    soup_.vertices.push_back(x);
    return std::uint32_t(soup_.vertices.size() - 1);
  }

  /// Where the surface crosses an edge of a cell.
  const Mark& crossing(const Corner& cell, int e) {
    const int k = e / 4;
    Corner from = cell, to;
    from[(k + 1) % 3] += e & 1, from[(k + 2) % 3] += e >> 1 & 1;
    to = from, ++to[k];
    const auto [found, is_new] = crossings_.try_emplace(3 * number(from) + k);
    if (!is_new) return found->second;
    const bool rises = inside(from);
    double low = 0, high = 1;
    const Vec3d a = place(from), way = place(to) - a;
    for (int n = 0; n < 45; ++n) {
      const double middle = 0.5 * (low + high);
      ((shape_.distance(a + middle * way) < 0) == rises ? low : high) = middle;
    }
    const Vec3d x = a + std::clamp(0.5 * (low + high), 0.1 * kClear, 1 - 0.1 * kClear) * way;
    return found->second = {add_vertex(x), x, shape_.nearest(x).normal};
  }

  /// From `middle` towards x, as far as the raster's cell allows.
  Vec3d within(const Corner& cell, const Vec3d& middle, const Vec3d& x) const {
    const Vec3d low = place(cell), way = x - middle;
    double part = 1;
    for (int k = 0; k < 3; ++k) {
      const double space = way[k] > 0 ? low[k] + size_ - middle[k] : middle[k] - low[k];
      if (std::abs(way[k]) > (1 - kClear) * space)
        part = std::min(part, (1 - kClear) * space / std::abs(way[k]));
    }
    return middle + part * way;
  }

  /// Nearest to the planes of all marks, among such points the nearest to their middle; on the surface where
  /// they make no edge. `flat`: an axis along which it stays, or -1.
  Vec3d meet(const Corner& cell, const std::vector<Mark>& marks, const Vec3d& middle, int flat,
             bool& sharp) const {
    Eigen::Matrix3d planes = Eigen::Matrix3d::Zero();
    Eigen::Vector3d offsets = Eigen::Vector3d::Zero();
    for (const Mark& m : marks) {
      Eigen::Vector3d u(m.normal.x, m.normal.y, m.normal.z);
      if (flat >= 0) u[flat] = 0;
      planes += u * u.transpose();
      offsets += u * dot(m.normal, m.x - middle);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(planes);
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    int rank = 0;
    for (int k = 0; k < 3; ++k) {
      if (axes.eigenvalues()[k] < kSharp * axes.eigenvalues()[2]) continue;
      const Eigen::Vector3d u = axes.eigenvectors().col(k);
      shift += u * (u.dot(offsets) / axes.eigenvalues()[k]);
      ++rank;
    }
    sharp = rank > 1;
    Vec3d x = middle + Vec3d{shift.x(), shift.y(), shift.z()};
    if (!sharp) {
      const SurfacePoint s = shape_.nearest(x);
      x -= s.distance * s.normal;
    }
    return within(cell, middle, x);
  }

  /// Lines on the sides of a cell along which the surface passes through them. Where they might go two ways,
  /// they part the corners inside the solid, in both cells of the side.
  std::vector<Segment> segments(const Corner& cell) const {
    std::vector<Segment> all;
    for (int f = 0; f < 3; ++f)
      for (int side = 0; side < 2; ++side) {
        const int u = (f + 1) % 3, v = (f + 2) % 3;
        const auto in = [&](int a, int b) {
          Corner c = cell;
          c[f] += side, c[u] += a, c[v] += b;
          return inside(c);
        };
        std::array<int, 4> cut{};
        int count = 0;
        for (int n = 0; n < 2; ++n) {
          if (in(0, n) != in(1, n)) cut[count++] = edge(u, n, side);
          if (in(n, 0) != in(n, 1)) cut[count++] = edge(v, side, n);
        }
        if (count == 2) all.push_back({{cut[0], cut[1]}, f, false});
        for (int a = 0; count == 4 && a < 2; ++a)
          for (int b = 0; b < 2; ++b)
            if (in(a, b)) all.push_back({{edge(u, b, side), edge(v, side, a)}, f, true});
      }
    return all;
  }

  /// A fan for each sheet of the surface in the cell, whose rim lies on the cell's sides.
  void add_cell(const Corner& cell) {
    int within = 0;
    for (int c = 0; c < 8; ++c)
      within += inside({cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)});
    if (within == 0 || within == 8) return;
    std::vector<Segment> rest = segments(cell);
    std::vector<std::vector<Segment>> rims;
    while (!rest.empty()) {
      std::vector<Segment> rim{rest.back()};
      rest.pop_back();
      for (int at = rim[0].edge[1]; at != rim[0].edge[0];) {
        const auto next = std::find_if(rest.begin(), rest.end(),
                                       [&](const Segment& s) { return s.edge[0] == at || s.edge[1] == at; });
        rim.push_back(*next);
        rest.erase(next);
        if (rim.back().edge[0] != at) std::swap(rim.back().edge[0], rim.back().edge[1]);
        at = rim.back().edge[1];
      }
      rims.push_back(rim);
    }
    for (const auto& rim : rims) add_fan(cell, rim, rims.size() == 1);
  }

  /// `alone`: no other fan of the cell may be crossed.
  void add_fan(const Corner& cell, const std::vector<Segment>& rim, bool alone) {
    std::vector<Mark> marks;
    for (const Segment& s : rim) marks.push_back(crossing(cell, s.edge[0]));
    bool sharp = false;
    Vec3d middle;
    for (const Mark& m : marks) middle += m.x / double(marks.size());
    const std::uint32_t tip = add_vertex(alone ? meet(cell, marks, middle, -1, sharp) : middle);
    for (std::size_t n = 0; n < rim.size(); ++n) {
      const Mark &a = marks[n], &b = marks[(n + 1) % rim.size()];
      const std::uint32_t bend = rim[n].straight ? a.vertex : bend_of(cell, rim[n], a, b);
      if (bend == a.vertex) {
        soup_.triangles.push_back({tip, a.vertex, b.vertex});
      } else {
        soup_.triangles.push_back({tip, a.vertex, bend});
        soup_.triangles.push_back({tip, bend, b.vertex});
      }
    }
  }

  /// The vertex where an edge of the solid passes a side of a cell; that of `a` if none does.
  std::uint32_t bend_of(const Corner& cell, const Segment& s, const Mark& a, const Mark& b) {
    const std::uint64_t key =
        std::uint64_t(std::min(a.vertex, b.vertex)) << 32 | std::max(a.vertex, b.vertex);
    if (const auto found = bends_.find(key); found != bends_.end()) {
      const std::uint32_t bend = found->second;
      bends_.erase(found);  // the second cell of the side has it, and no other will ask
      return bend == kNone ? a.vertex : bend;
    }
    bool sharp = false;
    const Vec3d x = meet(cell, {a, b}, 0.5 * (a.x + b.x), s.axis, sharp);
    const std::uint32_t bend = sharp ? add_vertex(x) : kNone;
    bends_[key] = bend;
    return sharp ? bend : a.vertex;
  }

  static constexpr std::uint32_t kNone = 0xffffffff;

  const Shape& shape_;
  double size_;
  Vec3d start_;
  std::array<std::int64_t, 3> n_;
  std::vector<std::uint8_t> inside_;
  TriangleSoup soup_;
  std::unordered_map<std::size_t, Mark> crossings_;
  std::unordered_map<std::uint64_t, std::uint32_t> bends_;  ///< of sides seen from one cell so far
};

}  // namespace

TriangleSoup contour(const Shape& shape, double size) { return Contour(shape, size).soup(); }

}  // namespace bedload
