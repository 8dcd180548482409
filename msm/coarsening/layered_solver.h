// Cholesky factors of the stiffness of a small lattice, layer by layer.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace springproof {

/// A symmetric positive definite matrix whose unknowns lie in layers, each coupled with itself and the next one.
class LayeredMatrix {
 public:
  /// Zero.
  /// @param unknowns of each layer
  explicit LayeredMatrix(const std::vector<int>& unknowns);

  /// Block of a layer; the lower triangle is read.
  auto of(std::size_t layer) { return columns_[layer].topRows(columns_[layer].cols()); }
  /// Rows of the layer after `layer`, columns of `layer`.
  auto below(std::size_t layer) { return columns_[layer].bottomRows(below_of(layer)); }

  /// Replaces the matrix by its factors.
  /// @return false if it is not positive definite
  bool factor();
  /// Solves with the factors.
  /// @param b right-hand sides as columns, the layers one after the other; replaced by the solutions
  void solve(Eigen::MatrixXd& b) const;

 private:
  Eigen::Index below_of(std::size_t layer) const { return columns_[layer].rows() - columns_[layer].cols(); }

  std::vector<Eigen::Index> begin_;
  std::vector<Eigen::MatrixXd> columns_;  ///< of each layer: its own rows, and those of the next one
};

}  // namespace springproof
