// Multigrid for the mixed displacement-pressure form of HybMSS: the cost does not grow as nu -> 1/2.
#pragma once

#include "msm/multigrid/braess_sarazin.h"

namespace springproof {

/// The saddle-point system  [K_s B^T; B -V/kappa] (u, p) = (f, g)  of springs K_s (everything but the volume term) and
/// one pressure per cell, p = kappa/V B u; kappa > 0.
class MixedMultigrid : public LatticeSaddlePoint {
 public:
  /// A lattice that `may_float` needs no supports of its own.
  /// @throws std::invalid_argument unless cell.kappa > 0.
  MixedMultigrid(LatticeLevels levels, const CellStiffness& cell, bool may_float = false);

  SaddlePointLevel& finest() override { return *levels_[0]; }
  void cycle_on_levels() override;

 private:
  const LatticeLevels& lattice() const override { return lattice_; }
  const std::vector<int>& place_of_pressure() const override { return lattice_.cell_of_cell; }
  void force_rows(const double* u, const double* p, double* y) override;
  void volume_change_rows(const double* u, double* J) override { K_.divergence(u, J); }
  void solve_coarsest(SaddlePointLevel& level) const;

  LatticeLevels lattice_;
  std::vector<std::unique_ptr<SaddlePointLevel>> levels_;
  LatticeOperator<double> K_;
  Eigen::VectorXd change_;  ///< what the pass of force_rows() finds too
  DirectSolver coarsest_;
};

}  // namespace springproof
