// Multigrid of a lattice (msm/multigrid/multigrid.h) on a GPU.
#pragma once

#include <array>
#include <vector>

#include "msm/algebra/krylov.h"
#include "msm/gpu/gpu.h"
#include "msm/multigrid/hierarchy.h"
#include "msm/multigrid/lattice_operator.h"

namespace springproof {

/// The displacement form, for Poisson's ratios away from 1/2: conjugate gradients, preconditioned by the same V-cycle
/// as Multigrid's but without its correction of thin parts.  Set up by the processor.  Without a GPU its code runs on
/// the processor, thread by thread.
class GpuMultigrid {
 public:
  /// As Multigrid; `levels` down to some 300 unknowns, whose matrix is inverted.
  /// @throws std::invalid_argument if the finest level's cells are filled in part; std::runtime_error as
  ///   factor_coarsest().
  GpuMultigrid(LatticeLevels levels, const CellMatrix& cell, int smoothing_degree = 3);

  /// u = K^-1 b on the free unknowns, 0 on the fixed; nodal vectors.
  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u);
  /// y = K x, all unknowns.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y);
  double seconds() const { return seconds_; }  ///< wall time of the last solve on the GPU, without moving b and u
  double bytes() const { return solver_.bytes(); }

 private:
  std::vector<double> to_box(const Eigen::VectorXd& nodal) const;
  void from_box(const std::vector<double>& box, Eigen::VectorXd& nodal) const;
  static gpu::MultigridForGpu prepared(const LatticeLevels& levels, const CellMatrix& cell, int degree);

  LatticeLevels lattice_;
  std::vector<std::array<std::size_t, 3>> places_;  ///< of the network's unknowns, in its order
  std::size_t size_ = 0;                            ///< of a field of the finest box
  gpu::MultigridSolver solver_;
  double seconds_ = 0;
};

}  // namespace springproof
