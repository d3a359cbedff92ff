#include <gtest/gtest.h>

#include <algorithm>

#include "bedload/geometry/shape.hpp"
#include "kernels/coupling/suspension_viscosity.hpp"
#include "kernels/drag/ergun.hpp"
#include "tests/support/coupled_box.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

/// A periodic cubic lattice of grains of diameter 0.1 and fluid anywhere in it.
CoupledBox lattice_of_grains(double spacing, const char* kernel = "wendland_c2",
                             const CouplingConfig& couple = {}) {
  const double d = 0.1, length = 9 * spacing;
  Config c = unit_box(kernel == std::string("lucy") ? 4 * d : 2 * d, 1e-3);
  const double hc = c.couple.hc;
  c.couple = couple;
  c.couple.hc = hc;
  c.fluid.kernel = kernel;
  c.domain.max = {length, length, length};
  c.domain.periodic = {true, true, true};
  std::mt19937_64 random(5);
  Pebbles grains{lattice(c.domain.min, c.domain.max, spacing), {}, {}, {}};
  grains.v.resize(grains.x.size());
  grains.omega.resize(grains.x.size());
  grains.radius.assign(grains.x.size(), d / 2);
  return CoupledBox(c, fluid_at(random_points(400, c.domain.min, c.domain.max, random), 0.05, 1000, 1),
                    grains);
}

TEST(Porosity, OfAUniformBedIsItsVoidFraction) {
  for (const char* kernel : {"wendland_c2", "cubic", "lucy"})
    for (double spacing : {0.105, 0.125}) {
      CoupledBox box = lattice_of_grains(spacing, kernel);
      box.coupling.porosity(box.fluid, box.grains, {}, 0);
      const double expected = 1 - M_PI / 6 * std::pow(0.1 / spacing, 3);
      for (Real eps : box.fluid.eps.values()) EXPECT_NEAR(eps, expected, 1e-2) << kernel << " " << spacing;
      EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).floor_hits, 0u);
    }
}

/// Grains of unlike sizes are not stored in the order of the cells that fluid searches.
TEST(Porosity, IsTheSameHoweverGrainsAreStored) {
  CoupledBox sorted = lattice_of_grains(0.125), stored = lattice_of_grains(0.125);
  const Index n = stored.grains.size();
  std::vector<Index> backwards(n);
  for (Index i = 0; i < n; ++i) backwards[i] = n - 1 - i;
  Buffer<Index> order;
  order.assign(backwards);
  stored.grains.reorder(order);
  stored.relist(false);
  for (CoupledBox* box : {&sorted, &stored}) box->coupling.porosity(box->fluid, box->grains, {}, 0);
  const auto expected = sorted.fluid.eps.values(), found = stored.fluid.eps.values();
  for (std::size_t a = 0; a < expected.size(); ++a)  // sums over a cell in another order
    EXPECT_NEAR(found[a], expected[a], tolerance(1e-13, 1e-6, 1e-6));
}

/// One way fluid fills the space of the grains, too: its velocity is the flux, which the law is taken at.
TEST(Porosity, OneWayGrainsHaveTheDragOfTheirBed) {
  const double d = 0.1, U = 3e-3, eps = 0.45, spacing = d * std::cbrt(M_PI / 6 / (1 - eps));
  Config c = unit_box(2 * d, 1e-3);
  c.domain.max = Vec3d(1, 1, 1) * (9 * spacing);
  c.domain.periodic = {true, true, true};
  c.couple.mode = CouplingMode::one_way;
  c.couple.drag = DragLaw::ergun;
  Pebbles grains{lattice(c.domain.min, c.domain.max, spacing), {}, {}, {}};
  const std::size_t n = grains.x.size();
  grains.v.resize(n), grains.omega.resize(n), grains.radius.assign(n, d / 2);
  Cloud fluid = fluid_at(lattice(c.domain.min, c.domain.max, spacing / 2), spacing / 2, 1000, 1);
  for (Vec3d& v : fluid.v) v = {U, 0, 0};
  CoupledBox box(c, fluid, grains);
  const auto state = box.fluid.eos_state.values();
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  box.coupling.gather(box.fluid, box.grains, {}, 0);
  const double law = double(Ergun{}.K(Real(eps), Real(d), 1000, Real(1e-3), Real(U / eps))) * U / eps;
  const auto seen = box.grains.eps.values(), K = box.grains.drag_coefficient.values();
  const auto around = box.grains.fluid_velocity.values();
  for (std::size_t j = 0; j < n; ++j) {
    EXPECT_NEAR(seen[j], eps, 3e-3);                   // sums over the lattice
    EXPECT_NEAR(K[j] * around[j].x, law, 0.02 * law);  // falls with the cube of that
  }
  const auto after = box.fluid.eos_state.values();
  for (std::size_t a = 0; a < after.size(); ++a)
    EXPECT_EQ(after[a].mass_over_eps, state[a].mass_over_eps) << "fluid gives way";
}

