// One collision of random populations.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "kernels/lattice/node_passes.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER::lattice {
namespace {

constexpr double kClose = tolerance(1e-14, 2e-7, 2e-7);

/// A node by itself, in a periodic box of its own.
struct Node {
  explicit Node(Real3 force) : force(force) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> small(-0.02, 0.02);
    for (int i = 0; i < kVelocities; ++i) before[i] = store[i] = Real(small(random));
  }
  /// Populations of a step of either kind, as they arrive; what it leaves, by velocity.
  void collide(bool odd, Relaxation rate) {
    const Populations f{store.data(), {{1, 1, 1}}, odd};
    for (int i = 1; i < kVelocities; ++i) f.arriving(i, 0) = before[i];
    f.at(0, 0) = before[0];
    CollidePass{f, rate, force, {&solid, 1}}(0);
    after[0] = f.at(0, 0);
    for (int i = 1; i < kVelocities; ++i) after[i] = f.leaving(i, 0);
  }
  static double mass(const std::vector<Real>& f) {
    double sum = 0;
    for (const Real x : f) sum += x;
    return sum;
  }
  static Vec3d momentum(const std::vector<Real>& f) {
    Vec3d sum;
    for (int i = 0; i < kVelocities; ++i) sum += double(f[i]) * velocity_of<double>(i);
    return sum;
  }
  static double stress(const std::vector<Real>& f, int a, int b) {
    double sum = 0;
    for (int i = 0; i < kVelocities; ++i) sum += double(f[i]) * velocity(i, a) * velocity(i, b);
    return sum;
  }

  Real3 force;
  std::uint32_t solid = 0;
  std::vector<Real> store = std::vector<Real>(kVelocities), before = store, after = store;
};

TEST(LatticeCollision, KeepsMassAndAddsTheForceToTheMomentum) {
  for (const bool odd : {false, true}) {
    Node node({Real(1e-3), Real(-2e-3), Real(5e-4)});
    node.collide(odd, Relaxation::of(0.8, 3.0 / 16));
    EXPECT_NEAR(Node::mass(node.after), Node::mass(node.before), kClose);
    const Vec3d gain = Node::momentum(node.after) - Node::momentum(node.before);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(gain[k], node.force[k], kClose);
  }
}

TEST(LatticeCollision, StressRelaxesWithTheEvenRate) {
  Node node({});
  const double tau = 0.7;
  node.collide(true, Relaxation::of(tau, 0.1));
  const double rho = 1 + Node::mass(node.before);
  const Vec3d j = Node::momentum(node.before), u = j / rho;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b <= a; ++b) {
      const double equal = rho * u[a] * u[b] + (a == b ? (rho - 1) / 3 : 0);
      EXPECT_NEAR(Node::stress(node.after, a, b) - equal,
                  (1 - 1 / tau) * (Node::stress(node.before, a, b) - equal), kClose);
    }
}

TEST(LatticeCollision, LeavesEquilibriumAndSolidsAlone) {
  Node node({});
  const Real3 u{Real(0.03), Real(-0.02), Real(0.01)};
  const NodeState s{Real(0.01), u};
  for (int i = 0; i < kVelocities; ++i) {
    const Real w = Real(weight(i)), cu = dot(velocity_of<Real>(i), u);
    node.before[i] = even_equilibrium(w, s, cu) + 3 * w * s.rho() * cu;
  }
  node.collide(false, Relaxation::of(0.6, 3.0 / 16));
  for (int i = 0; i < kVelocities; ++i) EXPECT_NEAR(node.after[i], node.before[i], kClose);
  node.solid = 1;
  node.before.assign(kVelocities, Real(0.01));
  node.collide(false, Relaxation::of(0.6, 3.0 / 16));
  for (const Real f : node.after) EXPECT_EQ(f, Real(0.01));
}

}  // namespace
}  // namespace BL_SOLVER::lattice
