// Lists and what goes with them: neighbours, history through a rebuild, checkpoints.
#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <set>

#include "bedload/core/error.hpp"
#include "tests/support/grain_bench.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

using Pair = std::pair<Id, Id>;

/// Grains of mixed sizes thrown about in a box with periodic sides; at first none touch.
struct Heap : GrainBench {
  explicit Heap(int n, bool periodic = true) {
    config.domain.min = {0, 0, 0};
    config.domain.max = {0.02, 0.02, 0.03};
    config.domain.periodic = {periodic, periodic, false};
    config.gravity = {0, 0, -9.81};
    config.contact.rolling = "epsd";
    plane({0, 0, 0}, {0, 0, 1});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double cell = 0.02 / 7;
    for (int i = 0; i < n; ++i) {
      const Vec3d at{i % 7 + 0.5, i / 7 % 7 + 0.5, i / 49 + 0.5};
      add(at * cell + Vec3d(unit(random), unit(random), unit(random)) * 3e-5,
          {unit(random), unit(random), unit(random)}, {}, R() * (0.9 + 0.1 * unit(random)));
    }
  }
};

std::set<Pair> listed_pairs(const GrainBench& b) {
  const auto id = b.grains->id.values();
  const HostVerletList host(b.solver->list());
  std::set<Pair> pairs;
  for (Index i = 0; i < b.solver->list().rows(); ++i)
    for (std::uint32_t k = 0; k < host.count[i]; ++k) {
      const bool fresh = pairs.insert({id[i], id[host.entry[host.view().slot(i, k)]]}).second;
      EXPECT_TRUE(fresh) << "listed twice";
    }
  return pairs;
}

TEST(SolidLists, HoldExactlyThePairsWithinReach) {
  for (bool periodic : {true, false}) {
    Heap b(300, periodic);
    b.start();
    const auto id = b.grains->id.values();
    const auto x = b.grains->x.values();
    const auto r = b.grains->radius.values();
    std::set<Pair> expected;
    int across = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < x.size(); ++j) {
        if (i == j) continue;
        Vec3d d = x[i] - x[j];
        for (int k = 0; k < 2 && periodic; ++k) {
          const double plain = d[k];
          d[k] -= 0.02 * std::round(d[k] / 0.02);
          across += d[k] != plain && norm(d) < double(r[i]) + double(r[j]) + b.solver->skin();
        }
        if (norm(d) < double(r[i]) + double(r[j]) + b.solver->skin()) expected.insert({id[i], id[j]});
      }
    EXPECT_EQ(listed_pairs(b), expected);
    if (periodic) {
      EXPECT_GT(across, 0);
    }
  }
}

std::map<Pair, std::vector<std::byte>> histories(const GrainBench& b) {
  const HostStore s = b.solver->save_contacts(*b.grains);
  const auto* lo = s.find("lo")->as<Id>();
  const auto* hi = s.find("hi")->as<Id>();
  const std::byte* h = s.find("history")->bytes.data();
  std::map<Pair, std::vector<std::byte>> out;
  for (std::size_t c = 0; c < s.count; ++c)
    out[{lo[c], hi[c]}].assign(h + c * sizeof(ContactHistory), h + (c + 1) * sizeof(ContactHistory));
  return out;
}

TEST(SolidLists, HistorySurvivesARebuildToTheLastBit) {
  Heap b(300);
  b.start();
  b.run(2e-6, 400);
  const auto before = histories(b);
  const auto wall = b.solver->totals(*b.grains).wall_contacts;
  const double elastic = b.solver->totals(*b.grains).elastic;
  ASSERT_GT(before.size(), 30u);
  b.refresh();
  EXPECT_EQ(histories(b), before);
  EXPECT_EQ(b.solver->totals(*b.grains).wall_contacts, wall);
  EXPECT_NEAR(b.solver->totals(*b.grains).elastic / elastic, 1, 1e-12);
}

TEST(SolidLists, BothPartnersHoldTheSameHistory) {
  // totals count each side for half a pair: a difference would show as a fraction
  Heap b(300);
  b.start();
  b.run(2e-6, 400);
  const double pairs = b.solver->totals(*b.grains).contacts;
  EXPECT_EQ(pairs, double(histories(b).size()));
  // and forces between the grains cancel: what is left is the floor's
  std::vector<Real3> force = b.grains->force.values();
  Vec3d sum;
  double scale = 0;
  for (const Real3& f : force) sum += Vec3d(f), scale += norm(Vec3d(f));
  b.set_poses(1, 0);
  const Vec3d floor = b.solver->body_loads(*b.grains, b.poses())[0].force();
  EXPECT_LT(std::abs(sum.x), scale * 0.5);
  EXPECT_LT(std::abs(sum.z + floor.z), 1e-2 * std::abs(sum.z) + kInvariant * scale);
}

TEST(SolidLists, ARunWithManyRebuildsIsTheRunWithFew) {
  Heap a(200), b(200);
  b.config.skin_grain = 0.6;
  a.start(), b.start();
  a.run(2e-6, 400);
  b.run(2e-6, 400);
  EXPECT_GT(a.refreshes, b.refreshes);
  const Frame frame(a.config.domain.min, a.config.domain.max, true, true, false);
  double worst = 0;  // list order changes sums by rounding alone
  for (Id i = 0; i < 200; ++i)
    worst = std::max(worst, norm(frame.nearest_image(a.position(i) - b.position(i))));
  EXPECT_LT(worst, tolerance(1e-9, 1e-3, 1e-3) * a.R());
}

