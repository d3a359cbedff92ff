#pragma once
// Frames of lines, whose number changes; read_vtkhdf.py knows the formulas, too.

#include "fake_simulation.hpp"

namespace bedload::testing {

/// Frame k of 3, 0, 5, 5 lines; line n goes from (n, k, 0) to (n, k, 1).
inline HostStore line_frame(int k) {
  const std::size_t count = k == 0 ? 3 : k == 1 ? 0 : 5;
  std::vector<double> ends;
  std::vector<float> force;
  std::vector<std::uint32_t> id;
  for (std::size_t n = 0; n < count; ++n) {
    for (const double z : {0.0, 1.0}) ends.insert(ends.end(), {double(n), double(k), z});
    force.push_back(float(10 * k) + float(n));
    id.push_back(std::uint32_t(n + 7));
  }
  HostStore store{"contacts",
                  count,
                  {array_of("ends", "m", Scalar::f64, 6, ends), array_of("force", "N", Scalar::f32, 1, force),
                   array_of("id", "-", Scalar::u32, 1, id)}};
  store.lines = true;
  return store;
}

}  // namespace bedload::testing
