#pragma once
// Insertion of single grains.

#include "bedload/core/frame.hpp"
#include "bedload/core/span.hpp"

namespace BL_SOLVER {

/// A grain to insert.
struct NewGrain {
  Vec3d x, v;         ///< m, m/s
  double radius = 0;  ///< m
  std::uint32_t material = 0;
};

/// Up to N candidate positions for a grain: which of them overlap existing grains.
template <int N>
struct ClearanceBody {
  Frame frame;
  Vec3d place[N];
  double radius;
  Span<const Vec3d> x;
  Span<const Real> radii;
  BL_HD void operator()(Index i, double* out) const {
    const double least = radius + double(radii[i]);
    for (int k = 0; k < N; ++k) out[k] = norm2(frame.separation(x[i], place[k])) < least * least ? 1 : 0;
  }
};

/// Appends new grains.
struct DropPass {
  Span<const NewGrain> grain;
  Index place;  ///< index of the first
  Id first;     ///< its id
  Span<Id> id;
  Span<Vec3d> x;
  Span<Real3> v;
  Span<Real> radius, eps;
  Span<std::uint32_t> material;  ///< may be empty
  Span<Index> source_index;
  BL_HD void operator()(Index k) const {
    const Index i = place + k;
    id[i] = first + k;
    x[i] = grain[k].x;
    v[i] = Real3(grain[k].v);
    radius[i] = Real(grain[k].radius);
    eps[i] = 1;
    if (material) material[i] = grain[k].material;
    source_index[i] = kNone;
  }
};

}  // namespace BL_SOLVER
