// The same results, to the last bit, however many ranks share the work.

#include <gtest/gtest.h>

#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "src/team/divisible.hpp"
#include "src/time/coupled_simulation.hpp"
#include "tests/support/cases.hpp"
#include "tests/support/stage_cases.hpp"
#include "tests/support/team.hpp"

namespace BL_SOLVER {
namespace {

using test::kFluid, test::kGate, test::kTank;

/// A dam break, which spreads over blocks that were empty and throws drops.
const std::string kDam = R"([domain]
min = [0, 0, 0]
max = [0.3, 0.06, 0.2]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.06, 0.12]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.3, 0.06, 0.2]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 1
[out]
every = 1
[[probe]]
name = "corner"
type = "point"
at = [0.15, 0.03, 0.03]
[[probe]]
name = "level"
type = "height"
at = [0.2, 0.03, 0]
[[probe]]
name = "box"
type = "box"
min = [0.1, 0, 0]
max = [0.2, 0.06, 0.1]
[[probe]]
name = "front"
type = "front"
direction = "x+"
[[probe]]
name = "side"
type = "force"
sample = "instant"
body = "tank"
[[probe]]
name = "mean"
type = "force"
body = "tank"
[[probe]]
name = "patch"
type = "wall_pressure"
body = "tank"
at = [0.3, 0.03, 0.02]
normal = [-1, 0, 0]
size = [0.02, 0.02]
)";
/// A duct without walls, periodic across, with an inlet and an outlet.
const std::string kDuct = R"(gravity = [0, 0, 0]
[domain]
min = [-0.06, 0, 0]
max = [0.3, 0.08, 0.08]
periodic = [false, true, true]
[fluid]
dx = 0.01
vmax = 1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.08, 0.08]
[[inlet]]
name = "feed"
shape = "rectangle"
centre = [0, 0.04, 0.04]
direction = [1, 0, 0]
half_a = [0, 0.04, 0]
half_b = [0, 0, 0.04]
rate = 0.0064
[[outlet]]
name = "end"
shape = "plane"
point = [0.2, 0, 0]
normal = [1, 0, 0]
[time]
end = 1
[out]
every = 1
)";
const std::string kSheared = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.12, 0.1, 0.1]
periodic = [true, true, true]
shear_rate = 3
[fluid]
dx = 0.01
mu = 0.5
vmax = 0.3
[[fluid.fill]]
min = [0, 0, 0]
max = [0.12, 0.1, 0.1]
[time]
end = 1
[out]
every = 1
)";
const std::string kPlane = R"([domain]
min = [0, 0, 0]
max = [0.2, 0.01, 0.2]
two_d = true
periodic = [true, false, false]
[fluid]
dx = 0.01
mu = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.01, 0.1]
[[wall.body]]
name = "floor"
shape = "box"
min = [-0.1, 0, -0.1]
max = [0.3, 0.01, 0]
type = "frozen"
[drive]
f = [0.5, 0, 0]
[time]
end = 1
[out]
every = 1
)";

