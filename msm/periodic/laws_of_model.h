// Force laws of a row of the model table, for bodies and for periodic cells.
#pragma once

#include "msm/cells/dispersion_weights.h"
#include "msm/periodic/bulk_calibration.h"

namespace springproof {

/// The laws of a calibrated network.  `volume_gradient`: derivative of the body's volume with respect to the positions
/// of the nodes [m^2]; zero without a surface.  `start`: what exact weights of momentum dispersion are nearest to.
/// @throws as bulk_calibration() if the model has momentum dispersion.
std::vector<ForceLaw> laws_of(const ModelParameters& p, const Network& network, const IsotropicMaterial& material,
                              const BulkCalibration& calibration, const NodalVectors& volume_gradient,
                              WeightStart start = WeightStart::stiffness);

/// The springs of a model averaged over its cells, which for small strains have its moduli.
/// @param p row and options
/// @param material of the cells
/// @param regions other materials of the body
/// @return springs of all
AveragedSprings averaged_law(const ModelParameters& p, const IsotropicMaterial& material,
                             const std::vector<IsotropicMaterial>& regions = {});

/// The law that cells are measured with (msm/coarsening/): near nu = 1/2 noise times the bulk modulus would be fitted.
/// @param p row and options
/// @param material the cells'
/// @param regions other materials of the body
/// @return averaged springs per unit of Young's modulus, at Poisson's ratio 0.3 at most; shear moduli in proportion
AveragedSprings measuring_law(const ModelParameters& p, const IsotropicMaterial& material,
                              const std::vector<IsotropicMaterial>& regions = {});

/// Momentum dispersion of eMSM; symmetric dispersion with p.exact_volumes resolved (empty: k L).
MomentumDispersion dispersion_law(const ModelParameters& p, const Network& network, const BulkCalibration& calibration,
                                  const NodalVectors& volume_gradient, WeightStart start = WeightStart::stiffness);

}  // namespace springproof
