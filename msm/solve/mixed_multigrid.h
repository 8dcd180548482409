// Multigrid for the mixed displacement-pressure form of HybMSS: the cost does not grow as nu -> 1/2.
#pragma once

#include "msm/solve/krylov.h"
#include "msm/solve/multigrid.h"

namespace springproof {

/// The saddle-point system  [K_s B^T; B -V/kappa] (u, p) = (f, g)  of springs K_s (everything but the volume term) and
/// one pressure per cell, p = kappa/V B u; kappa > 0.  The V-cycle smooths with inexact Braess-Sarazin sweeps.
class MixedMultigrid {
 public:
  /// @throws std::invalid_argument unless cell.kappa > 0.
  MixedMultigrid(std::vector<LatticeLevel> levels, const CellStiffness& cell, int sweeps = 2, int inner_steps = 6);

  /// Vectors hold 3 displacements per node, then one pressure per cell (scaled to equal units).
  Eigen::Index unknowns() const { return 3 * levels_[0].nodes + static_cast<Eigen::Index>(levels_[0].cells.size()); }
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;  ///< y = A x on the free unknowns
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

  /// K_s u + B^T p, fixed unknowns included [N]: minus the internal force.
  Eigen::VectorXd force(const Eigen::VectorXd& u, const Eigen::VectorXd& p) const;
  /// B u: first-order volume change of each cell, in the same scaling as g.
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u) const;

 private:
  struct Level {
    BlockMatrix springs;
    CellVector gradient;                 ///< row of B of a full cell
    Eigen::VectorXd fill;
    Eigen::VectorXd compliance;          ///< V / kappa per cell
    Eigen::VectorXd inverse_diagonal;    ///< of omega diag(K_s), 0 on fixed unknowns
    Eigen::VectorXd inverse_schur_diagonal;
    double schur_bound = 1;              ///< largest eigenvalue of diag(S)^-1 S
  };
  struct Pair {
    Eigen::VectorXd u, p;
  };

  void divergence(std::size_t level, const Eigen::VectorXd& u, Eigen::VectorXd& p) const;       ///< p = B u
  void add_gradient(std::size_t level, const Eigen::VectorXd& p, Eigen::VectorXd& u) const;     ///< u += B^T p
  void schur(std::size_t level, const Eigen::VectorXd& q, Eigen::VectorXd& y) const;            ///< y = S q
  void solve_schur(std::size_t level, const Eigen::VectorXd& b, Eigen::VectorXd& q) const;
  void residual(std::size_t level, const Pair& b, const Pair& x, Pair& r) const;
  void sweep(std::size_t level, const Pair& b, bool from_zero, Pair& x) const;
  void cycle(std::size_t level, const Pair& b, Pair& x) const;

  std::vector<LatticeLevel> levels_;
  std::vector<Level> data_;
  DirectSolver coarsest_;
  int sweeps_, inner_steps_;
};

}  // namespace springproof