/// A small drum of grains of two materials, which rises, turns and lets go.
const std::string kDrum = R"([domain]
min = [-0.04, -0.03, -0.04]
max = [0.04, 0.03, 0.04]
[[shape]]
name = "inside"
kind = "cylinder"
a = [0, -0.025, 0]
b = [0, 0.025, 0]
radius = 0.03
[[shape]]
name = "drum"
kind = "hollow"
of = ["inside"]
[[wall.body]]
name = "drum"
shape = "drum"
mu = 1
[wall.body.motion]
kind = "rotation"
axis = [0, 1, 0]
centre = [0, 0, 0]
rate = 20
[grain]
d = 0.005
E = 1e7
mu_r = 0.05
[[grain.material]]
name = "heavy"
rho = 7000
[[grain.fill]]
shape = "inside"
count = 60
[[grain.fill]]
shape = "inside"
count = 30
material = "heavy"
[time]
end = 1
[out]
every = 1
[[probe]]
name = "side"
type = "force"
sample = "instant"
body = "drum"
[[probe]]
name = "mean"
type = "force"
body = "drum"
[[probe]]
name = "box"
type = "box"
phase = "grains"
min = [-0.02, -0.02, -0.04]
max = [0.02, 0.02, 0]
[[probe]]
name = "front"
type = "front"
phase = "grains"
direction = "x+"
[[probe]]
name = "field"
type = "field"
at = [-0.02, 0, -0.03]
span = [[0.04, 0, 0], [0, 0, 0.03]]
count = [4, 3]
radius = 0.011
sample_every = 0.002
[[probe]]
name = "flux"
type = "flux"
phase = "grains"
direction = "x+"
min = [-0.01, -0.03, -0.04]
max = [0.01, 0.03, 0.04]
)";
/// Of this drum: a probe of mixing.
const std::string kMixed = R"([[probe]]
name = "mix"
type = "mixing"
of = "heavy"
min = [-0.04, -0.03, -0.04]
max = [0.04, 0.03, 0.04]
cell = 0.02
)";
/// Some touch each other, some the floor.
const std::string kSingle = R"([grain]
d = 0.01
[[grain.fill]]
positions = [[0.05, 0.05, 0.0048], [0.058, 0.05, 0.011], [0.02, 0.05, 0.014], [0.03, 0.02, 0.04], [0.08, 0.08, 0.02]]
velocity = [0.3, 0, -0.3]
)";
/// A packing of spinning grains that goes from block to block: contacts go along.
std::string drifting_bed() {
  std::string places;
  for (int k = 0; k < 72; ++k) {
    char place[60];
    std::snprintf(place, sizeof place, "%s[%g, %g, %g]", k > 0 ? ", " : "", 0.00494 * (k % 8) + 0.003,
                  0.00494 * (k / 8 % 3) + 0.006, 0.00494 * (k / 24) + 0.0034);
    places += place;
  }
  return R"([domain]
min = [0, 0, 0]
max = [0.06, 0.03, 0.03]
periodic = [true, true, false]
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0.001]
normal = [0, 0, 1]
[grain]
d = 0.005
E = 1e7
mu_r = 0.05
[[grain.fill]]
positions = [)" +
         places + R"(]
velocity = [1, 0.3, 0]
spin = [0, 60, 30]
[time]
end = 1
[out]
every = 1
)";
}
/// Two soft large grains in shells of small ones, which drift from block to block: their rows are long, and
/// contacts outlive lists.
std::string drifting_shells() {
  std::string places;
  for (int k = 0; k < 300; ++k) {
    const int n = k / 2;
    const double z = 1 - (2 * n + 1) / 150.0, turn = 2.399963 * n, out = 0.00539,
                 across = std::sqrt(1 - z * z);
    char place[60];
    std::snprintf(place, sizeof place, "%s[%.6f, %.6f, %.6f]", k > 0 ? ", " : "",
                  (k % 2 ? 0.032 : 0.01) + out * across * std::cos(turn),
                  0.015 + out * across * std::sin(turn), 0.015 + out * z);
    places += place;
  }
  return R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.06, 0.03, 0.03]
periodic = [true, true, false]
[grain]
d = 0.0008
E = 1e4
mu_r = 0.05
[[grain.fill]]
positions = [[0.01, 0.015, 0.015], [0.032, 0.015, 0.015]]
velocity = [1, 0.3, 0]
[[grain.fill.sizes]]
d = 0.01
[[grain.fill]]
positions = [)" +
         places + R"(]
