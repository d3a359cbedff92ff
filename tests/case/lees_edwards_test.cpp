// Which cases Lees-Edwards boundaries take.

#include <gtest/gtest.h>

#include "support.hpp"

namespace bedload::test {
namespace {

const std::string kSheared = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
periodic = [true, true, true]
shear_rate = 0.5
[fluid]
dx = 0.01
vmax = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
[time]
end = 1
[out]
every = 1
)";

TEST(LeesEdwardsCase, TakesFluidAlone) {
  EXPECT_EQ(error_of(kSheared), "");
  EXPECT_EQ(read(kSheared).domain.shear_rate, 0.5);
  EXPECT_EQ(error_of(kSheared, {"domain.periodic=[true,false,true]"}), "");
  const std::string key = "domain.shear_rate = 0.5 must be 0 with ", at = "dam.toml:6: ";
  const std::string wall =
      "[[wall.body]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n";
  EXPECT_EQ(error_of(kSheared + wall), at + key + "[[wall.body]]");
  EXPECT_EQ(error_of(kSheared + "[grain]\nd = 0.002\n[[grain.fill]]\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n"
                                "count = 5\n"),
            at + key + "[grain]");
  EXPECT_EQ(error_of(kSheared + "[[outlet]]\nname = \"drain\"\nshape = \"box\"\nmin = [0, 0, 0]\n"
                                "max = [0.1, 0.1, 0.1]\n"),
            at + key + "[[outlet]]");
  for (const auto& [set, what] : std::vector<std::pair<std::string, std::string>>{
           {"gravity=[1,0,0]", "gravity"},
           {"drive.f=[1,0,0]", "[drive]"},
           {"fluid.variable_h=true", "fluid.variable_h"},
           {"visc.collision=true", "visc.collision"},
           {"xsph=0.5", "xsph > 0"},
           {"tensile=1", "tensile > 0"},
           {"time.integrator=ab3", "time.integrator = \"ab3\""}}) {
    std::vector<std::string> more{set};
    if (what == "fluid.variable_h") more.push_back("shift.A=0"), more.push_back("fluid.dx=0.007");
    EXPECT_EQ(error_of(kSheared, more), at + key + what);
  }
}

TEST(LeesEdwardsCase, NeedsAPeriodicBoxThatIsWideEnough) {
  EXPECT_NE(error_of(kSheared, {"domain.periodic=[true,true,false]"})
                .find("domain.periodic = false along z must be true with domain.shear_rate"),
            std::string::npos);
  // wide enough at rest, 2 kappa h = 0.06, not where images of a flat box are half a period aside
  EXPECT_EQ(error_of(kSheared, {"domain.max=[0.07,0.1,0.07]", "domain.shear_rate=0",
                                "fluid.fill.0.max=[0.07,0.1,0.07]"}),
            "");
  EXPECT_NE(error_of(kSheared, {"domain.max=[0.07,0.1,0.07]", "fluid.fill.0.max=[0.07,0.1,0.07]"})
                .find("must be a period > 2 kappa h, sheared = 0.07"),
            std::string::npos);
}

TEST(LeesEdwardsCase, HasNoProbesThatAverageAcrossItsFaces) {
  EXPECT_NE(error_of(kSheared + "[[probe]]\nname = \"gauge\"\ntype = \"point\"\nat = [0.1, 0.05, 0.1]\n")
                .find("probe.type = \"point\" must be another with domain.shear_rate"),
            std::string::npos);
}

}  // namespace
}  // namespace bedload::test
