// What a lattice really has for moduli, measured on a block.
#pragma once

#include "msm/models.h"

namespace springproof {

struct MeasuredModuli {
  double youngs_modulus;  ///< end force / (area * strain) between slipping plates [Pa]
  double poisson_ratio;   ///< lateral over axial strain in the same test
  double shear_modulus;   ///< from the energy of an affine shear [Pa]
};

/// Uniaxial test between slipping plates, and an affine shear, on a free block of `cells` cubed cells, linearised.
/// @throws std::runtime_error if the block has no equilibrium (zero-energy modes).
MeasuredModuli measure_moduli(const ModelParameters& parameters, const IsotropicMaterial& material, int cells = 4);

}  // namespace springproof
