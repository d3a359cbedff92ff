// Points and columns, found through the fluid's cells, against sums over all particles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/smoothing/registry.hpp"
#include "tests/support/run.hpp"
#include "tests/support/stage_cases.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kDx = 0.01;

ProbeConfig at(const std::string& type, const Vec3d& x, const std::string& body = "") {
  ProbeConfig p;
  p.name = type, p.type = type;
  p.at = x, p.body = body;
  return p;
}

/// A block of water that falls apart over a floor, periodic along x.
Config block() {
  Config c = periodic_box(16, kDx);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {true, false, false};
  c.fluid.c = 15;
  c.fluid.fills = {{{0, 0.02, 0}, {0.16, 0.08, 0.09}}};
  c.wall.bodies = {test::tank(c.domain.min, c.domain.max, "z-y-y+")};
  return c;
}

Vec3d apart(const Config& c, const Vec3d& a, const Vec3d& b) { return frame_of(c).separation(a, b); }

struct Shepard {
  double weight = 0, pressure = 0;
  Vec3d velocity;
};

/// Over all particles of a snapshot.
Shepard summed(const Config& c, Simulation& s, const Vec3d& x) {
  const HostStore fluid = s.snapshot("fluid");
  const auto place = vectors(fluid, "position"), v = vectors(fluid, "velocity");
  const auto p = scalars(fluid, "pressure"), rho = scalars(fluid, "density");
  const SavedState saved = s.save();
  const auto kept = std::find_if(saved.stores.begin(), saved.stores.end(),
                                 [](const HostStore& store) { return store.name == "fluid"; });
  const auto mass = scalars(*kept, "mass");
  Shepard sum;
  with_kernel(c.fluid.kernel, c.fluid.h(), [&](const auto& w) {
    for (std::size_t a = 0; a < place.size(); ++a) {
      const double r = norm(apart(c, place[a], x));
      if (r >= double(w.kappa) * c.fluid.h()) continue;
      const double weight = mass[a] / rho[a] * w.W(Real(r));
      sum.weight += weight, sum.pressure += weight * p[a], sum.velocity += weight * v[a];
    }
  });
  return sum;
}

TEST(SmallPointProbe, SeesAllFluidWithinTheKernel) {
  const Config c = block();
  auto s = started(c);
  for (int k = 0; k < 60; ++k) s->step();
  // within, across the period, at the surface, outside all, and so far off that only drops are near
  for (const Vec3d& x : {Vec3d{0.08, 0.05, 0.06},
                         {0.001, 0.05, 0.03},
                         {0.159, 0.02, 0.01},
                         {0.05, 0.05, 0.095},
                         {0.05, 0.02, 0}}) {
    const Shepard all = summed(c, *s, x);
    const auto p = s->measure(at("point", x));
    ASSERT_GT(all.weight, 0.05);
    const double close = tolerance(1e-12, 1e-5, 1e-4);  // round-off of places, kernel and pressure
    EXPECT_NEAR(reading(p, "kernel_sum") / all.weight, 1, close);
    EXPECT_NEAR(reading(p, "pressure"), all.pressure / all.weight, close * 1200);
    EXPECT_NEAR(reading(p, "velocity_z"), all.velocity.z / all.weight, close);
  }
  EXPECT_EQ(reading(s->measure(at("point", {0.05, 0.05, 0.155})), "kernel_sum"), 0);
  EXPECT_TRUE(std::isnan(reading(s->measure(at("point", {0.05, 0.05, 0.155})), "pressure")));
}

