// Networks of the cells of a cut body: springs without a staircase.
#pragma once

#include <string>
#include <vector>

#include "meshes/voxels/cut_cells.h"
#include "msm/embedding/embedding.h"

namespace springproof {

/// Stiffness of an anchor, in units of E A / l, A the area of the patch in the cell of edge l: a support gives way like
/// a thirtieth of a cell.  Stiffer anchors make clamped bodies, which coarse cells leave too stiff, stiffer still.
inline constexpr double anchor_stiffness = 30;

/// The cells as a network: nodes are the corners of the cells, with an eighth of a cell's volume each, and one node, of
/// no volume, in the centroid of each part of the patches `held` in a cell, anchored to that cell.
/// `youngs_modulus` [Pa]: of the body, for the anchors.
Network cut_lattice(const CutBody& body, const std::vector<std::string>& held, double youngs_modulus);

/// Embedding in that network of a mesh in the body: the nodes of a cube of the mesh follow the cell that holds the
/// cube's middle.  Loads are integrals over the true body and its patches.
Embedding embed(const CutBody& body, const std::vector<std::string>& held, const Network& network, const Mesh& mesh);

/// Nodes by which a support holds a patch where it cannot be anchored, as in motion: of each cell that the patch
/// crosses the corners nearest to it, whose weights over the patch are those of the middle of the cell or larger; none
/// that is carried.
std::vector<int> nodes_at_patch(const CutBody& body, const std::string& patch);

/// Displacement of the network at points of the body [m].
NodalVectors displacement_at(const CutBody& body, const NodalVectors& displacement, const NodalVectors& points);

}  // namespace springproof
