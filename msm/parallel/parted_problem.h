// Linear static equilibrium of any model on several processes, with PETSc.
#pragma once

#include "msm/distribution/model_part.h"
#include "msm/parallel/parted_equations.h"
#include "msm/statics/equilibrium.h"

namespace springproof {

/// kappa / G (8 at nu = 0.45) above which pressures of cells are unknowns of their own; those of nodes always are, as
/// without them neighbours of neighbours are coupled.
inline constexpr double parted_mixed_above_kappa = 8;

/// The linear equations of a model, each process with the rows of its own nodes.  Displacement form: conjugate
/// gradients.  With momentum dispersion above nu = 1/4, and with a volume term that adds more than
/// parted_mixed_above_kappa G to lambda, with pressures (PressureForm): GMRES.  Lattices are preconditioned by the
/// multigrid of their cells, unless pressures are those of nodes; all else by smoothed aggregation (PETSc's GAMG),
/// which knows the rigid motions, with C (1 + kappa / 3G) in place of the Schur complement.
class PartedProblem {
 public:
  /// Finds the partition and takes this process' part; the whole model is not needed afterwards.
  /// @param model the same on every process, as are the conditions
  /// @param conditions supports, which leave no rigid motion, and loads
  /// @param communicator of the processes, all of which call this and solve()
  /// @throws InputError on all processes for a model whose forces have no energy.
  PartedProblem(const MassSpringModel& model, const BoundaryConditions& conditions, MPI_Comm communicator);

  /// @param tolerance relative residual
  /// @param max_iterations of the Krylov method
  /// @return displacement and support forces of all nodes, on every process; check `ok`
  Equilibrium solve(double tolerance, int max_iterations);

 private:
  /// What the equations gave on this process' part.
  struct Solution {
    Eigen::VectorXd u;  ///< own unknowns beside the prescribed ones [m]
    Eigen::VectorXd p;  ///< own pressures
    PetscOutcome outcome;
    std::string solver;
  };

  std::string multigrid_name() const;
  Solution solve_displacements(double tolerance, int max_iterations) const;
  Solution solve_mixed(double tolerance, int max_iterations) const;
  Eigen::VectorXd pressures_of_part(const Eigen::VectorXd& own) const;
  Eigen::VectorXd own_load(const Eigen::VectorXd& internal) const;
  NodalVectors own_positions() const;
  NodalVectors all_displacements(const Eigen::VectorXd& own) const;
  NodalVectors all_support(const NodalVectors& displacement, const Eigen::VectorXd& pressure) const;

  MPI_Comm communicator_;
  ModelPart part_;
  double kappa_;                   ///< volume_stiffness_ratio()
  bool mixed_;                     ///< pressures are unknowns
  std::vector<char> own_;          ///< nodes of this process
  BoundaryConditions conditions_;  ///< carried unknowns count as fixed
  EquationNumbers nodes_;          ///< places: nodes
  EquationNumbers pressures_;      ///< places: nodes, or cells of the part
  LatticeTransfers transfers_;     ///< empty: smoothed aggregation
  long unknowns_ = 0, all_cells_ = 0;
};

}  // namespace springproof
