#include "msm/parallel/parted_problem.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <vector>

#include "msm/algebra/block_matrix.h"
#include "msm/distribution/pressure_form.h"
#include "msm/parallel/petsc.h"
#include "msm/parameters/calibrate.h"
#include "msm/topology/network.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

using Partitioning = Owned<MatPartitioning, MatPartitioningDestroy>;

/// This process' rows of the graph of springs and cells; its arrays become PETSc's.
PetscMatrix graph(const Network& network, MPI_Comm communicator) {
  const int rank = rank_of(communicator), processes = size_of(communicator);
  const long nodes = network.nodes();
  const int first = static_cast<int>(nodes * rank / processes), last = static_cast<int>(nodes * (rank + 1) / processes);
  const auto coupled = coupled_through(carriers_of(network.nodes(), network.cells.carried), coupled_nodes(network));
  std::size_t entries = 0;
  for (int n = first; n < last; ++n) entries += coupled[n].size() - 1;
  PetscInt *begin, *columns;
  require(PetscMalloc1(last - first + 1, &begin));
  require(PetscMalloc1(entries, &columns));
  begin[0] = 0;
  for (int n = first; n < last; ++n) {  // each node is coupled with itself too
    const PetscInt* end = std::remove_copy(coupled[n].begin(), coupled[n].end(), columns + begin[n - first], n);
    begin[n - first + 1] = static_cast<PetscInt>(end - columns);
  }
  PetscMatrix adjacency;
  require(
      MatCreateMPIAdj(communicator, last - first, static_cast<PetscInt>(nodes), begin, columns, nullptr, &adjacency));
  return adjacency;
}

/// A partition of the nodes into one part per process, of about equal numbers of nodes and few springs between parts,
/// by PETSc's partitioner (PT-Scotch, where PETSc has it).
/// @param network the same on every process
/// @param communicator of the processes, all of which call this
/// @return process of each node
std::vector<int> owners_of_nodes(const Network& network, MPI_Comm communicator) {
  if (size_of(communicator) == 1) return std::vector<int>(network.nodes(), 0);
  const PetscMatrix adjacency = graph(network, communicator);
  Partitioning partitioning;
  PetscIndices own, all;
  require(MatPartitioningCreate(communicator, &partitioning));
  require(MatPartitioningSetAdjacency(partitioning, adjacency));
  require(MatPartitioningSetFromOptions(partitioning));
  require(MatPartitioningApply(partitioning, &own));
  require(ISAllGather(own, &all));
  const PetscInt* owner;
  require(ISGetIndices(all, &owner));
  std::vector<int> owners(owner, owner + network.nodes());
  require(ISRestoreIndices(all, &owner));
  return owners;
}

/// Process of each cell: the owner of its first corner, or of the node that carries that.
std::vector<int> owners_of_cells(const Network& network, const std::vector<int>& owner) {
  const Carriers carriers = carriers_of(network.nodes(), network.cells.carried);
  std::vector<int> of_cells;
  for (const Hexahedron& cell : network.cells.corners) {
    const int corner = cell[0];
    of_cells.push_back(owner[carriers.empty() || carriers[corner].empty() ? corner : carriers[corner].front().first]);
  }
  return of_cells;
}

/// Mean over all processes of the values, `block` per place, of their own places.
double mean(const Eigen::VectorXd& values, int block, const std::vector<int>& own, MPI_Comm communicator) {
  double sum = 0;
  for (const int place : own) sum += values.segment(block * place, block).sum();
  const Sum total{communicator};
  return total(sum) / total(static_cast<double>(block * own.size()));
}

Eigen::VectorXd row_squares(const NodalForms& B) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(B.rows());
  for (int row = 0; row < B.outerSize(); ++row)
    for (NodalForms::InnerIterator e(B, row); e; ++e) squares[row] += e.value() * e.value();
  return squares;
}

}  // namespace

