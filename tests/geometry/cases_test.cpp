// Every case that comes with Bedload can be read and initialised.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "bedload/case/read.hpp"
#include "bedload/geometry/setup.hpp"

namespace bedload::test {
namespace {

namespace fs = std::filesystem;

TEST(Cases, AreInitialisedWithoutOtherWarningsThanTheyExplain) {
  struct Count {
    std::size_t fluid, grains;
    std::vector<std::string> warnings = {};  ///< how they begin
  };
  const std::map<std::string, Count> expected{
      {"agitated_tube/case.toml", {9775, 0, {"wall.body \"agitator\""}}},
      {"brazil_nut/case.toml", {0, 11089}},
      {"constant_porosity_block/block_065.toml", {9 * 9 * 60, 2112}},
      {"couette_suspension/case.toml", {1000, 746}},
      {"dam_break_impact/case.toml", {7200, 0}},
      {"dam_break_slurry/case.toml", {1600, 400}},
      {"dam_break_single_phase/case.toml", {37 * 73 * 10, 0}},
      {"dam_break_two_phase/case.toml", {17 * 33 * 50, 7762}},
      {"debris_barrier/case.toml", {3262, 1877, {"fluid.c_factor", "grain.E"}}},
      {"ball_in_oil/case.toml", {238505, 0}},
      {"ball_mill/case.toml", {0, 1733}},
      {"ball_mill/slurry.toml", {7980, 2500}},
      {"drag_array/case.toml", {32 * 32 * 32, 8}},
      {"drag_array/fcc.toml", {28 * 28 * 28, 4}},
      {"drafting/case.toml", {34 * 34 * 226, 2}},
      {"elliptic_drop/case.toml", {13776, 0}},
      {"elliptic_drop/variable_h.toml", {1968, 0}},
      {"ergun_bed/beads_1000um.toml", {3800, 1458}},
      {"ergun_bed/beads_2700um.toml", {3800, 1458}},
      {"grain_heap/case.toml", {0, 2000}},
      {"hindered_settling/sand_060.toml", {9 * 9 * 60, 2432}},
      {"hindered_settling/sand_080.toml", {9 * 9 * 60, 1225}},
      {"hopper/case.toml", {0, 5000}},
      {"hydrostatic_column/case.toml", {8 * 8 * 25, 0}},
      {"hydrostatic_column/stretched.toml", {468, 0}},
      {"injection_cell/case.toml", {0, 4948, {"grains of 0.0011 m"}}},
      {"injection_cell/coarse.toml", {0, 618, {"fluid.c_factor", "grains of 0.0022 m"}}},
      {"launder/case.toml", {4000, 0, {"fluid.vmax", "fluid.c_factor"}}},
      {"lees_edwards/case.toml", {7 * 7 * 7, 0}},
      {"lees_edwards/wcsph.toml", {10 * 10 * 10, 0}},
      {"minimum_fluidisation/case.toml", {4200, 1800, {"grain.E"}}},
      {"mixing_tank/case.toml", {5872, 1870, {"fluid.c_factor", "grain.E", "wall.body \"impeller\""}}},
      {"oblique_impact/case.toml", {0, 36}},
      {"oscillating_drop/case.toml", {8848, 0}},
      {"oil_under_head/case.toml", {10 * 16 * 16, 0}},
      {"poiseuille/case.toml", {8 * 8 * 50, 0}},
      {"rayleigh_taylor_grains/glycerol.toml", {2548, 1960, {"grain.E"}}},
      {"rayleigh_taylor_grains/lattice.toml", {2548, 0}},
      {"rayleigh_taylor_grains/water.toml", {2548, 1960, {"grain.E"}}},
      {"reverse_poiseuille/case.toml", {28 * 56 * 14, 0}},
      {"reverse_poiseuille/small.toml", {7 * 7 * 14, 0}},
      {"reverse_poiseuille/walled.toml", {10 * 10 * 10, 0}},
      {"reverse_poiseuille_slurry/phi_03.toml", {686 - 45, 45, {"couple.hc"}}},
      {"reverse_poiseuille_slurry/phi_05.toml", {686 - 68, 68, {"couple.hc"}}},
      {"reverse_poiseuille_slurry/phi_11.toml", {686 - 137, 137, {"couple.hc"}}},
      {"reverse_poiseuille_slurry/thickened.toml", {10 * 10 * 20, 764}},
      {"rip_rap/case.toml", {90112, 2474, {"fluid.c_factor", "grain.E", "wall.body \"held\""}}},
      {"rod_drum/case.toml", {0, 850 + 3 * 450, {"grain.E"}}},
      {"rotating_drum/case.toml", {14553, 7755}},
      {"scour/case.toml", {52 * 52 * 44, 60458, {"fluid.c_factor"}}},
      {"segre_silberberg/case.toml", {44 * 44 * 60, 1, {"fluid.dx: 6 nodes"}}},
      {"sloshing/case.toml", {2000, 0}},
      {"sphere_near_wall/case.toml", {60 * 60 * 52, 1}},
      {"sphere_settling/air.toml", {20 * 20 * 30, 1}},
      {"sphere_settling/glycerol.toml", {20 * 20 * 30, 1}},
      {"sphere_settling/water.toml", {20 * 20 * 30, 1}},
      {"sphere_settling_newton/case.toml", {7599, 1, {"fluid.c_factor"}}},
      {"standing_wave/deep.toml", {11200, 0}},
      {"standing_wave/finite_depth.toml", {5600, 0}},
      {"still_bed/case.toml", {12 * 12 * 20, 600}},
      {"still_bed_two_sizes/case.toml", {83 * 83 * 50, 640012, {"grains of 0.01 m"}}},
      {"stirred_tank/case.toml", {49680, 0, {"wall.body \"impeller\""}}},
      {"suspension_viscosity/case.toml", {60 * 60 * 62, 83}},
      {"suspension_viscosity/plates.toml", {60 * 60 * 82, 110}},
      {"suspension_viscosity/sph.toml", {12 * 12 * 10, 282}},
      {"taylor_couette_two_fluids/case.toml", {5736, 0}},
      {"taylor_green/case.toml", {50 * 50 * 8, 0}},
      {"taylor_green/re100.toml", {100 * 100, 0}},
      {"taylor_green/re1000.toml", {100 * 100, 0}},
      {"taylor_green_lattice/case.toml", {50 * 50, 0}},
      {"taylor_green_lattice/re100.toml", {100 * 100, 0}},
      {"taylor_green_lattice/re1000.toml", {100 * 100, 0}},
      {"ten_cate/case.toml", {82 * 82 * 130, 1}},
      {"two_size_packing/case.toml", {0, 103411}},
      {"two_size_packing/one_size.toml", {0, 306}},
      {"two_size_packing/resting.toml", {0, 26001}},
  };
  std::size_t found = 0;
  const fs::path cases = fs::path(BL_SOURCE_DIR) / "cases";
  for (const auto& entry : fs::recursive_directory_iterator(cases)) {
    if (entry.path().extension() != ".toml" || entry.path().stem().string().starts_with("expect")) continue;
    const std::string name = entry.path().lexically_relative(cases).generic_string();
    SCOPED_TRACE(name);
    ASSERT_TRUE(expected.contains(name)) << "not listed here";
    std::vector<std::string> warnings;
    const Config config = read_case(entry.path(), {}, warnings);
    const auto setup = build_setup(config, warnings);
    EXPECT_EQ(setup.fluid.x.size() + setup.nodes.solid.size(), expected.at(name).fluid);
    EXPECT_EQ(setup.grains.x.size(), expected.at(name).grains);
    const auto& foreseen = expected.at(name).warnings;
    ASSERT_EQ(warnings.size(), foreseen.size()) << (warnings.empty() ? "" : warnings[0]);
    for (std::size_t k = 0; k < warnings.size(); ++k)
      EXPECT_TRUE(warnings[k].starts_with(foreseen[k])) << warnings[k];
    ++found;
  }
  EXPECT_EQ(found, expected.size());
}

}  // namespace
}  // namespace bedload::test