TEST(Porosity, OneWayALoneGrainDoesNotSeeItself) {
  Config c = unit_box(0.2, 1e-3);
  c.domain.periodic = {true, true, true};
  c.couple.mode = CouplingMode::one_way;
  CoupledBox box(c, fluid_at(lattice({0, 0, 0}, {1, 1, 1}, 0.05), 0.05, 1000, 1),
                 {{{0.51, 0.5, 0.52}}, {{}}, {{}}, {0.05}});
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  box.coupling.gather(box.fluid, box.grains, {}, 0);
  EXPECT_LT(box.grains.eps.values()[0], 0.993) << "its own volume, 4 % of drag by Di Felice's law";
  const double law = 4.8 * 4.8 / 24 * 3 * M_PI * 1e-3 * 0.1;  // Dalla Valle's, slow
  EXPECT_NEAR(box.grains.drag_coefficient.values()[0], law,
              4e-3 * law);  // a tenth of that: fluid h_c / 4 apart
}

TEST(Porosity, GrainsThickenTheFluidByTheLaw) {
  for (const auto& [law, expected] :
       {std::pair{SuspensionLaw::krieger_dougherty, std::pow(1 - 0.3 / 0.6, -1.5)},
        {SuspensionLaw::maron_pierce, 4.0}}) {
    const auto viscosity = SuspensionViscosity::of(law, 0.6);
    EXPECT_NEAR(viscosity(Real(0.3)), expected, 4 * kInvariant * expected);
    EXPECT_EQ(viscosity(0), 1);
    EXPECT_EQ(viscosity(Real(0.6)), viscosity(Real(0.58))) << "beyond 0.95 phi_max contacts carry";
    EXPECT_TRUE(std::isfinite(viscosity(Real(0.75))));
    CouplingConfig couple;
    couple.suspension = law, couple.phi_max = 0.6;
    CoupledBox box = lattice_of_grains(0.12, "wendland_c2", couple);
    box.fluid.viscosity.assign(std::vector<Real>(box.fluid.size(), Real(1)));
    box.coupling.porosity(box.fluid, box.grains, {}, 0);
    const auto eps = box.fluid.eps.values(), mu = box.fluid.viscosity.values();
    for (std::size_t a = 0; a < mu.size(); ++a) {
      const double expected = double(viscosity(1 - eps[a]));  // by the host's pow
      EXPECT_NEAR(mu[a], expected, 4 * kInvariant * expected);
    }
    EXPECT_GT(mu[0], 1.5);
  }
}

TEST(Porosity, ByATopHatCountsTheGrainsWithinReach) {  // [tsuzuki] Eq. 43
  Config c = unit_box(0.2, 1e-3);
  c.domain.periodic = {true, true, true};
  c.couple.kernel = CouplingKernel::top_hat;
  std::mt19937_64 random(8);
  const Pebbles grains = random_grains(300, {0, 0, 0}, {1, 1, 1}, 0.1, random);
  CoupledBox box(c, fluid_at(random_points(200, {0, 0, 0}, {1, 1, 1}, random), 0.1, 1000, 1), grains);
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  const double V_f = 4 * M_PI / 3 * std::pow(box.coupling.range(), 3), V_s = M_PI / 6 * 1e-3;
  const auto at = box.fluid_places();
  const auto eps = box.fluid.eps.values();
  for (std::size_t a = 0; a < at.size(); ++a) {
    int near = 0;
    for (const Vec3d& x : grains.x) near += norm(box.frame.separation(at[a], x)) < box.coupling.range();
    EXPECT_NEAR(eps[a], 1 - near * V_s / V_f, 1e-5) << at[a].x;
  }
}

