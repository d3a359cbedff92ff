// Lists and what goes with them: neighbours, history through a rebuild, checkpoints.
#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <set>

#include "bedload/core/error.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
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

/// Pairs within reach by a search through all; across: how many of them through a periodic side.
std::set<Pair> pairs_within_reach(const GrainBench& b, int& across) {
  const auto id = b.grains->id.values();
  const auto x = b.grains->x.values();
  const auto r = b.grains->radius.values();
  const Vec3d length = b.config.domain.max - b.config.domain.min;
  std::set<Pair> pairs;
  across = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j) {
      Vec3d d = x[i] - x[j];
      for (int k = 0; k < 3; ++k)
        if (b.config.domain.periodic[k]) d[k] -= length[k] * std::round(d[k] / length[k]);
      if (i == j || norm(d) >= double(r[i]) + double(r[j]) + b.solver->skin()) continue;
      pairs.insert({id[i], id[j]});
      across += norm(d - (x[i] - x[j])) > 0;
    }
  return pairs;
}

TEST(SolidLists, HoldExactlyThePairsWithinReach) {
  for (bool periodic : {true, false}) {
    Heap b(300, periodic);
    b.start();
    int across = 0;
    EXPECT_EQ(listed_pairs(b), pairs_within_reach(b, across));
    EXPECT_EQ(across > 0, periodic);
  }
}

/// Large grains with small ones around and between them, and some of a size between. side: of the box, over
/// the radius of the large ones.
GrainBench unlike_grains(double ratio, double side, bool periodic, bool plane = false) {
  GrainBench b;
  const double large = 2e-3, small = large / ratio, length = side * large;
  b.config.domain.min = {0, 0, 0};
  b.config.domain.max = {length, plane ? 2.2 * large : length, length};
  b.config.domain.periodic = {periodic, periodic || plane, periodic};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  const auto anywhere = [&] {
    return Vec3d{u(random) * length, plane ? 1.1 * large : u(random) * length, u(random) * length};
  };
  b.add({large, 1.1 * large, large}, {}, {}, large);
  b.add({large + 1.999 * large, 1.1 * large, large}, {}, {}, large);
  for (int k = 0; k < 40; ++k) b.add(anywhere(), {}, {}, std::sqrt(large * small));
  const int count = ratio > 2 ? 300 : 60;
  for (int k = 0; k < count; ++k) b.add(anywhere(), {}, {}, small);
  for (int k = 0; k < count; ++k) {  // on the surfaces of large ones
    Vec3d out{u(random) - 0.5, plane ? 0 : u(random) - 0.5, u(random) - 0.5};
    out *= 1 / norm(out);
    b.add(b.x[k % 2] + out * (large + (0.9 + u(random)) * small), {}, {}, small);
  }
  return b;
}

TEST(SolidLists, HoldGrainsOfAllSizesAndNoOthers) {
  for (const double ratio : {1., 1.9, 5., 20., 100.})
    for (const double side : {10., 3.5})  // that is less than two large ones and a skin
      for (const bool periodic : {true, false})
        for (const bool plane : {false, true}) {
          SCOPED_TRACE(testing::Message() << ratio << " " << side << " " << periodic << plane);
          GrainBench b = unlike_grains(ratio, side, periodic, plane);
          b.start();
          EXPECT_EQ(b.solver->in_levels(), ratio > 2);
          int across = 0;
          EXPECT_EQ(listed_pairs(b), pairs_within_reach(b, across));
          EXPECT_EQ(across > 0, periodic);
        }
}

