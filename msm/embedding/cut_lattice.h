// Networks of the cells of a cut body: springs without a staircase.
#pragma once

#include <string>
#include <vector>

#include "meshes/voxels/cut_cells.h"
#include "msm/embedding/embedding.h"
#include "problem/material.h"

namespace springproof {

/// Integral of a corner's trilinear weight over the filled part, in units of the volume of the cube; the moment of
/// third order is left out, so that force and moment of a uniform body force are exact.
double weight_of_corner(const FilledPart& part, int corner);

/// The cells as a network: nodes are the corners of the cells, with an eighth of a cell's volume each, and those, of no
/// volume, of the anchors of the patches `held`; of several materials with their bonds (supports.h).
/// `materials`: of the cells, by their number.
/// @throws std::invalid_argument if a cell has another material.
Network cut_lattice(const CutBody& body, const std::vector<std::string>& held,
                    const std::vector<IsotropicMaterial>& materials);

/// Embedding in that network of a mesh in the body: the nodes of a cube of the mesh follow the cell that holds the
/// cube's middle.  Loads are integrals over the true body and its patches; a part of another density than the body's
/// own counts in volumes by its mass.
Embedding embed(const CutBody& body, const std::vector<std::string>& held, const Network& network, const Mesh& mesh);

/// Displacement of the network at points of the body [m].
NodalVectors displacement_at(const CutBody& body, const NodalVectors& displacement, const NodalVectors& points);

}  // namespace springproof
