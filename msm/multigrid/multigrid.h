// Geometric multigrid on lattices: the displacement form, for Poisson's ratios away from 1/2.
#pragma once

#include <memory>
#include <vector>

#include "msm/algebra/direct_solver.h"
#include "msm/algebra/krylov.h"
#include "msm/multigrid/lattice_operator.h"
#include "msm/multigrid/thin_parts.h"
#include "msm/multigrid/v_cycle.h"

namespace springproof {

/// Factors the matrix of the coarsest level.  If it is singular because this level has lost the supports of the body (a
/// patch smaller than its cells), or because the lattice `may_float`, a small multiple of the identity is added.
/// @throws std::runtime_error if the body is not supported, or the model has zero-energy modes.
void factor_coarsest(BlockMatrix K, const LatticeLevels& lattice, bool may_float, DirectSolver& coarsest);

/// Adds the restriction of a finer field to a coarse one, component by component.
void restrict_field(const LatticeLevel& coarse, const CellKernels<float>& kernels, long fine_stride, const float* fine,
                    float* field);
/// Interpolates a coarse field to the finer level.
void prolongate_field(const LatticeLevel& coarse, const CellKernels<float>& kernels, const float* field,
                      long fine_stride, float* fine);

/// One level of the cycle for the displacement form: Chebyshev over Jacobi in single precision.
struct SmoothingLevel {
  /// `cell` in the level's axes and a unit in which its entries are of order one.
  SmoothingLevel(const LatticeLevel& level, const CellMatrix& cell);

  void smooth(Smoothing when);  ///< x from r; then x and r after adding z, the coarse correction
  void residual();              ///< r becomes the residual, zero on fixed unknowns
  void restrict_to(SmoothingLevel& below);
  void prolongate(const SmoothingLevel& below);

  /// Estimates largest_eigenvalue by Lanczos steps, at most `at_most`.
  void bound_eigenvalues(double at_most);

  LatticeOperator<float> K;
  Eigen::VectorXf inverse_diagonal;  ///< 0 on fixed unknowns
  Eigen::VectorXf r, z, x;           ///< nodal fields
  double largest_eigenvalue = 0;     ///< of diag(K)^-1 K, or a bound
  std::unique_ptr<ThinParts> thin;   ///< null: none

 private:
  void chebyshev(int first, int last);
};

/// Symmetric V-cycle: Chebyshev over Jacobi, trilinear transfer, lattices of doubled edge below; matrix-free above the
/// coarsest level.  The cycle works in single precision, the Krylov method that it preconditions in double.
/// With `may_float` the lattice needs no supports.  `mass` [N/m] is added to the diagonal of every cell and grows with
/// its volume on the coarser levels, as the masses of a time step do.
/// Its smoother's eigenvalue bound comes from a few Lanczos steps on each level; it is at most the largest eigenvalue
/// of diag(K_cell)^-1 K_cell, which bounds every lattice of such cells.  Thin parts of the body
/// (msm/multigrid/thin_parts.h) are corrected on every level in addition to the next coarser lattice.  Vectors hold 3
/// values per node of the network.
class Multigrid {
 public:
  Multigrid(LatticeLevels levels, const CellMatrix& cell, bool may_float = false, double mass = 0);

  /// u = K^-1 b on the free unknowns, 0 on the fixed.
  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u);
  /// y = K x, all unknowns.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y);
  /// z = M^-1 r, symmetric positive definite.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z);
  Eigen::VectorXd diagonal() const;  ///< of K

 private:
  SmoothingLevel& finest() { return *levels_[0]; }
  void cycle();  ///< x of the finest level from its r
  void multiply_rows(const Eigen::VectorXd& x, Eigen::VectorXd& y);
  void apply_rows(const Eigen::VectorXd& r, Eigen::VectorXd& z);

  LatticeLevels lattice_;
  CellMatrix cell_;  ///< of the finest level, in the network's displacements
  double unit_ = 1;  ///< 1 / unit of stiffness: the cycle works with entries of order one
  std::vector<std::unique_ptr<SmoothingLevel>> levels_;
  LatticeOperator<double> K_;
  DirectSolver coarsest_;
};

}  // namespace springproof
