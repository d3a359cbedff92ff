#pragma once
// What the host asks of the contact laws that a case names: bounds of e, impacts, softness, steps. They
// answer where they are written, in kernels/contact/.

#include <limits>

#include "bedload/case/config/contact.hpp"

namespace bedload {

/// The least restitution that the damping can reach; the largest is 1.
double least_restitution(const ContactConfig& contact);

/// Whether Young's moduli enter; else contact.k does.
bool takes_moduli(NormalLaw law);

/// Impact of two bodies.
struct Impact {
  double duration = std::numeric_limits<double>::infinity();  ///< s
  double stiffness = 0;                                       ///< where it is deepest, dF/d(overlap), N/m
};
/// Of reduced mass m (kg), radius R (m) and modulus E (Pa), at v (m/s). e: the restitution, which draws out
/// the contact of linear springs.
Impact impact(const ContactConfig& contact, double m, double R, double E, double v, double e = 1);

/// Overlap under a force at rest (N), m; 0 where there is no contact. R, E as above.
double overlap_under(const ContactConfig& contact, double force, double R, double E);

/// Longest stable step of rolling friction in a contact of the given stiffness (N/m), s; inertia: reduced,
/// about the contact, kg m2. Infinite where rolling has no spring.
double rolling_limit(const ContactConfig& contact, double stiffness, double mu_r, double R_star,
                     double inertia);

}  // namespace bedload
