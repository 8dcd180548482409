// Calibration of spring constants to a shear modulus, G = sum k L^2 / (d (d + 2) V) in d dimensions for every network.
#pragma once

#include "msm/laws/laws.h"

namespace springproof {

/// Shear modulus [Pa] of a network under affine strain, averaged over directions: sum k L^2 / (d (d + 2) V), where d =
/// 3, or d = 2 for planar networks (Network::triangles); Kot et al. (2014), eqs. (12) and (20) in terms of G.  Exact
/// for isotropic cell-superposed lattices (it contains Golec et al. 2019, eq. (5.11)), an upper bound for disordered
/// networks.
double affine_shear_modulus(const Network& network);

/// That of a model: of its springs, or of the averaged springs of its cells.
double affine_shear_modulus(const MassSpringModel& model);

/// lambda that the volume term of a model adds to that of its springs, over their shear modulus, of several
/// materials the largest; 0: it has none.  Of a whole model, not of a part.
double volume_stiffness_ratio(const MassSpringModel& model);

/// Scales all spring constants so that affine_shear_modulus(network) == G.
void calibrate(double shear_modulus, Network& network);

/// Makes the stiffness of every node proportional to its volume: near the surface nodes lack springs, or lie closer
/// together. A node's factor is V_i c / (sum k L^2 / 2 over its springs); springs are scaled by the mean factor of
/// their ends, five times over, each by no more than a factor of 4 in all.  c is the material's value, from the nodes
/// marked in `bulk` (whole; empty, or none marked: from those with at least the mean number of springs).
/// Afterwards sum k L^2 = c V, that of a bulk network of the same volume.  Periodic networks are corrected like the
/// inside of a body.
void correct_surface(Network& network, const std::vector<char>& bulk = {});

}  // namespace springproof