TEST(SmallPointProbe, RidesOnABody) {
  Config c = block();
  c.wall.bodies.push_back(test::body("box", {0.02, 0.1, 0.02}, {0.04, 0.12, 0.04}));
  MotionConfig& motion = c.wall.bodies[1].motion;
  motion.kind = "rotation";
  motion.axis = {1, 0, 0};
  motion.centre = {0.03, 0.11, 0.06};
  motion.rate = 40;
  auto s = started(c);
  run_until(*s, 0.03);
  const Vec3d from{0.03, 0.11, 0.11};
  const double angle = 40 * s->time();
  const Vec3d now{0.03, 0.11 - 0.05 * std::sin(angle), 0.06 + 0.05 * std::cos(angle)};
  const auto carried = s->measure(at("point", from, "box")), there = s->measure(at("point", now));
  ASSERT_GT(reading(there, "kernel_sum"), 0.3);
  EXPECT_EQ(reading(s->measure(at("point", from)), "kernel_sum"), 0);
  for (const char* name : {"kernel_sum", "pressure", "velocity_y"})
    EXPECT_NEAR(reading(carried, name), reading(there, name), 1e-6 * std::abs(reading(there, name))) << name;
}

/// Height of the topmost particle in the column over x, and that up to which gaps are below two spacings.
std::pair<double, double> searched(const Config& c, Simulation& s, const Vec3d& x, const Vec3d& up) {
  std::vector<double> heights;
  for (const Vec3d& place : vectors(s.snapshot("fluid"), "position")) {
    const Vec3d r = apart(c, place, x);
    if (norm(r - dot(r, up) * up) <= 1.5 * kDx) heights.push_back(dot(r, up));
  }
  std::sort(heights.begin(), heights.end());
  double connected = 0;
  for (const double h : heights)
    if (h >= 0 && h - connected < 2 * kDx) connected = h;
  return {heights.empty() ? 0 : heights.back() + kDx / 2, connected > 0 ? connected + kDx / 2 : 0};
}

TEST(SmallHeightProbe, FindsTheColumnAmongAllFluid) {
  Config c = block();
  c.fluid.fills.push_back({{0.04, 0.04, 0.12}, {0.09, 0.09, 0.15}});  // above the block
  auto s = started(c);
  const double close = tolerance(1e-12, 1e-6, 1e-5);
  int sprays = 0;
  for (int k = 0; k < 12; ++k) {
    for (int n = 0; n < 20; ++n) s->step();
    for (const Vec3d& x : {Vec3d{0.08, 0.05, 0},
                           {0, 0.05, 0},
                           {0.05, 0.115, 0},
                           {0.06, 0.115, 0.05},
                           {0.155, 0.081, 0.01},
                           {0.1, 0.05, 0.2},
                           {0.1, 0.05, -0.035}}) {
      const auto [height, depth] = searched(c, *s, x, {0, 0, 1});
      const auto p = s->measure(at("height", x));
      EXPECT_NEAR(reading(p, "height"), height, close);
      EXPECT_NEAR(reading(p, "column_depth"), depth, close);
      sprays += depth > 0 && depth < height;
    }
  }
  EXPECT_GT(sprays, 0);
}

TEST(SmallHeightProbe, TellsSprayFromTheColumn) {
  for (const double gap : {0.9, 1.1}) {  // between blocks; particles are one spacing farther apart
    for (const int axis : {2, 0}) {      // gravity along -z, then along -x
      Config c = periodic_box(16, kDx);
      c.domain.periodic = {false, false, false};
      c.gravity = {};
      c.gravity[axis] = -9.81;
      const auto layer = [&](double from, double to) {
        FluidFill fill{{0.04, 0.04, 0.04}, {0.12, 0.12, 0.12}};
        fill.min[axis] = from, fill.max[axis] = to;
        return fill;
      };
      const double lift = 0.05 + gap * kDx;
      c.fluid.fills = {layer(0, 0.05), layer(lift, lift + 0.02), layer(0.12, 0.14)};
      auto s = started(c);
      Vec3d x{0.08, 0.08, 0.08};
      x[axis] = 0;
      const auto p = s->measure(at("height", x));
      EXPECT_NEAR(reading(p, "height"), 0.14, 1e-6);
      EXPECT_NEAR(reading(p, "column_depth"), gap < 1 ? lift + 0.02 : 0.05, 1e-6);
      x[axis] = 0.1;  // in the air
      EXPECT_NEAR(reading(s->measure(at("height", x)), "height"), 0.04, 1e-6);
      EXPECT_EQ(reading(s->measure(at("height", x)), "column_depth"), 0);
      x[axis] = 0.01;  // within the water
      EXPECT_NEAR(reading(s->measure(at("height", x)), "column_depth"), gap < 1 ? lift + 0.01 : 0.04, 1e-6);
    }
  }
}