velocity = [1, 0.3, 0]
spin = [0, 60, 30]
[[grain.fill.sizes]]
d = 0.0008
[time]
end = 1
[out]
every = 1
)";
}
/// Water and grains that collapse together; to follow kDam.
const std::string kSlurry = R"([grain]
d = 0.008
[[grain.fill]]
min = [0, 0, 0]
max = [0.1, 0.06, 0.08]
count = 80
)";
/// The same of two sizes, of which each has its own averaging length.
const std::string kTwoSizesOfSlurry = R"([grain]
d = 0.004
[[grain.fill]]
min = [0, 0, 0]
max = [0.1, 0.06, 0.08]
count = 3
[[grain.fill.sizes]]
d = 0.02
[[grain.fill]]
min = [0, 0, 0]
max = [0.1, 0.06, 0.08]
count = 300
[[grain.fill.sizes]]
d = 0.004
)";
/// Of this slurry, with rods that share their drag, and some of which each sphere has its own.
const std::string kRodsOfSlurry = R"([[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
[[clump]]
name = "loose rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
drag = "members"
[[grain.fill]]
min = [0, 0, 0.08]
max = [0.1, 0.06, 0.11]
count = 10
clump = "rod"
[[grain.fill]]
min = [0, 0, 0.08]
max = [0.1, 0.06, 0.11]
count = 5
clump = "loose rod"
)";
/// Of this slope, with rods among the grains.
const std::string kRods = R"([[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
[[grain.fill]]
min = [0, 0, 0.03]
max = [0.1, 0.03, 0.045]
count = 20
clump = "rod"
[[grain_inlet]]
name = "rods"
shape = "box"
min = [0.07, 0.005, 0.045]
max = [0.095, 0.025, 0.055]
rate = 1000
clump = "rod"
)";
/// Small grains among those of this slope.
const std::string kDust = R"([[grain.fill]]
min = [0, 0, 0.001]
max = [0.1, 0.03, 0.03]
count = 200
[[grain.fill.sizes]]
d = 0.0012
)";
/// Grains that slide down a slope which is periodic, from an inlet above to an outlet.
const std::string kSlope = R"(gravity = [3, 0, -9]
[domain]
min = [0, 0, 0]
max = [0.1, 0.03, 0.06]
periodic = [true, true, false]
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0.001]
normal = [0, 0, 1]
[grain]
d = 0.005
E = 1e7
[[grain.fill]]
min = [0, 0, 0.001]
max = [0.1, 0.03, 0.03]
count = 100
[[grain_inlet]]
name = "feed"
shape = "box"
min = [0.03, 0.005, 0.045]
max = [0.06, 0.025, 0.055]
rate = 2000
velocity = [0, 0, -1]
[[outlet]]
name = "sink"
shape = "box"
min = [0, 0, 0]
max = [0.01, 0.015, 0.01]
[time]
end = 1
[out]
every = 1
)";

struct RankCase {
  const char* name;
  std::string text;
  std::vector<std::string> overrides;
  int steps;
};
std::ostream& operator<<(std::ostream& out, const RankCase& c) { return out << c.name; }

