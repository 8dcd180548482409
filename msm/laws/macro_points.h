// The points of a macro-cell at which its springs see the strain, and the modes of its volume.
#pragma once

#include <span>
#include <vector>

#include "msm/topology/network.h"

namespace springproof {

/// Middle of one of the eight cubes of the macro-cell [-1, 1]^3, x fastest.
inline Vec3 middle_of_cube(int cube) { return Vec3(cube % 2, cube / 2 % 2, cube / 4) - Vec3::Constant(0.5); }

/// A point of the macro-cell [-1, 1]^3.
struct MacroPoint {
  Vec3 at;
  double share;                           ///< of the cell's volume, > 0; they sum to 1
  Eigen::Matrix<double, 3, 27> gradient;  ///< of the nodes' triquadratic functions, over a cube's edge
  Eigen::Vector4d modes;                  ///< 1 and three linear functions, orthonormal in the mean over the points
};

/// Of a full cell its 27 Gauss points; of a cell that the body fills in part eight in each of its cubes, of equal
/// weight, which have all moments of the filled part up to the second order.
struct MacroPoints {
  double volume = 0;            ///< of the body in the cell [m^3]
  std::vector<MacroPoint> own;  ///< empty for full cells, which share theirs
  std::span<const MacroPoint> points;

  MacroPoints() = default;
  MacroPoints(MacroPoints&&) = default;  // a copy's points would be those of the original
};

/// @param network with macro-cells
/// @param cell number of one
MacroPoints macro_points(const Network& network, std::size_t cell);

/// Values of its 27 nodes, a column each.
/// @param values per node of the network, n x 3
Eigen::Matrix<double, 3, 27> at_nodes(const MacroCell& cell, const NodalVectors& values);

/// Whether the body fills a macro-cell.
bool is_full(const Network& network, std::size_t cell);

}  // namespace springproof
