// The cells of a body in motion: consistent mass, internal force, energy, and the factors of the tangent.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem_reference/elements/cell_equations.h"
#include "fem_reference/grid/grid_problem.h"
#include "fem_reference/grid/triangulate.h"
#include "fem_reference/solvers/multigrid.h"
#include "fem_reference/solvers/petsc.h"
#include "fem_reference/system/boundary_conditions.h"

namespace springproof::fem {

/// Displacements of all degrees of freedom and pressures; or forces and residuals of the dilatation equation.
struct Unknowns {
  Eigen::VectorXd u, p;
};

/// Viscosity and branches in a step, whose middle is x: the rate of displacements is per_rate * (x - before).
struct Viscous {
  double time = 0;      ///< of retardation [s]; 0: none
  double per_rate = 0;  ///< [1/s]; 0: at rest, without branches
  Eigen::VectorXd before;

  bool acts() const { return time * per_rate > 0; }
};

/// A cell, and its place in the equations.
struct BodyCell {
  unsigned int material = 0;  ///< number in Mesh::materials
  CellShape shape;
  Eigen::MatrixXd mass;                  ///< consistent, with what is attached, of one component [kg]
  std::vector<Eigen::Index> u;           ///< 3 a + i: component i of node a
  std::vector<Eigen::Index> p;           ///< pressures
  std::vector<PetscInt> rows_u, rows_p;  ///< in the matrix; -1: held
  Overstrains overstrains = {};          ///< of the branches at the end of the last step
};

/// The equations of a body with mass: of free displacements, and after them of the pressures of the mixed form.
class BodyEquations {
 public:
  /// Keeps references to all but `held`.
  /// @param points of the quadrature (cell_quadrature())
  BodyEquations(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                const std::vector<Prescribed>& held, const std::vector<CellLaw>& laws, unsigned int points);

  void for_each_cell(const std::function<void(BodyCell&&)>& visit) const;
  PetscInt unknowns() const { return displacements + pressures; }
  std::unique_ptr<SparseMatrix> matrix() const;  ///< with the entries that cells couple, all zero

  std::vector<PetscInt> number;  ///< of each degree of freedom among the free ones; -1: held
  PetscInt displacements = 0, pressures = 0;

 private:
  const GridProblem& problem_;
  const Body3& body_;
  const dealii::DoFHandler<3>& u_;
  std::optional<dealii::DoFHandler<3>> p_;
  const std::vector<CellLaw>& laws_;
  unsigned int points_;
};

/// The cells of a body with their equations: consistent mass, internal force, and the factors of the tangent.
class BodyCells {
 public:
  BodyCells(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
            const std::vector<Prescribed>& held);

  Unknowns zero() const {
    return {Eigen::VectorXd::Zero(Eigen::Index(component_.size())), Eigen::VectorXd::Zero(equations_.pressures)};
  }
  Eigen::Index unknowns() const { return equations_.unknowns(); }
  bool is_free(Eigen::Index dof) const { return equations_.number[dof] >= 0; }
  int component(Eigen::Index dof) const { return component_[dof]; }
  std::string form() const { return form_; }

  /// M a on all degrees of freedom.
  Eigen::VectorXd times_mass(const Eigen::VectorXd& a) const;
  /// Sum of x M v over the nodes' positions x.
  Vec3 angular_momentum(const Eigen::VectorXd& position, const Eigen::VectorXd& v) const;
  /// Elastic energy; nothing at small strain and of a law without one.
  std::optional<double> energy(const Unknowns& x) const;
  /// Internal force and dilatation residual at x, on all degrees of freedom; the smallest det F, not positive if they
  /// are not valid.
  /// `before`, if not null: of the energy-momentum step from it whose middle x is (cell_equations.h).
  double residual(const Unknowns& x, const Viscous& viscous, const Unknowns* before, Unknowns& r) const;
  /// Makes the step of the branches whose middle is x.
  void relax(const Unknowns& x, const Viscous& viscous);
  /// Factors of inertia M + dr/dx, symmetrised.
  void factor(const Unknowns& x, const Viscous& viscous, double inertia);
  /// The correction by the factors; zero where held.
  Unknowns correction(const Unknowns& r) const;

 private:
  CellVector read(const BodyCell& cell, const Unknowns& x) const;
  std::vector<RelaxingStep> branches_over(const Viscous& step) const;
  static Unknowns rate_of(const Unknowns& x, const Viscous& viscous) {
    return {viscous.acts() ? Eigen::VectorXd(viscous.per_rate * (x.u - viscous.before)) : x.u, x.p};
  }

  std::vector<CellLaw> laws_;  ///< by material
  Relaxation relaxation_;
  std::string form_;
  BodyEquations equations_;
  std::vector<BodyCell> cells_;
  std::vector<int> component_;  ///< of each degree of freedom
  std::unique_ptr<SparseMatrix> matrix_;
  std::unique_ptr<SymmetricFactors> factors_;
};

}  // namespace springproof::fem
