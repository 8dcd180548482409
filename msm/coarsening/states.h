// States of a body, by which its cells are measured.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "msm/coarsening/fine_cells.h"
#include "msm/laws/laws.h"
#include "problem/material.h"

namespace springproof {

/// The materials that averaged springs stand for, of density 1.
std::vector<IsotropicMaterial> materials_of(const AveragedSprings& law);

/// The fine cells of a body, held on patches.
/// @param fine cells
/// @param held names of the patches
/// @param law of its materials
/// @return network and laws, anchors and bonds among them
MassSpringModel held_fine_cells(const FineCells& fine, const std::vector<std::string>& held,
                                const AveragedSprings& law);

/// Gives the anchors of coarse cells the stiffness of the materials there; of a body of one they have it.
/// @param body the coarse cells
/// @param held names of the patches, in the order of the anchors
/// @param fine cells of the body
/// @param law of its materials
/// @param network whose anchors are changed
void set_anchors(const CutBody& body, const std::vector<std::string>& held, const FineCells& fine,
                 const AveragedSprings& law, Network& network);

/// Loads all over a body: Gaussian body forces, of one to three cells' width, and forces and torques at marks, the tips
/// of its limbs among them, taken by another mark.  On a free body with the acceleration that they cause.
/// @param network of cells, held by anchors or free
/// @param series number of a series of such loads: another one has other places and directions
/// @return forces [N] of the nodes, 3 * node + axis, a load per column
Eigen::MatrixXd loads_all_over(const Network& network, unsigned series);

/// Displacements under loads.
/// @param model of cells, held or free
/// @param loads one per column [N]; on a free body without resultant
/// @return [m]; of a free body without rigid motions (least squares by the nodes' volumes)
/// @throws std::runtime_error if a system is not solved
Eigen::MatrixXd displacements_under(const MassSpringModel& model, const Eigen::MatrixXd& loads);

}  // namespace springproof
