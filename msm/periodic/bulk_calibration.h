// Spring constants and dispersed fraction that give an infinite periodic network the material's moduli.
#pragma once

#include "msm/parameters/model_table.h"

namespace springproof {

struct BulkCalibration {
  double spring_shear_modulus;  ///< what affine_shear_modulus() of the springs must be [Pa]
  double q;                     ///< of momentum dispersion, with weights as exact_volumes() has them
};

/// As the model asks: random networks as measured, unless `calibration = "affine"`; all others by the formulas.
/// @throws as calibrate_in_bulk().
BulkCalibration bulk_calibration(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Eq. (20) of Kot et al. (2014) and Kot & Nagahashi (2015), eq. (9): exact on lattices.
BulkCalibration affine_calibration(const ModelParameters& parameters, const IsotropicMaterial& material);

/// For random networks.  Their nodes relax, so that eq. (20), which is affine, promises more than they keep; a periodic
/// sample of 1331 nodes of the same minL, maxL or <S>, and exponent, with a seed that no case file can have, is
/// homogenised, and springs and q are corrected until its shear and bulk modulus (springs alone: its Young's modulus)
/// are the material's to 1e-3.  Results are kept for the life of the program; may be called from several threads.
/// @throws std::runtime_error if no q gives the sample the bulk modulus wanted (eMSM with w = k L near nu = 1/2).
BulkCalibration calibrate_in_bulk(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Poisson's ratio of the network's springs alone, where q changes its sign, whatever the weights: 1/4 by the formulas,
/// a little more as measured (0.28 at 10 springs per node).
double springs_poisson_ratio(const ModelParameters& parameters);

/// Whether symmetric dispersion takes exact nodal volumes.  k L is proved stable for every q > -1/2 on every network;
/// exact volumes are energies too, but a negative one (q < 0) can outweigh the springs at disordered nodes and where
/// surface nodes lack springs.  q has the sign of nu - springs_poisson_ratio(), whatever the weights.
bool exact_volumes(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
