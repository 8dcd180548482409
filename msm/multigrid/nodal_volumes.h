// Momentum dispersion at rest on a cubic lattice as a pressure per node: K = K_springs + B^T C^-1 B, B u the change of
// the nodes' volumes.
#pragma once

#include <array>
#include <vector>

#include "msm/laws/laws.h"
#include "msm/multigrid/hierarchy.h"

namespace springproof {

/// The rows of B by springs, on the points of a lattice's finest level.
struct NodalVolumes {
  std::vector<SpringRun> runs;
  std::vector<double> directions;            ///< unit vectors in the level's axes, three components each
  std::vector<double> weight_i, weight_j;    ///< per spring of the runs, of either end [edge^2]
  std::vector<std::array<long, 2>> members;  ///< point, and the point whose volume includes its springs
  Eigen::VectorXd compliance;                ///< C per point [edge^3 / G]; 0: the point has no volume of its own

  /// For a model with the symmetric form of dispersion, q > 0, on a lattice of cells; G the springs' shear modulus
  /// [Pa].
  /// @throws std::invalid_argument without Capability::nodal_pressures.
  NodalVolumes(const MassSpringModel& model, const LatticeLevels& lattice, double G);

  /// Diagonal of B D B^T, D a nodal field of the level.
  Eigen::VectorXd schur_diagonal(const LatticeLevel& level, const Eigen::VectorXf& D) const;
};

/// B and its transpose.  Nodal fields hold three arrays of `stride` values, volumes and pressures one.
template <class Real>
class NodalVolumeOperator {
 public:
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  NodalVolumeOperator(const NodalVolumes& volumes, long stride, InstructionSet set = instruction_set());

  /// J = B u.
  void change(const Real* u, Real* J) const;
  /// y += B^T p; p is ignored at points without a volume.
  void add_forces(const Real* p, Real* y) const;

 private:
  const CellKernels<Real>* kernels_;
  std::vector<SpringRun> runs_;
  std::vector<std::array<long, 2>> members_;
  Vector directions_, weight_i_, weight_j_;
  mutable Vector pressure_;  ///< including that of the members
  long stride_;
};

extern template class NodalVolumeOperator<float>;
extern template class NodalVolumeOperator<double>;

}  // namespace springproof
