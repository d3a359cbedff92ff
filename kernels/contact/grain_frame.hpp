#pragma once
#include "bedload/core/frame.hpp"
#include "bedload/core/mean_shear.hpp"

namespace BL_SOLVER {

/// Where grains are: in a sheared box its images across z move along x.
struct GrainFrame : Frame {
  MeanShear shear;

  GrainFrame() = default;
  GrainFrame(const Frame& frame, const MeanShear& of = {}) : Frame(frame), shear(of) {}

  /// a - b of the nearest images.
  BL_HD Vec3d separation(Vec3d a, const Vec3d& b) const {
    if (shear.acts()) {
      const double by = periods(a, b) * shear.height;
      a.z -= by, a.x -= by * shear.strain;
    }
    return Frame::separation(a, b);
  }
  /// Velocity of the image of b that is the nearest to a.
  BL_HD Real3 seen(Real3 v_b, const Vec3d& a, const Vec3d& b) const {
    if (shear.acts()) v_b.x += Real(periods(a, b) * shear.height * shear.rate);
    return v_b;
  }
  /// Where a grain is sorted and looked for, and the most that distances may be longer there.
  BL_HD Vec3d listed(const Vec3d& x) const { return shear.acts() ? shear.lattice(x) : x; }
  double stretch() const { return shear.acts() ? shear.stretch() : 1; }

 private:
  BL_HD double periods(const Vec3d& a, const Vec3d& b) const {
    using std::rint;
    return rint((a.z - b.z) / shear.height);
  }
};

}  // namespace BL_SOLVER
