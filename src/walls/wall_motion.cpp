#include "src/walls/wall_motion.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/geometry/lattice.hpp"
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

/// Of the box around a body and what lies within `beyond` of it.
std::vector<Vec3d> corners(const WallBody& b, double beyond = 0) {
  const Vec3d out{beyond, beyond, beyond}, min = b.min - out, max = b.max + out;
  std::vector<Vec3d> all;
  for (int k = 0; k < 8; ++k)
    all.push_back({k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z});
  return all;
}

WallKind kind_of(const WallBody& body) {
  if (body.type == "frozen") return WallKind::frozen;
  if (body.type == "mdbc") return WallKind::mirrored;
  if (body.type == "single_layer") return WallKind::single_layer;
  return WallKind::extrapolated;
}

}  // namespace

WallMotion::WallMotion(const Config& config, const FreeBodies& free)
    : config_(config), free_(free), removed_(config.wall.bodies.size(), false) {
  for (const WallBody& body : config.wall.bodies) laws_.emplace_back(body.motion, config.time.end);
  for (const InletConfig& inlet : config.inlets) inlets_.emplace_back(inlet, config.fluid.dx);
  if (config.fluid.present)
    with_kernel(config.fluid.kernel, config.fluid.h(), [&](const auto& w) { layer_depth_ = layer_depth(w); });
}

BodyPose WallMotion::pose(int body, double t) const {
  if (body >= walls()) {
    BodyPose p{inlets_[body - walls()].motion(t)};
    p.flows = 1;
    p.volume = cube(config_.fluid.dx);
    return p;
  }
  const WallBody& b = config_.wall.bodies[body];
  const int place = free_.place_of(body);
  BodyPose p{place < 0 ? laws_[body].at(t) : free_.motion(place)};
  p.free = std::uint32_t(place + 1);
  p.slip = b.slip == "slip";
  p.kind = kind_of(b);
  p.repulsion = b.repulsion && b.stops_fluid() && !b.single_layer();
  const double dx = config_.wall.spacing(b);
  const bool even = b.shape == "tank" || b.shape == "box";  // their particles divide the sides evenly
  p.volume = b.single_layer() ? dx * dx * layer_depth_ : even ? cell_volume(b.min, b.max, dx) : cube(dx);
  p.present = !removed_[body];
  return p;
}

Span<BodyPose> WallMotion::poses(double t, double dt, int n) {
  host_.clear();
  for (int k = 0; k <= n; ++k)
    for (int b = 0; b < bodies(); ++b) host_.push_back(pose(b, t + dt * k / n));
  if (device_.size() < host_.size()) device_.resize(host_.size() * 2);
  copy_to_device(device_.data(), host_.data(), host_.size() * sizeof(BodyPose));
  if (free_.any()) free_.write({device_.data(), Index(host_.size())}, bodies(), n + 1, t);
  return {device_.data(), Index(host_.size())};
}

Span<const BodyPose> WallMotion::poses_in_step(double t, double back, double dt) {
  const Span<BodyPose> rows = poses(t - back, back, 1);
  if (free_.any()) free_.write_middle(rows, dt);
  return rows;
}

double WallMotion::top_speed(double t, double dt) const {
  return std::max(prescribed_speed(t), free_.top_speed(t, dt));
}

double WallMotion::prescribed_speed(double t) const {
  double top = 0;
  for (const InletFlow& inlet : inlets_) top = std::max(top, norm(inlet.motion(t).v));
  for (int b = 0; b < walls(); ++b) {
    if (removed_[b] || !laws_[b].moves()) continue;
    const BodyPose p = pose(b, t);
    const WallBody& body = config_.wall.bodies[b];
    const double beyond = kind_of(body) == WallKind::mirrored ? config_.fluid.kappa() * config_.fluid.h() : 0;
    for (const auto& c : corners(body, beyond)) top = std::max(top, norm(p.velocity(p.place(c))));
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
  const Index n = pose.size / 2;
  const Span<const BodyPose> moving{pose.data, n}, placed{pose.data + n, n};
  for_each(walls.owned(), PlacePass{frame, moving, placed, walls.x0, walls.body, walls.x, walls.v_rho});
  for_each(walls.mirrors.owned(),
           PlaceImagesPass{frame, placed, walls.mirrors.x0, walls.body, walls.mirrors.x});
}

}  // namespace bedload::inline BL_VARIANT
