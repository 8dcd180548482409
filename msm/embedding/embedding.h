// Embedding of a body's mesh in a network: interpolation to the mesh's nodes, and the network nodes held by each patch.
#pragma once

#include <Eigen/SparseCore>
#include <map>
#include <string>
#include <vector>

#include "msm/topology/network.h"
#include "msm/topology/region.h"

namespace springproof {

/// Shares of the nodes of a network in integrals over a patch of the true body, N_n the interpolation of node n.
struct PatchShares {
  Eigen::VectorXd area;  ///< integral of N_n [m^2]
  NodalVectors normal;   ///< integral of N_n times the outward unit normal [m^2]
};

/// How a body's mesh hangs in a network.
struct Embedding {
  /// Displacement of the mesh's nodes = weights * displacement of the network's, mesh nodes x network nodes.  Affine
  /// displacements are reproduced exactly, so that the transpose preserves the resultant and moment of loads.
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;
  std::map<std::string, std::vector<int>> held;  ///< patch -> the network nodes that its supports hold, ascending
  std::map<std::string, PatchShares> patches;    ///< of the true body; empty: loads are those on the mesh's nodes
  Eigen::VectorXd volumes;                       ///< integral of N_n over the true body [m^3]; empty likewise
  bool free_fall = false;  ///< gravity acts on the nodes' masses, not with the wrench of the true body's weight
  /// Points of the true surface, by which the body touches others, as `weights`: points x nodes.  Empty: the nodes.
  Eigen::SparseMatrix<double, Eigen::RowMajor> surface;
};

/// Embedding in a network whose nodes are the mesh's nodes, in their order.
Embedding nodes_of_mesh(const Mesh& mesh);

/// Embedding in any other: moving least squares with linear fields over the nearest network nodes that are connected by
/// springs with the nearest of them (not across a gap in the body), and each patch holds the nodes within `grip` [m] of
/// it (possibly none).  If the network fills `region`, which the mesh only approximates, patches are those of `region`.
/// @throws std::invalid_argument if the nodes span no volume (no area, for a network in a plane z = const).
Embedding embed(const Mesh& mesh, const Network& network, double grip, const Region* region = nullptr);

/// nodes_of_mesh() if there is a node of the network at each node of the mesh and no other, in any order; else embed().
Embedding embed_at_nodes(const Mesh& mesh, const Network& network, double grip, const Region* region = nullptr);

}  // namespace springproof
