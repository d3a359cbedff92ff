// Every law and model that a case may name is read and runs.

#include <map>
#include <set>

#include "bedload/case/choices.hpp"
#include "bedload/case/read.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/support/cases.hpp"

namespace BL_SOLVER {
namespace {

/// Grains that fall into each other and onto the floor of a tank of water.
const std::string kBed = test::kTank + R"([fluid]
dx = 0.01
[[fluid.fill]]  # half a spacing from the walls, as single layers want it
min = [0.005, 0.005, 0.005]
max = [0.095, 0.095, 0.085]
[grain]
d = 0.01
[[grain.fill]]
positions = [[0.05, 0.05, 0.0048], [0.058, 0.05, 0.011], [0.045, 0.05, 0.014]]
velocity = [0.1, 0, -0.1]
)";

/// Runs kBed with key = each name of E, and `besides` where a name asks for more.
template <class E>
void expect_all_run(const std::string& key, const std::map<std::string, std::string>& besides = {}) {
  std::set<std::string> names;
  for (const auto& row : kNames<E>) {
    const std::string name(row.name);
    if constexpr (std::is_same_v<E, FluidModel>)
      if (row.nodes) continue;  // without grains, in tests/lattice
    SCOPED_TRACE(key + " = " + name);
    EXPECT_TRUE(names.insert(name).second) << "two of one name";
    EXPECT_FALSE(row.meaning.empty());
    EXPECT_EQ(Chosen<E>(name), row.value);
    EXPECT_EQ(Chosen<E>(row.value).name(), name);

    std::vector<std::string> overrides{key + "=" + name}, warnings;
    if (besides.contains(name)) overrides.push_back(besides.at(name));
    const Config config = read_case_text(kBed, "bed.toml", overrides, warnings);
    const auto s = started(config);
    for (int k = 0; k < 3; ++k) s->step();
    for (const char* phase : {"fluid", "grains"})
      for (const Vec3d& x : vectors(s->snapshot(phase), "position")) EXPECT_TRUE(std::isfinite(norm(x)));
  }
  EXPECT_THROW(Chosen<E>("nothing"), CaseError);
}

TEST(Choices, OfContactsRun) {
  expect_all_run<NormalLaw>("contact.normal", {{"linear", "contact.k=1000"}});
  expect_all_run<SlidingLaw>("contact.tangential");
  expect_all_run<RollingLaw>("contact.rolling");
  expect_all_run<LubricationForces>("lubrication.forces");
}

TEST(Choices, OfTheFluidRun) {
  expect_all_run<FluidModel>("fluid.model");
  expect_all_run<DensityMethod>("density.method",
                                {{"continuity", "fluid.model=sdpd"}, {"summation", "fluid.model=sdpd"}});
  expect_all_run<NoiseForm>("sdpd.noise",
                            {{"vector", "fluid.model=sdpd_a"}, {"tensor", "fluid.model=sdpd_a"}});
  expect_all_run<DriveMode>("drive.mode");
  expect_all_run<DrivenPhase>("drive.on");
  expect_all_run<DriveReversal>("drive.opposed");
  expect_all_run<KernelFunction>("fluid.kernel", {{"lucy", "fluid.h_over_dx=3"}});
  expect_all_run<EosType>("eos.type");
  expect_all_run<ViscosityModel>("visc.model");
  expect_all_run<TimeIntegrator>("time.integrator", {{"ab3", "couple.mode=one_way"}});
}

TEST(Choices, OfWallsRun) {
  expect_all_run<WallType>("wall.type");
  expect_all_run<WallSlip>("wall.slip");
  expect_all_run<LayerForce>("wall.force",
                             {{"kajtar", "wall.type=single_layer"}, {"monaghan", "wall.type=single_layer"}});
}

TEST(Choices, OfTheCouplingRun) {
  expect_all_run<CouplingMode>("couple.mode");
  expect_all_run<CouplingKernel>("couple.kernel");
  expect_all_run<DragSlip>("couple.slip");
  expect_all_run<DragLaw>(
      "drag.law",
      {{"table",
        "drag={law = \"table\", porosity = [0.4, 1], reynolds = [0, 10], factor = [30, 40, 1, 2]}"}});
  expect_all_run<DragIntegrator>("drag.integrator");
}

}  // namespace
}  // namespace BL_SOLVER