std::vector<RankCase> rank_cases() {
  return {
      {"dam", kDam, {}, 150},
      {"dam, blocks of two cells", kDam, {"run.block=2"}, 60},
      {"dam, ab3", kDam, {"time.integrator=ab3"}, 60},
      {"dam, euler, no shifting", kDam, {"time.integrator=euler", "shift.A=0"}, 60},
      {"tank with a gate", kTank + kFluid + kGate, {"xsph=0.3"}, 60},
      {"oil", kTank + kFluid + kGate, {"fluid.mu=1"}, 40},
      {"frozen walls", kTank + kFluid + kGate, {"wall.type=frozen"}, 40},
      {"mirrored walls", kTank + kFluid + kGate, {"wall.type=mdbc"}, 40},
      {"plane flow over a floor, periodic", kPlane, {}, 60},
      {"repulsion", kDam, {"wall.repulsion=true"}, 60},
      {"walls that pull, at a price", kDam, {"wall.suction=true", "wall.energy_consistent=true"}, 60},
      {"float", kTank + kFluid + test::kFloat, {}, 60},
      {"collisions", kDam, {"visc.collision=true", "visc.collision_range=1", "shift.A=0"}, 60},
      {"smoothing lengths", kTank + kFluid, {"fluid.variable_h=true"}, 40},
      {"sdpd", kTank + kFluid + kGate, {"fluid.model=sdpd_a", "sdpd.kT=1e-9"}, 40},
      {"sdpd by summation",
       kTank + kFluid,
       {"fluid.model=sdpd", "density.method=summation", "pressure.filter=true", "wall.type=frozen"},
       40},
      {"inlet and outlet", kDuct, {}, 120},
      {"drum of grains",
       kDrum + kMixed,
       {"out.spectra=true", "out.contacts=all", "out.fields=[\"contact_stress\"]", "wall.body.0.wear=archard",
        "wall.body.0.k_over_H=1e-13"},
       100},
      {"drum of grains, blocks of two cells", kDrum, {"run.block=2"}, 60},
      {"drifting bed", drifting_bed(), {"out.spectra=true", "out.contacts=touching"}, 60},
      {"drifting shells of small grains",
       drifting_shells(),
       {"out.spectra=true", "out.contacts=touching"},
       60},
      {"slope with inlet and outlet of grains", kSlope, {"out.spectra=true"}, 100},
      {"slope with clumps", kSlope + kRods, {"out.spectra=true"}, 80},
      {"slope of large and small grains", kSlope + kDust, {}, 30},
      {"settled grains", kDrum, {"grain.settle=true"}, 60},
      {"held grains", kDrum, {"grain.release_time=0.005"}, 40},
      {"grains in fluid that do not act on it", kTank + kFluid + kSingle, {"couple.mode=off"}, 40},
      {"slurry", kDam + kSlurry, {}, 60},
      {"slurry of large and small grains", kDam + kTwoSizesOfSlurry, {}, 30},
      {"bed with a rigid group", test::kBed + kGate, {"out.energy=true"}, 30},
      {"slurry, local slip, blocks of two cells", kDam + kSlurry, {"couple.slip=local", "run.block=2"}, 40},
      {"slurry with clumps", kDam + kSlurry + kRodsOfSlurry, {"out.energy=true", "couple.slip=local"}, 30},
      {"slurry, one way, mirrored walls", kDam + kSlurry, {"couple.mode=one_way", "wall.type=mdbc"}, 30},
      {"slurry with a float", kTank + kFluid + kSingle + test::kFloat, {}, 30},
      {"slurry with lubrication",
       kTank + kFluid + kSingle + kGate,
       {"lubrication.forces=all", "out.spectra=true", "out.contacts=all"},
       30},
      {"grains and a body", kTank + kSingle + test::kFloat, {"out.energy=true"}, 60},
      {"sdpd and grains",
       kTank + kFluid + kSingle + kGate,
       {"fluid.model=sdpd", "density.method=summation"},
       40},
      {"sheared", kSheared, {}, 40},
      {"sheared, sdpd", kSheared, {"fluid.model=sdpd", "sdpd.kT=1e-9"}, 40},
  };
}

Config config_of(const RankCase& c) {
  std::vector<std::string> warnings;
  std::vector<std::string> overrides = c.overrides;
  bool block = false;
  for (const std::string& o : overrides) block = block || o.starts_with("run.block");
  if (!block) overrides.push_back("run.block=1");  // the cases are smaller than a block of eight cells
  return read_case_text(c.text, "case.toml", overrides, warnings);
}

std::vector<std::byte> bytes_of(const HostStore& store) {
  std::vector<std::byte> out;
  for (const HostArray& a : store.arrays) out.insert(out.end(), a.bytes.begin(), a.bytes.end());
  return out;
}

