// States of a body, by which its cells are measured.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "meshes/voxels/cut_cells.h"
#include "msm/laws/laws.h"

namespace springproof {

/// The cells of a body under a law per unit of Young's modulus, held on patches.
/// @param body in cells
/// @param held names of the patches
/// @param of_cells the law of the cells
/// @return network and laws, anchors among them
MassSpringModel held_cells(const CutBody& body, const std::vector<std::string>& held, const ForceLaw& of_cells);

/// Loads all over a body: Gaussian body forces, of one to three cells' width, and forces and torques at marks, the tips
/// of its limbs among them, taken by another mark.  On a free body with the acceleration that they cause.
/// @param network of cells, held by anchors or free
/// @param series number of a series of such loads: another one has other places and directions
/// @return forces [N] of the nodes, 3 * node + axis, a load per column
Eigen::MatrixXd loads_all_over(const Network& network, unsigned series);

/// Displacements under loads.
/// @param model held_cells()
/// @param loads one per column [N]; on a free body without resultant
/// @return [m]; of a free body without rigid motions (least squares by the nodes' volumes)
/// @throws std::runtime_error if a system is not solved
Eigen::MatrixXd displacements_under(const MassSpringModel& model, const Eigen::MatrixXd& loads);

}  // namespace springproof
