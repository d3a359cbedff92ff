// Single contacts of grains as lines, against the forces on the grains.

#include <gtest/gtest.h>

#include <map>

#include "tests/support/free_body.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

/// Component k of entry n.
double entry(const HostStore& store, const char* name, std::size_t n, int k = 0) {
  const HostArray& a = *store.find(name);
  const std::size_t at = n * std::size_t(a.components) + std::size_t(k);
  return a.type == Scalar::u32   ? a.as<std::uint32_t>()[at]
         : a.type == Scalar::f32 ? double(a.as<float>()[at])
                                 : a.as<double>()[at];
}
Vec3d vector_at(const HostStore& store, const char* name, std::size_t n, int first = 0) {
  return {entry(store, name, n, first), entry(store, name, n, first + 1), entry(store, name, n, first + 2)};
}

TEST(ContactFrames, ForcesOfLinesAddUpToThatOnEachGrain) {
  GrainBench b;
  b.config.out.contacts = "touching", b.config.out.spectra = true;
  b.config.gravity = {0, 0, -9.81};
  b.config.domain.min = {-0.01, -0.01, -0.01}, b.config.domain.max = {0.01, 0.01, 0.1};
  b.config.domain.periodic = {true, false, false};
  b.plane({0, 0, 0}, {0, 0, 1});
  b.plane({0, -0.004, 0}, {0, 1, 0});
  b.plane({0, 0.0018, 0}, {0, -1, 0});
  b.config.grain.e = 0.3;
  b.motion = [](int body, double t) {  // the floor slides
    BodyPose p;
    if (body == 0) p.v = {0.2, 0, 0}, p.translation = t * p.v;
    return p;
  };
  const double d = 2 * b.R();
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 7; ++i)
        b.add({-0.0095 + (1.03 * i + 0.02 * k) * d, -0.004 + (0.55 + 1.02 * j + 0.01 * i) * d,
               (0.55 + 1.03 * k + 0.01 * j) * d},
              {0.05 * (k % 2), -0.02, -0.1}, {5.0 * i, 0, 3.0 * j});
  b.start();
  b.run(b.contact_time(0.2) / 40, 15010);
  const HostStore lines = b.solver->contact_lines(*b.grains);
  const GrainTotals totals = b.solver->totals(*b.grains);
  ASSERT_TRUE(lines.lines);
  ASSERT_EQ(double(lines.count), totals.contacts + totals.wall_contacts);
  ASSERT_GT(totals.contacts, 20);
  ASSERT_GT(totals.wall_contacts, 8);
  std::vector<Vec3d> sum(b.x.size());
  std::array<int, 4> of_body{};
  double sliding = 0, longest = 0, lost = 0;
  for (std::size_t n = 0; n < lines.count; ++n) {
    const auto id = std::size_t(entry(lines, "id", n)), other = std::size_t(entry(lines, "other", n));
    const auto body = std::size_t(entry(lines, "body", n));
    const Vec3d normal = vector_at(lines, "normal", n), along = vector_at(lines, "tangential_force", n);
    const Vec3d force = entry(lines, "normal_force", n) * normal + along;
    const Vec3d from = vector_at(lines, "ends", n), to = vector_at(lines, "ends", n, 3);
    const double length = norm(from - to), overlap = entry(lines, "overlap", n);
    EXPECT_NEAR(dot(along, normal), 0, 1e-5 * norm(force) + 1e-12);
    EXPECT_NEAR(length + overlap, body == 0 ? d : b.R(), 1e-6 * d);
    EXPECT_NEAR(dot(from - to, normal), length, 1e-6 * d);
    EXPECT_GT(overlap, 0);
    sum[id] += force;
    if (body == 0) {
      ASSERT_LT(id, other);
      sum[other] -= force;
    }
    ++of_body.at(body);
    sliding = std::max(sliding, norm(along));
    longest = std::max(longest, norm(vector_at(lines, "spring", n)));
    lost += entry(lines, "dissipated", n);
    if (n > 0) {
      EXPECT_LE(entry(lines, "id", n - 1), id) << "by ids";
    }
  }
  EXPECT_GT(of_body[1], 0);
  EXPECT_GT(of_body[2], 0);
  double scale = 0;
  for (Id i = 0; i < b.x.size(); ++i) scale = std::max(scale, norm(b.force(i)));
  EXPECT_GT(sliding, 1e-3 * scale);
  EXPECT_GT(longest, 0);
  for (Id i = 0; i < b.x.size(); ++i) EXPECT_LT(norm(sum[i] - b.force(i)), 1e-6 * scale) << i;
  // what these have dissipated and what those that have ended make up all
  EXPECT_GT(lost, 0);
  for (const SpectrumBin& bin : b.solver->spectra()->bins())
    lost += bin.sum.value() * b.solver->spectra()->layout().unit();
  double all = 0;
  for (const Quantity& q : b.solver->energy_terms(*b.grains))
    if (q.name.starts_with("grain_dissipated")) all += q.value;
  EXPECT_NEAR(lost / all, 1, 1e-6);
}

