// Two fluids between cylinders: spin keeps the angular momentum that friction without it loses at their
// interface.
#include "tests/boundaries/support.hpp"

namespace BL_SOLVER {
namespace {

/// The case taylor_couette_two_fluids, for a shorter time.
const std::string kCase = R"(gravity = [0, 0, 0]
[domain]
min = [-24, -24, 0]
max = [24, 24, 6]
periodic = [false, false, true]
[[shape]]
name = "inner cylinder"
kind = "cylinder"
a = [0, 0, 0]
b = [0, 0, 6]
radius = 10
[[shape]]
name = "within the interface"
kind = "cylinder"
a = [0, 0, 0]
b = [0, 0, 6]
radius = 15
[[shape]]
name = "within the outer cylinder"
kind = "cylinder"
a = [0, 0, 0]
b = [0, 0, 6]
radius = 20
[[shape]]
name = "inner annulus"
kind = "difference"
of = ["within the interface", "inner cylinder"]
[[shape]]
name = "outer annulus"
kind = "difference"
of = ["within the outer cylinder", "within the interface"]
[[shape]]
name = "outer cylinder"
kind = "pipe"
a = [0, 0, 0]
b = [0, 0, 6]
radius = 20
thickness = 3
[fluid]
kernel = "lucy"
dx = 1
h_over_dx = 2.5
rho0 = 1
vmax = 1
zeta = 0
[[fluid.species]]
name = "inner"
mu = 3
[[fluid.species]]
name = "outer"
mu = 9
[[fluid.fill]]
shape = "inner annulus"
[[fluid.fill]]
shape = "outer annulus"
species = "outer"
[[wall.body]]
name = "inner"
shape = "inner cylinder"
[[wall.body]]
name = "outer"
shape = "outer cylinder"
motion = {kind = "rotation", axis = [0, 0, 1], centre = [0, 0, 0], rate = 0.05}
[eos]
type = "democritus"
p0 = 38
beta = 28
[sdpd]
kI = 0.8
[time]
end = 8
friction = 0.4
[out]
every = 8
)";

/// Speed around the axis where stress is symmetric: A r + B / r in each fluid, mu B the same in both.
double exact(double r) {
  const double R1 = 10, R = 15, R2 = 20, ratio = 3.0 / 9;
  const double B = R / R2 / (1 / R - R / (R1 * R1) + ratio * (R / (R2 * R2) - 1 / R));
  return r < R ? B * (1 / r - r / (R1 * R1)) : r / R2 + ratio * B * (1 / r - r / (R2 * R2));
}

double miss(const std::string& model) {
  std::vector<std::string> warnings;
  const Config c = read_case_text(kCase, "case.toml", {"fluid.model=" + model}, warnings);
  auto s = started(c);
  run_until(*s, c.time.end);
  const auto store = s->snapshot("fluid");
  const auto x = vectors(store, "position"), v = vectors(store, "velocity");
  double sum = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double r = std::hypot(x[a].x, x[a].y);
    sum += square((x[a].x * v[a].y - x[a].y * v[a].x) / r - exact(r)) / double(x.size());
  }
  return std::sqrt(sum);
}

TEST(SlowTwoFluids, SpinAloneHasTheSymmetricStress) {  // root mean square over the outer speed, which is one
  EXPECT_LT(miss("sdpd_a"), 0.03);
  EXPECT_GT(miss("sdpd"), 0.04);
}

}  // namespace
}  // namespace BL_SOLVER
