// Linear equations of macro-cells, preconditioned by the multigrid of averaged springs on the same nodes.
#pragma once

#include <memory>
#include <vector>

#include "msm/algebra/krylov.h"
#include "msm/laws/laws.h"
#include "msm/multigrid/cut_multigrid.h"
#include "msm/multigrid/multigrid.h"

namespace springproof {

/// The tangent of macro-cells as K = A + kappa D^T C D: A that of the springs alone, whose lambda is G; D the
/// derivatives of the four modes of a cell's volume, C the curvature of U (msm/laws/macro_springs.h), kappa = lambda -
/// G.  Solved by conjugate gradients; for kappa much above G with four pressures per cell as unknowns,
///     A u + D^T p = f,   D u - (kappa C)^-1 p = g,
/// by GMRES.  The preconditioner of A is one V-cycle of hybmss_avg with the same nodes, the Schur complement is taken
/// as that of a volume term of G: its modes are orthogonal at rest.  In cut bodies cubes that are hardly filled count
/// as filled to a part there.  Before and after that V-cycle each cell that the body fills in part is relaxed exactly,
/// one after the other: its nodes outside of the body follow their neighbours in ways that the lattice does not know.
/// The Schur complement of its volume is that with the other cells held, times a constant.
class MacroSolver {
 public:
  /// Whether the model consists of macro-cells, of a block or of a cut body, and anchors.
  static bool covers(const MassSpringModel& model);

  MacroSolver(const MassSpringModel& model, const std::vector<char>& fixed);

  void take(const NodalVectors& x);                                   ///< the tangent at x
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;  ///< y = K x, all unknowns
  Eigen::VectorXd diagonal() const;                                   ///< of K
  void precondition(const Eigen::VectorXd& r,
                    Eigen::VectorXd& z) const;  ///< z = M^-1 r, symmetric, 0 on fixed unknowns
  bool mixed() const { return mixed_; }         ///< whether solve() is to be taken
  /// u = K^-1 b on the free unknowns, 0 on the fixed, with pressures as unknowns.
  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u) const;

  /// Of the form with given pressures, four per cell: dE/dx, and V d<U>/dtheta.
  struct State {
    Eigen::VectorXd gradient;  ///< [N]
    Eigen::VectorXd slope;     ///< [m^3]
  };
  /// The tangent of that form at x (msm/laws/macro_pressures.h).
  State take(const NodalVectors& x, const Eigen::VectorXd& pressures);
  double kappa() const { return kappa_; }
  /// C^-1 v, cell by cell.
  Eigen::VectorXd over_curvature(const Eigen::VectorXd& v) const;
  /// f -= A u and g -= D u.
  void subtract(const Eigen::VectorXd& u, Eigen::VectorXd& f, Eigen::VectorXd& g) const;
  /// (u, p) of the equations above, u = 0 on fixed unknowns.
  KrylovResult solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance, int max_iterations,
                     Eigen::VectorXd& u, Eigen::VectorXd& p) const;

 private:
  /// Of a cell: modes of the volume, and their curvature.
  struct Volume {
    Eigen::Matrix<double, 4, 81> gradient;
    Eigen::Matrix4d curvature;
  };
  Eigen::Matrix<double, 81, 1> gathered(std::size_t cell, const Eigen::VectorXd& u) const;
  void scatter(std::size_t cell, const Eigen::Vector4d& p, Eigen::VectorXd& f) const;  ///< f += D^T p
  void clear_fixed(Eigen::VectorXd& v) const;
  /// Unknowns of a macro-cell that the body fills in part, and the inverse of their part of A.
  struct Patch {
    int cell;
    std::vector<int> unknowns;
    Eigen::MatrixXf inverse;
  };
  void prepare_patches();  ///< for A and the volumes of this state
  void assume_schur();
  void relax(const Patch& patch, const Eigen::VectorXd& r, Eigen::VectorXd& z) const;  ///< exactly on the patch
  void add_constant_parts();                                                           ///< A_ += bonds and anchors
  void apply_lattice(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;              ///< the preconditioner of A

  const Network& network_;
  MacroSprings law_;
  std::vector<char> fixed_;
  double kappa_ = 0;  ///< [Pa]
  bool mixed_ = false;
  double outside_ = 0;  ///< of kappa, what A does not hold [Pa]
  BlockMatrix A_;       ///< [N/m]
  std::vector<Volume> volumes_;
  std::unique_ptr<Multigrid> lattice_;  ///< of blocks
  std::vector<Patch> patches_;
  std::vector<Eigen::Matrix4d> schur_;  ///< per cell, the inverse of the Schur complement that is assumed
  double step_ = 1;                     ///< of the lattice's correction
  std::unique_ptr<CutMultigrid> cut_;   ///< of cut bodies
};

}  // namespace springproof
