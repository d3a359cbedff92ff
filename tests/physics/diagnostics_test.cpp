// Sums and extremes in diagnostics.csv, against those over the particles of a snapshot.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/run.hpp"
#include "tests/support/stage_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

Config config_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> warnings;
  return read_case_text(text, "case.toml", overrides, warnings);
}
std::unique_ptr<Simulation> after(const Config& c, int steps) {
  auto s = started(c);
  for (int k = 0; k < steps; ++k) s->step();
  return s;
}
/// What a checkpoint has of the fluid's particles.
std::vector<double> kept(Simulation& s, const char* name) {
  const SavedState saved = s.save();
  const auto fluid = std::find_if(saved.stores.begin(), saved.stores.end(),
                                  [](const HostStore& store) { return store.name == "fluid"; });
  return scalars(*fluid, name);
}
Vec3d vector_in(const std::vector<Quantity>& rows, const std::string& name) {
  return {reading(rows, name + "_x"), reading(rows, name + "_y"), reading(rows, name + "_z")};
}
/// To rounding of what is added.
void expect_near(const Vec3d& found, const Vec3d& expected, double size, const char* name) {
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(found[k], expected[k], 2e-6 * size) << name << "_"
                                                    << "xyz"[k];
}

TEST(SmallDiagnostics, OfFluidAreSumsOverItsParticles) {
  const Config c = config_of(test::kBed, {"gravity=[1, -2, -9]"});
  const auto s = after(c, 20);
  const auto d = s->diagnostics();
  const HostStore fluid = s->snapshot("fluid");
  const auto x = vectors(fluid, "position"), v = vectors(fluid, "velocity");
  const auto p = scalars(fluid, "pressure"), rho = scalars(fluid, "density");
  const auto mass = kept(*s, "mass");
  Vec3d centre, momentum, angular;
  double all = 0, kinetic = 0, potential = 0, fastest = 0, heights = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double m = mass[a];
    all += m, centre += m * x[a];
    momentum += m * v[a], angular += cross(x[a], m * v[a]);
    kinetic += 0.5 * m * norm2(v[a]), potential -= m * dot(c.gravity, x[a]);
    heights += m * norm(c.gravity) * norm(x[a]);
    fastest = std::max(fastest, norm(v[a]));
  }
  ASSERT_GT(fastest, 0.02);
  EXPECT_EQ(reading(d, "fluid_count"), double(x.size()));
  EXPECT_NEAR(reading(d, "fluid_mass"), all, 1e-6 * all);
  expect_near(vector_in(d, "fluid_centre"), centre * (1 / all), 0.1, "centre of mass");
  expect_near(vector_in(d, "fluid_momentum"), momentum, all * fastest, "momentum");
  expect_near(vector_in(d, "fluid_angular_momentum"), angular, 0.1 * all * fastest, "angular momentum");
  EXPECT_NEAR(reading(d, "fluid_kinetic_energy"), kinetic, 1e-5 * kinetic);
  EXPECT_NEAR(reading(d, "fluid_potential_energy"), potential, 1e-6 * heights);
  EXPECT_NEAR(reading(d, "fluid_speed_max"), fastest, 1e-5 * fastest);
  const auto [p_least, p_most] = std::minmax_element(p.begin(), p.end());
  const auto [rho_least, rho_most] = std::minmax_element(rho.begin(), rho.end());
  ASSERT_LT(*p_least, *p_most - 100);
  EXPECT_NEAR(reading(d, "pressure_max"), *p_most, 1e-2);
  EXPECT_NEAR(reading(d, "pressure_min"), *p_least, 1e-2);
  EXPECT_NEAR(reading(d, "density_max"), *rho_most, 1e-3);
  EXPECT_NEAR(reading(d, "density_min"), *rho_least, 1e-3);
  const auto eps = scalars(fluid, "porosity");
  EXPECT_NEAR(reading(d, "porosity_min"), *std::min_element(eps.begin(), eps.end()), 1e-6);
}

