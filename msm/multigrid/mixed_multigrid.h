// Multigrid for the mixed displacement-pressure form of HybMSS: the cost does not grow as nu -> 1/2.
#pragma once

#include "msm/multigrid/multigrid.h"

namespace springproof {

/// kappa / G (3 at nu = 0.4, 8 at 0.45) above which pressures as unknowns are worth it.
inline constexpr double mixed_above_kappa = 4;

/// The saddle-point system  [K_s B^T; B -V/kappa] (u, p) = (f, g)  of springs K_s (everything but the volume term) and
/// one pressure per cell, p = kappa/V B u; kappa > 0.  The V-cycle smooths with inexact Braess-Sarazin sweeps, in
/// single precision.  Displacements are 3 per node of the network, pressures and g one per cell, all in units of the
/// cell's (shear modulus, edge) so that both equations have entries of order one.
class MixedMultigrid {
 public:
  /// A lattice that `may_float` needs no hold of its own.
  /// @throws std::invalid_argument unless cell.kappa > 0.
  MixedMultigrid(LatticeLevels levels, const CellStiffness& cell, bool may_float = false);

  /// (u, p) of the system, u = 0 on the fixed unknowns.
  KrylovResult solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance, int max_iterations,
                     Eigen::VectorXd& u, Eigen::VectorXd& p);

  /// (u, p) = M^-1 (f, g).
  void apply(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u, Eigen::VectorXd& p);

  /// K_s u + B^T p, fixed unknowns included: minus the internal force.
  Eigen::VectorXd force(const Eigen::VectorXd& u, const Eigen::VectorXd& p);
  /// B u: first-order volume change of each cell.
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u);

  struct Level {
    LatticeOperator<float> K;          ///< of the springs, and the gradient of volumes
    Eigen::VectorXf compliance;        ///< V / kappa per cell
    Eigen::VectorXf inverse_diagonal;  ///< of omega diag(K_s), 0 on fixed unknowns
    Eigen::VectorXf inverse_schur_diagonal;
    double schur_bound = 1;           ///< largest eigenvalue of diag(S)^-1 S
    Eigen::VectorXf f, g, u, p;       ///< right-hand side and solution of a cycle
    Eigen::VectorXf d, Bu, r, z, q;   ///< work of a sweep
    std::unique_ptr<ThinParts> thin;  ///< null: none
  };

  /// The finest level and the cycle on it, (u, p) of its (f, g): for cycles that go on above it.
  Level& finest() { return levels_[0]; }
  const LatticeLevel& finest_lattice() const { return lattice_.levels[0]; }
  void cycle() { cycle(0); }

 private:
  Level make_level(const LatticeLevel& lattice, const CellStiffness& cell) const;
  void bound_schur(Level& level) const;
  void schur_step(Level& level, const ChebyshevStep& step) const;  ///< r -= S z; z = a z + b D r; q += z
  void solve_schur(Level& level) const;
  void sweep(Level& level, bool from_zero) const;
  void residual(Level& level) const;  ///< d = f - K_s u - B^T p, zero on fixed; B u
  void correct_thin_parts(Level& level) const;
  void solve_coarsest(Level& level) const;
  void cycle(std::size_t l);
  void multiply_rows(const double* x, double* y);
  Eigen::Index pressures() const { return 3 * lattice_.levels[0].stride(); }  ///< where they begin in a vector of both
  Eigen::Index size() const { return pressures() + lattice_.levels[0].cells() + array_slack; }
  void cells_to_rows(const Eigen::VectorXd& cells, double* rows) const;
  Eigen::VectorXd cells_from_rows(const double* rows) const;

  LatticeLevels lattice_;
  int inner_steps_;  ///< of the pressures in a sweep
  std::vector<Level> levels_;
  LatticeOperator<double> K_;
  Eigen::VectorXd compliance_;
  DirectSolver coarsest_;
};

}  // namespace springproof
