// Numerical measurement of the elastic moduli that a model has.
#pragma once

#include "msm/parameters/model_table.h"

namespace springproof {

/// Moduli that a model has.
struct MeasuredModuli {
  double youngs_modulus;  ///< [Pa]
  double poisson_ratio;   ///< [1]
  double shear_modulus;   ///< [Pa]
};

/// Lattices whose nodes are the mesh's: uniaxial test between slipping plates (end force / (area * strain), lateral
/// over axial strain) and an affine shear (from its energy), on a free block of `cells` cubed cells, linearised. Planar
/// networks: the same in the plane, as plane strain.  Others: the infinite periodic network, homogenised; random
/// networks on a sample of 1000 nodes that the calibration does not use.
/// @throws std::runtime_error if there is no equilibrium (zero-energy modes).
MeasuredModuli measure_moduli(const ModelParameters& parameters, const IsotropicMaterial& material, int cells = 4);

}  // namespace springproof
