// Stress of cells of averaged springs, recovered at nodes, and their error, estimated without a reference.
#pragma once

#include <optional>
#include <vector>

#include "meshes/voxels/cut_cells.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Energies of cells in a small displacement.
struct CellEnergies {
  std::vector<double> error;    ///< of each cell's stress against that recovered at its nodes [J]
  std::vector<double> anchors;  ///< of those that hold each cell: a support does not give way [J]
  double elastic = 0;           ///< of all cells and anchors [J]

  /// Estimated relative error of the displacement: of each cell the larger of the two energies, over that of the
  /// displacement.  Under given forces the displacement in their direction is too small by the cells' fraction, if
  /// their energy of the error is right, and too large by the anchors'.
  double estimated_error() const;
  /// Those of the two energies that sum to more: to be made smaller first.
  const std::vector<double>& larger() const;
};

/// Zienkiewicz and Zhu's estimate (1987): the strain recovered at a node is the mean of the strains of its cells by
/// volume, and between nodes trilinear.
/// @param model of averaged springs, cut or full, of one size or several
/// @param displacement small, of the nodes, carried ones in their places [m], n x 3
/// @return one error per cell
/// @throws std::invalid_argument if the model has no averaged springs.
CellEnergies cell_energies(const MassSpringModel& model, const NodalVectors& displacement);

/// What a lattice of a body says of itself.
struct LatticeEstimate {
  double error = 0;    ///< CellEnergies::estimated_error
  double elastic = 0;  ///< energy under the loads [J]
};

/// How many times as large as estimated the error is, at least 1: if the estimates are all wrong by one factor kappa,
/// the energies are E (1 - kappa error) or, where supports are moved, E (1 + kappa error); of the straight line that is
/// nearest to them.  Creases that a lattice does not resolve are in its energy, not in its estimate.
/// @param lattices of the same body and loads, the finest last
/// @return nothing unless an estimate is more than 1.1 times the last, nor where the line ends beyond zero
std::optional<double> falls_short(const std::vector<LatticeEstimate>& lattices);

/// xx yy zz xy yz xz [Pa], one row per node.
using NodalStresses = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// Stress at the nodes by patch recovery (Zienkiewicz and Zhu 1992): Hooke's law of the strain that is linear in the
/// cells around a node, by least squares of their mean strains in the middle of what they hold, each by its volume;
/// where these do not span the space, as on surfaces, with the cells around those.  The mean over a node's cells leaves
/// alternating pressures out.  Where materials meet, in the cells of each alone.
/// @param model of averaged springs
/// @param displacement small, of the nodes [m], n x 3
/// @return a row per node of apart() (meshes/voxels/cells_apart.h); 0 at nodes without a cell
/// @throws std::invalid_argument if the model has no averaged springs.
NodalStresses recovered_stress(const MassSpringModel& model, const NodalVectors& displacement);

/// Halves the cells of a body whose errors are the largest and make up three tenths of the error; cells may be halved
/// four times.
/// @param cut the body in cells of the grid
/// @param errors one per cell
/// @param grid gets smaller cells
/// @return false if no cell was halved
bool halve_worst_cells(const CutBody& cut, const std::vector<double>& errors, VoxelGrid& grid);

}  // namespace springproof
