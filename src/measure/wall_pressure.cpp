// Pressure on patches of a wall, as transducers measure it.

#include <cmath>

#include "bedload/parallel/reductions.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

constexpr int kAtOnce = 8;  // patches in one sweep

/// A grid of patches on a body, in its pose of t = 0. A force at a point is spread evenly over a square
/// around it, aligned with the patches.
struct PatchGrid {
  Frame frame;
  Vec3d at, along, across, normal;  ///< centre of all, m; unit vectors
  double side[2];                   ///< of one patch, m
  int count[2];
  double depth;      ///< largest distance of a point from their plane, m
  int through = -1;  ///< side along which a plane flow does not vary

  /// Whether x is within `margin` (m) of the region that counts.
  BL_HD bool near(const Vec3d& x, double margin) const {
    bool any = false;
    each_image(x, margin, depth + margin, [&](double, double) { any = true; });
    return any;
  }
  /// Adds to out the parts of `value`, spread over a square around x, on the patches from `first` on.
  BL_HD void spread(const Vec3d& x, double square, double value, int first, double* out) const {
    each_image(x, 0.5 * square, depth, [&](double u, double v) {
      for (int k = 0; k < kAtOnce && first + k < count[0] * count[1]; ++k)
        out[k] += value * covered(0, (first + k) % count[0], u, square) *
                  covered(1, (first + k) / count[0], v, square);
    });
  }

 private:
  /// f(u, v) for x and its periodic images within `margin` of the rectangle and `deep` of its plane (m); a
  /// rectangle may be as wide as the period.
  template <class F>
  BL_HD void each_image(const Vec3d& x, double margin, double deep, F&& f) const {
    const Vec3d r = frame.nearest_image(x - at);
    const double a = 0.5 * count[0] * side[0] + margin, b = 0.5 * count[1] * side[1] + margin;
    for (int image = 0; image < 27; ++image) {
      const int step[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
      Vec3d at_image = r;
      bool there = true;
      for (int k = 0; k < 3; ++k) {
        there = there && (step[k] == 0 || (frame.periodic[k] && !(k == 1 && through >= 0)));
        at_image[k] += step[k] * frame.length[k];
      }
      if (!there || std::abs(dot(at_image, normal)) > deep) continue;
      const double u = dot(at_image, along), v = dot(at_image, across);
      if (std::abs(u) < a && std::abs(v) < b) f(u, v);
    }
  }
  /// Fraction of a square about u that lies in strip i across side k.
  BL_HD double covered(int k, int i, double u, double square) const {
    if (k == through) return 1.0 / count[k];
    const double lo = (i - 0.5 * count[k]) * side[k], hi = (i + 1 - 0.5 * count[k]) * side[k];
    return max_of(min_of(u + 0.5 * square, hi) - max_of(u - 0.5 * square, lo), 0.0) / square;
  }
};

/// Force on patches from the wall particles of one body, N against their normal.
struct PatchForces {
  PatchGrid patches;
  int first;
  std::uint32_t body;
  double spacing;  ///< m
  Vec3d inwards;   ///< against the normal, in the present rotation of the body
  Span<const std::uint32_t> of;
  Span<const Vec3d> x0, pressure, friction;
  BL_HD void operator()(Index w, double* out) const {
    if (of[w] != body) return;
    const double force = dot(pressure[w] + friction[w], inwards);
    if (force != 0) patches.spread(x0[w], spacing, force, first, out);
  }
};

/// The same from the repulsion of its surfaces, at the points closest to the fluid.
struct PatchRepulsion {
  PatchGrid patches;
  int first;
  std::uint32_t body;
  double dx;
  Vec3d inwards;
  WallRepulsion walls;
  Span<const FluidPosition> x;
  Span<const Real> mass;
  Span<const Real3> heading;
  BL_HD void operator()(Index a, double* out) const {
    const BodyPose& pose = walls.pose[body];
    const Vec3d at = coordinates(walls.frame, x[a]);
    const Vec3d beside = pose.origin() + walls.frame.nearest_image(at - pose.origin());
    if (!patches.near(pose.undo(beside), 0.5 * dx + walls.reach())) return;
    const auto take = [&](const SurfacePush& push) {
      const double force = -double(mass[a]) * dot(Vec3d(push.acceleration), inwards);
      patches.spread(pose.undo(push.point), dx, force, first, out);
    };
    walls.each(at, heading[a], walls.sheet(a), take, body);
  }
};

}  // namespace

std::vector<Quantity> CoupledSimulation::wall_pressure(const ProbeConfig& p) {
  const int body = wall_named(p.body);
  const double spacing = config_.wall.spacing(config_.wall.bodies[body]);
  const bool disc = p.radius > 0, one = p.count.empty();
  const double square = p.radius * std::sqrt(M_PI);  // of the disc's area
  PatchGrid patches{.frame = state_.frame,
                    .at = p.at,
                    .along = p.along,
                    .across = cross(p.normal, p.along),
                    .normal = p.normal,
                    .side = {},
                    .count = {},
                    .depth = 0};
  for (int k = 0; k < 2; ++k) {
    patches.count[k] = one ? 1 : int(p.count[k]);
    patches.side[k] = (disc ? square : p.size[k]) / patches.count[k];
  }
  patches.depth = stepper_.fluid().range() + spacing;
  if (config_.domain.two_d) {
    patches.through = std::abs(p.along.y) > 0.5 ? 0 : 1;
    patches.side[patches.through] = config_.domain.thickness() / patches.count[patches.through];
  }

  const WallForces& forces = wall_forces();
  const Span<const BodyPose> poses = state_.poses_now();
  const Vec3d inwards = -state_.motion.pose(body, state_.clock.time).rotation.rotate(p.normal);
  const WallRepulsion repulsion = stepper_.fluid().repulsion(state_.fluid, poses, state_.clock.last_dt);
  const int all = patches.count[0] * patches.count[1];
  std::vector<Quantity> out;
  for (int first = 0; first < all; first += kAtOnce) {
    auto sum = sum_over<kAtOnce>(state_.walls.owned(), PatchForces{.patches = patches,
                                                                   .first = first,
                                                                   .body = std::uint32_t(body),
                                                                   .spacing = spacing,
                                                                   .inwards = inwards,
                                                                   .of = state_.walls.body,
                                                                   .x0 = state_.walls.x0,
                                                                   .pressure = forces.pressure,
                                                                   .friction = forces.friction});
    if (repulsion.walls.surfaces.size > 0) {
      const auto more =
          sum_over<kAtOnce>(state_.fluid.owned(), PatchRepulsion{.patches = patches,
                                                                 .first = first,
                                                                 .body = std::uint32_t(body),
                                                                 .dx = config_.fluid.dx,
                                                                 .inwards = inwards,
                                                                 .walls = repulsion,
                                                                 .x = state_.fluid.x,
                                                                 .mass = state_.fluid.mass,
                                                                 .heading = state_.fluid.heading});
      for (int k = 0; k < kAtOnce; ++k) sum.v[k] += more.v[k];
    }
    for (int k = 0; k < kAtOnce && first + k < all; ++k)
      out.push_back({one ? "pressure" : "pressure_" + std::to_string(first + k), "Pa",
                     sum.v[k] / (patches.side[0] * patches.side[1])});
  }
  return out;
}

}  // namespace BL_SOLVER
