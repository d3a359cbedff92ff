#pragma once
#include "bedload/particles/fluid.hpp"

namespace bedload::inline BL_VARIANT {

/// What drives the fluid besides gravity, m/s2.
struct Drive {
  Frame frame;
  Span<const FluidPosition> x;
  Vec3d f;  ///< force per volume of space, N/m3; or per mass, m/s2
  bool per_mass;
  int opposed;           ///< axis along which f is reversed in the upper half of the domain; -1: none
  Vec3d spring, centre;  ///< acceleration -spring (x - centre) per axis, 1/s2, m
  bool pulls;

  BL_HD Real3 operator()(Index a, const Real4& m_state) const {
    Real3 acc = per_mass ? Real3(f) : Real3(f) / (m_state.w * m_state.z);
    if (opposed >= 0 && upper(a)) acc = -acc;
    if (pulls) acc -= Real3(pull(a));
    return acc;
  }
  BL_HD double energy(Index a) const {
    return 0.5 * dot(pull(a), coordinates(frame, x[a]) - centre);
  }  ///< J/kg

 private:
  BL_HD bool upper(Index a) const {
    const Vec3d at = frame.wrap(coordinates(frame, x[a]));
    return at[opposed] - frame.origin[opposed] > 0.5 * frame.length[opposed];
  }
  BL_HD Vec3d pull(Index a) const {
    const Vec3d r = coordinates(frame, x[a]) - centre;
    return {spring.x * r.x, spring.y * r.y, spring.z * r.z};
  }
};

}  // namespace bedload::inline BL_VARIANT
