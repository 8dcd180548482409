// A model of the table as an endless solid: its bulk, without surfaces.
#pragma once

#include "msm/models.h"

namespace springproof {

/// A periodic cell of about `nodes` nodes, one per volume `spacing`^3 [m^3], calibrated by eq. (20) and (9) of the papers, so that what
/// comes out shows what these promise and what the network keeps.
/// Lattices of corners and of centres have the same bulk.  Random networks: p.random, its spacing replaced.
/// @throws InputError for planar networks, and if a random network is out of range.
MassSpringModel periodic_model(const ModelParameters& p, const IsotropicMaterial& material, double spacing, int nodes);

}  // namespace springproof