/// All that a user reads of it.
std::vector<std::byte> readings(Simulation& s, const Config& c) {
  std::vector<std::byte> out;
  const auto add = [&](const std::vector<Quantity>& rows) {
    for (const Quantity& q : rows) {
      const auto raw = std::bit_cast<std::array<std::byte, sizeof q.value>>(q.value);
      out.insert(out.end(), raw.begin(), raw.end());
    }
  };
  const auto add_store = [&](const HostStore& store) {
    const auto more = bytes_of(store);
    out.insert(out.end(), more.begin(), more.end());
  };
  for (const char* name : {"fluid", "walls", "grains", "clumps"}) add_store(s.snapshot(name));
  if (c.grain.present) add_store(s.rheology("grains"));
  add(s.diagnostics());
  for (const ProbeConfig& probe : c.out.probes) add(s.measure(probe));
  const std::size_t groups = c.grain.rigid_fills().size();
  for (int b = 0; b < int(c.wall.bodies.size() + groups); ++b) add(s.body_state(b));
  if (c.out.contacts != ContactFrames::none) add_store(s.snapshot("contacts"));
  for (const WallBody& body : c.wall.bodies)
    if (body.wear != WearLaw::none) add_store(s.snapshot("wear/" + body.name));
  for (const auto& row : s.spectra()) add(row);
  for (const auto& row : s.spectra_peaks()) add(row);
  return out;
}

struct Outcome {
  std::vector<std::byte> kept, read;
  bool operator==(const Outcome&) const = default;
};

class Ranks : public testing::TestWithParam<RankCase> {
 protected:
  Ranks() : config_(config_of(GetParam())), setup_(setup_of(config_)) {}
  static bedload::Setup setup_of(const Config& c) {
    std::vector<std::string> warnings;
    return build_setup(c, warnings);
  }
  Outcome outcome(int ranks, int steps) {
    const auto s = make_divided(config_, setup_, ranks);
    begin(*s);
    for (int n = 0; n < steps; ++n) s->step();
    return {bits(*s), readings(*s, config_)};
  }
  void begin(Simulation& s) {
    if (config_.grain.settle) s.settle(0.02, [](double) {});
    s.start();
  }
  Config config_;
  bedload::Setup setup_;
};
INSTANTIATE_TEST_SUITE_P(Cases, Ranks, testing::ValuesIn(rank_cases()), [](const auto& of) {
  std::string name;
  for (const char letter : std::string(of.param.name))
    if (std::isalnum(static_cast<unsigned char>(letter))) name += letter;
  return name;
});

TEST_P(Ranks, GiveTheSameBits) {
  const Outcome one = outcome(1, GetParam().steps);
  for (const int ranks : {2, 3, 4}) {
    const Outcome several = outcome(ranks, GetParam().steps);
    EXPECT_TRUE(several.kept == one.kept) << ranks << " ranks: state";
    EXPECT_TRUE(several.read == one.read) << ranks << " ranks: frames, probes, diagnostics";
  }
}

TEST_P(Ranks, ContinueFromACheckpointOfOtherRanks) {
  const int steps = GetParam().steps, half = steps / 2 - 1;  // between two rebuilds or at one
  const Outcome unbroken = outcome(1, steps);
  SavedState saved;
  int done = 0;
  for (const auto& [ranks, until] : {std::pair{4, half}, {1, half + 5}, {3, steps - 4}, {2, steps}}) {
    const auto s = make_divided(config_, done > 0 ? bedload::Setup{} : setup_, ranks);
    done > 0 ? s->load(saved) : begin(*s);
    for (; done < until; ++done) s->step();
    saved = s->save();
    if (done < steps) continue;
    const Outcome outcome{bits(*s), readings(*s, config_)};
    EXPECT_TRUE(outcome == unbroken);
  }
}

/// Settled grains that a cache keeps are those of any number of ranks.
TEST(RankGrains, SettledOnSomeRanksStartOnOthers) {
  const Config config = config_of({"", kDrum, {"grain.settle=true"}, 0});
  std::vector<std::string> warnings;
  const bedload::Setup setup = build_setup(config, warnings);
  std::vector<std::vector<std::byte>> found;
  for (const auto& [first, then] : {std::pair{1, 1}, {3, 2}}) {
    const auto a = make_divided(config, setup, first);
    a->settle(0.05, [](double) {});
    const auto b = make_divided(config, setup, then);
    b->load_grains(a->save_grains());
    b->start();
    for (int n = 0; n < 10; ++n) b->step();
    found.push_back(bits(*b));
  }
  EXPECT_TRUE(found[0] == found[1]);
}

