#include "src/walls/wall_motion.hpp"

#include <algorithm>
#include <cmath>

namespace bedload::inline BL_VARIANT {
namespace {

struct PlacePass {
  Frame frame;
  Span<const BodyPose> pose;
  Span<const Vec3d> x0;
  Span<const std::uint32_t> body;
  Span<Vec3d> x;
  Span<Real4> v_rho;
  BL_HD void operator()(Index i) const {
    const BodyPose& k = pose[body[i]];
    const Vec3d at = k.place(x0[i]);
    x[i] = frame.wrap(at);
    v_rho[i] = {Real3(k.velocity(at)), v_rho[i].w};
  }
};

std::vector<Vec3d> corners(const WallBody& b) {
  std::vector<Vec3d> out;
  for (int k = 0; k < 8; ++k)
    out.push_back({k & 1 ? b.max.x : b.min.x, k & 2 ? b.max.y : b.min.y, k & 4 ? b.max.z : b.min.z});
  return out;
}

}  // namespace

BodyPose pose_at(const WallBody& body, double t) {
  const MotionConfig& m = body.motion;
  BodyPose p;
  p.centre = m.centre;
  p.slip = body.slip == "slip";
  p.repulsion = body.repulsion && body.type == "adami";
  const bool moving = t >= m.start && t < m.stop;
  const double s = std::clamp(t, m.start, m.stop) - m.start;
  if (m.kind == "velocity") {
    p.translation = m.velocity * s;
    if (moving) p.v = m.velocity;
  } else if (m.kind == "oscillation") {
    const double w = 2 * 3.14159265358979323846 * m.frequency;
    p.translation = m.amplitude * std::sin(w * s);
    if (moving) {
      p.v = m.amplitude * (w * std::cos(w * s));
      p.a = m.amplitude * (-w * w * std::sin(w * s));
    }
  } else if (m.kind == "rotation") {
    p.rotation = Quat<double>::from_rotation(m.axis * (m.rate * s));
    if (moving) p.omega = m.axis * m.rate;
  }
  return p;
}

WallMotion::WallMotion(const Config& config) : config_(config), removed_(config.wall.bodies.size(), false) {}

BodyPose WallMotion::pose(int body, double t) const {
  BodyPose p = pose_at(config_.wall.bodies[body], t);
  if (removed_[body]) p.present = 0;
  return p;
}

Span<const BodyPose> WallMotion::poses(double t, double dt, int n) {
  host_.clear();
  for (int k = 0; k <= n; ++k)
    for (int b = 0; b < bodies(); ++b) host_.push_back(pose(b, t + dt * k / n));
  if (device_.size() < host_.size()) device_.resize(host_.size() * 2);
  copy_to_device(device_.data(), host_.data(), host_.size() * sizeof(BodyPose));
  return {device_.data(), Index(host_.size())};
}

double WallMotion::top_speed(double t) const {
  double top = 0;
  for (int b = 0; b < bodies(); ++b) {
    if (removed_[b] || config_.wall.bodies[b].motion.kind == "fixed") continue;
    const BodyPose p = pose(b, t);
    for (const auto& c : corners(config_.wall.bodies[b])) top = std::max(top, norm(p.velocity(p.place(c))));
  }
  return top;
}

double WallMotion::lowest(int body, double t, const Vec3d& up) const {
  const BodyPose p = pose(body, t);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& c : corners(config_.wall.bodies[body])) least = std::min(least, dot(up, p.place(c)));
  return least;
}

void WallMotion::place(const Frame& frame, WallStore& walls, Span<const BodyPose> pose) {
  for_each(walls.owned(), PlacePass{frame, pose, walls.x0, walls.body, walls.x, walls.v_rho});
}

}  // namespace bedload::inline BL_VARIANT
