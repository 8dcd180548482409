// A model of the table as an infinite periodic network: its bulk, without surfaces; the spring constants and dispersed
// fraction that give it the material's moduli.
#pragma once

#include "msm/parameters/model_table.h"

namespace springproof {

struct BulkCalibration {
  double spring_shear_modulus;  ///< required affine_shear_modulus() of the springs [Pa]
  double q;                     ///< of momentum dispersion, with the weights that exact_volumes() selects
};

/// As the model requires: random networks by homogenisation, unless `calibration = "affine"`; all others by the
/// formulas.
/// @throws as calibrate_in_bulk().
BulkCalibration bulk_calibration(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Eq. (20) of Kot et al. (2014) and Kot & Nagahashi (2015), eq. (9): exact on lattices.
BulkCalibration affine_calibration(const ModelParameters& parameters, const IsotropicMaterial& material);

/// For random networks.  Their nodes relax, so that eq. (20), which is affine, overestimates their moduli; a periodic
/// sample of 1331 nodes of the same minL, maxL or <S>, and exponent, with a seed that no case file can have, is
/// homogenised, and springs and q are corrected until its shear and bulk modulus (springs alone: its Young's modulus)
/// are the material's to 1e-3.  Results are cached for the lifetime of the program; may be called from several threads.
/// @throws std::runtime_error if no q gives the sample the required bulk modulus (eMSM with w = k L near nu = 1/2).
BulkCalibration calibrate_in_bulk(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Poisson's ratio of the network's springs alone, at which q changes its sign for any weights: 1/4 by the formulas, a
/// little more as measured (0.28 at 10 springs per node).
double springs_poisson_ratio(const ModelParameters& parameters);

/// Whether symmetric dispersion uses exact nodal volumes.  Weights k L are proved stable for every q > -1/2 on every
/// network; exact volumes are conservative too, but a negative energy (q < 0) can outweigh the springs at disordered
/// nodes and where surface nodes lack springs.  q has the sign of nu - springs_poisson_ratio() for any weights.
bool exact_volumes(const ModelParameters& parameters, const IsotropicMaterial& material);

/// A periodic cell of about `nodes` nodes, one per volume `spacing`^3 [m^3]: the model that build_embedded() puts into
/// a body, with the same springs, calibration and weights.  Lattices of corners and of centres have the same bulk.
/// Random networks: p.random, its spacing replaced.
/// @throws InputError for planar networks, and if a random network is out of range; std::runtime_error if it cannot
///   have the material's moduli.
MassSpringModel periodic_model(const ModelParameters& p, const IsotropicMaterial& material, double spacing, int nodes);

/// The same for a random network with a given calibration; symmetric dispersion: p.exact_volumes resolved (empty: k L).
MassSpringModel periodic_random_model(const ModelParameters& p, const BulkCalibration& calibration, double spacing,
                                      int nodes);

}  // namespace springproof
