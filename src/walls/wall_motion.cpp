#include "src/walls/wall_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "bedload/core/error.hpp"
#include "kernels/fluid/views.hpp"

namespace BL_SOLVER {
namespace {

struct PlacePass {
  Frame frame;
  WallBodies bodies;
  Span<const Vec3d> x0;
  Span<Vec3d> x;
  BL_HD void operator()(Index w) const { x[w] = frame.wrap(bodies[w].place(x0[w])); }
};

/// Of particles that bodies carry along, whose velocity is that of `moving`.
struct CarryPass {
  PlacePass place;
  WallBodies moving;
  Span<VelocityDensity<>> v_rho;
  BL_HD void operator()(Index w) const {
    place(w);
    const BodyPose& k = moving[w];
    v_rho[w] = {Real3(k.velocity(k.place(place.x0[w]))), v_rho[w].rho};
  }
};

}  // namespace

WallMotion::WallMotion(const WallMotionParameters& parameters, const FreeBodies& free)
    : walls_(parameters.walls),
      inlets_(parameters.inlets),
      free_(free),
      removed_(parameters.walls.size(), false) {
  for (int b = 0; b < walls(); ++b) walls_[b].still.free = std::uint32_t(free.place_of(b) + 1);
  coming_in_.flows = 1;
  coming_in_.volume = parameters.inlet_volume;
}

BodyPose WallMotion::pose(int body, double t) const {
  BodyPose p = body < walls() ? walls_[body].still : coming_in_;
  RigidMotion& motion = p;
  if (body >= walls()) {
    motion = inlets_[body - walls()].motion(t);
    return p;
  }
  motion = p.free ? free_.motion(int(p.free) - 1) : walls_[body].law.at(t);
  if (!p.free &&
      !std::isfinite(norm2(motion.translation) + norm2(motion.v) + norm2(motion.omega) + motion.rotation.w))
    throw SimulationFault("wall.body " + std::to_string(body + 1) +
                          ": its motion has no finite place or velocity at t = " + std::to_string(t) + " s");
  p.present = !removed_[body];
  return p;
}

bool WallMotion::moves() const {
  if (!inlets_.empty() || free_.any()) return true;
  for (int b = 0; b < walls(); ++b)
    if (!removed_[b] && walls_[b].law.moves()) return true;
  return false;
}

Span<BodyPose> WallMotion::rows(double t, double dt, int n, Rows& out) {
  std::vector<BodyPose>& rows = next_;
  rows.clear();
  for (int k = 0; k <= n; ++k)
    for (int b = 0; b < bodies(); ++b) rows.push_back(pose(b, t + dt * k / n));
  const std::size_t bytes = rows.size() * sizeof(BodyPose);
  if (out.device.size() < rows.size()) out.device.resize(rows.size() * 2);
  const Span<BodyPose> device{out.device.data(), Index(rows.size())};
  // walls at rest are where they were
  const bool there = !free_.any() && rows.size() <= out.host.size() &&
                     std::memcmp(static_cast<const void*>(rows.data()), out.host.data(), bytes) == 0;
  if (!there) {
    out.sending.copy(device.data, rows.data(), rows.size());
    out.host.swap(rows);
  }
  if (free_.any()) free_.write(device, bodies(), n + 1, t);
  return device;
}

Span<BodyPose> WallMotion::poses(double t, double dt, int n) { return rows(t, dt, n, along_); }

Span<const BodyPose> WallMotion::poses_at(double t) { return rows(t, 0, 1, at_); }

Span<const BodyPose> WallMotion::poses_in_step(double t, double back, double dt) {
  const Span<BodyPose> poses = rows(t - back, back, 1, in_step_);
  if (free_.any()) free_.write_middle(poses, dt);
  return poses;
}

double WallMotion::top_speed(double t, double dt) const {
  return std::max(prescribed_speed(t), free_.top_speed(dt));
}

double WallMotion::prescribed_speed(double t) const {
  double top = 0;
  for (const InletFlow& inlet : inlets_) top = std::max(top, norm(inlet.motion(t).v));
  for (int b = 0; b < walls(); ++b) {
    if (removed_[b] || !walls_[b].law.moves()) continue;
    const BodyPose p = pose(b, t);
    for (const Vec3d& c : walls_[b].reach) top = std::max(top, norm(p.velocity(p.place(c))));
  }
  return top;
}

double WallMotion::lowest(int body, double t, const Vec3d& up) const {
  const BodyPose p = pose(body, t);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3d& c : walls_[body].corners) least = std::min(least, dot(up, p.place(c)));
  return least;
}

void WallMotion::place(const Frame& frame, WallStore& walls, Span<const BodyPose> pose) {
  const Index n = pose.size / 2;
  const WallBodies moving{walls.body, {pose.data, n}}, placed{walls.body, {pose.data + n, n}};
  MirrorStore& images = walls.mirrors;
  for_each(walls.owned(), CarryPass{{frame, placed, walls.x0, walls.x}, moving, walls.v_rho});
  for_each(images.owned(), PlacePass{frame, placed, images.x0, images.x});
}

}  // namespace BL_SOLVER