/// A bed in water, after some steps.
struct Bed {
  Config config;
  std::unique_ptr<Simulation> s;
  Bed() {
    std::vector<std::string> warnings;
    config = read_case_text(test::kBed, "case.toml", {}, warnings);
    s = started(config);
    for (int k = 0; k < 20; ++k) s->step();
  }
};

TEST(SmallBoxProbe, IsTheMeanOfWhatLiesInIt) {
  Bed bed;
  ProbeConfig p;
  p.name = "box", p.type = "box";
  p.min = {0.02, 0.02, 0.0}, p.max = {0.09, 0.09, 0.035};
  const auto in_box = [&](const Vec3d& x) {
    return x.x >= p.min.x && x.x <= p.max.x && x.y >= p.min.y && x.y <= p.max.y && x.z >= p.min.z &&
           x.z <= p.max.z;
  };
  const SavedState saved = bed.s->save();
  const auto kept = std::find_if(saved.stores.begin(), saved.stores.end(),
                                 [](const HostStore& store) { return store.name == "fluid"; });
  const auto of_fluid = scalars(*kept, "mass");
  for (const bool fluid : {true, false}) {
    const HostStore store = bed.s->snapshot(fluid ? "fluid" : "grains");
    const auto x = vectors(store, "position"), v = vectors(store, "velocity");
    const auto eps = scalars(store, "porosity"), pressure = scalars(store, fluid ? "pressure" : "porosity"),
               radius = scalars(store, fluid ? "porosity" : "radius");
    double count = 0, mass = 0, p_mean = 0, eps_mean = 0;
    Vec3d momentum;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!in_box(x[i])) continue;
      const double m = fluid ? of_fluid[i] : 4.0 / 3 * M_PI * cube(radius[i]) * bed.config.grain.rho;
      count += 1, mass += m, momentum += m * v[i], p_mean += m * pressure[i], eps_mean += m * eps[i];
    }
    ASSERT_GT(count, fluid ? 50 : 2);
    ASSERT_LT(count, double(x.size()));
    p.phase = fluid ? Phase::fluid : Phase::grains;
    const auto found = bed.s->measure(p);
    const double close = 2e-5;  // of single numbers in a snapshot
    EXPECT_EQ(reading(found, "count"), count);
    EXPECT_NEAR(reading(found, "mass") / mass, 1, close);
    EXPECT_NEAR(reading(found, "velocity_x"), momentum.x / mass, close * 0.1);
    EXPECT_NEAR(reading(found, "velocity_y"), momentum.y / mass, close * 0.1);
    EXPECT_NEAR(reading(found, "velocity_z"), momentum.z / mass, close * 0.1);
    if (!fluid) continue;
    EXPECT_NEAR(reading(found, "pressure") / (p_mean / mass), 1, close);
    EXPECT_NEAR(reading(found, "porosity") / (eps_mean / mass), 1, close);
    EXPECT_LT(eps_mean / mass, 0.999);
  }
  p.phase = Phase::grains;
  p.min.z = 0.1, p.max.z = 0.12;
  EXPECT_EQ(reading(bed.s->measure(p), "count"), 0);
  EXPECT_TRUE(std::isnan(reading(bed.s->measure(p), "velocity_z")));
}

