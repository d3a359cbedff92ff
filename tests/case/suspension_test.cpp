// Keys of suspensions: lubrication, materials, several fluids, drives, grains on the fluid's lattice.

#include <gtest/gtest.h>

#include "bedload/case/limits.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

TEST(SuspensionCase, LubricationBoundsTheSubstep) {
  const Config c = read(kCase, {"lubrication.forces=all", "fluid.mu=1"});
  const double R = 0.001, m = 4.0 / 3 * M_PI * R * R * R * 2500;
  double film = 0;
  for (const StepLimit& limit : grain_limits(c))
    if (limit.limit == Limit::lubrication) film = limit.seconds;
  // 0.2 m* s_m / (6 pi mu R*^2), s_m = 0.01 R*
  EXPECT_NEAR(film / (0.2 * (m / 2) * 0.01 / (6 * M_PI * 1 * R / 2)), 1, 1e-9);
  for (const StepLimit& limit : grain_limits(read(kCase))) EXPECT_NE(limit.limit, Limit::lubrication);
}

TEST(SuspensionCase, MaterialsTakeWhatTheyLeaveOutFromAllGrains) {
  const Config c = read(changed(
      "[[grain.fill]]",
      "mu = 0.5\n[[grain.material]]\nname = \"steel\"\nrho = 7800\n[[grain.fill]]\nmaterial = \"steel\""));
  ASSERT_EQ(c.grain.materials.size(), 1u);
  EXPECT_EQ(c.grain.materials[0], (GrainMaterial{"steel", 7800, 1e8, 0.3, 0.5, 0.01, 0.9}));
  EXPECT_EQ(c.grain.material(c.grain.fills[0].material), 1u);
}

TEST(SuspensionCase, PresetOfDemocritus) {
  const Config c = read("preset = \"democritus\"\n" + kCase, {"fluid.mu=0.01"});
  EXPECT_EQ(c.fluid.model, FluidModel::sdpd_a);
  EXPECT_EQ(c.fluid.kernel, KernelFunction::lucy);
  EXPECT_EQ(c.eos.type, EosType::democritus);
  EXPECT_TRUE(c.eos.clip_negative && c.eos.filter);
  EXPECT_EQ(c.contact.normal, NormalLaw::democritus);
  EXPECT_EQ(c.contact.tangential, SlidingLaw::democritus);
  EXPECT_EQ(c.couple.drag, DragLaw::gidaspow);
  EXPECT_EQ(c.couple.kernel, CouplingKernel::top_hat);
  EXPECT_EQ(c.density.method, DensityMethod::summation) << "what SDPD brings along";
  EXPECT_TRUE(c.density.count_grains);
  EXPECT_EQ(c.wall.type, WallType::frozen);
  EXPECT_EQ(read("preset = \"democritus\"\n" + kCase, {"fluid.model=wcsph"}).fluid.model, FluidModel::wcsph);
}

TEST(SuspensionCase, SaysWhatSdpdDoesNotTake) {
  const std::string sdpd = "preset = \"democritus\"\n" + kCase;
  const std::vector<std::string> viscous{"fluid.mu=0.01"};
  const auto refused = [&](std::vector<std::string> overrides) {
    overrides.push_back(viscous[0]);
    return error_of(sdpd, overrides);
  };
  EXPECT_EQ(
      refused({"density.method=continuity"}),
      "--set density.method=continuity: density.count_grains = true must be false unless density.method "
      "= \"summation\"");
  EXPECT_EQ(refused({"couple.mode=one_way"}),
            "dam.toml: density.count_grains = true must be false unless couple.mode = \"two_way\"");
  EXPECT_EQ(refused({"couple.hc=0.001"}),
            "dam.toml: density.count_grains = true must be false unless couple.hc is at least the smoothing "
            "length, 0.012 m");
  EXPECT_EQ(refused({"wall.type=mdbc"}),
            "dam.toml:11: wall.body.type = \"mdbc\" must be adami, frozen or grains_only with fluid.model = "
            "\"sdpd_a\"");
  const std::string raft =
      "preset = \"democritus\"\n" +
      changed("[grain]\n",
              "[[wall.body]]\nname = \"raft\"\nshape = \"box\"\nmin = [0.08, 0.02, 0.12]\nmax = [0.12, 0.06, "
              "0.16]\n[wall.body.free]\ndensity = 500\n[grain]\n");
  EXPECT_NE(error_of(raft, viscous).find("must be \"adami\" for a free body"), std::string::npos)
      << error_of(raft, viscous);
}

struct Refused {
  std::vector<std::string> overrides;
  const char* message;
};

TEST(SuspensionCase, SaysWhatDoesNotGoTogether) {
  const Refused all[] = {
      {{"lubrication.forces=normal", "couple.mode=off"},
       "--set lubrication.forces=normal: lubrication.forces = \"normal\" must be \"none\" without [fluid] to "
       "which "
       "grains are coupled"},
      {{"lubrication.forces=normal", "contact.normal=none"},
       "--set lubrication.forces=normal: lubrication.forces = \"normal\" must be \"none\" with "
       "contact.normal = "
       "\"none\""},
      {{"lubrication.forces=normal", "lubrication.least_gap=1.5"},
       "--set lubrication.least_gap=1.5: lubrication.least_gap = 1.5 must be below lubrication.cut_off = 1"},
      {{"couple.suspension_viscosity=maron_pierce", "lubrication.forces=normal"},
       "--set couple.suspension_viscosity=maron_pierce: couple.suspension_viscosity = \"maron_pierce\" must "
       "be "
       "\"none\" with lubrication.forces, of which it is the mean"},
      {{"drive.f=[1, 0, 0]", "drive.factor=1/x"},
       "--set drive.factor=1/x: drive.factor = \"1/x\" must be finite; it is not at [0, 0, 0] m, t "
       "= 0 s"},
      {{"visc.collision=true", "fluid.model=sdpd", "sdpd.kT=1e-9"},
       "--set visc.collision=true: visc.collision = true must be false with sdpd.kT > 0, since "
       "collisions take "
       "out what noise brings"}};
  for (const Refused& r : all) EXPECT_EQ(error_of(kCase, r.overrides), r.message);

  EXPECT_EQ(error_of(changed("[[grain.fill]]", "[[grain.fill]]\nmaterial = \"lead\"")),
            "dam.toml:18: grain.fill.material = \"lead\" must name a grain.material; this case has none");
  EXPECT_EQ(error_of(changed("[[fluid.fill]]", "[[fluid.species]]\nname = \"oil\"\nmu = 1\n[[fluid.fill]]")),
            "dam.toml:7: fluid.species = 1 fluids must be none with grains that the fluid acts on");
  EXPECT_EQ(error_of(changed("count = 500", "count = 500\nspin = [0, 0, 1]\n[grain.fill.rigid]")),
            "dam.toml:22: grain.fill.rigid = [grain.fill.rigid] must be left out where grains have their "
            "own spins or velocities");
  EXPECT_EQ(error_of(changed("count = 500", "every = [5, 1]")),
            "dam.toml:20: grain.fill.every = [5, 1] must be one whole number, or three");
  EXPECT_EQ(error_of(changed("min = [0, 0, 0]\nmax = [0.05, 0.1, 0.1]\ncount = 500",
                             "positions = [[0.01, 0.01, 0.01]]\nspins = [[0, 0, 1], [0, 0, 2]]")),
            "dam.toml:19: grain.fill.spins = 2 vectors must be as many as positions, 1");
}

}  // namespace
}  // namespace bedload::test