TEST(SolidLists, AGrainIsPushedByOneTwentyTimesAsLarge) {
  GrainBench b;
  const double large = 2e-3, small = large / 20, overlap = 0.01 * small;
  b.add({0, 0, 0}, {}, {}, large);
  b.add({large + small - overlap, 0, 0}, {}, {}, small);
  b.start();
  // Hertz between spheres of those radii; the overlap is a difference of radii that Real has rounded
  const double R = large * small / (large + small), E = b.E_star();
  const double expected = 4.0 / 3 * E * std::sqrt(R) * std::pow(overlap, 1.5);
  const double rounding = tolerance(1e-9, 3e-4, 3e-4);
  EXPECT_NEAR(b.force(1).x, expected, rounding * expected);
  EXPECT_EQ(b.force(0), -b.force(1));
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
  b.run(2e-6, 500);  // then some are on the floor
  const auto before = histories(b);
  const auto wall = b.solver->totals(*b.grains).wall_contacts;
  const double elastic = b.solver->totals(*b.grains).elastic;
  ASSERT_GT(before.size(), 30u);
  ASSERT_GT(wall, 0);
  b.refresh();
  EXPECT_EQ(histories(b), before);
  EXPECT_EQ(b.solver->totals(*b.grains).wall_contacts, wall);
  EXPECT_NEAR(b.solver->totals(*b.grains).elastic / elastic, 1, 1e-12);
}

TEST(SolidLists, BothPartnersHoldTheSameHistory) {
  Heap b(300);
  b.start();
  b.run(2e-6, 500);
  const auto of_lower = histories(b);
  ASSERT_GT(of_lower.size(), 30u);
  EXPECT_EQ(b.solver->totals(*b.grains).contacts, double(of_lower.size()));
  // what is saved is what the partner of lower id holds: with ids turned round, that is the other one
  std::vector<Id> id = b.grains->id.values();
  const Id last = Id(id.size() - 1);
  for (Id& k : id) k = last - k;
  b.grains->id.assign(id);
  std::map<Pair, std::vector<std::byte>> of_higher;
  for (const auto& [pair, history] : histories(b))
    of_higher[{last - pair.second, last - pair.first}] = history;
  EXPECT_EQ(of_higher, of_lower);
}

TEST(SolidLists, ForcesBetweenGrainsCancel) {
  Heap b(300);
  b.start();
  b.run(2e-6, 500);
  b.set_poses(1, 0);
  b.solver->evaluate(*b.grains, b.poses());
  Vec3d sum;
  double scale = 0;
  for (const Real3& f : b.grains->force.values()) sum += Vec3d(f), scale += norm(Vec3d(f));
  const Vec3d on_floor = b.solver->body_loads(*b.grains, b.poses())[0].force();
  EXPECT_GT(norm(on_floor), 0.01 * scale);
  // in double 1e-9: springs on both sides add up their own rounding over 500 steps
  EXPECT_LT(norm(sum + on_floor), tolerance(1e-8, kInvariant, kInvariant) * scale);
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
  const HostStore contacts = a.solver->save_contacts(*a.grains);
  HostStore grains = a.grains->save();
  a.solver->save_walls(grains);
  ASSERT_GT(contacts.count, 10u);

  Heap b(200);
  b.build();
  b.grains->load(grains);
  b.solver->load_walls(grains, *b.grains);
  b.solver->load_contacts(*b.grains, *b.grid, contacts);
  b.time = a.time;
  EXPECT_EQ(bits(*a.grains), bits(*b.grains));
  a.run(2e-6, 300);
  b.run(2e-6, 300);
  EXPECT_EQ(bits(*a.grains), bits(*b.grains));
  EXPECT_EQ(histories(a), histories(b));
}

