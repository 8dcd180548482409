// A body in a lattice several times as fine as that of its cells.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "meshes/voxels/cut_cells.h"
#include "msm/laws/averaged_springs.h"

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

/// Cuts a body by planes among which are those of `coarse`, each material as a body of its own.
/// @param coarse cells of one size, of the body as one material
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

/// The materials of a body in one of its coarse cells.
/// @param fine cells of the body
/// @param cell of the coarse lattice
/// @param materials how many there are
/// @return share of each in its volume
std::vector<double> shares_of_materials(const FineCells& fine, int cell, std::size_t materials);

/// Springs in place of the materials in a coarse cell.  What a stiff part does depends on how it is joined to the next
/// cell: their moduli are the geometric mean of the arithmetic mean over the cell, which says that it is, and of the
/// geometric one.
/// @param fine cells of the body
/// @param cell of the coarse lattice
/// @param law of the materials
/// @return springs of one material
AveragedSprings springs_in_cell(const FineCells& fine, int cell, const AveragedSprings& law);

}  // namespace springproof
