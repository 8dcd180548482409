// One formula calibrates every network: G = sum k L^2 / (15 V) in three dimensions.
#pragma once

#include "msm/network.h"

namespace springproof {

/// Shear modulus [Pa] of a network under affine strain, averaged over directions: sum k L^2 / (d (d + 2) V), d = 3;
/// Kot et al. (2014), eq. (20) in terms of G.  Exact for isotropic cell-superposed lattices (it contains Golec et al.
/// 2019, eq. (5.11)), an upper bound for disordered networks.
double affine_shear_modulus(const Network& network);

/// Scales all spring constants so that affine_shear_modulus(network) == G.
void calibrate(double shear_modulus, Network& network);

}  // namespace springproof