std::vector<std::byte> bits(const GrainStore& g) {
  std::vector<std::byte> all;
  for (const auto& a : g.save().arrays) all.insert(all.end(), a.bytes.begin(), a.bytes.end());
  return all;
}

TEST(SolidLists, ACheckpointContinuesBitForBit) {
  Heap a(200);
  a.start();
  a.run(2e-6, 310);  // well after the last rebuild and before the next
  const HostStore grains = a.grains->save(), contacts = a.solver->save_contacts(*a.grains);
  ASSERT_GT(contacts.count, 10u);

  Heap b(200);
  b.build();
  b.grains->load(grains);
  b.solver->load_contacts(*b.grains, *b.grid, contacts);
  b.time = a.time;
  EXPECT_EQ(bits(*a.grains), bits(*b.grains));
  a.run(2e-6, 300);
  b.run(2e-6, 300);
  EXPECT_EQ(bits(*a.grains), bits(*b.grains));
  EXPECT_EQ(histories(a), histories(b));
}

TEST(SolidLists, RefusesContactsThatDoNotBelong) {
  Heap a(200);
  a.start();
  a.run(2e-6, 100);
  const HostStore grains = a.grains->save();
  HostStore contacts = a.solver->save_contacts(*a.grains);
  ASSERT_GT(contacts.count, 0u);
  Heap b(200);
  b.build();
  b.grains->load(grains);
  contacts.arrays[0].as<Id>()[0] = contacts.arrays[1].as<Id>()[0];  // a grain touching itself
  EXPECT_THROW(b.solver->load_contacts(*b.grains, *b.grid, contacts), FileError);
  contacts.arrays.pop_back();
  EXPECT_THROW(b.solver->load_contacts(*b.grains, *b.grid, contacts), FileError);
}

TEST(SolidLists, WallsAreMetByTheListAsWithoutOne) {
  // a lid comes down on a heap and goes farther than a skin
  const auto boxed = [](double told_speed) {
    auto b = std::make_unique<Heap>(200, false);
    WallBody lid;
    lid.shape = "box";
    lid.min = {-0.01, -0.01, 0.0145}, lid.max = {0.03, 0.03, 0.02};
    b->config.wall.bodies.push_back(lid);
    b->motion = [](int body, double t) {
      BodyPose pose;
      if (body == 1) pose.v = {0, 0, -2}, pose.translation = t * pose.v;
      return pose;
    };
    b->wall_speed = told_speed;
    b->start();
    b->run(2e-6, 1500);
    return b;
  };
  const auto all = boxed(WallList::kAnywhere), listed = boxed(2);
  EXPECT_EQ(all->solver->near_walls(), 200u);
  EXPECT_LT(listed->solver->near_walls(), 150u);
  EXPECT_GT(listed->solver->near_walls(), 50u);
  listed->set_poses(1, 0);
  EXPECT_GT(listed->solver->body_loads(*listed->grains, listed->poses())[1].force().z, 0) << "the lid is met";
  EXPECT_EQ(bits(*all->grains), bits(*listed->grains));
  EXPECT_EQ(histories(*all), histories(*listed));
}

TEST(SolidLists, TheSameRunTwiceIsBitEqual) {
  Heap a(200), b(200);
  a.start(), b.start();
  a.run(2e-6, 300), b.run(2e-6, 300);
  EXPECT_EQ(bits(*a.grains), bits(*b.grains));
}

TEST(SolidLists, PeriodicImagesTouch) {
  GrainBench b;
  b.config.domain.periodic = {true, false, false};
  b.add({-0.1 + 0.5 * b.R(), 0, 0}, {-0.1, 0, 0});
  b.add({0.1 - 1.4 * b.R(), 0, 0}, {0.1, 0, 0});
  b.start();
  EXPECT_EQ(b.solver->totals(*b.grains).contacts, 1);
  EXPECT_GT(b.force(0).x, 0);
  EXPECT_EQ(b.force(0).x, -b.force(1).x);
  b.run(1e-6, 200);
  b.refresh();
  EXPECT_GT(b.velocity(0).x, 0) << "pushed apart through the boundary";
}

TEST(SolidLists, WatchFindsSpeedTravelAndFaults) {
  GrainBench b;
  b.add({0, 0, 0}, {0.1, 0, 0});
  b.add({0.05, 0, 0}, {0, 0.2, 0});
  b.add({0, 0.05, 0}, {0, 0, 0});
  b.start();
  b.run(1e-5, 10);
  GrainWatch w = b.solver->watch(*b.grains);
  EXPECT_NEAR(w.speed, 0.2, 1e-6);
  EXPECT_NEAR(w.displacement, 2e-5, 1e-9);
  EXPECT_EQ(w.bad, kNone);
  auto v = b.grains->v.values();
  const auto id = b.grains->id.values();
  for (std::size_t i = 0; i < 3; ++i)
    if (id[i] == 1 || id[i] == 2) v[i].y = std::nan("");
  b.grains->v.assign(v);
  EXPECT_EQ(b.solver->watch(*b.grains).bad, 1u);
}

TEST(SolidLists, NoGrainsAtAllIsFine) {
  GrainBench b;
  b.start();
  b.run(1e-5, 10);
  EXPECT_EQ(b.solver->totals(*b.grains).mass, 0);
  EXPECT_EQ(b.solver->watch(*b.grains).bad, kNone);
  EXPECT_EQ(b.solver->save_contacts(*b.grains).count, 0u);
}

}  // namespace
}  // namespace bedload::inline BL_VARIANT
