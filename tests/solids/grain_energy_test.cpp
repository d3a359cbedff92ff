// Where the energy of grains goes, against what is known exactly.

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "tests/support/free_body.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

using Terms = std::map<std::string, double>;

Terms by_name(const std::vector<Quantity>& rows) {
  Terms terms;
  for (const Quantity& q : rows) terms[q.name] = q.value;
  return terms;
}
Terms terms_of(const GrainBench& b) { return by_name(b.solver->energy_terms(*b.grains)); }
/// Of the contacts that have ended, over all bins and classes: how many, and the energy by kind, J.
struct Ended {
  double count = 0, energy[ContactSpectra::kKinds] = {};
};
Ended ended(const SolidSolver& solver) {
  const ContactSpectra& layout = solver.spectra()->layout();
  const auto bins = solver.spectra()->bins();
  Ended sum;
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const int kind = int(k / std::size_t(layout.size()) % ContactSpectra::kKinds);
    if (kind == 0) sum.count += double(bins[k].count);
    sum.energy[kind] += bins[k].sum.value() * layout.unit();
  }
  return sum;
}
double dissipated(Terms terms) {
  return terms["grain_dissipated_normal"] + terms["grain_dissipated_sliding"] +
         terms["grain_dissipated_rolling"];
}

TEST(GrainEnergy, IsCountedOnlyIfAskedFor) {
  GrainBench b;
  b.add({});
  b.start();
  EXPECT_TRUE(b.solver->energy_terms(*b.grains).empty());
}

/// Half of the reduced mass times v^2 (1 - e^2), in dashpots alone.
TEST(GrainEnergy, AnImpactHeadOnDissipatesByItsRestitution) {
  for (const double e : {0.5, 0.7, 0.9}) {
    GrainBench b;
    b.config.out.energy = b.config.out.spectra = true;
    b.config.out.spectra_sizes = {b.config.grain.d, 2 * b.config.grain.d};  // both are in the second class
    b.config.grain.e = e;
    const double R = b.R(), speed = 0.2;
    b.add({-1.001 * R, 0, 0}, {speed / 2, 0, 0});
    b.add({1.001 * R, 0, 0}, {-speed / 2, 0, 0});
    b.start();
    b.run(b.contact_time(speed) / 200, 1000);
    ASSERT_LT(b.velocity(0).x, 0);
    const double lost = 0.5 * (b.mass() / 2) * speed * speed * (1 - e * e);
    Terms terms = terms_of(b);
    EXPECT_NEAR(terms["grain_dissipated_normal"] / lost, 1, 2e-3) << e;
    EXPECT_NEAR(dissipated(terms) / lost, 1, 2e-3) << e;
    EXPECT_LT(std::abs(terms["grain_energy_residual"]), 1e-3 * lost) << e;
    // one contact in the bin of its energy
    EXPECT_NEAR(ended(*b.solver).energy[0] / dissipated(terms), 1, 1e-6);
    const ContactSpectra& layout = b.solver->spectra()->layout();
    const auto bins = b.solver->spectra()->bins();
    const std::size_t first =
        std::size_t(layout.of_pair(1, 1)) * ContactSpectra::kKinds * std::size_t(layout.size());
    for (int k = 0; k < layout.size(); ++k) {
      const double from = layout.from * std::pow(10.0, double(k) / layout.per_decade),
                   to = from * std::pow(10.0, 1.0 / layout.per_decade);
      EXPECT_EQ(bins[first + std::size_t(k)].count, lost > from && lost < to ? 1u : 0u) << k;
    }
  }
}

TEST(GrainEnergy, BinsHoldNegativeAndLargeEnergies) {
  SpectrumBin bin{};
  bin.enter(-5);
  EXPECT_EQ(bin.sum.value(), -5);
  bin.enter(7);
  EXPECT_EQ(bin.sum.value(), 2);
  for (int k = 0; k < 4; ++k) bin.enter(std::int64_t(1) << 62);
  EXPECT_EQ(bin.sum.value(), std::ldexp(1.0, 64));
  for (int k = 0; k < 4; ++k) bin.enter(-(std::int64_t(1) << 62));
  EXPECT_EQ(bin.sum.value(), 2);
  EXPECT_EQ(bin.count, 10u);
}

