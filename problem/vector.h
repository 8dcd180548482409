// Array types shared by all modules.
#pragma once

#include <Eigen/Core>
#include <array>

namespace springproof {

/// A point, displacement or force in space.
using Vec3 = Eigen::Vector3d;

/// One row per node: positions [m], displacements [m] or forces [N], shape n x 3, x y z contiguous.
using NodalVectors = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The same values as one vector of 3 n.
inline Eigen::Map<const Eigen::VectorXd> flat(const NodalVectors& v) { return {v.data(), v.size()}; }

/// Numbers of cells along x, y and z.
using Cells = std::array<int, 3>;

}  // namespace springproof
