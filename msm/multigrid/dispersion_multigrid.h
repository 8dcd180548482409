// Multigrid for the mixed form of momentum dispersion on cubic lattices: a pressure per node, so that the cost does not
// grow as nu -> 1/2.
#pragma once

#include "msm/multigrid/mixed_multigrid.h"
#include "msm/multigrid/nodal_volumes.h"

namespace springproof {

/// The saddle-point system  [K_s B^T; B -C] (u, p) = (f, g)  of springs K_s and dispersion's nodal volumes
/// (NodalVolumes). Inexact Braess-Sarazin sweeps on the lattice itself, in single precision; below it the mixed cycle
/// of HybMSS cells of twice the edge, with a pressure per cell, springs of the same moduli and the bulk modulus that
/// dispersion adds; forces go down to it, displacements come back, pressures stay. Displacements are 3 per node of the
/// network, pressures and g one per node, 0 where a node has no volume of its own; all in units of (shear modulus, cell
/// edge).
class DispersionMultigrid {
 public:
  /// G: the springs' shear modulus [Pa].
  /// @throws std::invalid_argument unless NodalVolumes::covers(model), or for a single cell.
  DispersionMultigrid(const MassSpringModel& model, const std::vector<char>& fixed, double G);

  /// (u, p) of the system, u = 0 on the fixed unknowns.
  KrylovResult solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance, int max_iterations,
                     Eigen::VectorXd& u, Eigen::VectorXd& p);

  /// K_s u + B^T p, fixed unknowns included: minus the internal force.
  Eigen::VectorXd force(const Eigen::VectorXd& u, const Eigen::VectorXd& p);
  /// B u: first-order change of each node's volume.
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u);

 private:
  DispersionMultigrid(const MassSpringModel& model, LatticeLevels lattice, double G);
  void bound_schur();
  void schur_step(const ChebyshevStep& step);  ///< r -= S z; z = a z + b D r; q += z
  void sweep(bool from_zero);
  void residual();  ///< d = f - K_s u - B^T p
  void correct_thin_parts();
  void cycle();  ///< (u, p) of (f, g)
  void multiply_rows(const double* x, double* y);
  Eigen::Index pressures() const { return 3 * lattice_.levels[0].stride(); }  ///< where they begin in a vector of both
  Eigen::Index size() const { return 4 * lattice_.levels[0].stride(); }
  Eigen::VectorXd to_rows(const Eigen::VectorXd& u, const Eigen::VectorXd& p) const;
  Eigen::VectorXd pressures_from_rows(const Eigen::VectorXd& rows) const;

  LatticeLevels lattice_;  ///< the finest level only
  NodalVolumes volumes_;
  MixedMultigrid below_;
  int inner_steps_;  ///< of the pressures in a sweep
  LatticeOperator<float> K_;
  LatticeOperator<double> K_double_;
  NodalVolumeOperator<float> B_;
  NodalVolumeOperator<double> B_double_;
  std::unique_ptr<ThinParts> thin_;  ///< null: none
  Eigen::VectorXf compliance_, inverse_diagonal_, inverse_schur_diagonal_;
  double schur_bound_ = 1;
  Eigen::VectorXf f_, g_, u_, p_, d_, y_, Bu_, r_, z_, q_;
};

}  // namespace springproof