/// Without damping a spring takes all the energy, m* v^2 / 2, with the force v sqrt(k m*).
TEST(GrainEnergy, PeaksOfImpactsAreThoseOfASpring) {
  GrainBench b;
  b.config.out.spectra = true, b.config.out.spectra_from_force = 1e-3;
  b.config.contact.normal = "linear", b.config.contact.k = 2000;
  b.config.grain.e = 1;
  b.plane({0, 0, -0.01}, {0, 0, 1});
  const double R = b.R(), speed = 0.2, m = b.mass();
  b.add({-1.001 * R, 0, 0}, {speed / 2, 0, 0});
  b.add({1.001 * R, 0, 0}, {-speed / 2, 0, 0});
  b.add({0.03, 0, -0.01 + 1.001 * R}, {0, 0, -speed});
  b.start();
  b.run(M_PI * std::sqrt(m / 2 / b.config.contact.k) / 200, 600);
  ASSERT_EQ(ended(*b.solver).count, 2);
  const ContactSpectra& layout = b.solver->spectra()->layout();
  const auto peaks = b.solver->spectra()->peaks();
  const auto expect = [&](std::uint32_t of, int kind, double exact, double from, double unit) {
    const std::size_t first = (std::size_t(of) * ContactSpectra::kKinds + kind) * std::size_t(layout.size());
    for (int k = 0; k < layout.size(); ++k) {
      const SpectrumBin& bin = peaks[first + std::size_t(k)];
      const bool here = k == int(layout.per_decade * std::log10(exact / from));
      EXPECT_EQ(bin.count, here ? 1u : 0u) << of << ' ' << kind << ' ' << k;
      if (here) {
        EXPECT_NEAR(bin.sum.value() * unit / exact, 1, 1e-3) << of << ' ' << kind;
      }
    }
  };
  for (const bool wall : {false, true}) {
    const double m_star = wall ? m : m / 2;
    const std::uint32_t of = wall ? layout.on_wall(0, 0) : layout.of_pair(0, 0);
    expect(of, 0, 0.5 * m_star * speed * speed, layout.from, layout.unit());
    expect(of, 1, speed * std::sqrt(b.config.contact.k * m_star), layout.from_force, layout.unit_of_force());
  }
}

/// Aslant, with spin and rolling friction, on another grain and on a wall that moves.
TEST(GrainEnergy, TheResidualOfObliqueImpactsIsSmall) {
  GrainBench b;
  b.config.out.energy = b.config.out.spectra = true;
  b.config.grain.mu_r = 0.1;
  b.config.contact.rolling = "epsd";
  const double R = b.R();
  b.plane({0, 0, -0.01}, {0, 0, 1});
  b.motion = [](int, double t) {
    BodyPose p;
    p.v = {0.1, 0, 0.05}, p.translation = t * p.v;
    return p;
  };
  b.add({-1.001 * R, 0, 0}, {0.1, 0.1, 0}, {20, -30, 40});
  b.add({1.001 * R, 0, 0.5 * R}, {-0.1, 0, 0});
  b.add({0.03, 0, -0.01 + 1.001 * R}, {0.2, 0, -0.2}, {0, 30, 10});
  b.start();
  b.run(b.contact_time(0.2) / 40, 400);
  ASSERT_EQ(b.solver->totals(*b.grains).contacts + b.solver->totals(*b.grains).wall_contacts, 0);
  Terms terms = terms_of(b);
  EXPECT_GT(terms["grain_dissipated_sliding"], 0.01 * dissipated(terms));
  EXPECT_NE(terms["grain_dissipated_rolling"], 0);
  EXPECT_GT(std::abs(terms["grain_work_walls"]), 0.1 * dissipated(terms));
  EXPECT_LT(std::abs(terms["grain_energy_residual"]), 2e-3 * dissipated(terms));
  // all contacts have ended
  const Ended sum = ended(*b.solver);
  EXPECT_GE(sum.count, 2);
  EXPECT_NEAR(sum.energy[0], terms["grain_dissipated_normal"], 1e-6 * dissipated(terms));
  EXPECT_NEAR(sum.energy[1], terms["grain_dissipated_sliding"] + terms["grain_dissipated_rolling"],
              1e-6 * dissipated(terms));
}

/// Over all patches of a wall that wears.
double over_patches(const HostStore& map, const char* name) {
  double sum = 0;
  for (std::size_t k = 0; k < map.count; ++k) sum += map.find(name)->as<double>()[k];
  return sum;
}

