// What a live view keeps of a run: rows, frames and pictures.

#include "src/viewer/live/view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/output/fake_simulation.hpp"

namespace bedload::testing {
namespace {

TEST(LiveTable, KeepsFirstAndLastRowsAndThinsThoseBetweenEvenly) {
  LiveView view("dam");
  for (int k = 0; k < 5000; ++k) {
    view.add_row("probes/gauge", 0.1 * k, {{"level", "m", 2.0 * k}, {"none", "-", std::nan("")}});
    if (k % 97 != 0 && k != 4999) continue;
    const auto table = nlohmann::json::parse(*view.table("probes/gauge"));
    const std::vector<double> times = table["time"]["values"], levels = table["columns"][0]["values"];
    ASSERT_EQ(times.size(), levels.size());
    ASSERT_LE(times.size(), LiveView::kMostRows);
    ASSERT_GE(times.size(), std::min<std::size_t>(k + 1, LiveView::kMostRows / 2));
    ASSERT_EQ(times.front(), 0);
    ASSERT_EQ(times.back(), 0.1 * k);
    ASSERT_EQ(table["rows"], k + 1);
    const double step = times.size() > 1 ? times[1] - times[0] : 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
      ASSERT_DOUBLE_EQ(levels[n], 20 * times[n]);
      const bool between = n > 0 && n + 1 < times.size();
      ASSERT_NEAR(between ? times[n] - times[n - 1] : step, step, 1e-9);
    }
    ASSERT_TRUE(table["columns"][1]["values"].back().is_null()) << "JSON knows no NaN";
  }
  EXPECT_FALSE(view.table("probes/none"));
}

/// Many grains, some of which are nowhere any more, and a body that has moved by 0.2 m.
class Crowd : public FakeSimulation {
 public:
  HostStore snapshot(const std::string& store) override {
    if (store != "grains") return {store, 0, {}};
    const std::size_t n = 100000;
    std::vector<double> x;
    std::vector<float> v, radius(n, 0.01f);
    std::vector<std::uint32_t> id;
    for (std::size_t k = 0; k < n; ++k) {
      const double z = k % 10 == 0 ? std::nan("") : 0.5;
      x.insert(x.end(), {1e-5 * double(k), 0.5, z});
      v.insert(v.end(), {0, k < n / 2 ? 0.3f : 0, 0});
      id.push_back(std::uint32_t(n - k));
    }
    return {store,
            n,
            {array_of("position", "m", Scalar::f64, 3, x), array_of("velocity", "m/s", Scalar::f32, 3, v),
             array_of("radius", "m", Scalar::f32, 1, radius), array_of("id", "-", Scalar::u32, 1, id)}};
  }
};

Config crowd_config() {
  Config c = fake_config();
  c.wall.bodies.front().shape = "box";
  c.wall.bodies.front().min = {0.1, 0.4, 0.1}, c.wall.bodies.front().max = {0.2, 0.6, 0.2};
  c.wall.bodies.front().motion.kind = "velocity";
  return c;
}

TEST(LiveFrame, TakesTheSameFewOfManyAndNoneThatIsNowhere) {
  Crowd crowd;
  const FrameTaker taker(crowd_config());
  const LiveFrame one = taker.take(crowd), other = taker.take(crowd);
  const LiveParticles& grains = one.grains;
  EXPECT_TRUE(one.fluid.x.empty());
  EXPECT_NEAR(double(grains.x.size()), 0.9 * 30000, 500);
  EXPECT_NEAR(grains.enlarged, std::cbrt(100000.0 / 30000), 1e-12);
  EXPECT_NEAR(grains.radius.front(), 0.01 * grains.enlarged, 1e-8);
  for (const Vec3d& x : grains.x) ASSERT_TRUE(std::isfinite(norm(x)));
  ASSERT_EQ(other.grains.x.size(), grains.x.size());
  for (std::size_t k = 0; k < grains.x.size(); ++k) ASSERT_EQ(other.grains.x[k].x, grains.x[k].x);
  EXPECT_NEAR(
      double(std::count_if(grains.x.begin(), grains.x.end(), [](const Vec3d& x) { return x.x < 0.25; })),
      0.25 * double(grains.x.size()), 300)
      << "evenly";
  EXPECT_EQ(one.top_speed, 0.5) << "above 0.3 m/s, rounded up";
  EXPECT_TRUE(one.bodies.at(0));
}

TEST(LivePicture, LeavesOutBodiesThatHaveBeenRemoved) {
  LivePicture picture(crowd_config());
  LiveFrame frame;
  frame.grains = {{{0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}}, {0, 0}, {0.05, 0.05}, 1};
  frame.bodies.emplace_back(RigidMotion());
  frame.removed = {false};
  const auto png = [&] { return picture.draw(frame, LiveSide::front).png(); };
  const auto there = png();
  frame.removed = {true};
  const auto gone = png();
  frame.removed = {false};
  frame.bodies.front()->translation = {0, 0, 50};
  EXPECT_NE(there, gone);
  EXPECT_EQ(png(), gone) << "as if it were far away";
}

TEST(LivePicture, ShowsGrainsBySpeedAndWallsWhereTheyAre) {
  LivePicture picture(crowd_config());
  LiveFrame frame;
  frame.grains = {{{0.5, 0.5, 0.9}, {5, 5, 5}, {0.5, 0.5, 0.1}}, {0, 0, 2}, {0.05, 0.05, 0.05}, 1};
  frame.top_speed = 1;
  frame.bodies.emplace_back(RigidMotion());
  const Image there = picture.draw(frame, LiveSide::front);
  frame.bodies.front()->translation = {0.6, 0, 0};
  const Image moved = picture.draw(frame, LiveSide::front);
  // The view holds what was ever seen: 0.1..0.8 m by about 0.05..0.95 m, and no grain far outside the domain.
  ASSERT_EQ(moved.height(), 600);
  const auto red_over_blue = [](const Image& image, double fx, double fz) {
    const Colour c = image.at(int(fx * image.width()), int((1 - fz) * image.height()));
    return c.r - c.b;
  };
  const auto at = [](double x) { return (x - 0.1) / 0.7; };
  EXPECT_GT(red_over_blue(moved, at(0.75), 0.11), 0.1) << "the body, red";
  EXPECT_LT(red_over_blue(moved, at(0.15), 0.11), 0.05) << "it has left";
  EXPECT_GT(there.width(), 160);
  const Colour slow = moved.at(int(at(0.5) * moved.width()), int(0.055 * moved.height()));
  const Colour fast = moved.at(int(at(0.5) * moved.width()), int(0.945 * moved.height()));
  EXPECT_GT(slow.g, 2 * fast.g) << "sand and deep red";
}

}  // namespace
}  // namespace bedload::testing
