// Array types shared by all modules.
#pragma once

#include <Eigen/Core>
#include <array>

// Eigen's allocator depends on its alignment: a program and the libraries that it passes vectors to must agree.
#if EIGEN_DEFAULT_ALIGN_BYTES != 64 || EIGEN_MAX_STATIC_ALIGN_BYTES != 16
#error "compile with -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 (CMake: link springproof::msm)"
#endif

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
