#pragma once
// Bounding volume hierarchy of axis-aligned boxes.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "bedload/geometry/shape.hpp"

namespace bedload::detail {

/// Finds items by their boxes. Built from the top, each node split at the median of its items' centres along
/// their widest side; the same boxes give the same tree.
class AabbTree {
 public:
  explicit AabbTree(const std::vector<Bounds>& boxes) : items_(boxes.size()) {
    std::iota(items_.begin(), items_.end(), 0u);
    nodes_.reserve(boxes.size());
    build(boxes, 0, std::uint32_t(boxes.size()));
  }

  /// Calls visit(item), the nearer boxes first, for items whose box lies no farther from x than sqrt(limit2),
  /// which `visit` may lower.
  template <class F>
  void visit_near(const Vec3d& x, double& limit2, F visit) const {
    struct Due {
      std::uint32_t node;
      double distance2;
    };
    Due stack[kMaxDepth];
    int size = 0;
    stack[size++] = {0, distance2(nodes_[0].box, x)};
    while (size > 0) {
      const Due due = stack[--size];
      if (due.distance2 > limit2) continue;
      const Node& node = nodes_[due.node];
      for (std::uint32_t n = node.begin; n < node.end; ++n) visit(items_[n]);
      if (node.right == 0) continue;
      Due near{due.node + 1, distance2(nodes_[due.node + 1].box, x)};
      Due far{node.right, distance2(nodes_[node.right].box, x)};
      if (far.distance2 < near.distance2) std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
    }
  }

  /// Calls visit(i, j) once for each two items in nodes whose boxes meet.
  template <class F>
  void visit_pairs(F visit) const {
    visit_within(0, visit);
  }

  struct Node {
    Bounds box;
    std::uint32_t begin = 0, end = 0;  ///< leaf: its items, places in items()
    std::uint32_t right = 0;           ///< second child; the first follows its parent
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& items() const { return items_; }

 private:
  static constexpr int kLeafSize = 2, kMaxDepth = 64;

  static double distance2(const Bounds& box, const Vec3d& x) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double beyond = std::max({box.min[k] - x[k], x[k] - box.max[k], 0.0});
      sum += beyond * beyond;
    }
    return sum;
  }
  static bool meet(const Bounds& a, const Bounds& b) {
    for (int k = 0; k < 3; ++k)
      if (a.min[k] > b.max[k] || b.min[k] > a.max[k]) return false;
    return true;
  }

  std::uint32_t build(const std::vector<Bounds>& boxes, std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t index = std::uint32_t(nodes_.size());
    nodes_.emplace_back();
    Bounds box, centres;
    for (std::uint32_t n = begin; n < end; ++n) {
      const Bounds& item = boxes[items_[n]];
      box.add(item), centres.add(item.min + item.max);
    }
    nodes_[index].box = box;
    if (end - begin <= kLeafSize) {
      nodes_[index].begin = begin, nodes_[index].end = end;
      return index;
    }
    const Vec3d width = centres.max - centres.min;
    const int axis = width.x >= width.y && width.x >= width.z ? 0 : width.y >= width.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [&](std::uint32_t i, std::uint32_t j) {
                       const double ci = boxes[i].min[axis] + boxes[i].max[axis];
                       const double cj = boxes[j].min[axis] + boxes[j].max[axis];
                       return ci < cj || (ci == cj && i < j);
                     });
    build(boxes, begin, middle);
    nodes_[index].right = build(boxes, middle, end);
    return index;
  }

  template <class F>
  void visit_within(std::uint32_t node, F& visit) const {
    const Node& n = nodes_[node];
    for (std::uint32_t i = n.begin; i < n.end; ++i)
      for (std::uint32_t j = i + 1; j < n.end; ++j) visit(items_[i], items_[j]);
    if (n.right == 0) return;
    visit_within(node + 1, visit);
    visit_within(n.right, visit);
    visit_between(node + 1, n.right, visit);
  }

  template <class F>
  void visit_between(std::uint32_t a, std::uint32_t b, F& visit) const {
    const Node &na = nodes_[a], &nb = nodes_[b];
    if (!meet(na.box, nb.box)) return;
    if (na.right == 0 && nb.right == 0) {
      for (std::uint32_t i = na.begin; i < na.end; ++i)
        for (std::uint32_t j = nb.begin; j < nb.end; ++j) visit(items_[i], items_[j]);
      return;
    }
    if (nb.right == 0 ||
        (na.right != 0 && norm2(na.box.max - na.box.min) >= norm2(nb.box.max - nb.box.min))) {
      visit_between(a + 1, b, visit);
      visit_between(na.right, b, visit);
    } else {
      visit_between(a, b + 1, visit);
      visit_between(a, nb.right, visit);
    }
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace bedload::detail
