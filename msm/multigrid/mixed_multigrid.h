// Multigrid for the mixed displacement-pressure form of HybMSS: the cost does not grow as nu -> 1/2.
#pragma once

#include "msm/multigrid/braess_sarazin.h"

namespace springproof {

/// kappa / G (3 at nu = 0.4, 8 at 0.45) above which pressures as unknowns are worth it.
inline constexpr double mixed_above_kappa = 4;

/// The saddle-point system  [K_s B^T; B -V/kappa] (u, p) = (f, g)  of springs K_s (everything but the volume term) and
/// one pressure per cell, p = kappa/V B u; kappa > 0.
class MixedMultigrid : public SaddlePointSystem {
 public:
  /// A lattice that `may_float` needs no supports of its own.
  /// @throws std::invalid_argument unless cell.kappa > 0.
  MixedMultigrid(LatticeLevels levels, const CellStiffness& cell, bool may_float = false);

  SaddlePointLevel& finest() override { return *levels_[0]; }
  void cycle() override { cycle(0); }
  const LatticeLevel& finest_lattice() const { return lattice_.levels[0]; }

 private:
  const LatticeLevels& lattice() const override { return lattice_; }
  const std::vector<int>& place_of_pressure() const override { return lattice_.cell_of_cell; }
  void multiply_rows(const double* x, double* y) override;
  void volume_change_rows(const double* u, double* J) override { K_.divergence(u, J); }
  void cycle(std::size_t l);
  void add_coarse_correction(std::size_t l);
  void solve_coarsest(SaddlePointLevel& level) const;

  LatticeLevels lattice_;
  std::vector<std::unique_ptr<SaddlePointLevel>> levels_;
  LatticeOperator<double> K_;
  Eigen::VectorXd compliance_;
  DirectSolver coarsest_;
};

}  // namespace springproof