TEST(Porosity, HasAFloorAndCountsWhoIsHeldThere) {
  CoupledBox box = lattice_of_grains(0.085);  // solid fraction 0.85: overlapping spheres
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  for (Real eps : box.fluid.eps.values()) EXPECT_EQ(eps, Real(0.25));
  EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).floor_hits, 400u);
  EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).cornered, 0u);
  box.coupling.gather(box.fluid, box.grains, {}, 0);
  EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).densest, 729u) << "of 729 grains";
}

/// Beside an orifice the fluid is clear: the drag of a dense bed there is that at the floor all the same.
TEST(Porosity, CountsGrainsAtTheFloorWithoutTheInflowToo) {
  const double spacing = 0.085, length = 9 * spacing;  // overlapping spheres
  for (const bool open : {false, true}) {
    Config c = unit_box(0.2, 1e-3);
    c.domain.max = {length, length, length};
    c.domain.periodic = {true, true, true};
    c.couple.eps_min = 0.3;
    c.fluid.dx = 0.02;
    if (open) {
      InletConfig inlet;
      inlet.shape = "disc";
      inlet.centre = {length / 2, length / 2, length / 2};
      inlet.direction = {0, 0, 1};
      inlet.radius = 0.05;
      c.inlets = {inlet};
    }
    Pebbles grains{lattice(c.domain.min, c.domain.max, spacing), {}, {}, {}};
    const std::size_t n = grains.x.size();
    grains.v.resize(n), grains.omega.resize(n), grains.radius.assign(n, 0.05);
    CoupledBox box(c, fluid_at(lattice(c.domain.min, c.domain.max, length / 24), length / 24, 1000, 1),
                   grains);
    box.coupling.porosity(box.fluid, box.grains, {}, 0);
    box.coupling.gather(box.fluid, box.grains, {}, 0);
    const auto eps = box.grains.eps.values();
    const auto clear = std::count_if(eps.begin(), eps.end(), [](Real e) { return e > Real(0.35); });
    EXPECT_EQ(clear > 0, open);
    const auto counted = box.coupling.counters(box.fluid, box.grains).densest;
    EXPECT_GE(counted, open ? std::uint64_t(clear) : std::uint64_t(n)) << "of " << n;
  }
}

/// A grain beside a single fluid particle, which takes no couple, and one within fluid, which does.
TEST(Porosity, CountsWetGrainsWhoseFluidTakesNoCouple) {
  for (const bool couple : {true, false}) {
    Config c = unit_box(0.1, 1e-3);
    c.couple.angmom = c.couple.torque = couple;
    Cloud fluid = fluid_at(lattice({0.2, 0.2, 0.2}, {0.5, 0.5, 0.5}, 0.05), 0.05, 1000, 1);
    const Cloud one = fluid_at({{0.8, 0.8, 0.82}}, 0.1, 1000, 1);
    fluid.x.push_back(one.x[0]), fluid.v.push_back({}), fluid.mass.push_back(one.mass[0]);
    fluid.rho.push_back(1000), fluid.eps.push_back(1), fluid.stress_acceleration.push_back({});
    CoupledBox box(c, fluid,
                   {{{0.35, 0.35, 0.35}, {0.8, 0.8, 0.8}, {0.7, 0.2, 0.2}},
                    {{}, {}, {}},
                    {{}, {}, {}},
                    {0.02, 0.02, 0.02}});
    EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).uncoupled, 0u) << "before any is looked at";
    box.coupling.gather(box.fluid, box.grains, {}, 1e-6);
    EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).wet, 2u) << "the third is dry";
    EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).uncoupled, couple ? 1u : 0u);
  }
}

/// A slit a tenth of the reach wide leaves more than an eighth of the kernel, where two more walls meet it
/// less.
TEST(Porosity, CountsGrainsInTheNarrowestCorners) {
  Config c = unit_box(0.1, 1e-3);
  c.wall.bodies = {test::tank({0.24, 0.2, 0.2}, {0.26, 1.5, 1.5}, "x-x+y-z-")};
  Cloud fluid = fluid_at(lattice({0.24, 0.2, 0.2}, {0.26, 0.8, 0.8}, 0.02), 0.02, 1000, 1);
  CoupledBox box(c, fluid, {{{0.25, 0.21, 0.21}, {0.25, 0.6, 0.6}}, {{}, {}}, {{}, {}}, {0.01, 0.01}});
  Buffer<BodyPose> poses;
  poses.assign(std::vector<BodyPose>(1));
  EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).cornered, 0u) << "before any is looked at";
  box.coupling.porosity(box.fluid, box.grains, poses, 0);
  EXPECT_EQ(box.coupling.counters(box.fluid, box.grains).cornered, 1u);
}