TEST(SmallDiagnostics, OfGrainsAreSumsOverThem) {
  const Config c = config_of(test::kTank + test::kFluid + R"([grain]
d = 0.01
[[grain.fill]]
positions = [[0.05, 0.05, 0.0049], [0.058, 0.05, 0.0107], [0.066, 0.05, 0.0049], [0.03, 0.02, 0.04]]
velocity = [0.1, 0, -0.1]
)",
                             {"gravity=[1, -2, -9]"});
  const auto s = after(c, 1);
  const auto d = s->diagnostics();
  const HostStore grains = s->snapshot("grains");
  const auto x = vectors(grains, "position"), v = vectors(grains, "velocity"),
             spin = vectors(grains, "angular_velocity"), drag = vectors(grains, "drag_force"),
             pushed = vectors(grains, "fluid_force");
  const auto R = scalars(grains, "radius");
  Vec3d centre, momentum, angular, force;
  double mass = 0, kinetic = 0, rotational = 0, potential = 0, fastest = 0, contacts = 0, deepest = 0,
         far = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double m = 4.0 / 3 * M_PI * cube(R[i]) * c.grain.rho, inertia = 0.4 * m * R[i] * R[i];
    mass += m, centre += m * x[i], momentum += m * v[i], angular += cross(x[i], m * v[i]) + inertia * spin[i];
    kinetic += 0.5 * m * norm2(v[i]), rotational += 0.5 * inertia * norm2(spin[i]);
    potential -= m * dot(c.gravity, x[i]);
    fastest = std::max(fastest, norm(v[i]));
    force += drag[i] + pushed[i], far += norm(drag[i]) + norm(pushed[i]);
    deepest = std::max(deepest, (R[i] - x[i].z) / (2 * R[i]));  // in the floor
    for (std::size_t j = 0; j < i; ++j) {
      const double overlap = R[i] + R[j] - norm(x[i] - x[j]);
      if (overlap > 0) contacts += 1, deepest = std::max(deepest, overlap / (2 * R[i]));
    }
  }
  ASSERT_GT(contacts, 0);
  ASSERT_GT(rotational, 1e-12);
  EXPECT_EQ(reading(d, "grain_count"), double(x.size()));
  EXPECT_NEAR(reading(d, "grain_mass"), mass, 1e-6 * mass);
  expect_near(vector_in(d, "grain_centre"), centre * (1 / mass), 0.1, "centre of mass");
  expect_near(vector_in(d, "grain_momentum"), momentum, mass * fastest, "momentum");
  expect_near(vector_in(d, "grain_angular_momentum"), angular, 0.1 * mass * fastest, "angular momentum");
  EXPECT_NEAR(reading(d, "grain_kinetic_energy"), kinetic, 1e-5 * kinetic);
  EXPECT_NEAR(reading(d, "grain_rotational_energy"), rotational, 1e-5 * rotational);
  EXPECT_NEAR(reading(d, "grain_potential_energy"), potential, 1e-5 * mass);
  EXPECT_NEAR(reading(d, "grain_speed_max"), fastest, 1e-5 * fastest);
  EXPECT_NEAR(reading(d, "coordination_number"), 2 * contacts / double(x.size()), 1e-12)
      << "neighbours of each";
  EXPECT_NEAR(reading(d, "overlap_max"), deepest, 1e-3 * deepest + 1e-9);
  expect_near(vector_in(d, "force_fluid_on_grains"), force, far, "force of the fluid");
}

/// Water that its walls have left: at the limit of its tension, or beyond.
TEST(SmallDiagnostics, CountWhatCavitates) {
  const auto s = after(config_of(test::kTank + test::kFluid, {"gravity=[0, 0, 60]"}), 40);
  const auto compression = kept(*s, "compression");
  const auto thin =
      std::count_if(compression.begin(), compression.end(), [](double x) { return x < -0.001; });
  ASSERT_GT(thin, 0);
  ASSERT_LT(thin, std::ptrdiff_t(compression.size()));
  EXPECT_EQ(reading(s->diagnostics(), "fluid_cavitating"), double(thin));
}

TEST(SmallDiagnostics, HaveTheEnergyOfSpins) {
  const auto s =
      after(config_of(test::kTank + test::kFluid, {"fluid.model=sdpd_a", "sdpd.kT=1e-9", "sdpd.kI=0.2"}), 10);
  const auto spin = vectors(s->snapshot("fluid"), "angular_velocity");
  const auto mass = kept(*s, "mass");
  double expected = 0;
  for (std::size_t a = 0; a < spin.size(); ++a)
    expected += 0.5 * 0.2 * mass[a] * square(0.01) * norm2(spin[a]);
  ASSERT_GT(expected, 0);
  EXPECT_NEAR(reading(s->diagnostics(), "fluid_spin_energy"), expected, 1e-5 * expected);
}

}  // namespace
}  // namespace BL_SOLVER
