// Several fluids of one density and different viscosities.
#include "tests/boundaries/support.hpp"
#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// A box of which the upper half is three times as viscous.
Config two_fluids(const std::string& model) {
  Config c = periodic_box(10, 1.0);
  c.fluid.model = model;
  c.fluid.rho0 = 1, c.fluid.c = 10;
  c.fluid.species = {{"thin", 1}, {"thick", 3}};
  c.fluid.mu = 3;
  if (c.fluid.model->own_viscosity) {
    c.fluid.zeta = 20.0 / 21 * 3;
    c.density.method = DensityMethod::summation;
    c.sdpd.kT = 0.5;
  }
  return c;
}

struct Halves : FluidBox {
  explicit Halves(const Config& c) : FluidBox(c, 0.3, true) {
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> u(-1, 1);
    for (Vec3d& v : velocity) v = {u(rng), u(rng), u(rng)};
    upload();
    const auto x = coordinates_now();
    std::vector<Real> relative;
    for (const Vec3d& at : x) relative.push_back(at.z > 5 ? Real(1) : Real(1.0 / 3));
    fluid.viscosity.assign(relative);
    fluid.species.assign(std::vector<std::uint32_t>(x.size()));
  }
};

TEST(Species, PairsOfUnlikeFluidsKeepMomentum) {
  for (const std::string model : {"wcsph", "sdpd", "sdpd_a"}) {
    Halves box(two_fluids(model));
    box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0.01);
    const auto acc = box.fluid.acc_next.values();
    const auto m = box.fluid.mass.values();
    Vec3d sum;
    double scale = 0;
    for (std::size_t a = 0; a < acc.size(); ++a) {
      sum += double(m[a]) * Vec3d(acc[a]);
      scale += double(m[a]) * norm(Vec3d(acc[a]));
    }
    EXPECT_LT(norm(sum), kInvariant * scale) << model;
  }
}

TEST(Species, FrictionTakesTheMeanOfBoth) {
  // two particles alone: Morris' form counts the mean of both viscosities, SDPD the harmonic mean
  for (const std::string model : {"wcsph", "sdpd"}) {
    const auto drag = [&](double first, double second) {
      Config c = two_fluids(model);
      c.sdpd.kT = 0;
      c.eos.background = 0;
      FluidBox box(c);
      box.position.clear(), box.velocity.clear(), box.mass.clear(), box.s.clear();
      box.add({5, 5, 5}, {}, 1), box.add({5, 5, 6}, {1, 0, 0}, 1);
      box.upload();
      box.fluid.viscosity.assign({Real(first), Real(second)});
      box.fluid.species.assign({0, 0});
      box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0.01);
      return double(std::abs(box.fluid.acc_next.values()[0].x));
    };
    const double like = drag(1, 1), mean = model == "sdpd" ? 0.5 : 2.0 / 3;
    ASSERT_GT(like, 0);
    EXPECT_NEAR(drag(1, 1.0 / 3) / like, mean, 1e-5) << model;
    EXPECT_NEAR(drag(1.0 / 3, 1) / like, mean, 1e-5) << model;
    EXPECT_NEAR(drag(1.0 / 3, 1.0 / 3) / like, 1.0 / 3, 1e-5) << model;
  }
}

/// Layers of two fluids between plates, the upper of which moves.
const std::string kLayers = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, -0.04]
max = [0.07, 0.07, 0.16]
periodic = [true, true, false]
[fluid]
dx = 0.01
vmax = 0.1
rho0 = 1000
[[fluid.species]]
name = "thick"
mu = 30
[[fluid.species]]
name = "thin"
mu = 10
[[fluid.fill]]
min = [0, 0, 0]
max = [0.07, 0.07, 0.06]
[[fluid.fill]]
min = [0, 0, 0.06]
max = [0.07, 0.07, 0.12]
species = "thin"
[[wall.body]]
name = "lower"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "upper"
shape = "box"
min = [0, 0, 0.12]
max = [0.07, 0.07, 0.16]
surface_velocity = [0.1, 0, 0]
[time]
end = 1
[out]
every = 1
)";

TEST(Species, LayersShareTheStressOfShear) {
  // stress is one: three quarters of the speed fall to the thin layer
  const Config c = config_of(kLayers);
  EXPECT_EQ(c.fluid.mu, 30);
  auto s = started(c);
  run_until(*s, 0.5);
  const auto store = s->snapshot("fluid");
  const auto x = vectors(store, "position"), v = vectors(store, "velocity");
  const HostArray& species = *store.find("species");
  LineFit thick, thin;
  const auto ids = ids_of(store);
  for (std::size_t n = 0; n < ids.size(); ++n) {
    const Id a = ids[n];
    EXPECT_EQ(species.as<std::uint32_t>()[n], x[a].z < 0.06 ? 0u : 1u);
    if (x[a].z > 0.01 && x[a].z < 0.04) thick.add(x[a].z, v[a].x);
    if (x[a].z > 0.08 && x[a].z < 0.11) thin.add(x[a].z, v[a].x);
  }
  EXPECT_NEAR(thick.slope() / (0.1 / 0.06 / 4), 1, 0.06);
  EXPECT_NEAR(thin.slope() / thick.slope(), 3, 0.1);
  expect_restart_is_bit_equal(*s, c, 20);
}

}  // namespace
}  // namespace BL_SOLVER
