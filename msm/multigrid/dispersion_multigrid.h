// Multigrid for the mixed form of momentum dispersion on cubic lattices: a pressure per node, so that the cost does not
// grow as nu -> 1/2.
#pragma once

#include "msm/laws/capabilities.h"
#include "msm/multigrid/mixed_multigrid.h"
#include "msm/multigrid/nodal_volumes.h"

namespace springproof {

/// The saddle-point system  [K_s B^T; B -C] (u, p) = (f, g)  of springs K_s and dispersion's nodal volumes
/// (NodalVolumes); p and g are 0 where a node has no volume of its own. The lattice itself is smoothed with these
/// pressures; its coarse correction is the mixed cycle of HybMSS cells of twice the edge, with a pressure per cell,
/// springs of the same moduli and the bulk modulus that dispersion adds: forces are restricted, displacements
/// prolongated, pressures are not transferred.
class DispersionMultigrid : public LatticeSaddlePoint {
 public:
  /// G: the springs' shear modulus [Pa].
  /// @throws std::invalid_argument without Capability::nodal_pressures, or for a single cell.
  DispersionMultigrid(const MassSpringModel& model, const std::vector<char>& fixed, double G);

  SaddlePointLevel& finest() override { return *level_; }
  void cycle_on_levels() override;

 private:
  DispersionMultigrid(const MassSpringModel& model, LatticeLevels lattice, double G);
  const LatticeLevels& lattice() const override { return lattice_; }
  const std::vector<int>& place_of_pressure() const override { return lattice_.point_of_node; }
  void force_rows(const double* u, const double* p, double* y) override;
  void volume_change_rows(const double* u, double* J) override { B_.change(u, J); }

  LatticeLevels lattice_;  ///< the finest level only
  NodalVolumes volumes_;
  MixedMultigrid below_;
  LatticeOperator<double> K_;
  NodalVolumeOperator<double> B_;
  std::unique_ptr<SaddlePointLevel> level_;
};

}  // namespace springproof