TEST(SmallFrontProbe, IsTheOuterEdgeOfTheLastParticle) {
  Bed bed;
  for (const bool fluid : {true, false})
    for (int axis = 0; axis < 3; ++axis)
      for (const int sign : {1, -1}) {
        double last = -1e300;
        for (const Vec3d& x : vectors(bed.s->snapshot(fluid ? "fluid" : "grains"), "position"))
          last = std::max(last, sign * x[axis]);
        ProbeConfig p;
        p.name = "front", p.type = "front";
        p.phase = fluid ? Phase::fluid : Phase::grains;
        p.axis = axis, p.sign = sign;
        const std::string name = std::string("front_") + "xyz"[axis];
        EXPECT_NEAR(reading(bed.s->measure(p), name), sign * (last + 0.005), 1e-8) << name << " " << sign;
      }
}

/// Each of several points is measured as a probe of its own would be.
TEST(SmallPointProbe, MeasuresLinesPlanesAndGrids) {
  auto s = started(block());
  for (int k = 0; k < 20; ++k) s->step();
  ProbeConfig grid = at("point", {0.04, 0.03, 0.01});
  grid.span = {{0.06, 0, 0}, {0, 0.03, 0}, {0, 0, 0.05}}, grid.count = {4, 2, 3};
  const auto all = s->measure(grid);
  ASSERT_EQ(all.size(), 4u * 2 * 3 * 5);
  int n = 0;
  for (const double z : {0.01, 0.035, 0.06})
    for (const double y : {0.03, 0.06})
      for (const double x : {0.04, 0.06, 0.08, 0.1}) {
        const auto one = s->measure(at("point", {x, y, z}));
        // points differ by round-off of their coordinates
        EXPECT_NEAR(reading(all, "pressure_" + std::to_string(n)) / reading(one, "pressure"), 1, 1e-5) << n;
        ++n;
      }
  ProbeConfig line = at("height", {0, 0.05, 0});
  line.span = {{0.15, 0, 0}}, line.count = {4};
  const auto heights = s->measure(line);
  ASSERT_EQ(heights.size(), 8u);
  EXPECT_EQ(heights[6].name, "height_3");
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(reading(heights, "column_depth_" + std::to_string(k)),
                reading(s->measure(at("height", {0.05 * k, 0.05, 0})), "column_depth"), 1e-6);
}

/// Up a slope: the sheet that is connected to the start of the line, without drops ahead of it.
TEST(SmallHeightProbe, MeasuresRunUpAlongASlope) {
  Config c = block();
  c.domain.periodic = {false, false, false};
  c.wall.bodies.clear();
  c.fluid.fills = {{{0, 0, 0}, {0.08, 0.16, 0.16}}, {{0.12, 0, 0}, {0.14, 0.16, 0.16}}};
  auto s = started(c);
  const Vec3d up{std::sqrt(0.5), 0, std::sqrt(0.5)};
  ProbeConfig p = at("height", {0.005, 0.085, 0.005});  // no particle lies just 1.5 dx from it
  p.along = up;
  const auto [height, sheet] = searched(c, *s, p.at, up);
  const auto found = s->measure(p);
  const double close = tolerance(1e-12, 1e-6, 1e-5);
  EXPECT_NEAR(reading(found, "height"), height, close);
  EXPECT_NEAR(reading(found, "column_depth"), sheet, close);
  EXPECT_LT(sheet, height - 0.04);
  // the sheet ends in the first block, 0.08 m along x; the line reaches 1.5 dx to its sides
  EXPECT_NEAR(sheet, (0.075 + 0.5 * kDx) * std::sqrt(2.0), 2.5 * kDx);
}

