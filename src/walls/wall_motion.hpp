#pragma once
#include <algorithm>

#include "bedload/parallel/loops.hpp"
#include "bedload/parallel/sending.hpp"
#include "bedload/particles/walls.hpp"
#include "src/walls/free_bodies.hpp"
#include "src/walls/parameters.hpp"

namespace BL_SOLVER {

/// Moves all bodies, SPH particles and DEM surfaces by one law; poses live on the device. Free bodies are
/// where their state puts them, whatever the time. The fluid on its way through each inlet is a body too,
/// listed after the walls.
class WallMotion {
 public:
  /// `free` must outlive it.
  WallMotion(const WallMotionParameters& parameters, const FreeBodies& free);

  int walls() const { return int(walls_.size()); }
  int bodies() const { return walls() + int(inlets_.size()); }
  std::vector<InletFlow>& inlets() { return inlets_; }
  /// Whether wall particles ever change place.
  bool moves() const;
  // Poses on the device, a row of all bodies for each time; each call has separate memory, which its next
  // call overwrites.
  /// At t + k dt / n for k = 0..n, [n + 1][bodies].
  Span<BodyPose> poses(double t, double dt, int n);
  /// At t; the same row twice, as place() wants it.
  Span<const BodyPose> poses_at(double t);
  /// Two rows: at t - back, where free bodies are in the middle of the step dt that ends now, and at t.
  Span<const BodyPose> poses_in_step(double t, double back, double dt);
  /// Counts what has come through the inlets up to time t, s.
  void advance(double t) {
    for (InletFlow& inlet : inlets_) inlet.advance(t);
  }
  /// Pose of one body at time t (s), on the host.
  BodyPose pose(int body, double t) const;
  /// Largest speed of any wall point at time t, m/s; of free bodies as read back last, dt before.
  double top_speed(double t, double dt = 0) const;
  /// The same of prescribed motions alone.
  double prescribed_speed(double t) const;
  /// Places wall particles and their images and sets their true velocity; `pose`: [2][bodies], that of the
  /// velocity and that of the place.
  static void place(const Frame& frame, WallStore& walls, Span<const BodyPose> pose);
  /// The wall is gone from now on.
  void remove(int body) { removed_[body] = true; }
  bool removed(int body) const { return removed_[body]; }
  bool any_removed() const { return std::find(removed_.begin(), removed_.end(), true) != removed_.end(); }
  /// Lowest point of a wall along `up` at time t, m.
  double lowest(int body, double t, const Vec3d& up) const;

 private:
  /// Rows of poses, and what the device holds of them.
  struct Rows {
    std::vector<BodyPose> host;
    Buffer<BodyPose> device;
    Sending<BodyPose> sending;
  };
  Span<BodyPose> rows(double t, double dt, int n, Rows& out);

  std::vector<MovingWall> walls_;
  std::vector<InletFlow> inlets_;
  BodyPose coming_in_;  ///< of fluid on its way in, all but how it moves
  const FreeBodies& free_;
  std::vector<bool> removed_;
  std::vector<BodyPose> next_;
  Rows along_, at_, in_step_;
};

}  // namespace BL_SOLVER
