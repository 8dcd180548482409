// A body in a lattice several times as fine as that of its cells.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "meshes/voxels/cut_cells.h"

namespace springproof {

/// Edge of the cells over that of those in which they are measured.
inline constexpr int measuring_ratio = 3;

/// The fine cells of a body, and the coarse cell that each lies in.
struct FineCells {
  CutBody body;                      ///< cut by the fine lattice
  int ratio = 0;                     ///< edge of the coarse cells over that of these
  std::vector<int> in;               ///< coarse cell of each; -1: none, where the coarse lattice leaves the body out
  std::vector<std::vector<int>> of;  ///< fine cells of each coarse cell
};

/// Cuts a body by planes among which are those of `coarse`.
/// @param coarse cells of one size
/// @param mesh tetrahedra of the same body
/// @param ratio of the edges, from 2
/// @return the fine cells
/// @throws as cut_body()
FineCells fine_cells(const CutBody& coarse, const Mesh& mesh, int ratio);

/// The trilinear fields of the coarse cells at the fine nodes.
/// @param coarse cells
/// @param fine cells of the same body
/// @return P, fine x coarse nodes; rows of nodes in no coarse cell are empty
Eigen::SparseMatrix<double, Eigen::RowMajor> prolongation(const CutBody& coarse, const FineCells& fine);

}  // namespace springproof
