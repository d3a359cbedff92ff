// What frames, Python and the viscometer get of a simulation, and what memory its particles take.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "bedload/geometry/setup.hpp"
#include "src/time/coupled_simulation.hpp"
#include "tests/support/stage_cases.hpp"

namespace BL_SOLVER {
namespace {

using test::kBed, test::kFluid, test::kTank;
using Names = std::vector<std::string>;

struct Started {
  Config config;
  CoupledSimulation simulation;
  explicit Started(const test::StageCase& of) : config(of.config()), simulation(config, setup_of(config)) {
    simulation.start();
  }
  static Setup setup_of(const Config& c) {
    std::vector<std::string> warnings;
    return build_setup(c, warnings);
  }
};

/// "name [unit] components", in their order.
template <class Arrays>
Names names_of(const Arrays& arrays) {
  Names out;
  for (const auto& a : arrays) out.push_back(a.name + " [" + a.unit + "] " + std::to_string(a.components));
  return out;
}

TEST(Outputs, OfFramesHaveTheirOrder) {
  Started coupled({"coupled", kBed, {}});
  EXPECT_EQ(names_of(coupled.simulation.snapshot("fluid").arrays),
            (Names{"position [m] 3", "velocity [m/s] 3", "pressure [Pa] 1", "density [kg/m3] 1",
                   "porosity [-] 1", "id [-] 1"}));
  EXPECT_EQ(names_of(coupled.simulation.snapshot("grains").arrays),
            (Names{"position [m] 3", "velocity [m/s] 3", "angular_velocity [rad/s] 3", "radius [m] 1",
                   "contact_force [N] 3", "clump [-] 1", "drag_force [N] 3", "fluid_force [N] 3",
                   "porosity [-] 1", "wetness [-] 1", "id [-] 1"}));
  EXPECT_EQ(names_of(coupled.simulation.snapshot("walls").arrays),
            (Names{"position [m] 3", "velocity [m/s] 3", "pressure [Pa] 1", "body [-] 1", "id [-] 1"}));
  EXPECT_TRUE(coupled.simulation.snapshot("gas").arrays.empty());

  Started lengths({"lengths", kTank + kFluid, {"fluid.variable_h=true"}});
  EXPECT_EQ(names_of(lengths.simulation.snapshot("fluid").arrays),
            (Names{"position [m] 3", "velocity [m/s] 3", "pressure [Pa] 1", "density [kg/m3] 1",
                   "smoothing_length [m] 1", "volume [m3] 1", "id [-] 1"}));
  EXPECT_TRUE(lengths.simulation.snapshot("grains").arrays.empty());

  Started spinning({"sdpd_a", kTank + kFluid, {"fluid.model=sdpd_a"}});
  EXPECT_EQ(names_of(spinning.simulation.snapshot("fluid").arrays),
            (Names{"position [m] 3", "velocity [m/s] 3", "pressure [Pa] 1", "density [kg/m3] 1",
                   "angular_velocity [rad/s] 3", "id [-] 1"}));
}

TEST(Outputs, TakenLaterAreThoseOfTheirStep) {
  Started s({"coupled", kBed, {}});
  const Names stores{"fluid", "grains", "walls"};
  std::vector<Later<HostStore>> later;
  std::vector<HostStore> at_once;
  for (int step = 0; step < 3; ++step) {
    for (const std::string& store : stores) {
      later.push_back(s.simulation.snapshot_later(store));
      at_once.push_back(s.simulation.snapshot(store));
    }
    s.simulation.step();
  }
  later.pop_back(), at_once.pop_back();  // one that nobody takes
  std::thread([&] {
    for (std::size_t k = 0; k < later.size(); ++k) {
      const HostStore store = later[k]();
      ASSERT_EQ(names_of(store.arrays), names_of(at_once[k].arrays));
      for (std::size_t n = 0; n < store.arrays.size(); ++n)
        EXPECT_EQ(store.arrays[n].bytes, at_once[k].arrays[n].bytes)
            << store.name << " " << store.arrays[n].name;
    }
  }).join();
}

TEST(Outputs, OfTheViscometerHaveTheirOrder) {
  Started s({"coupled", kBed, {}});
  s.simulation.step();
  EXPECT_EQ(names_of(s.simulation.rheology("fluid").arrays),
            (Names{"position [m] 3", "velocity [m/s] 3", "mass [kg] 1", "volume [m3] 1", "drive [N] 3",
                   "stress_pressure [J] 9", "stress_friction [J] 9"}));
  EXPECT_EQ(names_of(s.simulation.rheology("grains").arrays),
            (Names{"position [m] 3", "velocity [m/s] 3", "mass [kg] 1", "volume [m3] 1", "drive [N] 3",
                   "stress_contact [J] 9"}));
}

/// What is a part of a field is that part, and what is seen without a copy is what frames have.
TEST(Outputs, HoldWhatTheFieldsHold) {
  Started s({"coupled", kBed, {}});
  for (int k = 0; k < 3; ++k) s.simulation.step();
  const auto v_rho = s.simulation.state().fluid.v_rho.values();
  const auto eos_state = s.simulation.state().fluid.eos_state.values();
  const HostStore frame = s.simulation.snapshot("fluid");
  ASSERT_EQ(frame.count, v_rho.size());
  double fastest = 0;
  for (std::size_t a = 0; a < frame.count; ++a) {
    const Real* const v = frame.find("velocity")->as<Real>() + 3 * a;
    EXPECT_EQ(norm(Real3{v[0], v[1], v[2]} - v_rho[a].v), 0);
    EXPECT_EQ(frame.find("density")->as<Real>()[a], eos_state[a].rho);
    fastest = std::max(fastest, double(norm(v_rho[a].v)));
  }
  EXPECT_GT(fastest, 0);
#if !BL_CUDA
  int seen = 0;
  for (const char* store : {"fluid", "grains", "walls"}) {
    const HostStore all = s.simulation.snapshot(store);
    for (const FieldView& view : s.simulation.fields(store)) {
      const HostArray* const copy = all.find(view.name);
      if (!copy || view.name == "position") continue;  // of which frames have fewer digits
      ASSERT_EQ(view.components, copy->components) << view.name;
      ASSERT_EQ(view.count, copy->count()) << view.name;
      const std::size_t row = view.components * size_of(view.type);
      for (std::size_t k = 0; k < view.count; ++k)
        ASSERT_EQ(std::memcmp(static_cast<const std::byte*>(view.data) + k * view.stride,
                              copy->bytes.data() + k * row, row),
                  0)
            << view.name << ' ' << k;
      ++seen;
    }
  }
  EXPECT_EQ(seen, 4 + 9 + 3);
#endif
}

/// One line of a store, and it is written wherever others are.
TEST(Outputs, AreDeclaredAtTheField) {
  Started s({"fluid", kTank + kFluid, {}});
  FluidStore& fluid = s.simulation.state().fluid;
  const ParticleBytes before = s.simulation.field_bytes();
  Field<Real3> extra{fluid, "extra", "N s", Lifetime::kept, Output{}};
  Field<Real> silent{fluid, "silent", "-", Lifetime::derived};
  extra.resize(fluid.size()), silent.resize(fluid.size());
  const HostStore frame = s.simulation.snapshot("fluid");
  ASSERT_TRUE(frame.find("extra"));
  EXPECT_EQ(frame.find("extra")->unit, "N s");
  EXPECT_EQ(frame.arrays.back().name, "id");
  EXPECT_FALSE(frame.find("silent"));
  const std::vector<FieldView> views = s.simulation.fields("fluid");
  const auto named = [&](const char* name) {
    return std::any_of(views.begin(), views.end(), [&](const FieldView& v) { return v.name == name; });
  };
  EXPECT_TRUE(named("extra"));
  EXPECT_FALSE(named("silent"));
  EXPECT_FALSE(s.simulation.rheology("fluid").find("extra"));
  EXPECT_EQ(s.simulation.field_bytes().fluid, before.fluid + sizeof(Real3) + sizeof(Real));
}

/// Known before there are particles, they are what fields then take.
TEST(FieldBytes, AreThoseOfTheParticlesThatCome) {
  for (const test::StageCase& c : test::stage_cases()) {
    Started s(c);
    CoupledSimulation empty(s.config, {});
    const ParticleBytes each = s.simulation.field_bytes(), known = empty.field_bytes();
    EXPECT_EQ(known.fluid, each.fluid) << c.name;
    EXPECT_EQ(known.walls, each.walls) << c.name;
    EXPECT_EQ(known.grains, each.grains) << c.name;
    const auto held = [](const Store& store) {
      std::size_t sum = 0;
      for (const FieldBase* f : store.fields()) sum += f->view().count * f->view().stride;
      return sum;
    };
    State& state = s.simulation.state();
    EXPECT_EQ(held(state.fluid), each.fluid * state.fluid.size()) << c.name;
    EXPECT_EQ(held(state.walls) + held(state.walls.mirrors), each.walls * state.walls.size()) << c.name;
    EXPECT_EQ(held(state.grains), each.grains * state.grains.size()) << c.name;
  }
}

/// Known before there are particles, and by the case.
TEST(ScratchBytes, AreThoseOfTheCase) {
  const auto known = [](const std::string& text, const std::vector<std::string>& overrides) {
    const test::StageCase c{"scratch", text, overrides};
    CoupledSimulation empty(c.config(), {});
    const ParticleBytes bytes = empty.scratch_bytes();
    Started s(c);
    const ParticleBytes later = s.simulation.scratch_bytes();
    EXPECT_EQ(later.fluid, bytes.fluid);
    EXPECT_EQ(later.walls, bytes.walls);
    EXPECT_EQ(later.grains, bytes.grains);
    EXPECT_EQ(later.near_grains, bytes.near_grains);
    EXPECT_EQ(later.near_walls, bytes.near_walls);
    return bytes;
  };
  const ParticleBytes water = known(kTank + kFluid, {}), bed = known(kBed, {}),
                      spectra = known(kTank + test::kGrains, {"out.spectra=true"}),
                      collisions = known(kTank + kFluid, {"visc.collision=true"});
  EXPECT_EQ(water.grains, 0u);
  EXPECT_EQ(water.near_grains, 0u);
  EXPECT_EQ(water.near_walls, 0u);
  EXPECT_EQ(collisions.fluid - water.fluid, sizeof(Real4));
  EXPECT_EQ(bed.near_grains, sizeof(Index) + 1 + 2 * sizeof(Real4));
  EXPECT_EQ(spectra.near_grains - bed.near_grains, sizeof(ContactAction) + 2 * sizeof(OpenContact));
}

/// A block of grains on the floor of a wide tank: those of its lowest layer alone keep memories of walls.
TEST(ScratchBytes, OfWallContactsAreThoseOfGrainsNearWalls) {
  std::string places;
  int count = 0;
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 12; ++i) {
        const Vec3d x{0.004 + 0.00105 * i, 0.004 + 0.00105 * j, 0.0006 + 0.00105 * k};
        places += "[" + std::to_string(x.x) + ", " + std::to_string(x.y) + ", " + std::to_string(x.z) + "],";
        ++count;
      }
  const std::string bed = "[grain]\nd = 0.001\nE = 1e6\n[[grain.fill]]\npositions = [" + places +
                          "]\n[time]\nend = 1\n[out]\nevery = 1\n[domain]\nmin = [0, 0, 0]\n" +
                          "max = [0.02, 0.02, 0.03]\n";
  const std::string tank = R"([[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.02, 0.02, 0.03]
faces = ["x-", "x+", "y-", "y+", "z-"]
)";
  const auto held = [](const std::string& text) {
    const auto before = bytes_held_by_thread();
    Started s({"bed", text, {}});
    for (int n = 0; n < 20; ++n) s.simulation.step();
    return double(bytes_held_by_thread() - before);
  };
  const double more = held(bed + tank) - held(bed);
  EXPECT_GT(more, 144.0 * 5 * sizeof(WallMemory));
  EXPECT_LT(more, 0.2 * 5 * sizeof(WallMemory) * count);
  const auto known = [](const std::string& text) {
    const Config c = test::StageCase{"bed", text, {}}.config();
    return CoupledSimulation(c, {}).scratch_bytes();
  };
  EXPECT_EQ(known(bed + tank).grains, known(bed).grains);
  EXPECT_GT(known(bed + tank).near_walls, 5 * sizeof(WallMemory));
}

}  // namespace
}  // namespace BL_SOLVER