TEST(Porosity, IsOneWhereThereIsNoGrain) {
  Config c = unit_box(0.1, 1e-3);
  std::mt19937_64 random(6);
  CoupledBox box(c, fluid_at(random_points(50, {0, 0, 0}, {1, 1, 0.5}, random), 0.1, 1000, 0.5),
                 {{{0.5, 0.5, 0.9}}, {{}}, {{}}, {0.05}});
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  for (Real eps : box.fluid.eps.values()) EXPECT_EQ(eps, Real(1));
}

TEST(Porosity, KnowsWhatFractionOfTheKernelWallsLeave) {
  const WendlandC2 w(0.1);
  std::vector<Surface> planes(2);
  planes[0].axis[2] = {0, 0, 1};
  planes[1].axis[2] = {1, 0, 0};
  planes[1].body = 1;
  std::vector<BodyPose> pose(2);
  pose[1].present = 0;
  const Frame frame({-1, -1, -1}, {1, 1, 1}, false, false, false);
  const auto of = [&](const WendlandC2& kernel) {
    return WallFreeFraction<>{HalfSpaceFraction::of(kernel), frame, {{{planes.data(), 2}}}, {pose.data(), 2}};
  };
  const auto fraction = [&](const Vec3d& x) { return of(w)(x); };
  for (double z : {0.0, 0.04, 0.11, 0.25}) {
    double free = 0, all = 0;
    for (const Vec3d& r : lattice({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}, 0.01)) {
      const double weight = w.W(Real(norm(r)));
      all += weight;
      if (r.z > -z) free += weight;
    }
    EXPECT_NEAR(fraction({0, 0, z}), free / all, 5e-3) << z;
    EXPECT_NEAR(of(WendlandC2(0.025))({0, 0, z}, Real(0.2)), fraction({0, 0, z}), 1e-5) << z;
  }
  EXPECT_EQ(fraction({0.3, 0, 0.25}), Real(1));
  pose[1].present = 1;
  EXPECT_NEAR(fraction({0, 0, 0}), 0.25, 1e-6);
}

TEST(Porosity, AsksNoWallThatIsTooFarToCutTheKernel) {
  const WendlandC2 w(0.1);  // reaches 0.2 m
  std::vector<Surface> surfaces(3);
  surfaces[0].axis[2] = {0, 0, 1};
  surfaces[0].centre = {0, 0, -0.9};
  surfaces[1].kind = SurfaceKind::rectangle;
  surfaces[2].kind = SurfaceKind::box;
  for (int k : {1, 2}) {
    surfaces[k].axis[0] = {1, 0, 0}, surfaces[k].axis[1] = {0, 1, 0}, surfaces[k].axis[2] = {0, 0, 1};
    surfaces[k].half[0] = surfaces[k].half[1] = 0.2;
  }
  surfaces[2].half[2] = 0.1;
  surfaces[2].centre = {0.4, 0.6, 0.7};
  std::vector<BodyPose> pose(1);
  const Frame frame({-1, -1, -1}, {1, 1, 1}, false, false, false);
  const WallFreeFraction<> free{HalfSpaceFraction::of(w), frame, {{{surfaces.data(), 3}}}, {pose.data(), 1}};
  const double skin = 0.03;
  std::mt19937_64 random(5);
  int cut = 0, near = 0;
  for (const Vec3d& x : random_points(20000, {-1, -1, -1}, {1, 1, 1}, random)) {
    const Vec3d listed = x + skin / std::sqrt(3.0) * Vec3d{1, -1, 1};
    const bool asked = free.may_cut(listed, free.half_space.range, skin);
    near += asked;
    if (free(x) == Real(1)) continue;
    ++cut;
    EXPECT_TRUE(asked) << x.x << ' ' << x.y << ' ' << x.z;
  }
  EXPECT_GT(cut, 2000);
  EXPECT_LT(near, 2 * cut);
}

