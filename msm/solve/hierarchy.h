// Coarser and coarser lattices over the cells of a network, and how displacements pass between them.
#pragma once

#include <array>
#include <vector>

#include "msm/network.h"

namespace springproof {

/// One level: cells of edge 2^level times the finest, only where the body is.
struct LatticeLevel {
  int nodes = 0;
  std::vector<Hexahedron> cells;
  std::vector<double> fill;        ///< fraction of each cell that lies in the body, 0 < fill <= 1
  std::vector<char> fixed;         ///< per unknown 3 * node + axis
  double edge_ratio = 1;           ///< cell edge / finest cell edge

  // Passage to the next finer level; empty on the finest.
  std::vector<int> parent;         ///< for each finer cell, the cell that holds it
  std::vector<int> weight_begin;   ///< for each finer node, where its row starts; then the end
  std::vector<int> weight_node;
  std::vector<double> weight;      ///< trilinear

  /// u_fine = P u (fixed unknowns of either level left out).
  void prolongate(const Eigen::VectorXd& u, const std::vector<char>& fine_fixed, Eigen::VectorXd& u_fine) const;
  /// r = P^T r_fine.
  void restrict_to(const Eigen::VectorXd& r_fine, const std::vector<char>& fine_fixed, Eigen::VectorXd& r) const;
};

/// The levels of a lattice network, finest first, down to about `coarsest_unknowns` or a single cell per side.
/// A coarse cell is there if any of its eight children is, with the mean of their fills; a coarse node is fixed where
/// the node it coincides with is, or, outside the body, where a neighbouring fixed node is.
/// `fill` is that of the network's cells, empty: 1.
/// @throws std::invalid_argument if the network remembers no grid.
std::vector<LatticeLevel> lattice_levels(const Network& network, const std::vector<char>& fixed,
                                         int coarsest_unknowns = 900, const std::vector<double>& fill = {});

}  // namespace springproof
