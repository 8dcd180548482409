// Weights of momentum dispersion that make the inflow of a node its exact share of the volume change.
#pragma once

#include <vector>

#include "msm/topology/network.h"

namespace springproof {

/// Weights, and which nodes share an inflow.
struct DispersionWeights {
  std::vector<double> weight;  ///< per spring end, i then j: w [N], for Dispersion::symmetric
  std::vector<int> group;      ///< for MomentumDispersion::group
  int iterations = 0;          ///< of the least squares; 0 in closed form
  double residual = 0;         ///< |unmet conditions| / |conditions|
};

/// Nodes whose springs lie to one side (surfaces) share the J of the inner node that their shortest spring leads to: a
/// J of their own could not distinguish shear from a change of volume, and one constraint per node would stiffen the
/// body near nu = 1/2.  Returns, per node, the node whose J it shares.
std::vector<int> volume_groups(const Network& network);

/// Which weights the exact ones are nearest to.
enum class WeightStart {
  stiffness,     ///< k L, nodes whose springs lie to one side sharing a J: volume_groups()
  near_springs,  ///< 1 / L^4, each node with a J of its own: of networks of many springs per node, for q < 0
};

/// Weights w with two properties, up to a factor 10 G:
///  - under any affine displacement, J_n = V_n div u (V_n the volume share of the group): no node responds to shear;
///  - for any displacement, sum_n J_n is the body's change of volume to first order, `volume_gradient` . u: uniform
///    pressure is in equilibrium at every node.
/// With w = k L the first fails at edges and corners and on disordered nodes, the second on disordered nodes, where the
/// network relaxes the pressure.
/// Superposed cells meet both with w = k c on their edges and none on their diagonals, in any body: each cell gives an
/// eighth of its volume to each corner by the three edges there.  Other networks get the weights nearest to `start`,
/// w_0, in the sum of (w - w_0)^2 / w_0.
/// Planar networks: J_n = V_n (the in-plane divergence), the factor is 8 G.
/// Nodes at the surface of a disordered network may have too few springs to meet all conditions, which are then met
/// approximately, with a slack of 1e-3.
/// @param network of the springs
/// @param volume_gradient dV/dx of the body at the nodes [m^2], n x 3; zero for periodic networks
/// @param shear_modulus G [Pa]
/// @param start what they are nearest to
/// @return weights [N] and groups
/// @throws std::runtime_error if the residual exceeds 0.2.
DispersionWeights volume_weights(const Network& network, const NodalVectors& volume_gradient, double shear_modulus,
                                 WeightStart start = WeightStart::stiffness);

}  // namespace springproof