/// mu N s of a block of four grains that cannot turn, on a plane; which it wears by k/H N s [archard53].
TEST(GrainEnergy, GrossSlidingDissipatesForceTimesPath) {
  constexpr double d = 2e-3, g = 9.81, mu = 0.3, speed = 0.5;
  Config c = void_case();
  c.domain.min = {-0.1, -0.1, -0.1}, c.domain.max = {0.1, 0.1, 0.1};
  c.gravity = {0, 0, -g};
  c.out.energy = true;
  c.wall.bodies = {ground()};
  c.wall.bodies[0].wear = "archard", c.wall.bodies[0].k_over_H = 1e-13, c.wall.bodies[0].wear_patch = 0.01;
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = d;
  c.grain.mu = mu, c.grain.e = 0.2;
  c.grain.fills.resize(1);
  RigidConfig& block = c.grain.fills[0].rigid;
  block.present = true, block.turn = "none";
  c.grain.fills[0].velocity = {speed, 0, 0};
  bedload::Setup setup;
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0}) {
      setup.grains.x.push_back({x * d - 0.08, y * d, d / 2 - 1e-9});
      setup.grains.v.push_back({speed, 0, 0});
      setup.grains.radius.push_back(d / 2);
      setup.grains.fill.push_back(0);
    }
  auto s = started(c, setup);
  const auto look = [&](double until) {
    run_until(*s, until);
    Terms terms = by_name(s->diagnostics());
    return std::tuple{terms, reading(s->body_state(1), "centre_x"), s->snapshot("wear/plane")};
  };
  auto [before, from, map_before] = look(0.02);  // it has settled
  auto [after, to, map] = look(0.12);
  const double mass = before["grain_mass"], path = to - from;
  ASSERT_GT(path, 0.01);
  EXPECT_NEAR(
      (after["grain_dissipated_sliding"] - before["grain_dissipated_sliding"]) / (mu * mass * g * path), 1,
      1e-3);
  EXPECT_LT(std::abs(after["grain_energy_residual"]), 1e-3 * dissipated(after));
  const double worn = over_patches(map, "wear_volume") - over_patches(map_before, "wear_volume");
  EXPECT_NEAR(worn / (1e-13 * mass * g * path), 1, 1e-3);
  EXPECT_NEAR(over_patches(map, "shear_energy") / after["grain_dissipated_sliding"], 1, 1e-6);
  EXPECT_NEAR(over_patches(map, "normal_energy"), after["grain_dissipated_normal"], 1e-6 * dissipated(after));
  EXPECT_NEAR((over_patches(map, "contact_time") - over_patches(map_before, "contact_time")) / (4 * 0.1), 1,
              0.01);
  ASSERT_GE(map.count, 2u) << "it has crossed patches";
  for (std::size_t k = 0; k < map.count; ++k) {
    const double* const x = map.find("position")->as<double>() + 3 * k;
    EXPECT_GT(x[0], -0.085 - 0.005);
    EXPECT_LT(x[0], to + 0.005 + d);
    EXPECT_NEAR(x[1], d / 2, 0.005 + d);
    EXPECT_NEAR(x[2], 0, 0.005 + 1e-9);
  }
}