TEST(Porosity, IsOneInAnOrificeAndFallsToThatOfTheBed) {
  const auto lies_in = [](const std::vector<InletConfig>& inlets) {
    Config c = unit_box(0.2, 1e-3);
    c.domain.periodic = {true, true, true};
    c.fluid.dx = 0.05;
    c.inlets = inlets;
    std::mt19937_64 random(12);
    return CoupledBox(c, fluid_at(random_points(4000, {0, 0, 0}, {1, 1, 1}, random), 0.1, 1000, 1),
                      random_grains(2000, {0, 0, 0}, {1, 1, 1}, 0.05, random));
  };
  InletConfig disc, rectangle;
  disc.shape = "disc";
  disc.centre = {0.25, 0.25, 0.02};  // seen across the period, too
  disc.direction = {0, 0, 1};
  disc.radius = 0.1;
  rectangle.shape = "rectangle";
  rectangle.centre = {0.75, 0.75, 0.5};
  rectangle.direction = {1, 0, 0};
  rectangle.half_a = {0, 0.1, 0};
  rectangle.half_b = {0, 0, 0.05};
  CoupledBox plain = lies_in({}), open = lies_in({disc, rectangle});
  plain.coupling.porosity(plain.fluid, plain.grains, {}, 0);
  open.coupling.porosity(open.fluid, open.grains, {}, 0);
  const auto at = open.fluid_places();
  const auto bed = plain.fluid.eps.values(), eps = open.fluid.eps.values();
  int one = 0, between = 0;
  for (std::size_t a = 0; a < at.size(); ++a) {
    const Vec3d r = open.frame.separation(at[a], disc.centre);
    const Vec3d q = open.frame.separation(at[a], rectangle.centre);
    const double from_disc = std::hypot(r.z, std::max(0.0, std::hypot(r.x, r.y) - 0.1));
    const double from_rectangle =
        std::hypot(q.x, std::max(0.0, std::abs(q.y) - 0.1), std::max(0.0, std::abs(q.z) - 0.05));
    double fraction = 1;
    for (const double distance : {from_disc, from_rectangle}) {
      const double t = std::clamp((distance - 0.05) / 0.2, 0.0, 1.0);
      fraction *= t * t * (3 - 2 * t);
    }
    EXPECT_NEAR(1 - eps[a], (1 - bed[a]) * fraction, kInvariant) << at[a].x << " " << at[a].y;
    one += fraction == 0;
    between += fraction > 0 && fraction < 1;
  }
  EXPECT_GT(one, 20);
  EXPECT_GT(between, 200);
}

/// Porosity at random places in one box among random grains in another, beside walls that are `seen` or not.
std::vector<Real> porosity_beside(const std::vector<WallBody>& bodies, bool seen, const Bounds& fluid,
                                  const Bounds& grains) {
  Config c = unit_box(0.1, 1e-3);
  c.couple.wall_normalise = seen;
  c.wall.bodies = bodies;
  std::mt19937_64 random(8);
  const auto at = random_points(300, fluid.min, fluid.max, random);
  CoupledBox box(c, fluid_at(at, 0.1, 1000, 1), random_grains(60, grains.min, grains.max, 0.05, random));
  Buffer<BodyPose> poses;
  poses.assign(std::vector<BodyPose>(bodies.size()));
  box.coupling.porosity(box.fluid, box.grains, poses, 0);
  return box.fluid.eps.values();
}

/// The far side of a thin wall is seen from behind: a pipe and a vessel without end around the same bore
/// agree.
TEST(Porosity, DoesNotSeeTheFarSideOfAThinWall) {
  const auto lies_in = [](ShapePtr shape, bool seen = true) {
    return porosity_beside({test::shaped("vessel", shape)}, seen, {{0.3, 0.3, 0.4}, {0.7, 0.7, 0.6}},
                           {{0.3, 0.3, 0.2}, {0.7, 0.7, 0.8}});
  };
  const Vec3d a{0.5, 0.5, 0}, b{0.5, 0.5, 1};
  const auto thin = lies_in(make_pipe(a, b, 0.3, 0.32, PipeEnds::open));
  const auto thick = lies_in(make_hollow(make_cylinder(a, b, 0.3), 0.5));
  const auto unseen = lies_in(make_pipe(a, b, 0.3, 0.32, PipeEnds::open), false);
  ASSERT_EQ(thin.size(), thick.size());
  std::size_t beside = 0;
  for (std::size_t n = 0; n < thin.size(); ++n) {
    EXPECT_NEAR(thin[n], thick[n], 1e-6);
    beside += thin[n] < unseen[n] - 1e-4;
  }
  EXPECT_GT(beside, 50u);
}

