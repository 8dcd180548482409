// Spring constants under which every affine strain of a disordered network is in equilibrium at every node.
#pragma once

#include "msm/topology/network.h"

namespace springproof {

/// Replaces the spring constants by k = t k_0, k_0 = c / L^2, t > 0, that fulfil at each node n the ten conditions
///   sum_s k L n_i n_j n_k = -G (d_ij A_k + d_jk A_i + d_ki A_j)   (unit vectors n from the node, d Kronecker's
///   symbol)
/// and make the sum of (t - 1)^2 / 2 - 0.09 ln t least: near 1, and never zero.
/// Then the forces of the springs under any affine strain e balance the traction of the stress G (2 e + tr(e) 1) on the
/// surface, at every node: the network is exactly a solid of shear modulus G and nu = 1/4.  The dual problem, in ten
/// unknowns per node, is solved by Newton's method with a line search, its linear systems by conjugate gradients,
/// matrix-free, preconditioned by the nodes' blocks and a coarse space (patch_conditions.h).  Reports its progress.
/// @param area A_n, the integral of the outward normal over the node's part of the surface [m^2], n x 3: zero inside
/// and
///   for periodic networks; sum A_n = 0 and sum A_n x_n^T = V 1, or no constants exist.
/// At corners and in thin parts conditions can contradict each other (all springs at a corner lead inwards, but the
/// component xyz must vanish); a slack of 1e-5 spreads what is left over the node's conditions.  Nodes that are off by
/// 3 % of the condition of a plane face with a slack of 1e-4 keep that.
/// @throws std::runtime_error if the mean residual exceeds 0.03: too few springs at some nodes.
void fit_patch(const NodalVectors& area, double shear_modulus, Network& network);

}  // namespace springproof
