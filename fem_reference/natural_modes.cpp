#include "fem_reference/motion.h"

#include <deal.II/grid/grid_tools.h>
#include <fmt/format.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem_reference/body_cells.h"
#include "fem_reference/grid/processes.h"
#include "fem_reference/solvers/petsc.h"
#include "fem_reference/system/boundary_conditions.h"
#include "fem_reference/system/sample.h"
#include "problem/system/input_error.h"
#include "problem/system/progress.h"

namespace springproof::fem {
namespace {

constexpr int modes_beyond = 6;            // computed beside those wanted: a gap for the inertia, whole multiplets
constexpr int most_beyond = 48;            // where eigenvalues were missed, as copies of multiple ones are
constexpr double eigen_tolerance = 1e-10;  // relative residual
constexpr double rigid_below = 1e-7;       // of the largest eigenvalue computed: a rigid motion
constexpr double least_gap = 1e-4;         // relative, between eigenvalues: none lies in it by accident

/// Stiffness of a cell, its pressures in units of `unit` [Pa/m].
CellMatrix stiffness_of(const CellLaw& law, const CellShape& shape, double unit) {
  const Eigen::Index u = 3 * shape.nodes(), p = shape.pressures.cols();
  double smallest = 1;
  CellTangent tangent;
  cell_residual(law, shape, {Eigen::MatrixXd::Zero(shape.nodes(), 3), Eigen::VectorXd::Zero(p)}, smallest, &tangent);
  CellMatrix K(u + p, u + p);
  K.topLeftCorner(u, u) = tangent.uu;
  if (p == 0) return K;
  K.topRightCorner(u, p) = unit * tangent.up;
  K.bottomLeftCorner(p, u) = unit * tangent.pu;
  K.bottomRightCorner(p, p) = unit * unit * tangent.pp;
  return K;
}

/// The mass m of one component for all three; none of the `pressures` of the cell.
CellMatrix mass_of(const Eigen::MatrixXd& m, Eigen::Index pressures) {
  CellMatrix M = CellMatrix::Zero(3 * m.cols() + pressures, 3 * m.cols() + pressures);
  for (Eigen::Index a = 0; a < m.cols(); ++a)
    for (Eigen::Index b = 0; b < m.cols(); ++b)
      for (int i = 0; i < 3; ++i) M(3 * a + i, 3 * b + i) = m(a, b);
  return M;
}

/// Stiffness and consistent mass of the free displacements and, after them, of the pressures, which have no mass.
struct Pencil {
  BodyEquations equations;
  std::unique_ptr<SparseMatrix> K, M;

