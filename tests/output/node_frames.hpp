#pragma once
// Frames of a box of nodes; read_vtkhdf.py knows the formulas, too.

#include "fake_simulation.hpp"

namespace bedload::testing {

inline HostStore node_frame(int k) {
  const HostGrid grid{{5, 3, 2}, {0.25, 0.5, -1}, 0.5};
  std::vector<double> x;
  std::vector<float> speed, velocity;
  std::vector<std::uint32_t> solid;
  for (std::size_t n = 0; n < 30; ++n) {
    x.insert(x.end(), {0.25 + 0.5 * double(n % 5), 0.5 + 0.5 * double(n / 5 % 3), -1 + 0.5 * double(n / 15)});
    speed.push_back(float(100 * k) + float(n));
    velocity.insert(velocity.end(), {float(k), float(n), -float(n)});
    solid.push_back(n % 4 == 0);
  }
  return {
      "fluid",
      30,
      {array_of("position", "m", Scalar::f64, 3, x), array_of("speed", "m/s", Scalar::f32, 1, speed),
       array_of("velocity", "m/s", Scalar::f32, 3, velocity), array_of("solid", "-", Scalar::u32, 1, solid)},
      grid};
}

}  // namespace bedload::testing
