// A model of the table as an infinite periodic network: its bulk, without surfaces.
#pragma once

#include "msm/periodic/bulk_calibration.h"

namespace springproof {

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
