#pragma once
// Drag of clumps as of one sphere each: with the mean slip of their grains, at their centre of mass.

#include "kernels/bodies/clumps.hpp"

namespace BL_SOLVER {

/// Sums over the grains of a clump of what is weighted with a.w, and of the weights.
struct MemberSum {
  Vec4<double> a, b;
  BL_HD void add(const MemberSum& more) { a = sum(a, more.a), b = sum(b, more.b); }
  BL_HD static Vec4<double> sum(const Vec4<double>& a, const Vec4<double>& b) {
    return {sum_of_rounded(a.x, b.x), sum_of_rounded(a.y, b.y), sum_of_rounded(a.z, b.z),
            sum_of_rounded(a.w, b.w)};
  }
};

/// Terms of these sums, terms(i) of grain i.
template <class Terms>
struct MemberTermsPass {
  Span<const Index> grain;  ///< those of clumps
  Terms terms;
  Span<Vec4<double>> a, b;
  BL_HD void operator()(Index k) const {
    const MemberSum of = terms(grain[k]);
    a[k] = of.a, b[k] = of.b;
  }
};

/// In the order of the spheres; those that do not share their drag are left out.
struct SumMembersPass {
  ClumpPieces pieces;
  Span<const std::uint32_t> kind, shares;  ///< shares: of each kind
  Span<const Vec4<double>> a, b;
  Span<MemberSum> out;
  BL_HD void operator()(Index c) const {
    MemberSum sum;
    if (shares[kind[c]])
      for (Index slot = pieces.begin[pieces.first[c]]; slot < pieces.begin[pieces.first[c + 1]]; ++slot)
        sum.add({a[pieces.place[slot]], b[pieces.place[slot]]});
    out[c] = sum;
  }
};

/// Which grains share a clump's drag in this case, which may not be that of a checkpoint.
struct ChooseDragPass {
  Span<const std::uint32_t> clump, kind, shares;
  Span<const double> size;  ///< of clumps, m
  Span<Real> clump_d;
  BL_HD void operator()(Index i) const {
    const bool share = clump[i] > 0 && shares[kind[clump[i] - 1]];
    if (!share)
      clump_d[i] = 0;
    else if (!(clump_d[i] > 0))
      clump_d[i] = Real(size[clump[i] - 1]);
  }
};

/// a: drag coefficient times velocity of the fluid, and the coefficient; b: times its lever.
struct DragTerms {
  ClumpView all;
  Span<const Real> clump_d;  ///< > 0: the grain shares its clump's drag
  DragView drag;
  BL_HD MemberSum operator()(Index i) const {
    const double K = drag.coefficient[i];
    if (!(clump_d[i] > 0) || !(K > 0)) return {};
    const Vec3d U = K * Vec3d(drag.velocity[i]), lever = K * all.lever(i);
    return {{U.x, U.y, U.z, K}, {lever.x, lever.y, lever.z, 0}};
  }
};

/// Finds the drag of each clump for an advance.
struct BeginDragPass {
  ClumpView all;
  Span<const MemberSum> sums;
  double h;  ///< half a substep, s
  bool exponential;
  double held;  ///< time for which the clumps are held, s; 0: they move
  CentreDrag* drag;
  BL_HD void operator()(Index c) const {
    const double K = sums[c].a.w;
    CentreDrag of;
    if (K > 0) {
      of.coefficient = K;
      of.velocity = (1 / K) * sums[c].a.xyz();
      of.lever = (1 / K) * sums[c].b.xyz();
      of.slide = Relaxation(K / all.mass(c), h, exponential);
      of.impulse = held * K * of.velocity;
    }
    drag[c] = of;
  }
};

/// Gives grains their shares of what drag gave their clumps. Together they act at the centre of mass: what
/// they lack of torque is in their spin impulses.
struct ShareDragPass {
  Span<const std::uint32_t> clump;
  Span<const Real> clump_d, coefficient;
  const CentreDrag* drag;
  double duration;  ///< of the advance, s
  DragImpulses impulses;
  Span<Real3> force;
  BL_HD void operator()(Index i) const {
    if (!(clump_d[i] > 0)) return;
    const CentreDrag& of = drag[clump[i] - 1];
    if (!(of.coefficient > 0)) return;
    const Vec3d share = (coefficient[i] / of.coefficient) * of.impulse;
    impulses.linear[i] = Real3(share);
    impulses.angular[i] = Real3(Vec3d(impulses.angular[i]) - cross(of.lever, share));
    force[i] = Real3((1 / duration) * share);
  }
};

}  // namespace BL_SOLVER
