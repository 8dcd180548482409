// The network: point masses connected by springs, and the cells that the springs came from.
#pragma once

#include <array>
#include <vector>

#include "msm/topology/cells.h"

namespace springproof {

/// Spring of rest length zero between a weighted mean of the corners of a cell and a node, by which a support holds the
/// part of a patch in that cell: energy d.K d/2, d = sum_a w_a x_a - x_node.
struct Anchor {
  Hexahedron corners;             ///< nodes of the cell
  std::array<double, 8> weights;  ///< they sum to 1
  int node;                       ///< held by the support
  Eigen::Matrix3d stiffness;      ///< K [N/m], symmetric
  int axes = 7;                   ///< bits of the axes along which it acts; along others its node is fixed at rest

  bool acts(int axis) const { return axes >> axis & 1; }
  void release(int axis) {
    axes &= ~(1 << axis);
    stiffness.row(axis).setZero();
    stiffness.col(axis).setZero();
  }
};

/// The point that an anchor is held in at rest [m]: the mean of its corners by its weights.
/// @param anchor an anchor
/// @param X rest positions of the nodes [m], n x 3
Vec3 anchored_point(const Anchor& anchor, const NodalVectors& X);

/// Spring of rest length zero between weighted means of the corners of two cells, by which the interface of two
/// materials ties them: energy g.K g/2, g = sum_a w_0a x_0a - sum_a w_1a x_1a.
struct InterfaceBond {
  std::array<Hexahedron, 2> corners;             ///< nodes of the cells; they may have some in common
  std::array<std::array<double, 8>, 2> weights;  ///< of each cell; they sum to 1
  Eigen::Matrix3d stiffness;                     ///< K [N/m], symmetric
};

/// The gap of a bond at positions x [m].
/// @param bond a bond
/// @param x positions of the nodes [m], n x 3
/// @return g [m]
Vec3 gap(const InterfaceBond& bond, const NodalVectors& x);

/// Calls act(node, weight) for the corners of both cells of a bond, those of the second with -w.
template <class Act>
void for_each_corner(const InterfaceBond& bond, const Act& act) {
  for (int side = 0; side < 2; ++side)
    for (int n = 0; n < 8; ++n) act(bond.corners[side][n], side == 0 ? bond.weights[0][n] : -bond.weights[1][n]);
}

/// Nodes, springs and cells of a body; laws (msm/laws/laws.h) say what forces they have.
struct Network {
  NodalVectors X;                    ///< rest positions [m], n x 3
  std::vector<Spring> springs;       ///< each pair once, sorted by (i, j)
  CellSet cells;                     ///< cubes or boxes that fill the body; none in networks without
  std::vector<Anchor> anchors;       ///< of the supports of cut cells
  std::vector<InterfaceBond> bonds;  ///< of interfaces between cut cells
  Eigen::VectorXd volume;            ///< volume share of each node in the body [m^3]; of carried ones 0
  Eigen::VectorXd attached;          ///< mass of each node beside the body's own [kg]; empty: none
  std::vector<int> image_of;         ///< per node the node it is a periodic image of (itself if none); empty: no images
  std::vector<std::array<int, 3>> triangles;  ///< of planar networks, anticlockwise

  /// @return number of nodes, periodic images included
  int nodes() const { return static_cast<int>(X.rows()); }
  /// @param node a node
  /// @return the node that it is an image of; itself if it is none
  int master(int node) const { return image_of.empty() ? node : image_of[node]; }
};

/// Merges springs of the same pair by adding their stiffness (Kirchhoff's law, Golec et al. 2019, sec. 5.4) and
/// sorts by (i, j).
/// @param springs in any order, i < j
/// @return each pair once
/// @throws std::invalid_argument if merged springs differ in rest length.
std::vector<Spring> merge_springs(std::vector<Spring> springs);

/// Per unknown whether it is prescribed, that of a carried node, or that of an anchored node along an axis on which the
/// anchor does not act: solvers have no equation for these.
/// @param network with carried nodes or without
/// @param fixed prescribed unknowns, 3 * node + axis
/// @return the same, with the others
std::vector<char> fixed_or_carried(const Network& network, std::vector<char> fixed);

/// Displacement of the corners of a cell.
/// @param cell its corners
/// @param network that it is in
/// @param x positions [m], n x 3
/// @return [m]; 3 * corner + axis
Eigen::Matrix<double, 24, 1> displacement_of(const Hexahedron& cell, const Network& network, const NodalVectors& x);

/// Mass of each node over the density of the body's own material, without what is attached to it.
/// @param network with Network::volume
/// @return [m^3], one per node
Eigen::VectorXd volumes_by_mass(const Network& network);

/// Mass of each node: rho times its volume share (rho V/8 per cell corner, Golec et al. 2019, sec. 5.4), and what is
/// attached to it.
/// @param network with Network::volume
/// @param density rho of the body [kg/m^3]
/// @return [kg], one per node
Eigen::VectorXd masses(const Network& network, double density);

/// Their inverses: infinite without mass, but 0 for carried nodes, which no force moves.
/// @param network with Network::volume
/// @param density rho [kg/m^3]
/// @return [1/kg], one per node
Eigen::VectorXd inverse_masses(const Network& network, double density);

}  // namespace springproof