/// A lump that flies across blocks that were empty.
const std::string kLump = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.9, 0.1, 0.1]
[fluid]
dx = 0.01
vmax = 2
[[fluid.fill]]
min = [0.05, 0.02, 0.02]
max = [0.2, 0.08, 0.08]
velocity = [2, 0, 0]
[time]
end = 1
[out]
every = 1
)";

TEST(RankBalance, FollowsTheFluid) {
  const Config config = config_of({"", kLump, {}, 0});
  std::vector<std::string> warnings;
  const bedload::Setup setup = build_setup(config, warnings);
  std::vector<CoupledSimulation*> parts(3);
  const auto s = make_team({.ranks = 3, .make = [&](Link& link) {
                              auto part = std::make_unique<CoupledSimulation>(config, setup, &link);
                              parts[std::size_t(link.rank())] = part.get();
                              return part;
                            }});
  s->start();
  while (s->time() < 0.25) s->step();
  Index most = 0, all = 0;
  for (CoupledSimulation* part : parts) {
    const Index own = part->state().fluid.owned().size();
    most = std::max(most, own), all += own;
  }
  EXPECT_EQ(all, setup.fluid.x.size());
  EXPECT_LT(most, 1.3 * all / 3);
}

/// A link as that of a team, on which one rank fails or sleeps.
class BadLink final : public Link {
 public:
  BadLink(Link& link, std::function<void()> trouble) : link_(link), trouble_(std::move(trouble)) {}
  int rank() const override { return link_.rank(); }
  int size() const override { return link_.size(); }
  void all_gather(const void* own, void* all, std::size_t bytes) override {
    if (rank() == 1 && ++calls_ == 200) trouble_();
    link_.all_gather(own, all, bytes);
  }

 private:
  Link& link_;
  std::function<void()> trouble_;
  int calls_ = 0;
};

class RankFault : public testing::Test {
 protected:
  /// Runs until it fails; returns what is said.
  std::string run(double timeout, const std::function<void()>& trouble) {
    const Config config = config_of(rank_cases()[0]);
    std::vector<std::string> warnings;
    const bedload::Setup setup = build_setup(config, warnings);
    std::vector<std::unique_ptr<BadLink>> links(3);
    const auto s = make_team({.ranks = 3, .timeout = timeout, .make = [&](Link& link) {
                                auto& own = links[std::size_t(link.rank())];
                                own = std::make_unique<BadLink>(link, trouble);
                                return make_coupled(config, setup, own.get());
                              }});
    try {
      s->start();
      for (int n = 0; n < 1000; ++n) s->step();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(RankFault, OfOneEndsAllWithItsSentence) {
  EXPECT_EQ(run(60, [] { throw DeviceError("GPU 1 has fallen off the bus"); }),
            "GPU 1 has fallen off the bus");
}

TEST_F(RankFault, OneThatSleepsIsNotWaitedForLonger) {
  const std::string said = run(0.2, [] { std::this_thread::sleep_for(std::chrono::seconds(1)); });
  EXPECT_TRUE(said.starts_with("rank 1 has not responded for 0.2 s, in ")) << said;
}

TEST(RankLimits, NameWhatCannotBeDividedYet) {
  std::vector<std::string> warnings;
  const auto refused = [&](const std::string& text,
                           const std::vector<std::string>& overrides) -> std::string {
    try {
      refuse_undivided(read_case_text(text, "case.toml", overrides, warnings));
    } catch (const KeyError& error) {
      return error.key;
    }
    return "";
  };
  EXPECT_EQ(refused(kDam, {}), "");
  EXPECT_EQ(refused(kDrum, {}), "");
  EXPECT_EQ(refused(kDam + kSlurry + test::kFloat, {}), "");
  EXPECT_EQ(refused(test::kBed, {}), "");
  EXPECT_EQ(refused(drifting_shells(), {}), "");
  EXPECT_EQ(refused(kTank + test::kFloat, {}), "fluid");
}

}  // namespace
}  // namespace BL_SOLVER
