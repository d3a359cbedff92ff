// Forces in a sheared box are those of the same fluid stacked with its image, between which there is no
// boundary.

#include <gtest/gtest.h>

#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kRate = 0.7, kSide = 8;  // 1/s, m

Config sheared_box(const std::string& model, double height) {
  Config c = periodic_box(int(kSide), 1.0);
  c.domain.max.z = height;
  c.domain.shear_rate = kRate;
  c.fluid.model = model;
  c.fluid.rho0 = 1;
  c.fluid.mu = 3;
  c.fluid.zeta = 20.0 / 21 * c.fluid.mu;
  c.fluid.c = 10;
  if (model == "wcsph") c.visc.alpha = 0.2;
  return c;
}

struct Sheared : FluidBox {
  Sheared(const std::string& model, double height) : FluidBox(sheared_box(model, height), 0.4, true) {}

  /// Lists, density after a step, forces and stress where images have moved by `strain` over their distance.
  void evaluate(double strain) {
    std::vector<Quantity> saved;
    solver->save(saved);
    solver->load([&](const std::string& name) {
      if (name.starts_with("shear_strain")) return strain;
      for (const Quantity& q : saved)
        if (q.name == name) return q.value;
      return std::nan("");
    });
    upload();
    solver->density(fluid, walls, {}, moment(), 0.01);
    solver->forces(fluid, walls, {}, moment(), 0.01);
    solver->moments(fluid, walls, moment(), 0.01, moments);
    const auto id = fluid.id.values();
    const auto s_next = fluid.compression.values();
    const auto acc = fluid.acc_next.values();
    const auto stress = moments.friction.to_host();
    density.resize(id.size()), acceleration.resize(id.size()), shear_stress.resize(id.size());
    for (std::size_t a = 0; a < id.size(); ++a) {
      density[id[a]] = s_next[a], acceleration[id[a]] = Vec3d(acc[a]);
      shear_stress[id[a]] = stress[a].row[0].z;
    }
  }
  std::vector<double> density, shear_stress;
  std::vector<Vec3d> acceleration;
  FluidMoments moments;
};

TEST(SmallMeanShear, ImagesAreWhatAStackedBoxHolds) {
  for (const std::string model : {"wcsph", "sdpd", "sdpd_a"})
    for (const double strain : {0.3, -0.45, 0.8}) {
      Sheared one(model, kSide), two(model, 2 * kSide);
      std::mt19937 rng(5);
      std::uniform_real_distribution<double> u(-1, 1);
      for (std::size_t a = 0; a < one.position.size(); ++a) {
        for (int k = 0; k < 3; ++k) one.velocity[a][k] = u(rng);
        one.s[a] = 0.02 * u(rng);
      }
      two.position = one.position, two.velocity = one.velocity, two.mass = one.mass, two.s = one.s;
      for (std::size_t a = 0; a < one.position.size(); ++a) {
        two.add(one.position[a] + Vec3d{strain * kSide, 0, kSide},
                one.velocity[a] + Vec3d{kRate * kSide, 0, 0}, one.mass[a]);
        two.s.back() = one.s[a];
      }
      one.evaluate(strain), two.evaluate(strain);
      double size = 0, largest = 0, stress = 0;
      for (std::size_t a = 0; a < one.position.size(); ++a) {
        size = std::max(size, norm(one.acceleration[a]));
        stress = std::max(stress, std::abs(one.shear_stress[a]));
        largest = std::max(largest, std::abs(one.density[a] - one.s[a]));
      }
      ASSERT_GT(size, 1) << model;
      ASSERT_GT(largest, 1e-3) << model;
      for (std::size_t a = 0; a < one.position.size(); ++a) {
        EXPECT_LT(norm(one.acceleration[a] - two.acceleration[a]), 30 * kInvariant * size) << model << a;
        EXPECT_NEAR(one.density[a], two.density[a], 30 * kInvariant * largest) << model << a;
        EXPECT_NEAR(one.shear_stress[a], two.shear_stress[a], 30 * kInvariant * stress) << model << a;
      }
    }
}

}  // namespace
}  // namespace BL_SOLVER
