// Matrix-free operators of a lattice level, applied plane by plane.
#pragma once

#include <Eigen/Core>
#include <cstring>

#include "msm/algebra/block_matrix.h"
#include "msm/multigrid/cell_stiffness.h"
#include "msm/multigrid/hierarchy.h"

namespace springproof {

/// A cell's stiffness, permuted from the network's axes to the level's.
CellMatrix reorder(const CellMatrix& cell, const std::array<int, 3>& axes);

/// The same between displacements of the levels (Nodal), which are others than the network's where cells are boxes.
CellMatrix cell_of_levels(const CellMatrix& cell, const LatticeLevels& lattice);

/// @throws std::invalid_argument if the cell lacks the mirror planes.
template <class Real>
CellBlocks<Real> cell_blocks(const CellMatrix& cell, double gradient);

/// Assembles a level's matrix, unknown 3 * point + axis, from one cell's stiffness: K(edge) is proportional to the
/// edge; a partly filled cell is scaled by its fill.
BlockMatrix assemble(const LatticeLevel& level, const CellMatrix& cell);

/// Diagonal of that matrix, as a nodal field of the level.
Eigen::VectorXd diagonal(const LatticeLevel& level, const CellMatrix& cell);

/// Operator K (and the gradient of cell volumes) of a level.  Fields hold three arrays of level.stride() values, or one
/// value per cell; values beyond the points and cells are zero.
template <class Real>
class LatticeOperator {
 public:
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  /// `cell` in the level's axes, at edge 1; `gradient` = |dV/du| of a corner at edge 1, 0 if not needed.
  LatticeOperator(const LatticeLevel& level, const CellMatrix& cell, double gradient = 0,
                  InstructionSet set = instruction_set());

  long stride() const { return stride_; }
  const Vector& fill() const { return fill_; }  ///< empty: 1

  /// One pass: calls finish(axis, begin, n, y) when y = (K u + gradient^T p) of points begin ... begin + n is complete.
  /// finish may change u at these points: no later cell reads them.  `p` and `divergence` (of u) may be null.
  template <class Finish>
  void pass(const Real* u, const Real* p, Real* divergence, Finish finish);

  /// The same of y = gradient^T p alone: finish(k, begin, n) is called when plane k of points is complete in plane(k,
  /// axis); plane k - 1 is still stored then.
  template <class Finish>
  void gradient_pass(const Real* p, Finish finish);

  /// divergence = gradient u of the cells of plane k, with u of their points in plane(k, axis) and plane(k + 1, axis).
  void divergence_of_planes(int k, Real* divergence);
  /// The same for a whole field.
  void divergence(const Real* u, Real* divergence);

  Real* plane(int k, int axis) { return planes_.data() + (k % 3 * 3 + axis) * plane_size_; }

  const CellKernels<Real>& kernels() const { return *kernels_; }
  const LatticeLevel& level() const { return *level_; }

 private:
  void clear(int k) { std::memset(plane(k, 0), 0, 3 * plane_size_ * sizeof(Real)); }
  PlanePair<Real> pair(int k);

  const LatticeLevel* level_;
  const CellKernels<Real>* kernels_;
  CellBlocks<Real> blocks_;
  Vector fill_;
  long stride_ = 0, plane_size_ = 0;
  Vector planes_;  ///< accumulated values of three planes of points, three components each
};

template <class Real>
template <class Finish>
void LatticeOperator<Real>::pass(const Real* u, const Real* p, Real* divergence, Finish finish) {
  const Real* const components[3] = {u, u + stride_, u + 2 * stride_};
  const Real* fill = fill_.size() ? fill_.data() : nullptr;
  clear(0);
  for (int k = 0; k <= level_->planes(); ++k) {
    if (k < level_->planes()) {
      clear(k + 1);
      kernels_->cells(blocks_, level_->rows.data() + level_->row_begin[k],
                      level_->row_begin[k + 1] - level_->row_begin[k], components, fill, p, divergence, pair(k));
    }
    const long begin = level_->point_begin[k], n = level_->point_begin[k + 1] - begin;
    for (int a = 0; a < 3; ++a) finish(a, begin, n, plane(k, a));
  }
}

template <class Real>
template <class Finish>
void LatticeOperator<Real>::gradient_pass(const Real* p, Finish finish) {
  const Real* fill = fill_.size() ? fill_.data() : nullptr;
  clear(0);
  for (int k = 0; k <= level_->planes(); ++k) {
    if (k < level_->planes()) {
      clear(k + 1);
      kernels_->gradient(blocks_.gradient, level_->rows.data() + level_->row_begin[k],
                         level_->row_begin[k + 1] - level_->row_begin[k], p, fill, pair(k));
    }
    const long begin = level_->point_begin[k], n = level_->point_begin[k + 1] - begin;
    finish(k, begin, n);
  }
}

}  // namespace springproof
