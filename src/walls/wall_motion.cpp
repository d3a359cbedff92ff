#include "src/walls/wall_motion.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/geometry/body.hpp"
#include "bedload/geometry/sampling.hpp"
#include "kernels/fluid/layer_force.hpp"
#include "kernels/smoothing/registry.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

struct PlacePass {
  Frame frame;
  Span<const BodyPose> moving, placed;
  Span<const Vec3d> x0;
  Span<const std::uint32_t> body;
  Span<Vec3d> x;
  Span<Real4> v_rho;
  BL_HD void operator()(Index i) const {
    const BodyPose& k = moving[body[i]];
    x[i] = frame.wrap(placed[body[i]].place(x0[i]));
    v_rho[i] = {Real3(k.velocity(k.place(x0[i]))), v_rho[i].w};
  }
};

struct PlaceImagesPass {
  Frame frame;
  Span<const BodyPose> placed;
  Span<const Vec3d> x0;
  Span<const std::uint32_t> body;
  Span<Vec3d> x;
  BL_HD void operator()(Index i) const { x[i] = frame.wrap(placed[body[i]].place(x0[i])); }
};

WallKind kind_of(const WallBody& body) {
  switch (body.type) {
    case WallType::frozen:
      return WallKind::frozen;
    case WallType::mdbc:
      return WallKind::mirrored;
    case WallType::single_layer:
      return WallKind::single_layer;
    case WallType::adami:
    case WallType::fluid_only:
    case WallType::grains_only:
      break;  // the last has no particles
  }
  return WallKind::extrapolated;
}

}  // namespace

WallMotion::WallMotion(const Config& config, const FreeBodies& free)
    : config_(config), free_(free), removed_(config.wall.bodies.size(), false) {
  double depth = 0;  // of a single layer, m
  if (config.fluid.present) with_fluid_kernel(config, [&](const auto& w) { depth = layer_depth(w); });
  for (const WallBody& body : config.wall.bodies) {
    laws_.emplace_back(body.motion, config.time.end);
    BodyPose& p = still_.emplace_back();
    p.free = std::uint32_t(free.place_of(int(still_.size()) - 1) + 1);
    p.slip = body.slip == WallSlip::slip;
    p.kind = kind_of(body);
    p.repulsion = body.repels();
    p.no_penetration = body.no_penetration && body.stops_fluid() && !body.single_layer();
    p.slide = body.surface_velocity;
    const double dx = config.wall.spacing(body);
    if (config.fluid.present)
      p.volume = body.single_layer() ? dx * config.domain.spacing_along(1, dx) * depth
                                     : particle_volume(body, dx, config.domain);
  }
  for (const InletConfig& inlet : config.inlets) {
    inlets_.emplace_back(inlet, config.fluid.dx, config.domain);
    BodyPose& p = still_.emplace_back();
    p.flows = 1;
    p.volume = config.domain.cell_volume(config.fluid.dx);
  }
}

BodyPose WallMotion::pose(int body, double t) const {
  BodyPose p = still_[body];
  RigidMotion& motion = p;
  if (body >= walls()) {
    motion = inlets_[body - walls()].motion(t);
    return p;
  }
  motion = p.free ? free_.motion(int(p.free) - 1) : laws_[body].at(t);
  p.present = !removed_[body];
  return p;
}

bool WallMotion::moves() const {
  return !inlets_.empty() || free_.any() ||
         std::any_of(laws_.begin(), laws_.end(), [](const MotionLaw& law) { return law.moves(); });
}

Span<BodyPose> WallMotion::rows(double t, double dt, int n, Buffer<BodyPose>& device) {
  host_.clear();
  for (int k = 0; k <= n; ++k)
    for (int b = 0; b < bodies(); ++b) host_.push_back(pose(b, t + dt * k / n));
  if (device.size() < host_.size()) device.resize(host_.size() * 2);
  copy_to_device(device.data(), host_.data(), host_.size() * sizeof(BodyPose));
  if (free_.any()) free_.write({device.data(), Index(host_.size())}, bodies(), n + 1, t);
  return {device.data(), Index(host_.size())};
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
    if (removed_[b] || !laws_[b].moves()) continue;
    const BodyPose p = pose(b, t);
    const WallBody& body = config_.wall.bodies[b];
    for (const auto& c : corners(body, config_.domain, particles_beyond(body, config_)))
      top = std::max(top, norm(p.velocity(p.place(c))));
  }
  return top;
}

double WallMotion::lowest(int body, double t, const Vec3d& up) const {
  const BodyPose p = pose(body, t);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& c : corners(config_.wall.bodies[body], config_.domain))
    least = std::min(least, dot(up, p.place(c)));
  return least;
}

void WallMotion::place(const Frame& frame, WallStore& walls, Span<const BodyPose> pose) {
  const Index n = pose.size / 2;
  const Span<const BodyPose> moving{pose.data, n}, placed{pose.data + n, n};
  for_each(walls.owned(), PlacePass{frame, moving, placed, walls.x0, walls.body, walls.x, walls.v_rho});
  for_each(walls.mirrors.owned(),
           PlaceImagesPass{frame, placed, walls.mirrors.x0, walls.body, walls.mirrors.x});
}

}  // namespace bedload::inline BL_VARIANT