  /// @param pressure_unit of the unknown pressures [Pa/m], for numbers as large as the displacements'
  Pencil(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
         const std::vector<CellLaw>& laws, double pressure_unit)
      : equations(problem, body, dof_handler, prescribed(dof_handler, body, problem.loads), laws,
                  body.has_tetrahedra() ? 4 : problem.degree + 1),
        K(equations.matrix()),
        M(equations.matrix()) {
    equations.for_each_cell([&](const BodyCell& cell) {
      const CellMatrix stiffness = stiffness_of(laws[cell.material], cell.shape, pressure_unit),
                       mass = mass_of(cell.mass, cell.shape.pressures.cols());
      std::vector<PetscInt> rows = cell.rows_u;
      rows.insert(rows.end(), cell.rows_p.begin(), cell.rows_p.end());
      K->add(rows, rows, stiffness.data());  // PETSc leaves out negative rows and columns
      M->add(rows, rows, mass.data());
    });
    for (SparseMatrix* matrix : {K.get(), M.get()}) {
      matrix->finish();
      succeed(MatSetOption(matrix->petsc(), MAT_SYMMETRIC, PETSC_TRUE));
    }
  }
};

/// Number of eigenvalues below sigma: that of negative pivots of K - sigma M (Sylvester), less one for each pressure,
/// whose own block is negative.
PetscInt eigenvalues_below(double sigma, const Pencil& pencil) {
  OwnedMat shifted;
  succeed(MatDuplicate(pencil.K->petsc(), MAT_COPY_VALUES, &shifted));
  succeed(MatAXPY(shifted, -sigma, pencil.M->petsc(), SAME_NONZERO_PATTERN));
  return SymmetricFactors(shifted).negative_pivots() - pencil.equations.pressures;
}

using Eigensolver = Owned<EPS, EPSDestroy>;

Eigensolver eigensolver(const Pencil& pencil, double target) {
  Eigensolver eps;
  ST transformation = nullptr;
  KSP ksp = nullptr;
  PC factors = nullptr;
  succeed(EPSCreate(PETSC_COMM_SELF, &eps));
  succeed(EPSSetOperators(eps, pencil.K->petsc(), pencil.M->petsc()));
  succeed(EPSSetProblemType(eps, EPS_GHEP));
  succeed(EPSSetType(eps, EPSKRYLOVSCHUR));
  succeed(EPSSetTolerances(eps, eigen_tolerance, 500));
  succeed(EPSSetTarget(eps, target));
  succeed(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  succeed(EPSGetST(eps, &transformation));
  succeed(STSetType(transformation, STSINVERT));
  succeed(STSetMatStructure(transformation, SAME_NONZERO_PATTERN));
  succeed(STGetKSP(transformation, &ksp));
  succeed(KSPSetType(ksp, KSPPREONLY));
  succeed(KSPGetPC(ksp, &factors));
  succeed(PCSetType(factors, PCCHOLESKY));
  succeed(PCFactorSetMatSolverType(factors, MATSOLVERMUMPS));
  return eps;
}

/// Computes `count` modes; the matrix is factorised once.  Iterations.
int solve(const Pencil& pencil, int count, EPS eps) {
  PetscInt iterations = 0;
  succeed(EPSSetDimensions(eps, count, std::min<PetscInt>(pencil.equations.displacements, 3 * count), PETSC_DEFAULT));
  succeed(EPSSolve(eps));
  succeed(EPSGetIterationNumber(eps, &iterations));
  return int(iterations);
}

struct Spectrum {
  std::vector<std::pair<double, PetscInt>> found;  ///< eigenvalues that rise, each with its number in the solver
  std::size_t rigid = 0;                           ///< so many are rigid motions
  std::size_t last = 0;                            ///< so many lie below the largest gap beyond those wanted
  double gap = 0;                                  ///< relative
};

Spectrum spectrum_of(EPS eps, int wanted) {
  Spectrum s;
  PetscInt converged = 0;
  succeed(EPSGetConverged(eps, &converged));
  s.found.resize(converged);
  for (PetscInt i = 0; i < converged; ++i) {
    succeed(EPSGetEigenvalue(eps, i, &s.found[i].first, nullptr));
    s.found[i].second = i;
  }
  if (s.found.empty()) return s;
  std::sort(s.found.begin(), s.found.end());
  const double largest = s.found.back().first;
  s.rigid =
      std::count_if(s.found.begin(), s.found.end(), [&](const auto& f) { return f.first < rigid_below * largest; });
  s.last = s.found.size() - 1;
  for (std::size_t i = s.rigid + wanted; i < s.found.size(); ++i)
    if (const double g = s.found[i].first / s.found[i - 1].first - 1; g > s.gap) {
      s.gap = g;
      s.last = i;
    }
  return s;
}

/// States that more eigenvalues lie below the gap than were found there; or nothing.
std::string missed(const Spectrum& s, const Pencil& pencil) {
  if (s.gap <= least_gap) return "";
  const PetscInt below = eigenvalues_below((s.found[s.last - 1].first + s.found[s.last].first) / 2, pencil);
  return below == PetscInt(s.last) ? ""
                                   : fmt::format("{} eigenvalues lie below one where {} were found", below, s.last);
}

}  // namespace

void solve_modes(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                 Solution& solution) {
  const Element element{body.has_tetrahedra(), problem.degree};
  const std::vector<CellLaw> laws = laws_of(problem, std::nullopt, body.has_tetrahedra());
  if (process_count() > 1) throw InputError("natural modes are computed by one process");
  start_mpi();
  progress::detail(fmt::format("{} unknowns, natural modes", dof_handler.n_dofs()));
  const auto [low, high] = dealii::GridTools::compute_bounding_box(body.triangulation).get_boundary_points();
  const Pencil pencil(problem, body, dof_handler, laws, shear_modulus(problem.material) / low.distance(high));
  double slowest = shear_modulus(problem.material) / problem.material.density / low.distance_square(high);
  for (const IsotropicMaterial& m : problem.regions)
    slowest = std::min(slowest, shear_modulus(m) / m.density / low.distance_square(high));
  const Eigensolver eps = eigensolver(pencil, -0.01 * slowest);
  solution.form = fmt::format("{}, consistent mass, Krylov-Schur", describe(element, form_of(laws)));
  solution.unknowns = pencil.equations.unknowns();
  Spectrum spectrum;
  for (int beyond = modes_beyond; beyond <= most_beyond; beyond *= 2) {
    const int count = int(std::min<PetscInt>(problem.modes + 6 + beyond, pencil.equations.displacements));
    solution.iterations += solve(pencil, count, eps);
    spectrum = spectrum_of(eps, problem.modes);
    if (int(spectrum.found.size()) < count) {
      solution.message = fmt::format("{} of {} natural modes converged", spectrum.found.size(), count);
      return;
    }
    solution.message = missed(spectrum, pencil);
    if (solution.message.empty() || count == pencil.equations.displacements) break;
  }
  if (!solution.message.empty()) return;
  const auto& [found, rigid, last, gap] = spectrum;
  const std::vector<Location> places = locate(body, problem.points);
  OwnedVec vector;
  succeed(MatCreateVecs(pencil.K->petsc(), &vector, nullptr));
  for (std::size_t i = rigid; i < last; ++i) {
    PetscReal error = 0;
    succeed(EPSComputeError(eps, found[i].second, EPS_ERROR_RELATIVE, &error));
    solution.residual = std::max(solution.residual, double(error));
    succeed(EPSGetEigenvector(eps, found[i].second, vector, nullptr));
    const PetscScalar* entries = nullptr;
    succeed(VecGetArrayRead(vector, &entries));
    DofVector u = zero_vector(dof_handler);
    for (std::size_t dof = 0; dof < pencil.equations.number.size(); ++dof)
      if (pencil.equations.number[dof] >= 0) u[dof] = entries[pencil.equations.number[dof]];
    succeed(VecRestoreArrayRead(vector, &entries));
    u.update_ghost_values();
    solution.frequencies.push_back(std::sqrt(found[i].first) / (2 * std::numbers::pi));
    solution.shapes.push_back(displacement_at(places, dof_handler, u));
  }
  solution.rigid_motions = int(rigid);
  solution.ok = true;
}

}  // namespace springproof::fem
