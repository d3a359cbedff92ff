#pragma once
#include "kernels/contact/grain_mass.hpp"
#include "kernels/integrate/grain_fields.hpp"
#include "kernels/sdpd/noise.hpp"

namespace BL_SOLVER {

/// Noise that belongs to drag in a fluid at temperature. Drag relaxes a grain's velocity to that of the fluid
/// at the rate k = drag_coefficient / m over a step dt; the noise adds to fluid_velocity three normal
/// deviates times
///   (kT / m coth(k dt / 2))^(1/2),
/// so that m v^2 is kT on average along each axis for any k dt (Ornstein-Uhlenbeck over a step). The fluid
/// receives the opposite of the drag impulse, noise included, by the weights of drag: the noise that balances
/// its own friction. The same holds for the spin.
struct DragNoisePass {
  NoiseKey key;
  double kT, dt;  ///< J, s
  MassPerR3 mass_per_r3;
  Span<const Id> id;
  Span<const Real> radius;
  DragFields drag;

  BL_HD void operator()(Index j) const {
    const double R = radius[j], m = mass_per_r3(j) * R * R * R;
    if (drag.coefficient[j] > 0) drag.velocity[j] += spread(m, drag.coefficient[j]) * deviates(id[j], 3);
    if (drag.rot_coefficient[j] > 0)
      drag.rotation[j] += spread(0.4 * m * R * R, drag.rot_coefficient[j]) * deviates(id[j], 4);
  }

 private:
  BL_HD Real spread(double inertia, Real friction) const {
    return Real(std::sqrt(kT / inertia / std::tanh(0.5 * double(friction) * dt / inertia)));
  }
  BL_HD Real3 deviates(Id grain, std::uint32_t draw) const {
    const Words w = key.words(grain, 0, draw);  // pairs of fluid use the draws 0 to 2
    const Normals xy = normals(w.x, w.y), z = normals(w.z, w.w);
    return {xy.a, xy.b, z.a};
  }
};

}  // namespace BL_SOLVER
