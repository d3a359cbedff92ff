#include "geometry/rough_size.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bedload/parallel/host_loop.hpp"

namespace bedload {

RoughSize rough_size(const Shape& shape, const DomainConfig& domain) {
  constexpr int kAlong = 24;
  const Bounds b = shape.bounds();
  Vec3d step = (b.max - b.min) / double(kAlong);
  const double near = 0.5 * (domain.two_d ? std::hypot(step.x, step.z) : norm(step));
  const Bounds around = b.grown(near);
  step = (around.max - around.min) / double(kAlong);
  if (domain.two_d) step.y = domain.thickness();
  const double cell = step.x * step.y * step.z;
  std::vector<RoughSize> slabs(kAlong);
  host_for_each(slabs.size(), [&](std::size_t l) {
    for (int j = 0; j < (domain.two_d ? 1 : kAlong); ++j)
      for (int i = 0; i < kAlong; ++i) {
        Vec3d x = around.min;
        x.x += (i + 0.5) * step.x, x.z += (double(l) + 0.5) * step.z;
        x.y = domain.two_d ? domain.middle() : x.y + (j + 0.5) * step.y;
        const double d = shape.distance(x);
        if (std::abs(d) < near) slabs[l].area += cell / (2 * near);
        slabs[l].volume += cell * std::clamp(0.5 - 0.5 * d / near, 0.0, 1.0);
      }
  });
  RoughSize all;
  for (const RoughSize& slab : slabs) all.area += slab.area, all.volume += slab.volume;
  return all;
}

}  // namespace bedload
