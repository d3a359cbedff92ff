#include "src/boundaries/orifices.hpp"

#include "bedload/geometry/orifice.hpp"

namespace BL_SOLVER {

std::vector<Orifice> orifices_of(const std::vector<InletConfig>& inlets, std::size_t walls, double dx,
                                 const DomainConfig& domain) {
  std::vector<Orifice> all;
  for (const InletConfig& inlet : inlets) {
    Orifice& o = all.emplace_back();
    o.centre = inlet.centre;
    o.direction = inlet.direction;
    o.disc = inlet.shape == OrificeShape::disc;
    o.body = std::uint32_t(walls + all.size() - 1);
    o.behind = 0.5 * orifice_layer(inlet, dx, domain).thickness;
    const Vec3d side[2] = {inlet.half_a, inlet.half_b};
    for (int k = 0; k < 2 && !o.disc; ++k) {
      o.half[k] = norm(side[k]);
      o.axis[k] = side[k] / o.half[k];
    }
    if (o.disc) o.half[0] = inlet.radius, o.half[1] = 0;
  }
  return all;
}

}  // namespace BL_SOLVER
