// Multigrid hierarchy of lattices over the cells of a network, each in compact arrays of points and cells, row by row.
#pragma once

#include <array>
#include <vector>

#include "msm/kernels/kernels.h"
#include "msm/topology/network.h"

namespace springproof {

/// Interpolation of one row of finer points from `count` rows of coarse points, one, two or four.
struct TransferRow {
  long fine = 0;     ///< first finer point
  int length = 0;    ///< finer points
  bool odd = false;  ///< the first lies between two coarse points
  int count = 1;
  long coarse[4] = {};
};

/// One level: cells of edge 2^level times the finest, only where the body is.  Points and cells are numbered along x,
/// then y, then z of the level's own axes; a nodal field is three arrays of `stride` values, one after the other.
struct LatticeLevel {
  std::array<int, 3> cells_per_side{};  ///< of the level's box of cells
  std::vector<CellRow> rows;
  std::vector<long> row_begin, cell_begin, point_begin;  ///< per plane z, then the end; planes of points: one more
  std::vector<double> fill;  ///< fraction of each cell that lies in the body, 0 < fill <= 1; empty: 1
  std::vector<int> fixed;    ///< indices of fixed unknowns in a nodal field, ascending
  double edge_ratio = 1;     ///< cell edge / finest cell edge
  Vec3 arms = Vec3::Ones();  ///< p_i^2 along the level's axes: at x rotations displace by arms x, crossed
  std::vector<std::array<int, 3>> cell_index, point_index;  ///< (i,j,k) of each

  // Transfer to the next finer level; empty on the finest.
  std::vector<TransferRow> transfer;
  std::vector<int> parent;  ///< for each finer cell, the cell that contains it

  int planes() const { return static_cast<int>(row_begin.size()) - 1; }  ///< of cells
  long cells() const { return cell_begin.back(); }
  long points() const { return point_begin.back(); }
  long stride() const { return points() + array_slack; }
  template <class Field>
  void clear_fixed(Field& field) const {
    for (int place : fixed) field[place] = 0;
  }
  /// Point of corner `c` (hexahedron_corners) of cell `i` of a row.
  static long corner(const CellRow& row, int i, int c);
};

/// What a nodal field holds.  Displacements of the levels of a lattice of boxes are u_i / p_i, p its proportions, so
/// that they change the volume of a cell by the same along each axis; forces are f_i p_i.
enum class Nodal { displacements, forces };

/// The levels of a lattice network, finest first, and the numbers of its nodes and cells on the finest.
struct LatticeLevels {
  std::vector<LatticeLevel> levels;
  std::array<int, 3> axes{0, 1, 2};  ///< network axis of each of the levels' axes
  Vec3 proportions = Vec3::Ones();   ///< those of the network
  std::vector<int> point_of_node, cell_of_cell;

  /// Converts the network's nodal field (3 values per node) to one of the finest level, and back.
  void to_rows(Nodal kind, const Eigen::VectorXd& nodal, Eigen::VectorXd& rows) const;
  void from_rows(Nodal kind, const Eigen::VectorXd& rows, Eigen::VectorXd& nodal) const;
};

/// Levels down to about `coarsest_unknowns` or a single cell per side.
/// A coarse cell exists if any of its eight children does, with the mean of their fills; a coarse point is fixed where
/// the point it coincides with is, or, outside the body, where a neighbouring fixed point is.
/// `fixed`: per unknown 3 * node + axis.  `fill` is that of the network's cells, empty: 1.
/// @throws std::invalid_argument if the network has no grid.
LatticeLevels lattice_levels(const Network& network, const std::vector<char>& fixed, int coarsest_unknowns = 900,
                             const std::vector<double>& fill = {});

}  // namespace springproof
