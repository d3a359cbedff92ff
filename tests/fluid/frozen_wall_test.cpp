// Frozen walls of SDPD: what their particles do is what fluid particles would do in their places that move
// and turn with the wall.

#include <gtest/gtest.h>

#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kSurface = 9, kTop = 13;  // the wall lies between, four layers thick

Config channel(const std::string& model, DensityMethod method) {
  Config c = periodic_box(9, 1.0);
  c.domain.max.z = kTop;
  c.domain.periodic = {false, false, true};  // a wall that turns has no images beside it
  c.fluid.model = model;
  c.fluid.rho0 = 1;
  c.fluid.mu = 3;
  c.fluid.zeta = 20.0 / 21 * c.fluid.mu;
  c.fluid.c = 10;
  c.density.method = method;
  c.density.delta = c.density.void_relaxation = 0;
  WallBody wall = test::body("box", {0, 0, kSurface}, {9, 9, kTop});
  wall.type = WallType::frozen;
  c.wall.bodies = {wall};
  return c;
}

/// A box of fluid whose upper layers are a wall, or fluid in its place.
struct Channel : FluidBox {
  Channel(const std::string& model, DensityMethod method, bool walled)
      : FluidBox(channel(model, method), 0.2), inside(position.size()) {
    BodyPose pose;
    pose.kind = WallKind::frozen;
    pose.volume = 1;
    pose.v = {0.2, -0.1, 0.3}, pose.omega = {0.1, 0.2, -0.15};
    poses.assign({pose});
    std::mt19937 rng(11);
    std::uniform_real_distribution<double> u(-1, 1);
    std::vector<Vec3d> spin;
    for (std::size_t a = 0; a < position.size(); ++a) {
      for (int k = 0; k < 3; ++k) velocity[a][k] = u(rng);
      spin.push_back({u(rng), u(rng), u(rng)});
      s[a] = 0.1 * u(rng);
      if (a / 81 < kSurface) continue;
      velocity[a] = pose.velocity(position[a]), spin[a] = pose.omega;
      inside[a] = a / 81 == 9 || a / 81 == 12 ? kInner : kOuter;
      if (inside[a] == kOuter) s[a] = 0;
    }
    if (walled) make_wall();
    upload();
    std::vector<Real3> sorted;
    for (const Id id : fluid.id.values()) sorted.push_back(Real3(spin[id]));
    if (solver->spin()) solver->spin()->omega.assign(sorted);
    if (walled) {  // meets fluid for the first time, and begins in balance with it, but here as fluid does
      const auto own = walls.compression.values();
      solver->walls(fluid, walls, poses, moment().gravity, 0, true);
      walls.compression.assign(own);
    }
    solver->density(fluid, walls, poses, moment(), kStep);
    found = fluid.compression.values();
    if (!walled) hold_outer_layers();
    solver->state(fluid, 0, false);
    if (walled) solver->walls(fluid, walls, poses, moment().gravity, 0, true);
    solver->forces(fluid, walls, poses, moment(), kStep);
  }
  /// Values of a field in the order of ids.
  template <class T>
  std::vector<T> by_id(const std::vector<T>& sorted) const {
    std::vector<T> out(sorted.size());
    const auto id = fluid.id.values();
    for (std::size_t a = 0; a < id.size(); ++a) out[id[a]] = sorted[a];
    return out;
  }

  static constexpr double kStep = 1e-3;
  enum Layer : char { kFluid, kInner, kOuter };
  std::vector<Layer> inside;
  Buffer<BodyPose> poses;
  std::vector<Real> found;  ///< density over rho0 - 1

