#pragma once
// Small cases that have, between them, every stage of a step.

#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/read.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {

inline const std::string kFluid = R"([fluid]
dx = 0.01
[[fluid.fill]]
min = [0.005, 0.005, 0.005]
max = [0.095, 0.095, 0.065]
)";
/// Some touch each other, some the floor, two are one body.
inline const std::string kGrains = R"([grain]
d = 0.01
[[grain.fill]]
positions = [[0.05, 0.05, 0.0048], [0.058, 0.05, 0.011], [0.02, 0.05, 0.014], [0.03, 0.02, 0.04]]
velocity = [0.1, 0, -0.1]
[[grain.fill]]
positions = [[0.08, 0.08, 0.02], [0.08, 0.0901, 0.02]]
rigid = {}
)";
inline const std::string kGate = R"([[wall.body]]
name = "gate"
shape = "box"
min = [0.045, 0.0, 0.035]
max = [0.055, 0.1, 0.13]
[wall.body.motion]
kind = "velocity"
velocity = [0.0, 0.0, 0.68]
)";
inline const std::string kFloat = R"([[wall.body]]
name = "float"
shape = "box"
min = [0.03, 0.03, 0.05]
max = [0.07, 0.07, 0.09]
[wall.body.free]
density = 500
)";

/// A case of few particles, given as text.
struct StageCase {
  const char* name;
  std::string text;
  std::vector<std::string> overrides;

  Config config() const {
    std::vector<std::string> warnings;
    return read_case_text(text, "case.toml", overrides, warnings);
  }
};

inline const std::string kBed = kTank + kFluid + kGrains;
/// Between them they have every stage.
inline std::vector<StageCase> stage_cases() {
  return {
      {"fluid", kTank + kFluid, {"visc.collision=true", "visc.collision_range=1", "xsph=0.3"}},
      {"fluid, euler", kTank + kFluid, {"time.integrator=euler"}},
      {"fluid, ab3", kTank + kFluid + kGate, {"time.integrator=ab3"}},
      {"oil", kTank + kFluid + kGate, {"fluid.mu=1"}},
      {"oil, ab3", kTank + kFluid, {"fluid.mu=1", "time.integrator=ab3"}},
      {"smoothing lengths", kTank + kFluid, {"fluid.variable_h=true"}},
      {"sdpd", kTank + kFluid + kGate, {"fluid.model=sdpd_a", "sdpd.kT=1e-9"}},
      {"sdpd by summation", kBed, {"fluid.model=sdpd", "density.method=summation", "pressure.filter=true"}},
      {"frozen walls", kTank + kFluid + kGate, {"wall.type=frozen"}},
      {"mirrored walls", kTank + kFluid + kGate, {"wall.type=mdbc"}},
      {"coupled", kBed + kGate, {"couple.slip=local"}},
      {"coupled, bodies", kBed + kFloat, {}},
      {"coupled one way", kBed + kFloat, {"couple.mode=one_way"}},
      {"grains", kTank + kGrains + kFloat, {}},
      {"held grains", kBed, {"grain.release_time=1"}},
  };
}

}  // namespace bedload::test
