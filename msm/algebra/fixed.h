// Vectors over all unknowns, three per point, of which some are fixed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace springproof {

/// Sets the entries of `v` that are `fixed` to zero.
template <class Vector>
void clear_fixed(const std::vector<char>& fixed, Vector& v) {
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) v.data()[i] = 0;
}

/// The same vector as a matrix with a row for each point.
template <class Vector>
auto by_point(Vector& v) {
  using Rows = Eigen::Matrix<typename Vector::Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;
  return Eigen::Map<std::conditional_t<std::is_const_v<Vector>, const Rows, Rows>>(v.data(), v.size() / 3, 3);
}

}  // namespace springproof
