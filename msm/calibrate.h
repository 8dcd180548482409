// One formula calibrates every network: G = sum k L^2 / (d (d + 2) V) in d dimensions.
#pragma once

#include "msm/network.h"

namespace springproof {

/// Shear modulus [Pa] of a network under affine strain, averaged over directions: sum k L^2 / (d (d + 2) V), d = 3,
/// d = 2 for planar
/// networks (Network::triangles); Kot et al. (2014), eqs. (12) and (20) in terms of G.  Exact for isotropic cell-superposed lattices (it contains Golec et al.
/// 2019, eq. (5.11)), an upper bound for disordered networks.
double affine_shear_modulus(const Network& network);

/// Scales all spring constants so that affine_shear_modulus(network) == G.
void calibrate(double shear_modulus, Network& network);

/// Gives every node the stiffness that its volume asks for.  Near the surface nodes lack springs; each has a factor
/// V_i c / (sum k L^2 / 2 over its springs), c the material's, and springs are scaled by the mean factor of their ends.
/// Repeated a few times, a spring's stiffness changing by no more than a factor of 4.  sum k L^2 of the network becomes
/// c V, c being the median of the nodes with at least the mean number of springs: the density of the bulk.
/// Only nodes short of springs (fewer than 3/4 of ... ) are corrected.
/// Not for periodic networks, which lack no springs: they stay as they are.
void correct_surface(Network& network);

}  // namespace springproof
