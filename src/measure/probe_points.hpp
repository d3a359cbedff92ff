#pragma once
// Probes at several points.

#include <string>
#include <utility>
#include <vector>

#include "bedload/case/config/output.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// The points of a probe, the first span fastest; one without spans.
inline std::vector<Vec3d> points_of(const ProbeConfig& p) {
  std::vector<Vec3d> out{p.at};
  for (std::size_t k = 0; k < p.span.size(); ++k) {
    const std::size_t before = out.size();
    for (int n = 1; n < int(p.count[k]); ++n)
      for (std::size_t i = 0; i < before; ++i) out.push_back(out[i] + n / (p.count[k] - 1) * p.span[k]);
  }
  return out;
}

/// What measure(probe at one point) gives for each of its points, their numbers behind the names.
template <class Measure>
std::vector<Quantity> at_each_point(const ProbeConfig& p, const Measure& measure) {
  if (p.span.empty()) return measure(p);
  std::vector<Quantity> out;
  ProbeConfig one = p;
  one.span.clear();
  const std::vector<Vec3d> points = points_of(p);
  for (std::size_t i = 0; i < points.size(); ++i) {
    one.at = points[i];
    for (Quantity& q : measure(one)) {
      q.name += '_' + std::to_string(i);
      out.push_back(std::move(q));
    }
  }
  return out;
}

}  // namespace bedload