TEST(GrainEnergy, IsRestartedToTheLastBit) {
  Config c = void_case();
  c.domain.min = {-0.02, -0.02, -0.02}, c.domain.max = {0.02, 0.02, 0.02};
  c.gravity = {0, 0, -9.81};
  c.out.energy = c.out.spectra = true;
  c.out.spectra_sizes = {1e-3};
  WallBody floor = ground();
  floor.point = {0, 0, -0.005};
  floor.wear = "archard", floor.k_over_H = 1e-13;
  c.wall.bodies = {floor};
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 2e-3;
  c.grain.fills.resize(1);
  bedload::Setup setup;
  for (int k = 0; k < 12; ++k) {
    setup.grains.x.push_back({2.1e-3 * (k % 2) + 1e-4 * k, 2.1e-3 * (k / 2 % 2), -0.0035 + 2.2e-3 * (k / 4)});
    setup.grains.v.push_back({0.1, 0, -0.1});
    setup.grains.radius.push_back(1e-3);
    setup.grains.fill.push_back(0);
  }
  auto whole = started(c, setup), parted = make_coupled(c, setup);
  run_until(*whole, 0.02);
  parted->load(whole->save());
  run_until(*whole, 0.04);
  while (parted->steps() < whole->steps()) parted->step();
  Terms a = by_name(whole->diagnostics()), b = by_name(parted->diagnostics());
  EXPECT_GT(dissipated(a), 0);
  EXPECT_EQ(a, b);
  const auto bins = whole->spectra();
  for (const auto table : {&Simulation::spectra, &Simulation::spectra_peaks}) {
    const auto rows = ((*whole).*table)(), again = ((*parted).*table)();
    ASSERT_EQ(rows.size(), again.size());
    double count = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (std::size_t n = 0; n < rows[k].size(); ++n) {
        EXPECT_EQ(rows[k][n].value, again[k][n].value) << rows[k][n].name;
        if (rows[k][n].name.ends_with("_count")) count += rows[k][n].value;
      }
    EXPECT_GT(count, 4);
  }
  const auto peaks = whole->spectra_peaks();
  EXPECT_EQ(peaks[0][1].name, "from_force");
  EXPECT_EQ(peaks[0][2].name, "grain_0_grain_0_energy_count");
  EXPECT_EQ(peaks[0][5].name, "grain_0_grain_0_force_sum");
  const HostStore map = whole->snapshot("wear/plane"), map_again = parted->snapshot("wear/plane");
  EXPECT_GT(map.count, 1u);
  for (const HostArray& array : map.arrays)
    EXPECT_TRUE(array.bytes == map_again.find(array.name)->bytes) << array.name;
  EXPECT_EQ(bins[0][1].name, "grain_0_grain_0_normal_count");
  EXPECT_EQ(bins[0][9].name, "grain_1_grain_1_normal_count");
  EXPECT_EQ(bins[0][17].name, "grain_1_on_plane_normal_count");

  SavedState old = whole->save();  // of a build that did not keep peaks
  std::erase_if(old.stores, [](const HostStore& store) { return store.name == "spectra_peaks"; });
  for (HostStore& store : old.stores)
    std::erase_if(store.arrays,
                  [](const HostArray& a) { return a.name == "peak" || a.name == "wall_peaks"; });
  auto later = make_coupled(c, setup);
  later->load(old);
  EXPECT_EQ(later->spectra()[0][9].value, bins[0][9].value);
  EXPECT_EQ(later->spectra_peaks().size(), 1u) << "none yet";
}

/// By m U^2 (sin 2a - 3 sin^2 a), for tan a > 1/3 m U^2 cos^2 a / 3, each contact once [finnie60].
TEST(GrainEnergy, ImpactsCutByTheirAngle) {
  for (const double degrees : {2.0, 15.0, 19.0, 45.0, 90.0}) {
    const double a = degrees * M_PI / 180, U = 0.2, factor = 1e-11;
    GrainBench b;
    b.plane({0, 0, -0.01}, {0, 0, 1});
    b.config.wall.bodies[0].wear = "finnie", b.config.wall.bodies[0].k_over_H = factor;
    b.config.wall.bodies[0].wear_patch = 0.01;
    b.add({0, 0, -0.01 + 1.0001 * b.R()}, U * Vec3d{std::cos(a), 0, -std::sin(a)});
    b.start();
    const double duration = b.contact_time(U * std::sin(a), true);
    b.run(duration / 40, 120);
    ASSERT_GT(b.velocity(0).z, 0) << degrees;
    const double f =
        std::tan(a) > 1 / 3.0 ? square(std::cos(a)) / 3 : std::sin(2 * a) - 3 * square(std::sin(a));
    const double energy = b.mass() * U * U * f, close = 1e-5 * b.mass() * U * U;
    const HostStore map = b.solver->wear()->frame(0, "wear/plane", RigidMotion{});
    EXPECT_NEAR(over_patches(map, "cutting_energy"), energy, close) << degrees;
    EXPECT_NEAR(over_patches(map, "wear_volume"), factor * energy, factor * close) << degrees;
  }
}