/// Fluid and grains that move as one through a section.
TEST(SmallFluxProbe, CountsWhatPasses) {
  Config c = block();
  c.fluid.fills[0].velocity = {"0.3", "0", "-0.1"};
  auto s = started(c);
  ProbeConfig p = at("flux", {});
  p.min = {0.06, 0, 0}, p.max = {0.1, 0.16, 0.16}, p.axis = 0, p.sign = 1;
  const auto along = s->measure(p);
  const double area = 0.06 * 0.09;                                      // m2
  EXPECT_NEAR(reading(along, "volume_flow"), 0.3 * area, 1e-5 * area);  // round-off of velocity and density
  // at rest the fluid is up to 0.4 % denser at its floor
  EXPECT_NEAR(reading(along, "mass_flow") / (0.3 * area * c.fluid.rho0), 1.002, 5e-4);
  p.sign = -1;
  EXPECT_NEAR(reading(s->measure(p), "mass_flow"), -reading(along, "mass_flow"), 1e-12);
  p.min = {0, 0, 0.02}, p.max = {0.16, 0.16, 0.06}, p.axis = 2, p.sign = 1;
  EXPECT_NEAR(reading(s->measure(p), "volume_flow"), -0.1 * 0.16 * 0.06, 1e-5 * 0.16 * 0.06);
}

/// 8 x 8 x 8 grains, steel where `steel(i, j, k)`, and larger.
template <class Steel>
std::vector<Quantity> mixing_of(const ProbeConfig& probe, const Steel& steel) {
  Config c = block();
  c.fluid.present = false, c.fluid.fills.clear(), c.wall.bodies.clear();
  c.gravity = {};
  c.grain.present = true;
  c.grain.d = 2e-3, c.grain.d_min = 2e-3, c.grain.d_max = 3e-3;
  c.grain.materials.resize(1);
  c.grain.materials[0].name = "steel";
  c.grain.materials[0] = c.grain.completed(c.grain.materials[0]);
  c.grain.fills.resize(2);
  c.grain.fills[1].material = "steel";
  bedload::Setup setup;
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 8; ++i) {
        const bool is = steel(i, j, k);
        setup.grains.x.push_back(5e-3 * Vec3d{i + 0.5, j + 0.5, k + 0.5});
        setup.grains.v.push_back({});
        setup.grains.radius.push_back(is ? 1.5e-3 : 1e-3);
        setup.grains.fill.push_back(is);
      }
  return started(c, setup)->measure(probe);
}

TEST(SmallProbes, TellHowWellGrainsAreMixed) {
  ProbeConfig steel;
  steel.name = "mixing", steel.type = "mixing", steel.of = "steel";
  steel.min = {0, 0, 0}, steel.max = {0.04, 0.04, 0.04}, steel.cell = 0.02;
  ProbeConfig large = steel;
  large.of = "", large.larger_than = 2.5e-3;
  for (const ProbeConfig& probe : {steel, large}) {
    const auto apart = mixing_of(probe, [](int, int, int k) { return k < 4; });
    EXPECT_NEAR(reading(apart, "lacey"), 0, 1e-12);
    EXPECT_EQ(reading(apart, "cells"), 8);
    EXPECT_EQ(reading(apart, "count"), 256);
    EXPECT_EQ(reading(apart, "count_others"), 256);
    EXPECT_NEAR(reading(apart, "centre_z"), 0.01, 1e-9);
    EXPECT_NEAR(reading(apart, "centre_others_z"), 0.03, 1e-9);
    EXPECT_NEAR(reading(apart, "centre_others_x"), 0.02, 1e-9);
    const auto regular = mixing_of(probe, [](int i, int j, int k) { return (i + j + k) % 2 == 0; });
    EXPECT_NEAR(reading(regular, "lacey"), 64.0 / 63, 1e-12) << "more even than at random";
    // cells of 64 with a fraction of 1/4 and of 3/4
    const auto half = mixing_of(probe, [](int i, int, int k) { return i % 4 < (k < 4 ? 1 : 3); });
    EXPECT_NEAR(reading(half, "lacey"), (0.25 - 0.0625) / (0.25 - 0.25 / 64), 1e-12);
  }
  ProbeConfig none = steel;
  none.max = {0.04, 0.04, 0.02};  // of one kind
  EXPECT_TRUE(std::isnan(reading(mixing_of(none, [](int, int, int k) { return k < 4; }), "lacey")));
}

}  // namespace
}  // namespace BL_SOLVER
