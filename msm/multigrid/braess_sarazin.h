// Multigrid for saddle-point systems on lattices: what pressures per cell and pressures per node share.
#pragma once

#include <memory>

#include "msm/algebra/saddle_point.h"
#include "msm/multigrid/multigrid.h"

namespace springproof {

/// One level of the cycle for  K u + B^T p = f,  B u - C p = g  with a diagonal C, in single precision.  Inexact
/// Braess-Sarazin smoothing (Braess and Sarazin 1997): K is replaced by D^-1 = 1.3 diag(K), and the Schur complement
/// S = C + B D B^T is solved by a few Chebyshev steps.  u, f, d are nodal fields of the level; p, g, Bu and C have a
/// value per pressure.
class SaddlePointLevel {
 public:
  virtual ~SaddlePointLevel() = default;

  void smooth(Smoothing when);  ///< (u, p) from (f, g), then again
  void residual();              ///< d = f - K u - B^T p, zero on fixed unknowns, and Bu = B u
  void restrict_to(SaddlePointLevel& below);
  void prolongate(const SaddlePointLevel& below);

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

  virtual void restrict_pressures(SaddlePointLevel&) {}  ///< g of the level below, which is zero
  virtual void prolongate_pressures(const SaddlePointLevel&) {}
  virtual void take_residual() = 0;  ///< d = f - K u - B^T p, Bu = B u
  /// d = D (f - K u - B^T p), r = B (u + d) - g - C p; `from_zero`: u = 0 and p = 0.
  virtual void predict(bool from_zero) = 0;
  virtual void schur_step(const ChebyshevStep& step) = 0;  ///< r -= S z; z = a z + b diag(S)^-1 r; q += z
  virtual void correct_displacements() = 0;                ///< u += d - D B^T q

  Eigen::VectorXf inverse_diagonal_;        ///< D, 0 on fixed unknowns
  Eigen::VectorXf inverse_schur_diagonal_;  ///< 0: no such pressure
  Eigen::VectorXf r_, z_, q_;
  std::unique_ptr<ThinParts> thin_;  ///< null: none

 private:
  void sweep(bool from_zero);
  void correct_thin_parts();

  int chebyshev_steps_;
  double schur_bound_ = 1;  ///< largest eigenvalue of diag(S)^-1 S
};

/// The system on a lattice, in double precision, and the cycle for it.  Displacements are 3 per node of the network,
/// pressures one per cell or per node of it, all in units of (shear modulus, cell edge).
class LatticeSaddlePoint : public SaddlePoint {
 public:
  Eigen::VectorXd force(const MixedVector& x) override;
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u) override;
  const Eigen::VectorXd& compliance() const override { return compliance_; }
  MixedVector cycle(const MixedVector& b) override;

  virtual SaddlePointLevel& finest() = 0;
  virtual void cycle_on_levels() = 0;  ///< (u, p) of (f, g) of the finest level

 protected:
  virtual const LatticeLevels& lattice() const = 0;
  virtual const std::vector<int>& place_of_pressure() const = 0;             ///< per cell or node of the network
  virtual void force_rows(const double* u, const double* p, double* y) = 0;  ///< y = K u + B^T p
  virtual void volume_change_rows(const double* u, double* J) = 0;           ///< J = B u
  void take_compliance(const Eigen::VectorXd& rows) { compliance_ = pressures_of(rows); }

 private:
  Eigen::VectorXd pressure_rows(const Eigen::VectorXd& p);
  Eigen::VectorXd pressures_of(const Eigen::VectorXd& rows) const;

  Eigen::VectorXd compliance_;
};

}  // namespace springproof
