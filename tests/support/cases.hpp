#pragma once
// Small cases as text, of which tests take what they share.

#include <string>

namespace bedload::test {

/// A tank 0.1 m square and 0.12 m high with room around it: what else is in it is to be added.
inline const std::string kTank = R"([domain]
min = [-0.1, -0.1, -0.1]
max = [0.2, 0.2, 0.2]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.12]
[time]
end = 1
[out]
every = 1
)";

/// A dam of 150 fluid particles and 40 grains in an open tank; a step takes about 0.3 ms of simulated time.
/// `grain`: more keys of [grain]; [time] and [out] are to be added.
inline std::string small_dam(const std::string& grain = "") {
  return R"([domain]
min = [0, 0, 0]
max = [0.1, 0.06, 0.12]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.06, 0.05]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.06, 0.1]
faces = ["x-", "x+", "y-", "y+", "z-"]
[grain]
d = 0.005
)" + grain +
         R"([[grain.fill]]
min = [0, 0, 0]
max = [0.05, 0.06, 0.03]
count = 40
)";
}

}  // namespace bedload::test
