// Correction for thin parts of a body: sheets and rods a few cells thick, which coarser lattices make too stiff in
// bending.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>

#include "msm/multigrid/lattice_operator.h"

namespace springproof {

/// A second coarse space for one level: the rigid motions of blocks of 2 to 4 points a side, where the body is less
/// than four cells thick and some way beyond.  Bulky bodies have none.
class ThinParts {
 public:
  /// Null: there are none.  `level` with its cell_index and point_index, `cell` in the level's axes.
  static std::unique_ptr<ThinParts> of(const LatticeLevel& level, const CellMatrix& cell);

  /// z += Z (Z^T K Z)^-1 Z^T (r - K z), nodal fields of the level.
  void correct(const float* r, float* z);

 private:
  struct Point {
    long place = 0;  ///< of its x component in a nodal field
    int block = 0;
    Eigen::Vector3f arm = Eigen::Vector3f::Zero();  ///< from the block's centre, LatticeLevel::arms
    bool free[3] = {true, true, true};
  };

  explicit ThinParts(long stride) : stride_(stride) {}
  std::vector<int> find_points(const LatticeLevel& level);
  void form_blocks(const LatticeLevel& level);
  void take_rows(const LatticeLevel& level, const std::vector<int>& number);
  void factor(const std::vector<int>& number, const CellMatrix& cell);

  long stride_ = 0;
  long blocks_ = 0;
  std::vector<Point> points_;
  std::unique_ptr<LatticeLevel> rows_;  ///< the level's cells at these points
  std::unique_ptr<LatticeOperator<float>> K_;
  Eigen::VectorXf residual_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace springproof
