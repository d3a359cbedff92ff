// Flow around spheres, in units of the lattice.

#include "kernels/contact/lubrication.hpp"
#include "support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Spheres of one radius in a cube of n nodes with periodic sides. They move as told.
class SphereFlow {
 public:
  SphereFlow(double tau, std::uint32_t n, double radius, const std::vector<Vec3d>& centres,
             const Vec3d& push = {}, const Vec3d& flow = {})
      : tau_(tau),
        n_(n),
        radius_(radius),
        resolved_(box(n), LatticeUnits{1, 1, 1}, {}, grains_),
        solver_(driven(tau, push), &resolved_) {
    const Index count = Index(centres.size());
    grains_.resize(count);
    grains_.x.assign(centres);
    grains_.radius.assign(std::vector<Real>(count, Real(radius)));
    std::vector<Id> ids;
    for (Id i = 0; i < count; ++i) ids.push_back(i);
    grains_.id.assign(ids);
    Setup::Nodes nodes = periodic_nodes(n, n, n);
    nodes.v.assign(nodes.solid.size(), flow);
    solver_.fill(nodes);
    solver_.begin();
  }

  /// v: of the spheres, in nodes a step; held: they neither move nor turn.
  void run(int steps, bool held = true, const Vec3d& v = {}, const Vec3d& omega = {}) {
    const Index count = grains_.size();
    grains_.v.assign(std::vector<Real3>(count, Real3(v)));
    grains_.omega.assign(std::vector<Real3>(count, Real3(omega)));
    for (int k = 0; k < steps; ++k, ++done_) {
      std::vector<Vec3d> x = grains_.x.values();
      for (Vec3d& at : x)
        for (int a = 0; a < 3; ++a) at[a] += v[a] - n_ * std::floor((at[a] + v[a]) / n_);
      grains_.x.assign(x);
      solver_.step(double(done_), done_ + 1, held);
    }
  }
  /// Each has its velocity but stays in place: the flow of the moment.
  void hold(int steps, const std::vector<Vec3d>& v) {
    std::vector<Real3> velocities;
    for (const Vec3d& each : v) velocities.push_back(Real3(each));
    grains_.v.assign(velocities);
    grains_.omega.assign(std::vector<Real3>(v.size(), Real3{}));
    for (int k = 0; k < steps; ++k, ++done_) solver_.step(double(done_), done_ + 1, false);
  }
  /// Until the flow no longer changes by more than that fraction in 100 steps.
  void settle(double change) {
    double before = -1, now = 0;
    while (std::abs(now - before) > change * std::abs(now)) {
      before = now;
      run(100);
      now = mean_velocity();
    }
  }

  double mean_velocity() const { return solver_.totals().momentum.x / volume(); }
  /// Drag with the mean pressure gradient over that of a sphere alone, at the mean velocity.
  double drag_factor(double push) const {
    const double nu = (tau_ - 0.5) / 3;
    return push * volume() / (6 * M_PI * nu * radius_ * mean_velocity() * grains_.size());
  }
  Vec3d force(std::size_t k = 0) const { return Vec3d(grains_.fluid_force.values()[k]); }
  Vec3d torque() const { return Vec3d(resolved_.torque().values()[0]); }
  const LatticeSolver& solver() const { return solver_; }
  const ResolvedGrains& resolved() const { return resolved_; }

 private:
  static DomainConfig box(std::uint32_t n) {
    DomainConfig d;
    d.max = {double(n), double(n), double(n)};
    d.periodic = {true, true, true};
    return d;
  }
  static LatticeParameters driven(double tau, const Vec3d& push) {
    LatticeParameters p = lattice_units(tau);
    p.drive.f = push;
    return p;
  }
  double volume() const { return double(n_) * n_ * n_; }

  double tau_;
  std::uint32_t n_;
  double radius_;
  GrainStore grains_;
  ResolvedGrains resolved_;
  LatticeSolver solver_;
  std::int64_t done_ = 0;
};

double radius_of(double fraction, double n) { return n * std::cbrt(3 * fraction / (4 * M_PI)); }
/// At a Reynolds number of the diameter far below 1.
double gentle_push(double tau, double n) {
  const double nu = (tau - 0.5) / 3;
  return 0.02 * nu * nu / (n * n * n);
}

