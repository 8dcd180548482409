// Spring constants and dispersed fraction that give an endless disordered network the material's moduli.
#pragma once

#include "msm/models.h"

namespace springproof {

struct BulkCalibration {
  double spring_shear_modulus;  ///< what affine_shear_modulus() of the springs must be [Pa]
  double q;                     ///< of momentum dispersion, with weights as they are in the sample
};

/// For random networks.  Their nodes relax, so that eq. (20) of Kot et al. (2014), which is affine, promises more than
/// they keep; a periodic sample of 1331 nodes (seed 1 of the same minL, maxL or <S>, and exponent) is homogenised and
/// springs and q are corrected until its shear and bulk modulus (springs alone: its Young's modulus) are the material's to
/// 1e-3.  Results are kept for the life of the program; may be called from several threads.
/// @throws std::runtime_error if no q gives the sample the bulk modulus wanted (eMSM with w = k L near nu = 1/2).
BulkCalibration calibrate_in_bulk(const ModelParameters& parameters, const IsotropicMaterial& material);

/// What calibrate_in_bulk() starts from: eq. (20) and Kot & Nagahashi (2015), eq. (9).
BulkCalibration affine_calibration(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
