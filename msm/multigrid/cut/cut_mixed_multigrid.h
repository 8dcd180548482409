// Multigrid for lattices of cut cells in mixed form: the cost does not grow as nu -> 1/2.
#pragma once

#include <memory>

#include "msm/algebra/saddle_point.h"
#include "msm/multigrid/cut/cut_levels.h"

namespace springproof {

/// The saddle-point system  [K_s B^T; B -C] (u, p) = (f, g)  of averaged springs, anchors and bonds K_s (nu = 1/4 but
/// for the hourglass stiffness) and one pressure per cell, p = kappa / (alpha V) B u, of materials with kappa > 0
/// (mixed_parts); in cells of others p = 0.  Inexact Braess-Sarazin
/// smoothing: Gauss-Seidel over the nodes, then pressures that restore the volumes.  u and f are of all nodes of the
/// network.  Units: shear modulus and edge of the finest cells.
class CutMixedMultigrid : public SaddlePoint {
 public:
  CutMixedMultigrid(const MassSpringModel& model, const std::vector<char>& fixed);
  ~CutMixedMultigrid() override;

  Eigen::VectorXd force(const MixedVector& x) override;
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u) override;
  const Eigen::VectorXd& compliance() const override { return compliance_; }
  MixedVector cycle(const MixedVector& b) override;

 private:
  class Level;

  AnchoredNodes nodes_;  ///< anchors in units
  const Network& network_;
  CutMatrix<double> K_;       ///< of the cells, in units
  Eigen::MatrixXd gradient_;  ///< 24 x cells
  Eigen::VectorXd compliance_;
  std::vector<std::unique_ptr<Level>> levels_;
  CoarsestFactors coarsest_;
};

}  // namespace springproof