struct Array {
  double fraction;  ///< of the volume
  std::uint32_t n;
  double factor;
};

/// Of a sphere that the period repeats.
double drag_factor(const Array& a, double tau, const Vec3d& offset) {
  const double push = gentle_push(tau, a.n), middle = 0.5 * a.n;
  SphereFlow flow(tau, a.n, radius_of(a.fraction, a.n), {Vec3d{middle, middle, middle} + offset},
                  {push, 0, 0});
  flow.settle(2e-5);
  return flow.drag_factor(push);
}

/// Simple cubic arrays, K by [zick82] Table 2; the mean of three places among the nodes.
TEST(LatticeSpheres, DragOfArraysIsThatOfStokesFlow) {
  for (const Array& a : {Array{0.064, 16, 2.810}, Array{0.216, 16, 7.442}, Array{0.343, 16, 15.4}}) {
    double mean = 0, least = 1e9, most = 0;
    for (const Vec3d& offset : {Vec3d{}, Vec3d{0.5, 0.5, 0.5}, Vec3d{0.21, 0.37, 0.12}}) {
      const double k = drag_factor(a, 1, offset) / a.factor;
      mean += k / 3, least = std::min(least, k), most = std::max(most, k);
    }
    EXPECT_NEAR(mean, 1, 0.015) << a.fraction;
    EXPECT_LT(most - least, 0.035) << a.fraction;
  }
}

TEST(LatticeSpheres, DragDoesNotDependOnTheRelaxationTime) {
  const Array a{0.216, 12, 7.442};
  const Vec3d offset{0.21, 0.37, 0.12};
  const double one = drag_factor(a, 1, offset);
  EXPECT_NEAR(drag_factor(a, 0.55, offset) / one, 1, 1e-3);
  EXPECT_NEAR(drag_factor(a, 1.5, offset) / one, 1, 1e-3);
}

/// In a periodic box, in which it takes up the fraction c: 8 pi mu R^3 omega / (1 - c).
TEST(LatticeSpheres, TorqueOnATurningSphere) {
  const double radius = 4, n = 20, tau = 0.8, c = 4 * M_PI / 3 * std::pow(radius / n, 3),
               nu = (tau - 0.5) / 3, omega = 1e-4;
  SphereFlow flow(tau, 20, radius, {{10.2, 10.4, 9.9}});
  flow.run(600, false, {}, {0, omega, 0});
  EXPECT_NEAR(flow.torque().y / (-8 * M_PI * nu * std::pow(radius, 3) * omega / (1 - c)), 1, 0.02);
  EXPECT_LT(norm(flow.force()), 0.01 * norm(flow.torque()) / radius);
}

/// The same flow from a frame in which spheres move over nodes.
TEST(LatticeSpheres, DragIsTheSameInAMovingFrame) {
  const double tau = 0.8, n = 18, push = 4e-6;
  const Vec3d frame{0.02, 0.003, -0.006};
  SphereFlow still(tau, 18, 5, {{9.2, 9.4, 8.7}}, {push, 0, 0}),
      moving(tau, 18, 5, {{9.2, 9.4, 8.7}}, {push, 0, 0}, frame);
  still.run(800);
  moving.run(800, false, frame);
  double sum = 0, noise = 0;
  constexpr int window = 300;
  for (int k = 0; k < window; ++k) {
    moving.run(1, false, frame);
    sum += moving.force().x / window;
    noise += square(moving.force().x / still.force().x - 1) / window;
  }
  still.run(window / 2);
  EXPECT_NEAR(sum / still.force().x, 1, 0.01);
  EXPECT_LT(std::sqrt(noise), 0.06);
  EXPECT_NEAR(still.force().x / (push * n * n * n), 1, 0.2) << "nearly steady";
}

