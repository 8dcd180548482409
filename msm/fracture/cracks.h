// Cracks of a broken network seen from above: directions, area, fragments.
#pragma once

#include <array>
#include <vector>

#include "msm/topology/network.h"

namespace springproof {

inline constexpr int direction_bins = 18;  ///< of 10 degrees, from the x axis

/// Directions in which cracks run, seen along z, of the broken springs in the upper half of the network.  The direction
/// phi at a broken spring is the longer principal axis of the middles of all broken springs within two mean spring
/// lengths of its own, in the plane; its weight is ((l1 - l2)/(l1 + l2))^2 with the variances l1 >= l2 along and
/// across, so that crossings and clouds count little.  Directions of the springs themselves do not enter: in a lattice
/// they are those of the lattice, whatever the crack.
struct CrackDirections {
  int springs = 0;     ///< broken springs with at least three others around them
  double along_4 = 0;  ///< weighted mean of cos 4 phi: 1 along x or y, -1 along their diagonals, 0 no preference
  double along_8 = 0;  ///< of cos 8 phi: 1 along x, y or their diagonals, -1 half way between
  double order_4 = 0;  ///< modulus of the mean of exp(4 i phi): along any two axes at right angles
  double order_8 = 0;  ///< of exp(8 i phi): along those or their diagonals
  std::array<double, direction_bins> share{};  ///< of the weight, per bin of phi from 0 to 180 degrees
};

/// `broken`: per spring.
CrackDirections crack_directions(const Network& network, const std::vector<char>& broken);

/// Area of the cracks [m^2], 2 V n / sum L for n broken springs: a plane through an isotropic network of volume V cuts
/// sum L / (2 V) springs per area.  Of the 18 springs of a cubic lattice a plane (100) cuts 13 % fewer, (110) 1 %
/// fewer.
double crack_area(const Network& network, const std::vector<char>& broken);

/// Fragments of the top: parts of the layer within 0.75 (V/N)^(1/3) of the highest node, in a lattice the uppermost
/// nodes, of at least 1 % of its nodes.  Nodes joined by a spring, broken or not, are of one fragment if they have not
/// moved apart: |u_j - u_i + shrinkage_s (X_j - X_i)| <= opening L_s.  Springs that hang across an open crack do not
/// count as a connection.  u: displacement [m], 3 n; `shrinkage`: of each spring [1].
int fragments(const Network& network, const Eigen::VectorXd& u, const std::vector<double>& shrinkage, double opening);

}  // namespace springproof
