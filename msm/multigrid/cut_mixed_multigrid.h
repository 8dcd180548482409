// Multigrid for lattices of cut cells in mixed form: the cost does not grow as nu -> 1/2.
#pragma once

#include "msm/algebra/krylov.h"
#include "msm/multigrid/cut_levels.h"

namespace springproof {

/// kappa / G (8 at nu = 0.45) above which the pressures as unknowns are worth it.
inline constexpr double cut_cells_mixed_above_kappa = 6;

/// The saddle-point system  [K_s B^T; B -C] (u, p) = (f, g)  of averaged springs and anchors K_s (nu = 1/4 but for the
/// hourglass stiffness) and one pressure per cell, p = kappa / (alpha V) B u; kappa > 0.  Inexact Braess-Sarazin
/// smoothing: Gauss-Seidel over the nodes, then pressures that restore the volumes; GMRES over the cycle.
/// Units: shear modulus and edge of the finest cells.
class CutMixedMultigrid {
 public:
  CutMixedMultigrid(const MassSpringModel& model, const std::vector<char>& fixed);

  /// (u, p) of the system, u = 0 on the fixed unknowns; u of all nodes of the network.
  KrylovResult solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance, int max_iterations,
                     Eigen::VectorXd& u, Eigen::VectorXd& p);
  /// (u, p) = M^-1 (f, g), one cycle.
  void apply(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u, Eigen::VectorXd& p);

  /// K_s u + B^T p, fixed unknowns included: minus the internal force.
  Eigen::VectorXd force(const Eigen::VectorXd& u, const Eigen::VectorXd& p) const;
  /// B u: first-order change of the volumes.
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u) const;

 private:
  /// One level of the cycle, in single precision.
  struct Level {
    std::vector<float> gradient;     ///< 24 per cell: row of B
    Eigen::VectorXf compliance;      ///< diagonal of C
    std::vector<int> begin, column;  ///< of the rows of S = C + B D B^T, a cell each
    std::vector<float> schur;        ///< its entries
    Eigen::VectorXf inverse_schur;   ///< of its diagonal
    Eigen::VectorXf f, g, u, p, d, Bu, r, q;
  };

  void set_up(std::size_t l, double kappa);
  void set_up_schur(std::size_t l);
  static void relax_schur(bool ascending, Level& level);  ///< Gauss-Seidel for S q = r
  void cycle(std::size_t l);
  void sweep(std::size_t l, bool ascending);
  void residual(std::size_t l);
  Eigen::VectorXf load(std::size_t l) const;  ///< f - B^T p
  void solve_coarsest();
  void divergence(std::size_t l, const Eigen::VectorXf& u, Eigen::VectorXf& out) const;
  void add_gradient(std::size_t l, const Eigen::VectorXf& p, Eigen::VectorXf& out) const;
  void scale_by_diagonal(std::size_t l, Eigen::VectorXf& v) const;

  AnchoredNodes nodes_, scaled_nodes_;  ///< anchors in N/m, and in units
  double unit_;                         ///< of stiffness [N/m]
  const Network& network_;
  CutMatrix<double> K_;       ///< of the cells, in units
  Eigen::MatrixXd gradient_;  ///< 24 x cells
  Eigen::VectorXd compliance_;
  std::vector<CutLevel> lattice_;
  std::vector<Level> levels_;
  int schur_sweeps_;
  CoarsestFactors coarsest_;
};

}  // namespace springproof