/// Two spheres of radius 1 that approach each other at twice the velocity: drag of each over that of one
/// alone, by the series of [brenner61] for a plane of symmetry.
double squeezing_factor(double gap) {
  const double a = std::acosh(1 + gap / 2);
  double sum = 0, term = 1;
  for (int n = 1; term > 1e-9 * sum; ++n) {
    const double m = 2 * n + 1;
    term = n * (n + 1.0) / ((m - 2) * (m + 2)) *
           ((4 * square(std::cosh(m * a / 2)) + square(m * std::sinh(a))) /
                (2 * std::sinh(m * a) - m * std::sinh(2 * a)) -
            1);
    sum += term;
  }
  return 4.0 / 3 * std::sinh(a) * sum;
}

/// Drag of each of two spheres of 8 nodes that move against each other, over that of one alone: from the
/// nodes and Lubrication, the mean of places of the gap among nodes.
double pair_factor(double gap, bool shears) {
  const double tau = 2, nu = (tau - 0.5) / 3, R = 4, n = 36, speed = 1e-4, half = R * (1 + gap / 2);
  const Vec3d v = shears ? Vec3d{0, speed, 0} : Vec3d{speed, 0, 0};
  LubricationConfig config;
  config.forces = LubricationForces::all;
  const auto lubrication = Lubrication::of(config, nu, 1);
  const auto near = NearSurfaces::spheres(Real(R), Real(R), {2 * half, 0, 0}, 2 * half);
  double force = norm(Vec3d(lubrication(near, Real3(2.0 * v), {}, {}).force));
  for (const double place : {0.0, 0.25, 0.5}) {
    const Vec3d middle{n / 2 + place, n / 2 + 0.2, n / 2 - 0.3};
    const std::vector<Vec3d> x{middle - Vec3d{half, 0, 0}, middle + Vec3d{half, 0, 0}};
    SphereFlow flow(tau, std::uint32_t(n), R, x);
    flow.hold(120, {v, -v});
    force += (place == 0.25 ? 0.5 : 0.25) * 0.5 * norm(flow.force(0) - flow.force(1));  // 0.75 is as 0.25
  }
  return force / (6 * M_PI * nu * R * speed);
}

/// In gaps of 0.72 nodes, which these resolve, and of 0.64 and 0.44, where lubrication adds to it. Without it
/// the last would be 22 % low. By single places among the nodes the resistance is up to 23 % off.
TEST(SlowLatticeSpheres, TwoThatApproachResistAsInStokesFlow) {
  std::vector<double> errors;
  for (const double gap : {0.18, 0.16, 0.11}) {
    errors.push_back(pair_factor(gap, false) / squeezing_factor(gap) - 1);
    EXPECT_LT(std::abs(errors.back()), 0.05) << gap;
  }
  EXPECT_NEAR(errors[1], errors[0], 0.03) << "no jump where lubrication begins";
}

/// Y11 - Y12 of [jeffrey84], summed to 60 terms, of spheres that do not turn; lubrication begins at 0.5
/// nodes.
TEST(SlowLatticeSpheres, TwoThatShearResistAsInStokesFlow) {
  EXPECT_NEAR(pair_factor(0.14, true) / 1.94595, 1, 0.05);
  EXPECT_NEAR(pair_factor(0.05, true) / 2.27728, 1, 0.05);
}

/// Between grains that touch there is less fluid than elsewhere: that pushes nothing.
TEST(LatticeSpheres, FluidAtRestStaysSo) {
  SphereFlow flow(0.6, 20, 3, {{10, 10, 10}, {16, 10, 10}, {13, 15.2, 10}, {13, 11.7, 14.9}});
  flow.run(50, false);
  EXPECT_EQ(norm(flow.force()), 0);
  EXPECT_EQ(flow.solver().extremes().speed2, 0);
}

/// What grains and forces have given the fluid is its momentum, while grains do not move.
TEST(LatticeSpheres, MomentumBalances) {
  const double push = 1e-5;
  SphereFlow flow(0.7, 20, 4.3, {{5, 6, 7}, {14.6, 13.1, 15.4}, {0.3, 19.1, 0.2}}, {push, 0, push});
  flow.run(300);
  const FluidSums sums = flow.solver().totals();
  EXPECT_LT(norm(sums.residual), tolerance(1e-11, 2e-5, 2e-5) * norm(flow.solver().driven()));
  EXPECT_GT(flow.resolved().sums().received.x, 0.1 * flow.solver().driven().x);
}

}  // namespace
}  // namespace BL_SOLVER
