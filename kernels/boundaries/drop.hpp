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
  std::uint32_t clump = 0, member = 0;  ///< 1 + which of the new clumps, 0: none; which of its spheres
  Vec3d arm = {};                       ///< from its centre, unturned, m
  double clump_d = 0;                   ///< of the sphere of its volume, m
};

/// Up to N candidate positions for a grain or a clump: which of them overlap existing grains.
template <int N>
struct ClearanceBody {
  Frame frame;
  Vec3d place[N];
  double radius;  ///< of a clump, that of the sphere about its centre that holds it
  Span<const Vec3d> x;
  Span<const Real> radii;
  Span<const Vec4<double>> spheres = {};  ///< of a clump: places from its centre and radii, m
  BL_HD bool near(Index i, const Vec3d& at, double R) const {
    const double least = R + double(radii[i]);
    return norm2(frame.separation(x[i], at)) < least * least;
  }
  BL_HD bool touches(Index i, const Vec3d& at) const {
    if (!near(i, at, radius)) return false;
    for (Index s = 0; s < spheres.size; ++s)
      if (near(i, at + Vec3d{spheres[s].x, spheres[s].y, spheres[s].z}, spheres[s].w)) return true;
    return spheres.size == 0;
  }
  BL_HD void operator()(Index i, double* out) const {
    for (int k = 0; k < N; ++k) out[k] = touches(i, place[k]) ? 1 : 0;
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
  Index clumps;               ///< how many there were
  Span<std::uint32_t> clump;  ///< may be empty, as what follows
  Span<std::uint32_t> member;
  Span<Vec3d> arm;
  Span<Real> clump_d;
  BL_HD void operator()(Index k) const {
    const Index i = place + k;
    id[i] = first + k;
    x[i] = grain[k].x;
    v[i] = Real3(grain[k].v);
    radius[i] = Real(grain[k].radius);
    eps[i] = 1;
    if (material) material[i] = grain[k].material;
    source_index[i] = kNone;
    if (clump_d) clump_d[i] = Real(grain[k].clump_d);
    if (!clump) return;
    clump[i] = grain[k].clump > 0 ? clumps + grain[k].clump : 0;
    member[i] = grain[k].member;
    arm[i] = grain[k].arm;
  }
};

}  // namespace BL_SOLVER