TEST(Porosity, IsTheSameBesideBoxesAsBesideTheTankThatTheyMakeUp) {
  const auto lies_in = [](const std::vector<WallBody>& bodies, bool seen = true) {
    return porosity_beside(bodies, seen, {{0.2, 0.4, 0.2}, {0.4, 0.6, 0.4}},
                           {{0.2, 0.3, 0.2}, {0.6, 0.7, 0.6}});
  };
  const WallBody tank = test::tank({0.2, -0.5, 0.2}, {1.5, 1.5, 1.5}, "x-z-");
  const auto whole = lies_in({tank});
  const auto parts = lies_in({test::body("box", {-0.2, -0.5, -0.2}, {0.2, 1.5, 1.5}),
                              test::body("box", {0.2, -0.5, -0.2}, {1.5, 1.5, 0.2})});
  const auto unseen = lies_in({tank}, false);
  std::size_t beside = 0;
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_NEAR(parts[n], whole[n], 1e-5);
    beside += whole[n] < unseen[n] - 1e-2;
  }
  EXPECT_GT(beside, 50u);
}

/// The volume flux of the mixture: of fluid, and of grains by how far they have come in the step, counted as
/// the porosity counts them, also where that is held at its floor.
TEST(Porosity, GoesWithTheFluxOfFluidAndGrains) {
  Config c = unit_box(0.1, 1e-3);
  c.couple.eps_min = 0.97;
  std::mt19937_64 random(17);
  Cloud fluid = fluid_at(random_points(300, {0, 0, 0}, {1, 1, 1}, random), 0.1, 1000, 1);
  fluid.v = random_vectors(300, 1, random);
  CoupledBox box(c, fluid, random_grains(400, {0, 0, 0}, {1, 1, 1}, 0.05, random));
  const double dt = 1e-3;
  const auto x = box.grains.x.values();
  const auto u = random_vectors(x.size(), 1, random);
  std::vector<Vec3d> before;
  for (std::size_t j = 0; j < x.size(); ++j) before.push_back(x[j] - dt * u[j]);
  box.grains.x_before.assign(before);
  box.coupling.porosity(box.fluid, box.grains, {}, dt);
  const auto at = box.fluid_places();
  const auto eps = box.fluid.eps.values(), factor = box.fluid.solid_factor.values();
  const auto v = box.fluid.v_rho.values(), flux = box.fluid.flux.values();
  const WendlandC2 w(0.1);
  int held = 0;
  for (std::size_t a = 0; a < at.size(); ++a) {
    double solid = 0;
    Vec3d carried;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double weight = M_PI / 6 * std::pow(0.05, 3) * w.W(Real(norm(at[a] - x[j])));
      solid += weight, carried += weight * u[j];
    }
    const double counted = std::min(solid, 0.03), part = solid > 0 ? counted / solid : 1;
    held += part < 1;
    EXPECT_NEAR(eps[a], 1 - counted, kInvariant);
    EXPECT_NEAR(factor[a], part, 10 * kInvariant);
    const Vec3d expected = (1 - counted) * Vec3d(v[a].v) + part * carried;
    EXPECT_LT(norm(Vec3d(flux[a].v) - expected), 10 * kInvariant);
  }
  EXPECT_GT(held, 30);
  EXPECT_LT(held, 270);
}

TEST(Porosity, FollowsGrainsThatMoveWithinTheSkin) {
  Config c = unit_box(0.1, 1e-3);
  std::mt19937_64 random(7);
  CoupledBox box(c, fluid_at(random_points(300, {0, 0, 0}, {1, 1, 1}, random), 0.1, 1000, 1),
                 random_grains(40, {0, 0, 0}, {1, 1, 1}, 0.05, random));
  auto x = box.grains.x.values();
  for (auto& at : x) at += Vec3d{0.003, -0.002, 0.004};  // skin 0.02
  box.grains.x.assign(x);
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  const auto at = box.fluid_places();
  const auto eps = box.fluid.eps.values();
  const WendlandC2 w(0.1);
  for (std::size_t a = 0; a < at.size(); ++a) {
    double solid = 0;
    for (const auto& xj : x) solid += M_PI / 6 * std::pow(0.05, 3) * w.W(Real(norm(at[a] - xj)));
    EXPECT_NEAR(eps[a], std::max(0.25, 1 - solid), kInvariant);
  }
}

}  // namespace
}  // namespace BL_SOLVER
