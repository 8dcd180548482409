// Matrices of lattices of cut cells, in which rows with equal blocks, those inside of the body, are stored once.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "msm/cells/stiffness_of_cells.h"
#include "msm/kernels/kernels.h"
#include "msm/laws/averaged_springs.h"

namespace springproof {

struct CutLevel;

/// A sparse matrix of 3x3 blocks with symmetric pattern, its rows from bottom to top of the lattice, x fastest. Vectors
/// hold three values per point.
template <class Real>
class CutMatrix {
 public:
  CutMatrix() = default;
  /// Of the cells and the bonds between them, in units of `unit` [N/m].  Rows at anchors, and those that are coupled
  /// with `fixed` unknowns (empty: none), are not shared, so that they can be changed.
  CutMatrix(const StiffnessOfCells& cells, double unit, const CutLevel& level, const std::vector<char>& fixed);
  /// Rounded.
  template <class Other>
  explicit CutMatrix(const CutMatrix<Other>& other);

  void add_anchors(const CutLevel& level, double unit);
  void clear_fixed(const std::vector<char>& fixed);  ///< rows and columns, of the unknowns in the constructor

  int rows() const { return static_cast<int>(point_.size()); }
  long stored_blocks() const { return static_cast<long>(block_.size() / 9); }
  void multiply(const Real* x, Real* y) const;                        ///< y = A x
  void residual(const Real* b, const Real* x, Real* r) const;         ///< r = b - A x
  void residual(const Real* b, const Real* x, int i, Real* r) const;  ///< of point i, three values
  /// Block of two points, nine values row by row; null: zero.
  const Real* block(int i, int j) const;
  Eigen::SparseMatrix<double> sparse() const;

  /// Inverse diagonal blocks, nine values per point; zero on fixed unknowns.
  std::vector<Real> inverse_diagonal(const std::vector<char>& fixed) const;
  /// Gauss-Seidel over all rows with these, in ascending or descending order.
  void relax(const std::vector<Real>& D, bool ascending, const Real* b, Real* x) const;
  /// The same, ascending, from x = 0: half of the work.
  void relax_from_zero(const std::vector<Real>& D, const Real* b, Real* x) const;

 private:
  template <class Other>
  friend class CutMatrix;
  BlockRows<Real> view() const;
  void add_bonds(const CutLevel& level, double unit, const Carriers& carriers);
  Real* own_block(int i, int j) { return const_cast<Real*>(block(i, j)); }

  std::vector<int> point_, row_;  ///< of a row, of a point
  std::vector<int> begin_, column_, first_, diagonal_;
  std::vector<Real> block_;
  mutable std::vector<Real> work_;
};

}  // namespace springproof
