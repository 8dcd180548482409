// Multigrid for saddle-point systems on lattices: what pressures per cell and pressures per node share.
#pragma once

#include <functional>
#include <memory>

#include "msm/multigrid/multigrid.h"

namespace springproof {

/// One level of the cycle for  K u + B^T p = f,  B u - C p = g  with a diagonal C, in single precision.  Inexact
/// Braess-Sarazin smoothing (Braess and Sarazin 1997): K is replaced by D^-1 = 1.3 diag(K), and the Schur complement
/// S = C + B D B^T is solved by a few Chebyshev steps.  u, f, d are nodal fields of the level; p, g, Bu and C have a
/// value per pressure.
class SaddlePointLevel {
 public:
  virtual ~SaddlePointLevel() = default;

  /// V-cycle: (u, p) of (f, g).  `add_coarse_correction` finds d = f - K u - B^T p and Bu and adds to u and p.
  void cycle(const std::function<void()>& add_coarse_correction);

  LatticeOperator<float> K;
  Eigen::VectorXf f, g, u, p;
  Eigen::VectorXf d, Bu;
  Eigen::VectorXf compliance;  ///< diagonal of C

 protected:
  /// K of cells of stiffness `cell`, in the level's axes; `gradient` as in LatticeOperator.
  /// `kappa`: ratio of bulk to shear stiffness, which decides the number of Chebyshev steps.
  SaddlePointLevel(const LatticeLevel& level, const CellMatrix& cell, double gradient, Eigen::Index pressures,
                   double kappa);
  void bound_schur();  ///< to be called once compliance and the inverse diagonal of S are set
  void find_thin_parts(const CellMatrix& cell);

  virtual void take_residual() = 0;  ///< d = f - K u - B^T p, Bu = B u
  /// d = D (f - K u - B^T p), r = B (u + d) - g - C p; `from_zero`: u = 0 and p = 0.
  virtual void predict(bool from_zero) = 0;
  virtual void schur_step(const ChebyshevStep& step) = 0;  ///< r -= S z; z = a z + b diag(S)^-1 r; q += z
  virtual void correct_displacements() = 0;                ///< u += d - D B^T q

  Eigen::VectorXf inverse_diagonal_;        ///< D, 0 on fixed unknowns
  Eigen::VectorXf inverse_schur_diagonal_;  ///< 0: no such pressure
  Eigen::VectorXf r_, z_, q_;

 private:
  void sweep(bool from_zero);
  void residual();
  void correct_thin_parts();

  int chebyshev_steps_;
  double schur_bound_ = 1;           ///< largest eigenvalue of diag(S)^-1 S
  std::unique_ptr<ThinParts> thin_;  ///< null: none
};

/// The system in double precision, solved by GMRES over the cycle.  Displacements are 3 per node of the network,
/// pressures one per cell or per node of it, all in units of (shear modulus, cell edge), so that both equations have
/// entries of order one.
class SaddlePointSystem {
 public:
  virtual ~SaddlePointSystem() = default;

  /// (u, p) of the system, u = 0 on the fixed unknowns.
  KrylovResult solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance, int max_iterations,
                     Eigen::VectorXd& u, Eigen::VectorXd& p);
  /// (u, p) = M^-1 (f, g), one cycle.
  void apply(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u, Eigen::VectorXd& p);

  /// K u + B^T p, fixed unknowns included: minus the internal force.
  Eigen::VectorXd force(const Eigen::VectorXd& u, const Eigen::VectorXd& p);
  /// B u: first-order change of the volumes.
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u);

  virtual SaddlePointLevel& finest() = 0;
  virtual void cycle() = 0;  ///< on the finest level

 protected:
  virtual const LatticeLevels& lattice() const = 0;
  virtual const std::vector<int>& place_of_pressure() const = 0;    ///< per cell or node of the network
  virtual void multiply_rows(const double* x, double* y) = 0;       ///< y = A x, u before p
  virtual void volume_change_rows(const double* u, double* J) = 0;  ///< J = B u

 private:
  Eigen::Index pressures_begin() const { return 3 * lattice().levels[0].stride(); }
  Eigen::VectorXd to_rows(Nodal kind, const Eigen::VectorXd& u, const Eigen::VectorXd& p);
  Eigen::VectorXd pressures_of(const double* rows) const;
};

}  // namespace springproof