 private:
  void make_wall() {
    std::vector<Id> id;
    std::vector<Vec3d> x;
    std::vector<Real> own;
    for (std::size_t a = 9 * 81; a < position.size(); ++a) {
      id.push_back(Id(x.size()));
      x.push_back(position[a]);
      own.push_back(inside[a] == kInner ? Real(s[a]) : kNoCompression);
    }
    position.resize(9 * 81), velocity.resize(9 * 81), mass.resize(9 * 81), s.resize(9 * 81);
    walls.resize(Index(x.size()));
    walls.id.assign(id);
    walls.x0.assign(x), walls.x.assign(x);
    walls.body.assign(std::vector<std::uint32_t>(x.size(), 0));
    walls.v_rho.assign(std::vector<VelocityDensity<>>(x.size(), {{}, 1}));
    walls.no_slip.assign(std::vector<NoSlip<>>(x.size()));
    walls.state.assign(std::vector<WallState<>>(x.size()));
    walls.compression.assign(own);
  }
  void hold_outer_layers() {
    auto s = fluid.compression.values();
    const auto id = fluid.id.values();
    for (std::size_t a = 0; a < s.size(); ++a)
      if (inside[id[a]] == kOuter) s[a] = 0;
    fluid.compression.assign(s);
  }
};

double worst(const std::vector<Real3>& is, const std::vector<Real3>& expected) {
  double error = 0, scale = 0;
  for (std::size_t a = 0; a < is.size(); ++a) {
    error = std::max(error, norm(Vec3d(is[a]) - Vec3d(expected[a])));
    scale = std::max(scale, norm(Vec3d(expected[a])));
  }
  return error / scale;
}

TEST(FrozenWalls, AreFluidThatMovesAndTurnsWithThem) {
  for (const std::string model : {"sdpd", "sdpd_a"})
    for (const DensityMethod method : {DensityMethod::summation, DensityMethod::continuity}) {
      SCOPED_TRACE(model + (method == DensityMethod::summation ? " summation" : " continuity"));
      Channel walled(model, method, true), all(model, method, false);
      const auto density = all.by_id(all.found), beside = walled.by_id(walled.found);
      for (std::size_t a = 0; a < beside.size(); ++a)
        ASSERT_NEAR(beside[a], density[a], tolerance(1e-12, 1e-5, 2e-5)) << a;
      const auto own = walled.walls.compression.values();
      const auto id = walled.walls.id.values();
      double most = 0;
      for (std::size_t b = 0; b < own.size(); ++b) {
        if (own[b] == kNoCompression) continue;
        ASSERT_NEAR(own[b], density[9 * 81 + id[b]], tolerance(1e-12, 1e-5, 2e-5)) << b;
        most = std::max(most, std::abs(double(own[b])));
      }
      EXPECT_GT(most, method == DensityMethod::summation ? 1e-2 : 1e-4);

      const double close = tolerance(1e-11, 1e-4, 1e-3);
      EXPECT_LT(worst(walled.by_id(walled.fluid.acc_next.values()), all.by_id(all.fluid.acc_next.values())),
                close);
      if (walled.solver->spin()) {
        EXPECT_LT(worst(walled.by_id(walled.solver->spin()->acc.values()),
                        all.by_id(all.solver->spin()->acc.values())),
                  close);
      }

      Buffer<Vec3d> force;
      walled.solver->wall_forces(walled.fluid, walled.walls, walled.poses, walled.moment(), 0, Channel::kStep,
                                 force);
      Vec3d sum;
      double forces = 0;
      for (const Vec3d& f : force.to_host()) sum += f, forces += norm(f);
      for (const Real3& acc : walled.fluid.acc_next.values()) sum += Vec3d(acc), forces += norm(Vec3d(acc));
      EXPECT_LT(norm(sum) / forces, kInvariant);
    }
}

TEST(FrozenWalls, ChangeTheDensityOfWcsphAsFluidOfTheirMass) {
  Channel walled("wcsph", DensityMethod::continuity, true), all("wcsph", DensityMethod::continuity, false);
  const auto density = all.by_id(all.found), beside = walled.by_id(walled.found);
  const double close = tolerance(1e-12, 1e-6, 2e-6);
  double most = 0;
  for (std::size_t a = 0; a < beside.size(); ++a) {
    ASSERT_NEAR(beside[a], density[a], close) << a;
    most = std::max(most, std::abs(double(beside[a])));
  }
  EXPECT_GT(most, 1e3 * close);
}

}  // namespace
}  // namespace BL_SOLVER
