// Multigrid for lattices of cut cells: the displacement form, for Poisson's ratios away from 1/2.
#pragma once

#include <memory>

#include "msm/multigrid/cut/cut_levels.h"
#include "msm/multigrid/v_cycle.h"

namespace springproof {

/// Symmetric V-cycle for the stiffness at rest of averaged springs, or measured cells, and anchors: symmetric
/// Gauss-Seidel over the points of each level, in single precision.  Anchored nodes are eliminated exactly.  Levels
/// above measured cells have averaged springs of their mean moduli.
class CutMultigrid {
 public:
  /// Of a model that has Capability::cut_multigrid.
  CutMultigrid(const MassSpringModel& model, const std::vector<char>& fixed);

  /// y = K x, all unknowns; x zero in carried ones.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { nodes_.multiply(K_, unit_, x, y); }
  Eigen::VectorXd diagonal() const;  ///< of K
  /// z = M^-1 r, symmetric positive definite; zero on the fixed unknowns.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

 private:
  struct Level {
    CutLevel lattice;
    std::vector<char> fixed;  ///< unknowns, of the finest level
    Eigen::VectorXf b, x, r;

    void smooth(Smoothing when);
    void residual() { lattice.A.residual(b.data(), x.data(), r.data()); }
    void restrict_to(Level& below) const;
    void prolongate(Level& below);
  };

  AnchoredNodes nodes_;
  double unit_ = 0;      ///< of stiffness [N/m]
  CutMatrix<double> K_;  ///< of the cells, in units
  std::vector<std::unique_ptr<Level>> levels_;
  CoarsestFactors coarsest_;
};

}  // namespace springproof
