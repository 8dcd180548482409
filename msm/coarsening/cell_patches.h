// The force of a coarse cell as the fine lattice around it has it: one local problem per cell.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "msm/coarsening/fine_cells.h"
#include "msm/laws/measured_cells.h"

namespace springproof {

/// How a cell answers to displacements U of the corners of the cells of its patch, 3 * node + axis.
struct PatchAnswer {
  std::vector<int> nodes;       ///< of the coarse lattice
  Eigen::MatrixXd deformation;  ///< y of the cell [m], 18 x 3 nodes
  Eigen::MatrixXd stress;       ///< s of the cell [N]: its forces are T^T s, T = deformation_of(); 18 x 3 nodes
};

/// The patch of a cell are all cells that share a node with it.  Its fine lattice moves with the trilinear field P U
/// where it is cut off from the rest of the body; the body's own surface is free.  Of the equilibrium u in it
///   y = T R u,  R u the corners' displacements whose field P R u is nearest to u (least squares by volume), and
///   s = (T^T)^+ sum over the fine cells e of the cell of P_e^T k_e u_e.
/// Summed over the body these forces are P^T of the fine lattice's: cells that give s for y move as it does.
/// Where a support holds the surface the fine lattice has its anchors, and the patch's cut does not move; the anchors'
/// own forces are not among those of the cell.  Bonds between materials have no forces in a field P U.
class CellPatches {
 public:
  /// All must outlive it.
  /// @param coarse cells of one size
  /// @param fine cells of the same body
  /// @param law of the materials, of Young's modulus 1 of the first
  /// @param held names of the patches that supports hold
  CellPatches(const CutBody& coarse, const FineCells& fine, const AveragedSprings& law,
              const std::vector<std::string>& held = {});

  /// Cells in whose patch a support holds the surface.
  /// @return whether each is one
  std::vector<char> near_supports() const;

  /// Solves the local problem of a cell.  May be called from several threads.
  /// @param cell of the coarse lattice
  /// @return its answer; no nodes: the patch is all of the body, or has none of its fine cells
  PatchAnswer answer(int cell) const;

 private:
  struct Patch;
  struct FineNodes;

  Patch patch_of(int cell) const;
  FineNodes nodes_of(const Patch& patch) const;
  const Eigen::Matrix<double, 24, 24>& stiffness(int fine) const;
  void add_supports(const std::vector<std::string>& held);
  void add_bonds();
  Eigen::MatrixXd stress_rows(int cell, const FineNodes& nodes) const;
  Eigen::MatrixXd deformation_rows(int cell, const Patch& patch, const FineNodes& nodes) const;
  Eigen::MatrixXd restriction_matrix(const Patch& patch, const FineNodes& nodes) const;
  template <class Act>
  void each_of_bond(const InterfaceBond& bond, const FineNodes& nodes, const Act& act) const;
  template <class Act>
  void each_coupling(const Patch& patch, const FineNodes& nodes, const Act& act) const;

  const CutBody& coarse_;
  const FineCells& fine_;
  const AveragedSprings& law_;
  std::vector<Eigen::Matrix<double, 24, 24>> stiffness_;  ///< of a full fine cell of each material, then of the others
  std::vector<int> number_;                               ///< of a fine cell among them
  std::vector<InterfaceBond> bonds_;                      ///< of the fine cells
  std::vector<std::vector<int>> bonds_of_;                ///< of a fine cell, those that it is the first cell of
  std::vector<char> reaches_;  ///< whether a bond of a fine cell leads to another cube, as those of slivers do
  std::map<int, Eigen::Matrix<double, 24, 24>> anchors_;  ///< of fine cells
  std::vector<char> at_support_;                          ///< fine nodes of these cells
  std::vector<std::vector<int>> at_;                      ///< coarse cells at each coarse node
  std::vector<int> cells_at_;                             ///< how many fine cells have each fine node
};

}  // namespace springproof
