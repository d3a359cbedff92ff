#pragma once
// What the laws of a contact take their parameters from.

#include "bedload/case/config/contact.hpp"
#include "bedload/case/materials.hpp"

namespace bedload::inline BL_VARIANT {

/// Two materials that touch, and [contact].
struct ContactMaterials {
  double normal, tangential;  ///< sums of the compliances of both sides, 1/Pa
  double nu;                  ///< Poisson's ratio, mean of both sides
  double mu, mu_r, e;
  const ContactConfig& contact;

  double E_star() const { return 1 / normal; }
  double G_star() const { return 1 / tangential; }
};

}  // namespace bedload::inline BL_VARIANT
