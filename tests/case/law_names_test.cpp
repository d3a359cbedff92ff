// Every name of every law and model goes through a case file and back.

#include <gtest/gtest.h>

#include <map>

#include "support.hpp"

namespace bedload::test {
namespace {

/// kCase with key = each name of E and what a name needs besides; written out and read again it is the same
/// case.
template <class E>
void expect_round_trips(const std::string& key,
                        std::map<std::string, std::vector<std::string>> besides = {}) {
  for (const auto& row : kNames<E>) {
    const std::string name(row.name);
    if constexpr (std::is_same_v<E, FluidModel>)
      if (row.nodes) continue;  // not with what kCase has; cases of its own are in cases_test
    SCOPED_TRACE(key + " = " + name);
    std::vector<std::string> overrides = besides[name];
    overrides.push_back(key + "=" + name);
    const Config config = read(kCase, overrides);
    const std::string text = resolved_toml(config);
    Config again = read(text);
    again.file = config.file;
    EXPECT_TRUE(again == config);
    EXPECT_NE(text.find('"' + name + '"'), text.npos) << "not written";
  }
}

TEST(LawNames, GoThroughACaseFile) {
  const std::vector<std::string> spring{"contact.k=1000"}, sdpd{"fluid.model=sdpd"},
      spin{"fluid.model=sdpd_a"};
  expect_round_trips<NormalLaw>("contact.normal", {{"linear", spring}});
  expect_round_trips<SlidingLaw>("contact.tangential");
  expect_round_trips<RollingLaw>("contact.rolling");
  expect_round_trips<DragLaw>(
      "drag.law",
      {{"table",
        {"drag.porosity=[0.4, 1]", "drag.reynolds=[0, 10, 1000]", "drag.factor=[7, 20, 150, 1, 3, 20]"}}});
  expect_round_trips<DragIntegrator>("drag.integrator");
  expect_round_trips<DragSlip>("couple.slip");
  expect_round_trips<CouplingMode>("couple.mode");
  expect_round_trips<FluidModel>("fluid.model");
  expect_round_trips<KernelFunction>("fluid.kernel", {{"lucy", {"fluid.h_over_dx=3"}}});
  expect_round_trips<ViscosityModel>("visc.model");
  expect_round_trips<EosType>("eos.type");
  expect_round_trips<DensityMethod>("density.method", {{"continuity", sdpd}, {"summation", sdpd}});
  expect_round_trips<NoiseForm>("sdpd.noise", {{"vector", spin}, {"tensor", spin}});
  expect_round_trips<DriveMode>("drive.mode");
  expect_round_trips<DriveReversal>("drive.opposed");
  expect_round_trips<WallType>("wall.type");
  expect_round_trips<WallSlip>("wall.slip");
  expect_round_trips<LayerForce>("wall.force");
  expect_round_trips<TimeIntegrator>("time.integrator", {{"ab3", {"couple.mode=one_way"}}});
}

TEST(SetupNames, GoThroughACaseFile) {
  expect_round_trips<Preset>(
      "preset", {{"robinson2014", {"contact.k=1000"}}, {"democritus", {"eos.p0=4000", "couple.hc=0.02"}}});
  expect_round_trips<Precision>("run.precision");
  expect_round_trips<Simd>("run.simd");
  expect_round_trips<ContactFrames>("out.contacts");
  expect_round_trips<BodyTables>("out.bodies");
  const std::string motion = "wall.body.0.motion.";
  const std::vector<std::string> wave{motion + "wave_height=0.01", motion + "wave_period=1",
                                      motion + "wave_depth=0.1", motion + "wave_ramp=0",
                                      motion + "wave_direction=[1, 2, 0]"};
  std::vector<std::string> hinged = wave;
  hinged.push_back(motion + "centre=[0, 0, 0]");
  expect_round_trips<MotionKind>(
      motion + "kind",
      {{"velocity", {motion + "velocity=[0, 0, 0.1]"}},
       {"oscillation", {motion + "amplitude=[0, 0, 0.01]", motion + "frequency=1"}},
       {"rotation", {motion + "axis=[0, 0, 1]", motion + "centre=[0, 0, 0]", motion + "rate=1"}},
       {"table", {motion + "rows=[[0, 0, 0, 0], [1, 0, 0, 0.1]]"}},
       {"piston", wave},
       {"flap", hinged}});
}

}  // namespace
}  // namespace bedload::test