/// A large grain and 300 small ones that fly towards it: its row is long.
struct Coated : GrainBench {
  Coated() {
    const double large = 1.35e-3, small = large / 20;
    config.contact.rolling = "epsd";
    add({0, 0, 0}, {}, {}, large);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(0, 1);
    for (int k = 0; k < 300; ++k) {  // spread evenly
      const double z = 1 - (2 * k + 1) / 300.0, turn = 2.399963 * k;
      const Vec3d out{std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
      const Vec3d across = cross(out, Vec3d{0, 0, 1});
      add(out * (large + small * (1.03 + 0.03 * u(random))), -0.2 * out + 0.1 * across, 40 * out, small);
    }
  }
};

TEST(SolidLists, ALargeGrainKeepsTheHistoryOfManySmallOnes) {
  Coated b;
  b.start();
  b.run(5e-8, 400);
  const auto before = histories(b);
  ASSERT_GT(before.size(), 150u);
  b.refresh();
  EXPECT_EQ(histories(b), before);
  b.run(5e-8, 40);
  EXPECT_EQ(b.solver->totals(*b.grains).contacts, double(histories(b).size())) << "both partners agree";
}

TEST(SolidLists, MomentumOfUnlikeGrainsIsKept) {
  Coated b;
  b.start();
  b.run(5e-8, 400);
  const auto v = b.grains->v.values();
  const auto r = b.grains->radius.values();
  Vec3d sum;
  double scale = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    sum += b.mass(double(r[i])) * Vec3d(v[i]), scale += b.mass(double(r[i])) * norm(Vec3d(v[i]));
  Vec3d start;
  for (std::size_t i = 0; i < b.v.size(); ++i) start += b.mass(b.radius[i]) * b.v[i];
  EXPECT_LT(norm(sum - start), tolerance(1e-10, 1e-6, 1e-6) * scale);
}

TEST(SolidLists, PiecesOfALongRowAddUp) {
  Coated b;
  b.start();
  b.run(5e-8, 400);
  b.set_poses(1, 0);
  b.solver->evaluate(*b.grains, b.poses());
  ASSERT_GT(HostVerletList(b.solver->list()).count[0], 2 * LongRowsView::kPiece)
      << "the large grain is first";
  const auto f = b.grains->force.values();
  Vec3d by_small;
  double scale = 0;
  for (std::size_t i = 1; i < f.size(); ++i) by_small += Vec3d(f[i]), scale += norm(Vec3d(f[i]));
  EXPECT_GT(scale, 0);
  EXPECT_LT(norm(Vec3d(f[0]) + by_small), tolerance(1e-12, 1e-6, 1e-6) * scale);
}

#if !BL_CUDA
TEST(SolidLists, AnyNumberOfThreadsGivesTheSameBits) {
  const int threads = omp_get_max_threads();
  std::vector<std::byte> expected;
  for (const int n : {1, 3}) {
    omp_set_num_threads(n);
    Coated b;
    b.start();
    b.run(5e-8, 400);
    b.refresh();
    b.run(5e-8, 40);
    if (n == 1)
      expected = bits(*b.grains);
    else
      EXPECT_EQ(bits(*b.grains), expected);
  }
  omp_set_num_threads(threads);
}
#endif

TEST(SolidLists, ACheckpointOfUnlikeGrainsContinuesBitForBit) {
  Coated a, b;
  a.start();
  a.run(5e-8, 310);
  const HostStore contacts = a.solver->save_contacts(*a.grains);
  HostStore grains = a.grains->save();
  a.solver->save_walls(grains);
  ASSERT_GT(contacts.count, 100u);
  b.build();
  b.grains->load(grains);
  b.solver->load_walls(grains, *b.grains);
  b.solver->load_contacts(*b.grains, *b.grid, contacts);
  b.time = a.time;
  a.run(5e-8, 300);
  b.run(5e-8, 300);
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
  b.add({-0.1 + 0.5 * b.R(), 0, 0});
  b.add({0.1 - 1.4 * b.R(), 0, 0});
  b.start();
  EXPECT_EQ(b.solver->totals(*b.grains).contacts, 1);
  const double hertz = 4.0 / 3 * b.E_star() * std::sqrt(b.R() / 2) * std::pow(0.1 * b.R(), 1.5);
  EXPECT_NEAR(b.force(0).x / hertz, 1, tolerance(1e-9, 1e-5, 1e-5));
  EXPECT_NEAR(b.solver->totals(*b.grains).max_overlap, 0.1 / 2, 1e-6) << "over the diameter";
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
}  // namespace BL_SOLVER