/// A column above a wall: gaps of 0.05, then -0.01, 0.08, 0.2, 0.4 diameters. Lubrication reaches 0.25, and
/// 0.5 to walls.
TEST(ContactFrames, OfAllAreOfWhatIsNear) {
  for (const bool wet : {false, true}) {
    GrainBench b;
    b.config.out.contacts = "all";
    b.plane({0, 0, 0}, {0, 0, 1});
    if (wet) b.config.fluid.mu = 0.05, b.config.lubrication.forces = LubricationForces::normal;
    const double d = 2 * b.R();
    double z = 0.55;
    for (const double gap : {-0.01, 0.08, 0.2, 0.4, 0.0}) {
      b.add({0, 0, z * d}, {0, 0, -0.1 * z * z});
      z += 1 + gap;
    }
    b.build();
    b.grains->wetness.assign(std::vector<Real>(b.x.size(), Real(1)));
    b.refresh();
    b.set_poses(1, 0);
    b.solver->evaluate(*b.grains, b.poses());
    b.run(1e-9, 1);
    const HostStore lines = b.solver->contact_lines(*b.grains);
    const std::vector<double> gaps =
        wet ? std::vector{-0.01, 0.05, 0.08, 0.2} : std::vector{-0.01, 0.05, 0.08};
    ASSERT_EQ(lines.count, gaps.size());
    ASSERT_EQ(lines.find("lubrication_force") != nullptr, wet);
    std::vector<Vec3d> sum(b.x.size());
    std::vector<double> found;
    for (std::size_t n = 0; n < lines.count; ++n) {
      const double overlap = entry(lines, "overlap", n), normal_force = entry(lines, "normal_force", n);
      found.push_back(-overlap / d);
      EXPECT_EQ(normal_force > 0, overlap > 0);
      EXPECT_NEAR(norm(vector_at(lines, "ends", n) - vector_at(lines, "ends", n, 3)) + overlap,
                  entry(lines, "body", n) == 0 ? d : d / 2, 1e-6 * d);
      Vec3d force = normal_force * vector_at(lines, "normal", n);
      if (wet) force += vector_at(lines, "lubrication_force", n);
      sum[std::size_t(entry(lines, "id", n))] += force;
      if (entry(lines, "body", n) == 0) sum[std::size_t(entry(lines, "other", n))] -= force;
    }
    std::sort(found.begin(), found.end());
    for (std::size_t n = 0; n < gaps.size(); ++n) EXPECT_NEAR(found[n], gaps[n], 1e-4);
    for (Id i = 0; i < b.x.size(); ++i) {
      EXPECT_LT(norm(sum[i] - b.force(i)), 1e-5 * norm(b.force(0))) << i;
    }
    EXPECT_EQ(norm(b.force(3)) > 0, wet);
  }
}

TEST(ContactFrames, AreOnlyThereIfAskedFor) {
  GrainBench b;
  b.add({}), b.add({1.99 * b.R(), 0, 0});
  b.start();
  EXPECT_EQ(b.solver->contact_lines(*b.grains).count, 0u);
}

TEST(ContactFrames, AreAfterARestartToTheLastBit) {
  Config c = void_case();
  c.domain.min = {-0.02, -0.02, -0.02}, c.domain.max = {0.02, 0.02, 0.02};
  c.gravity = {0, 0, -9.81};
  c.out.contacts = "touching";
  WallBody floor = ground();
  floor.point = {0, 0, -0.005};
  c.wall.bodies = {floor};
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 2e-3;
  c.grain.e = 0.1;
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
  EXPECT_EQ(parted->snapshot("contacts").count, 0u) << "no step was taken";
  run_until(*whole, 0.03);
  while (parted->steps() < whole->steps()) parted->step();
  const HostStore a = whole->snapshot("contacts"), b = parted->snapshot("contacts");
  ASSERT_GT(a.count, 4u);
  ASSERT_EQ(a.arrays.size(), b.arrays.size());
  for (std::size_t k = 0; k < a.arrays.size(); ++k)
    EXPECT_TRUE(a.arrays[k].bytes == b.arrays[k].bytes) << a.arrays[k].name;
}

}  // namespace
}  // namespace BL_SOLVER
