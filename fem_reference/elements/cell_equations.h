// Cell residual and tangent, total Lagrangian, with one implementation for every law.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "fem_reference/elements/element.h"
#include "fem_reference/elements/laws.h"
#include "problem/relaxation.h"

namespace springproof::fem {

/// Shape functions of a cell at its quadrature points.
struct CellShape {
  Eigen::MatrixXd gradients;  ///< 3 q + i, a: dN_a/dX_i at point q [1/m]
  Eigen::VectorXd weights;    ///< quadrature weight times Jacobian determinant [m^3]
  Eigen::MatrixXd pressures;  ///< q, f: pressure shape function f at point q; no columns: no pressure

  int nodes() const { return int(gradients.cols()); }
  int points() const { return int(weights.size()); }
};

/// Unknowns, or forces, of a cell.
struct CellVector {
  Eigen::MatrixXd u;  ///< nodes x 3
  Eigen::VectorXd p;
};

/// Row-major, unknown 3 a + i is component i of node a.
using CellMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct CellTangent {
  CellMatrix uu, up, pu, pp;
};

struct CellLaw {
  std::optional<Law> law;  ///< none: small strain
  Form form;
  double mu, lambda;     ///< [Pa]
  double pointwise = 0;  ///< part of lambda that the mixed form leaves to the dilatation at each point, at rest [Pa]
  double density = 0;    ///< [kg/m^3]
};

/// Whether one of them is mixed: then all have pressures, which are 0 in the cells that are not.
bool any_mixed(const std::vector<CellLaw>& laws);

/// CellLaw::pointwise of a body.  Continuous pressures of tetrahedra leave the dilatation at single points free: at the
/// rim of a support det F falls to a twentieth, and laws lose their ellipticity there.  At large strain they stand for
/// what lambda exceeds its value at nu = 0.4 by, up to which quadratic tetrahedra take none.
double pointwise_part(bool tetrahedra, const CellLaw& law);

/// Lowers `smallest` to min det F over the quadrature points; the residual is valid only if that is positive.
/// `tangent` may be null.
CellVector cell_residual(const CellLaw& law, const CellShape& shape, const CellVector& x, double& smallest,
                         CellTangent* tangent);

/// The residual of an energy-momentum step from `before` to `after` = 2 middle - before, for the middle's F: with the
/// mean of S over the straight line from C of `before` to that of `after` (Gauss, four points: exact to the eighth
/// power of the change), whose work S : (C1 - C0)/2 is the change of the law's energy (Gonzalez 1996); pressures are
/// means over the dilatation in the same way.  At small strain it is cell_residual() at the middle.
CellVector step_residual(const CellLaw& law, const CellShape& shape, const CellVector& before, const CellVector& middle,
                         double& smallest);

/// Elastic energy at finite strain [J]; in the mixed form with its pressures, of which it is stationary.
double cell_energy(const CellLaw& law, const CellShape& shape, const CellVector& x);

/// Kelvin-Voigt viscosity: adds to the residual `viscosity` [s] times the stress 2 mu E' (second Piola-Kirchhoff, E'
/// the rate of Green-Lagrange strain) and lambda tr(F' F^-1) F^-T (first).  In the mixed form the pressure resists the
/// rate too: the dilatation residual becomes that of g + viscosity tr(F' F^-1), divided by 1 + viscosity * per_rate.
/// `rate`: velocities [m/s], nodes x 3.  `tangent`, if not null: its derivative to displacements on which the rate
/// depends by the factor `per_rate` [1/s] is added, for F as it is.
void add_viscosity(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd& u, const Eigen::MatrixXd& rate,
                   double viscosity, double per_rate, CellVector& residual, CellTangent* tangent);

/// A branch that relaxes, over a step (problem/relaxation.h).
struct RelaxingStep {
  double share;  ///< of its shear modulus in the long-time one
  BranchStep over;
};

/// Overstrains of the branches at the quadrature points of a cell, point by point.
using Overstrains = std::vector<Eigen::Matrix3d>;

/// Branches: adds to the residual the stress 2 mu share Q (second Piola-Kirchhoff), Q the mean overstrain of a step
/// from `before` whose middle is u, with the middle's F: its work is stored or dissipated. `tangent`, if not null: its
/// derivative to the middle is added, for F as it is.
/// @param before, u displacements [m], nodes x 3
void add_relaxation(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd& before, const Eigen::MatrixXd& u,
                    const std::vector<RelaxingStep>& branches, const Overstrains& overstrains, CellVector& residual,
                    CellTangent* tangent);

/// Makes the step from `before` whose middle is u.
void advance(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd& before, const Eigen::MatrixXd& u,
             const std::vector<RelaxingStep>& branches, Overstrains& overstrains);

/// The small-strain stiffness with gradients in the configuration deformed by u (nullptr: undeformed), integrated over
/// the rest volume: the matrix of the multigrid.  Of lambda the mixed form has the pointwise part alone.
CellMatrix cell_stiffness(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd* u);

}  // namespace springproof::fem