PartedProblem::PartedProblem(const MassSpringModel& model, const BoundaryConditions& conditions, MPI_Comm communicator)
    : communicator_(communicator),
      kappa_(volume_stiffness_ratio(model)),
      mixed_(kappa_ > (dispersion_of(model) ? 0 : parted_mixed_above_kappa)),
      conditions_(conditions) {
  const Network& network = model.network;
  std::vector<int> owner = owners_of_nodes(network, communicator);
  agree(communicator, [&] {
    for (const int o : owner) own_.push_back(o == rank_of(communicator));
    part_ = part_of(model, own_);
    const std::vector<char>& fixed = conditions_.fixed = fixed_or_carried(network, conditions.fixed);
    unknowns_ = std::count(fixed.begin(), fixed.end(), 0);
    std::vector<int> with_equations = owner, of_cells;
    for (std::size_t n = 0; n < owner.size(); ++n)
      if (fixed[3 * n] && fixed[3 * n + 1] && fixed[3 * n + 2]) with_equations[n] = -1;
    nodes_ = number_equations(with_equations, communicator);
    if (mixed_ && dispersion_of(model)) {
      pressures_ = number_equations(owner, communicator);
      return;
    }
    if (mixed_) {
      of_cells = owners_of_cells(network, owner);
      all_cells_ = static_cast<long>(of_cells.size());
      pressures_ = number_equations(of_cells, part_.cells, communicator);
    }
    transfers_ = lattice_transfers(network, fixed, with_equations, of_cells, communicator);
  });
}

Eigen::VectorXd PartedProblem::own_load(const Eigen::VectorXd& internal) const {
  Eigen::VectorXd load(static_cast<Eigen::Index>(3 * nodes_.own.size()));
  for (std::size_t i = 0; i < nodes_.own.size(); ++i)
    for (int d = 0; d < 3; ++d) {
      const int at = 3 * nodes_.own[i] + d;
      load[3 * i + d] = conditions_.fixed[at] ? 0 : conditions_.external(nodes_.own[i], d) - internal[at];
    }
  return load;
}

NodalVectors PartedProblem::own_positions() const { return part_.model.network.X(nodes_.own, Eigen::all); }

std::string PartedProblem::multigrid_name() const {
  return transfers_.displacements.empty() ? "smoothed aggregation" : "multigrid of the lattice";
}

PartedProblem::Solution PartedProblem::solve_displacements(double tolerance, int max_iterations) const {
  PetscMatrix A;
  PetscVector b;
  {
    const Tangent K = tangent(part_.model, part_.model.network.X);
    Eigen::VectorXd internal;
    K.multiply(flat(conditions_.prescribed), internal);
    b = vector_of(own_load(internal), 3, communicator_);
    A = matrix_of(K, part_.model.network, nodes_, conditions_.fixed, communicator_);
  }
  set_rigid_motions(A, own_positions(), communicator_);
  const PetscSolver solver = displacement_solver(A, transfers_, communicator_);
  PetscVector x;
  require(VecDuplicate(b, &x));
  const PetscOutcome outcome = springproof::solve(solver, A, b, x, tolerance, max_iterations);
  return {values_of(x), {}, outcome, "CG + " + multigrid_name()};
}

PartedProblem::Solution PartedProblem::solve_mixed(double tolerance, int max_iterations) const {
  PetscMatrix A, B, minus_C, schur;
  PetscVector b;
  double unit;  // of pressure, so that both equations have entries of one size
  {
    const PressureForm form = pressure_form(part_.model);
    const Tangent K = tangent(form.springs, form.springs.network.X);
    Eigen::VectorXd internal;
    K.multiply(flat(conditions_.prescribed), internal);
    A = matrix_of(K, part_.model.network, nodes_, conditions_.fixed, communicator_);
    const Eigen::VectorXd diagonal = K.diagonal();
    const double stiffness = mean(diagonal, 3, nodes_.own, communicator_);
    unit = stiffness / std::sqrt(mean(row_squares(form.B), 1, pressures_.own, communicator_));
    B = matrix_of(form.B, unit, pressures_, nodes_, conditions_.fixed, communicator_);
    Eigen::VectorXd C(static_cast<Eigen::Index>(pressures_.own.size()));
    for (Eigen::Index i = 0; i < C.size(); ++i) {
      const double own = form.C[pressures_.own[i]];
      C[i] = own > 0 ? unit * unit * own : stiffness;  // a place without a volume: p = 0
    }
    minus_C = diagonal_matrix(-C, pressures_, communicator_);
    schur = diagonal_matrix(-(1 + kappa_ / 3) * C, pressures_, communicator_);
    const Eigen::VectorXd f = own_load(internal), g = -unit * (form.B * flat(conditions_.prescribed))(pressures_.own);
    Eigen::VectorXd both(f.size() + g.size());
    both << f, g;
    b = vector_of(both, 1, communicator_);
  }
  set_rigid_motions(A, own_positions(), communicator_);
  PetscMatrix B_transposed, system;
  require(MatCreateTranspose(B, &B_transposed));
  Mat blocks[4] = {A, B_transposed, B, minus_C};
  require(MatCreateNest(communicator_, 2, nullptr, 2, nullptr, blocks, &system));
  const PetscSolver solver = mixed_solver(system, schur, transfers_, communicator_);
  PetscVector x;
  require(VecDuplicate(b, &x));
  const PetscOutcome outcome = springproof::solve(solver, system, b, x, tolerance, max_iterations);
  const Eigen::VectorXd both = values_of(x);
  const auto n = static_cast<Eigen::Index>(3 * nodes_.own.size());
  return {both.head(n), unit * both.tail(both.size() - n), outcome, "GMRES + " + multigrid_name() + " with pressures"};
}

