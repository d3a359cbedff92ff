// Which cases a viscometer takes, and what it says of others.

#include "src/viscometer/plane_flow.hpp"

#include <gtest/gtest.h>

#include "tests/case/support.hpp"

namespace bedload::test {
namespace {

constexpr const char* kReverse = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.2, 0.3, 0.4]
periodic = [true, true, true]
[fluid]
dx = 0.02
mu = 1
vmax = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.3, 0.4]
[drive]
f = [0, -2, 0]
opposed = "z"
[time]
end = 1
[out]
every = 1
)";

constexpr const char* kWalled = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, -0.1]
max = [0.2, 0.3, 0.5]
periodic = [true, true, false]
[fluid]
dx = 0.02
mu = 1
vmax = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.3, 0.4]
[[wall.body]]
name = "floor"
shape = "box"
min = [0, 0, -0.1]
max = [0.2, 0.3, 0]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 0.4]
normal = [0, 0, -1]
surface_velocity = [0.05, 0, 0]
[time]
end = 1
[out]
every = 1
)";

PlaneFlow flow_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return plane_flow_of(read(text, overrides));
}

TEST(ViscometerCase, IsDecidedFromTheCase) {
  const PlaneFlow reverse = flow_of(kReverse);
  EXPECT_EQ(reverse.kind, PlaneFlowKind::reverse_poiseuille);
  EXPECT_EQ(reverse.along, 1);
  EXPECT_EQ(reverse.gradient, 2);
  EXPECT_DOUBLE_EQ(reverse.gap(), 0.2);

  const PlaneFlow couette = flow_of(kWalled);
  EXPECT_EQ(couette.kind, PlaneFlowKind::couette);
  EXPECT_EQ(couette.along, 0);
  EXPECT_DOUBLE_EQ(couette.gap(), 0.4);
  EXPECT_DOUBLE_EQ(couette.relative_speed, 0.05);
  EXPECT_DOUBLE_EQ(couette.area, 0.06);
  EXPECT_EQ(couette.lower, 0);
  EXPECT_EQ(couette.upper, 1);

  const PlaneFlow driven = flow_of(kWalled, {"wall.body.1.surface_velocity=[0,0,0]", "drive.f=[0,3,0]"});
  EXPECT_EQ(driven.kind, PlaneFlowKind::poiseuille);
  EXPECT_EQ(driven.along, 1);
  const PlaneFlow moved =
      flow_of(kWalled, {"wall.body.1.surface_velocity=[0,0,0]", "wall.body.0.motion.kind=velocity",
                        "wall.body.0.motion.velocity=[0.02,0,0]"});
  EXPECT_DOUBLE_EQ(moved.relative_speed, -0.02);

  const PlaneFlow images = flow_of(
      kReverse, {"drive.f=[0,0,0]", "drive.opposed=none", "domain.shear_rate=0.5", "fluid.h_over_dx=1.2"});
  EXPECT_EQ(images.kind, PlaneFlowKind::lees_edwards);
  EXPECT_EQ(images.along, 0);
  EXPECT_EQ(images.gradient, 2);
  EXPECT_DOUBLE_EQ(images.gap(), 0.4);
  EXPECT_DOUBLE_EQ(images.relative_speed, 0.2);
  EXPECT_DOUBLE_EQ(images.area, 0.06);
  EXPECT_DOUBLE_EQ(images.relaxation(2), 0.4 * 0.4 / (4 * M_PI * M_PI * 2)) << "of a wave of that length";
  EXPECT_DOUBLE_EQ(couette.relaxation(2), 0.4 * 0.4 / (M_PI * M_PI * 2));
}

struct Refused {
  const char* text;
  std::vector<std::string> overrides;
  const char *key, *why;
};

TEST(ViscometerCase, RefusesWhatItCannotMeasure) {
  for (const Refused& r : std::vector<Refused>{
           {kReverse, {"drive.opposed=none"}, "drive.opposed", "neither walls nor an opposed drive"},
           {kReverse, {"drive.f=[0,1,1]"}, "drive.f", "one axis"},
           {kReverse, {"drive.f=[0,0,1]"}, "drive.f", "one axis"},
           {kReverse, {"domain.periodic=[true,false,true]"}, "domain.periodic", "along y"},
           {kReverse, {"visc.alpha=0.1"}, "visc.alpha", "artificial viscosity must be 0"},
           {kReverse, {"fluid.mu=0"}, "fluid.mu", "viscosity above 0"},
           {kReverse, {"fluid.dx=0.06", "domain.max=[0.6,0.6,0.4]"}, "fluid.dx", "too narrow"},
           {kWalled, {"drive.f=[0,3,0]"}, "drive.f", "driven and sheared at the same time"},
           {kWalled, {"wall.body.1.surface_velocity=[0,0,0]"}, "drive.f", "nothing drives"},
           {kWalled, {"wall.body.1.normal=[0,0,1]"}, "wall.body", "one side"},
           {kWalled, {"wall.body.0.max=[0.1,0.3,0]"}, "wall.body.0.shape", "not a plane wall"},
           {kWalled,
            {"wall.body.0.motion.kind=oscillation", "wall.body.0.motion.frequency=1",
             "wall.body.0.motion.amplitude=[0.01,0,0]"},
            "wall.body.0.motion",
            "must be constant"}}) {
    try {
      flow_of(r.text, r.overrides);
      ADD_FAILURE() << r.why << " was not refused";
    } catch (const KeyError& error) {
      EXPECT_EQ(error.key, r.key);
      EXPECT_NE(std::string(error.what()).find(r.why), std::string::npos) << error.what();
    }
  }
}

/// Which is not to be said of flows that nobody would measure.
TEST(ViscometerCase, TellsNoPlaneFlowFromOneThatIsRefused) {
  EXPECT_THROW(plane_flow_of(read(kCase)), NoPlaneFlow);
  EXPECT_THROW(plane_flow_of(read(kCase, {"visc.alpha=0.02"})), NoPlaneFlow);
  try {
    flow_of(kWalled, {"visc.alpha=0.02"});
    FAIL();
  } catch (const NoPlaneFlow&) {
    FAIL() << "it is one";
  } catch (const KeyError& error) {
    EXPECT_EQ(error.key, "visc.alpha");
  }
  EXPECT_EQ(blocks_until(flow_of(kWalled), 1e-3, 1e6), 50);
  EXPECT_THROW(blocks_until(flow_of(kWalled), 1e-3, 14 * 0.16 / (M_PI * M_PI * 1e-3) * 0.99), KeyError);
}

/// fluid.vmax follows from the faster wall, and sound from that.
TEST(ViscometerCase, WallsThatPassEachOtherAreAsFastAsTheFaster) {
  const PlaneFlow flow = flow_of(kWalled, {"wall.body.0.surface_velocity=[-0.03, 0, 0]"});
  EXPECT_DOUBLE_EQ(flow.relative_speed, 0.08);
  EXPECT_DOUBLE_EQ(flow.fastest, 0.05);
}

}  // namespace
}  // namespace bedload::test
