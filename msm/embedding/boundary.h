// Transfer of loads to the nodes of a mesh or network, and the reactions of the supports.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "meshes/field.h"
#include "msm/embedding/embedding.h"
#include "problem/attached_mass.h"
#include "problem/loads.h"
#include "problem/system/input_error.h"

namespace springproof {

/// An unknown that a further patch prescribes, the same as the patch of its owner.
struct SharedUnknown {
  int unknown;   ///< 3 * node + axis
  int load;      ///< number of the load that prescribes it too
  double share;  ///< of the reaction, by the areas of the patches at the node
};

/// Supports and loads of nodes, as solvers take them; carried nodes (CellSet::carried) have neither: hand_back() passes
/// forces on them on.  A program may fill it itself (examples/own_model.cpp).
struct BoundaryConditions {
  std::vector<char> fixed;                 ///< per unknown 3 * node + axis: displacement prescribed
  std::vector<int> owner;                  ///< per unknown: number of the load that prescribes it, -1 = free
  NodalVectors prescribed;                 ///< prescribed displacement, zero where free [m]
  NodalVectors external;                   ///< nodal forces [N]
  std::vector<SharedUnknown> shared = {};  ///< each further patch of an unknown once
};

/// Transfers the loads at load factor `factor` to the mesh's nodes.  Tractions and pressure by the facets' shape
/// functions, gravity by nodal mass, a point force by the shape functions of the cell that contains it: resultant and
/// moment are preserved.  A load that carries a wrench (of the true body, which the mesh only approximates) gets that
/// wrench.
/// @throws InputError: a body force of an exact field, no such patch, a point force outside the body, two loads that
///   prescribe different values at one node.
/// @param loads forces and prescribed displacements
/// @param mesh whose nodes are those of the network, as in lattices of cells
/// @param density for gravity [kg/m^3]
/// @param kinematics linear: rotations are linearised
/// @param factor fraction of the loads that is applied
/// @return conditions of 3 n unknowns, n nodes of the mesh
BoundaryConditions transfer(const std::vector<Load>& loads, const Mesh& mesh, double density, Kinematics kinematics,
                            double factor = 1.0);

/// The same for a network in the mesh: forces are transferred by the transposed embedding, which preserves resultant
/// and moment; supports fix the nodes that their patch holds, with the values at the nodes' own positions.  The nodes
/// of a planar network stay in their plane.
/// @param loads forces and prescribed displacements
/// @param mesh of the body
/// @param embedding of the mesh in the network: EmbeddedModel::embedding
/// @param network whose nodes the conditions are for
/// @param density for gravity [kg/m^3]
/// @param kinematics linear: rotations are linearised
/// @param factor fraction of the loads that is applied
/// @return conditions of 3 n unknowns, n nodes of the network
/// @throws InputError also if a support finds no node to hold.
BoundaryConditions transfer(const std::vector<Load>& loads, const Mesh& mesh, const Embedding& embedding,
                            const Network& network, double density, Kinematics kinematics, double factor = 1.0);

/// Sets Network::attached: each node has the share in a mass that it has in a force in its place, and none where that
/// is negative, as it may be at the surface of a disordered network.
/// @param masses beside the body's own
/// @param mesh of the body
/// @param embedding of the mesh in the network: EmbeddedModel::embedding
/// @param network that gets the masses
/// @throws InputError naming the mass, as transfer() of such a force
void attach(const std::vector<AttachedMass>& masses, const Mesh& mesh, const Embedding& embedding, Network& network);

/// Checks that supports leave no rigid motion.
/// @param conditions with the fixed unknowns
/// @param X positions of their nodes at rest [m], n x 3
/// @throws InputError naming the free rigid motion if they leave one.
void require_supported(const BoundaryConditions& conditions, const NodalVectors& X);

/// Fixes, at zero displacement, the fewest unknowns that constrain the remaining rigid motions: this causes no strain,
/// and no reaction if the loads are in equilibrium.
/// @param X positions of the nodes at rest [m], n x 3
/// @param conditions that get the additional supports
/// @param carried nodes that follow others and cannot be held: CellSet::carried
void hold_free_motions(const NodalVectors& X, BoundaryConditions& conditions,
                       const std::vector<CarriedPoint>& carried = {});

/// Support forces and torques per patch with prescribed displacement, from the support force of each node at X [N].
/// Patches that prescribe one unknown share its force by their areas at the node, equally where they have none.
/// @param loads those of the conditions
/// @param mesh with the patches
/// @param X positions of the nodes at rest [m], n x 3
/// @param conditions that the loads gave
/// @param support force of the supports on each node [N], n x 3: Equilibrium::support
/// @param displacement of the nodes [m], n x 3
/// @param kinematics finite: lever arms are those of the deformed body
/// @return one per patch with prescribed displacement
std::vector<PatchReaction> patch_reactions(const std::vector<Load>& loads, const Mesh& mesh, const NodalVectors& X,
                                           const BoundaryConditions& conditions, const NodalVectors& support,
                                           const NodalVectors& displacement, Kinematics kinematics);

/// Patches that prescribe an unknown which another patch prescribes too (held edges in common): how the support force
/// of such an unknown is shared between them is a convention, so their separate forces are no property of the solid.
/// @param loads forces and prescribed displacements
/// @param mesh with the patches
/// @param kinematics as for transfer()
/// @return names of these patches
std::set<std::string> patches_sharing_supports(const std::vector<Load>& loads, const Mesh& mesh, Kinematics kinematics);

}  // namespace springproof