Equilibrium PartedProblem::solve(double tolerance, int max_iterations) {
  const double start = cpu_seconds();
  const Solution s = mixed_ ? solve_mixed(tolerance, max_iterations) : solve_displacements(tolerance, max_iterations);
  Equilibrium result;
  result.unknowns = unknowns_;
  const int processes = size_of(communicator_);
  result.solver = fmt::format("{}, {} process{}", s.solver, processes, processes == 1 ? "" : "es");
  result.iterations = s.outcome.iterations;
  result.residual = s.outcome.residual;
  result.ok = s.outcome.converged;
  if (!result.ok)
    result.message = fmt::format("{} did not converge: residual {:.2e} after {} iterations", s.solver, result.residual,
                                 result.iterations);
  result.displacement = all_displacements(s.u);
  result.support = all_support(result.displacement, pressures_of_part(s.p));
  result.seconds = cpu_seconds() - start;
  result.memory_MiB = peak_memory_MiB();
  return result;
}

/// Pressures of all nodes, or of the part's cells.
Eigen::VectorXd PartedProblem::pressures_of_part(const Eigen::VectorXd& own) const {
  if (!mixed_) return {};
  const bool of_cells = all_cells_ > 0;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(of_cells ? all_cells_ : static_cast<long>(own_.size()));
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    const int place = pressures_.own[i];
    all[of_cells ? part_.cells[place] : place] = own[i];
  }
  Sum{communicator_}.all(all.data(), all.size());
  if (of_cells) return all(part_.cells);
  return all;
}

NodalVectors PartedProblem::all_displacements(const Eigen::VectorXd& own) const {
  NodalVectors all = NodalVectors::Zero(conditions_.prescribed.rows(), 3);
  for (std::size_t i = 0; i < nodes_.own.size(); ++i) all.row(nodes_.own[i]) = own.segment<3>(3 * i).transpose();
  Sum{communicator_}.all(all.data(), all.size());
  all += conditions_.prescribed;
  carry(part_.model.network.cells.carried, all);
  return all;
}

NodalVectors PartedProblem::all_support(const NodalVectors& displacement, const Eigen::VectorXd& pressure) const {
  NodalVectors all = NodalVectors::Zero(displacement.rows(), 3);
  Eigen::VectorXd internal;
  if (mixed_) {
    const PressureForm form = pressure_form(part_.model);
    tangent(form.springs, form.springs.network.X).multiply(flat(displacement), internal);
    internal += form.B.transpose() * pressure;
  } else {
    tangent(part_.model, part_.model.network.X).multiply(flat(displacement), internal);
  }
  for (Eigen::Index n = 0; n < all.rows(); ++n)
    for (int d = 0; d < 3; ++d)
      if (own_[n] && conditions_.fixed[3 * n + d]) all(n, d) = internal[3 * n + d] - conditions_.external(n, d);
  Sum{communicator_}.all(all.data(), all.size());
  return all;
}

}  // namespace springproof
