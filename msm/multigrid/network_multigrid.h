// Multigrid for networks without cells of their own: the finest level is the network, the coarser ones an auxiliary
// lattice of HybMSS cells.
#pragma once

#include <memory>
#include <vector>

#include "msm/laws/laws.h"
#include "msm/multigrid/multigrid.h"

namespace springproof {

/// The stiffness K at rest of a model and the smoothing of a symmetric cycle for K x = b on the network; vectors of 3
/// n, fixed unknowns of x stay 0.
class NetworkSmoother {
 public:
  virtual ~NetworkSmoother() = default;

  virtual void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const = 0;  ///< y = K x
  virtual Eigen::VectorXd diagonal() const = 0;                                   ///< of K

  /// Smooths from zero and stores x; r = b - K x.
  virtual void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) = 0;

  /// Adds the coarse correction to the stored x, smooths again, and returns x.
  virtual void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) = 0;
};

/// Matrix-free, smoothing in single precision, if ListStiffness covers the model; else with the assembled tangent.
std::unique_ptr<NetworkSmoother> network_smoother(const MassSpringModel& model, const std::vector<char>& fixed);

/// Symmetric cycle for the rest state of a conservative model: smoothing on the network itself before and after one
/// V-cycle of a lattice that fills the same body, with cells of 1.75 mean node distances (lattices of cells: two
/// edges), with the network's affine shear modulus and the bulk modulus that momentum dispersion adds.
class NetworkMultigrid {
 public:
  NetworkMultigrid(const MassSpringModel& model, const std::vector<char>& fixed);

  /// y = K x, all unknowns.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { smoother_->multiply(x, y); }
  Eigen::VectorXd diagonal() const { return smoother_->diagonal(); }  ///< of K
  /// z = M^-1 r, symmetric positive definite; zero on the fixed unknowns.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

 private:
  std::vector<char> fixed_;
  std::unique_ptr<NetworkSmoother> smoother_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights_;  ///< of the auxiliary lattice's points, per node
  std::vector<char> lattice_fixed_;
  std::unique_ptr<Multigrid> lattice_;
  mutable Eigen::VectorXd residual_, coarse_r_, coarse_x_, correction_;
};

}  // namespace springproof
