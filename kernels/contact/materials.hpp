#pragma once
// Input from which contact laws compute their parameters.

#include "bedload/case/config/contact.hpp"
#include "bedload/case/materials.hpp"
#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// The materials of both sides, and the table [contact].
struct ContactMaterials {
  double normal, tangential;  ///< sums of the compliances of both sides, 1/Pa
  double nu;                  ///< Poisson's ratio, mean of both sides
  double mu, mu_r, e;
  const ContactConfig& contact;

  double E_star() const { return 1 / normal; }
  double G_star() const { return 1 / tangential; }
};

}  // namespace BL_SOLVER