/// A bed in a turning drum. What turns the drum is the moment of its weight.
TEST(SlowGrainEnergy, ADrumOverOneTurnClosesItsBooks) {
  const double rate = 12, dt = 2e-5, radius = 0.0125, length = 0.0065, turn = 2 * M_PI / rate;
  GrainBench b;
  b.config.out.energy = b.config.out.spectra = true;
  b.config.gravity = {0, -9.81, 0};
  b.config.grain.mu = 0.5, b.config.grain.mu_r = 0.1, b.config.grain.E = 5e6;
  b.config.contact.rolling = "epsd";
  b.config.wall.bodies = {
      test::shaped("drum", make_hollow(make_cylinder({0, 0, 0}, {0, 0, length}, radius), 0.005))};
  b.config.wall.bodies[0].wear = "archard", b.config.wall.bodies[0].wear_patch = 1e-3;
  b.config.wall.bodies[0].k_over_H = 1e-13;
  const Bounds around = b.config.wall.bodies[0].solid.shape->bounds();
  b.config.wall.bodies[0].min = around.min, b.config.wall.bodies[0].max = around.max;
  b.motion = [&](int, double t) {
    BodyPose p;
    p.rotation = Quat<double>::from_rotation({0, 0, rate * t});
    p.omega = {0, 0, rate};
    return p;
  };
  const double R = b.R();
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 6; ++i)
        b.add(Vec3d{2.1 * (i - 2.5) + 0.05 * j, -5.9 + 2.1 * j + 0.02 * k,
                    1.1 + 2.1 * k + 0.02 * ((i + 2 * j) % 5)} *
              R);
  b.start();
  b.run(dt, 10000);
  Terms before = terms_of(b);
  const double weight = double(b.x.size()) * b.mass() * 9.81, swing = b.solver->totals(*b.grains).angular.z;
  const int looks = int(turn / (20 * dt));
  double moment = 0;  // of the weight about the axis, N m s
  for (int look = 0; look < looks; ++look) {
    const double x = b.solver->totals(*b.grains).centre.x;
    b.run(dt, 20);
    moment += weight * 20 * dt * 0.5 * (x + b.solver->totals(*b.grains).centre.x);
  }
  Terms after = terms_of(b);
  const double lost = dissipated(after) - dissipated(before);
  ASSERT_GT(lost, 0);
  EXPECT_LT(std::abs(after["grain_energy_residual"] - before["grain_energy_residual"]), 0.01 * lost);
  // what contacts have dissipated is in the spectra, or with those that go on
  const Ended sum = ended(*b.solver);
  EXPECT_GT(sum.count, 100);
  double booked = sum.energy[0] + sum.energy[1];
  const HostStore pairs = b.solver->save_contacts(*b.grains);
  const auto* open = pairs.find("loss")->as<double>();
  for (std::size_t k = 0; k < 2 * pairs.count; ++k) booked += open[k];
  const auto fields = b.solver->fields_of_contacts();
  const HostArray counts = fields.front()->to_host(), losses = fields.back()->to_host();
  for (std::size_t i = 0; i < counts.count(); ++i)
    for (std::uint32_t k = 0; k < 2 * counts.as<std::uint32_t>()[i]; ++k)
      booked += losses.as<double>()[2 * kMostWallContacts * i + k];
  EXPECT_NEAR(booked / dissipated(after), 1, 1e-6);
  // what walls have taken of it lies in the patches of its surface, inside
  double at_walls = 0;
  const ContactSpectra& layout = b.solver->spectra()->layout();
  const auto bins = b.solver->spectra()->bins();
  for (std::size_t k = std::size_t(layout.on_wall(0, 0)) * 2 * std::size_t(layout.size()); k < bins.size();
       ++k)
    at_walls += bins[k].sum.value() * layout.unit();
  for (std::size_t i = 0; i < counts.count(); ++i)
    for (std::uint32_t k = 0; k < 2 * counts.as<std::uint32_t>()[i]; ++k)
      at_walls += losses.as<double>()[2 * kMostWallContacts * i + k];
  const HostStore map = b.solver->wear()->frame(0, "wear/drum", RigidMotion{});
  EXPECT_NEAR((over_patches(map, "normal_energy") + over_patches(map, "shear_energy")) / at_walls, 1, 1e-6);
  EXPECT_GT(map.count, 300u);
  for (std::size_t k = 0; k < map.count; ++k) {
    const double* const x = map.find("position")->as<double>() + 3 * k;
    const double off_side = radius - std::hypot(x[0], x[1]), off_end = std::min(x[2], length - x[2]);
    EXPECT_LT(std::min(std::abs(off_side), std::abs(off_end)), 1e-3) << x[0] << ' ' << x[1] << ' ' << x[2];
  }
  EXPECT_GT(b.refreshes, 2) << "losses were carried to new lists";
  const double gained = b.solver->totals(*b.grains).angular.z - swing;
  EXPECT_NEAR((after["grain_work_walls"] - before["grain_work_walls"]) / rate / (moment + gained), 1, 5e-3);
}

}  // namespace
}  // namespace BL_SOLVER
