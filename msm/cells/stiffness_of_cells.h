// The stiffness of cells at rest, whatever their law.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace springproof {

/// Stiffness at rest of the cells of a lattice.
struct StiffnessOfCells {
  std::function<Eigen::Matrix<double, 24, 24>(std::size_t)> of;  ///< a cell by its number [N/m]; 3 * corner + axis
  bool full_alike = false;  ///< whether full cells have the same, in proportion to their edge
};

}  // namespace springproof
