// Which tetrahedron holds a point.
#pragma once

#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// Locates many points in tetrahedra by lists of those that reach into each box of a lattice.
class TetrahedronLocator {
 public:
  /// `corners`: rest positions [m].
  /// @throws std::invalid_argument if there are no tetrahedra.
  TetrahedronLocator(const NodalVectors& corners, const std::vector<Tetrahedron>& cells);

  struct Place {
    std::size_t cell;
    Eigen::Vector4d weights;  ///< barycentric coordinates; they sum to 1
    double outside;           ///< distance from the cell [m]; 0: inside
  };

  /// The cell that holds the point, or the nearest; of several the first.
  Place operator()(const Vec3& point) const;

 private:
  struct Cell {
    std::array<Vec3, 4> corners;
    Eigen::Matrix3d to_weights;  ///< of corners 1 2 3, from X - corner 0
  };
  std::array<int, 3> box_of(const Vec3& point) const;
  Place place_in(std::size_t cell, const Vec3& point) const;

  std::vector<Cell> cells_;
  Vec3 low_;
  double edge_;
  std::array<int, 3> count_;
  std::vector<std::size_t> start_;  ///< of each box in list_
  std::vector<int> list_;
};

}  // namespace springproof
