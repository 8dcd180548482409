#include "msm/parallel/slab_multigrid.h"

#include <stdexcept>

#include "msm/parallel/petsc.h"

namespace springproof {
namespace {

constexpr long shared_unknowns = 60000;  // a lattice of so many is replicated on every process

template <class Real>
constexpr MPI_Datatype mpi_type() {
  return sizeof(Real) == 4 ? MPI_FLOAT : MPI_DOUBLE;
}

}  // namespace

PlaneExchange::PlaneExchange(const SlabLevel& level, MPI_Comm communicator)
    : level_(&level), communicator_(communicator) {
  const int rank = rank_of(communicator);
  below_ = rank > 0 ? rank - 1 : MPI_PROC_NULL;
  above_ = rank + 1 < size_of(communicator) ? rank + 1 : MPI_PROC_NULL;
}

template <class Real, class Pack, class Unpack>
void PlaneExchange::exchange(int values_per_point, Pack pack, Unpack unpack) const {
  const std::vector<long>& begin = level_->lattice.point_begin;
  const int size = static_cast<int>(values_per_point * (begin[1] - begin[0]));  // all planes of a block are equal
  std::vector<Real> out(size), in(size);
  const auto pass = [&](int send_plane, int to, int receive_plane, int from) {
    if (to != MPI_PROC_NULL) pack(begin[send_plane], begin[send_plane + 1], out.data());
    MPI_Sendrecv(out.data(), size, mpi_type<Real>(), to, 0, in.data(), size, mpi_type<Real>(), from, 0, communicator_,
                 MPI_STATUS_IGNORE);
    if (from != MPI_PROC_NULL) unpack(begin[receive_plane], begin[receive_plane + 1], in.data());
  };
  pass(level_->own_end - 1, above_, 0, below_);
  pass(level_->own_begin, below_, level_->lattice.planes(), above_);
}

template <class Real>
void PlaneExchange::complete(Real* field) const {
  const long stride = level_->lattice.stride();
  exchange<Real>(
      3,
      [&](long begin, long end, Real* buffer) {
        for (int a = 0; a < 3; ++a) buffer = std::copy(field + a * stride + begin, field + a * stride + end, buffer);
      },
      [&](long begin, long end, const Real* buffer) {
        for (int a = 0; a < 3; ++a, buffer += end - begin) std::copy_n(buffer, end - begin, field + a * stride + begin);
      });
}

void PlaneExchange::complete(LatticeMotion& motion) const {
  exchange<double>(
      6,
      [&](long begin, long end, double* buffer) {
        motion.read(static_cast<int>(begin), static_cast<int>(end), buffer);
      },
      [&](long begin, long end, const double* buffer) {
        motion.write(static_cast<int>(begin), static_cast<int>(end), buffer);
      });
}

SlabPartition::SlabPartition(const std::array<int, 3>& block_cells, MPI_Comm communicator) : cells(block_cells) {
  const int processes = size_of(communicator);
  const auto along = [&](int axis, int l) { return (cells[axis] + (1 << l) - 1) >> l; };
  const auto unknowns = [&](int l) { return 3L * (along(0, l) + 1) * (along(1, l) + 1) * (along(2, l) + 1); };
  while (levels == 0 || (unknowns(levels) > shared_unknowns && along(2, levels + 1) >= 2 * processes)) ++levels;
  if (along(2, levels) < processes)
    throw std::invalid_argument("a block of " + std::to_string(cells[2]) + " planes of cells cannot be shared by " +
                                std::to_string(processes) + " processes (allowed: at most " +
                                std::to_string(along(2, 1)) + ")");
  PetscInt own = PETSC_DECIDE, all = along(2, levels);
  require(PetscSplitOwnership(communicator, &own, &all));
  PetscInt end = 0;
  MPI_Scan(&own, &end, 1, MPIU_INT, MPI_SUM, communicator);
  z_begin = static_cast<int>(end - own);
  z_end = static_cast<int>(end);
}

SlabLevel SlabPartition::level(int l, MPI_Comm communicator) const {
  const bool first = rank_of(communicator) == 0, last = rank_of(communicator) + 1 == size_of(communicator);
  const int factor = 1 << (levels - l), all = (cells[2] + (1 << l) - 1) >> l;
  const int begin = z_begin * factor, end = last ? all : z_end * factor;
  SlabLevel slab;
  slab.lattice = block_level(cells, l, first ? begin : begin - 1, end);
  slab.own_begin = first ? 0 : 1;
  slab.own_end = slab.own_begin + (end - begin) + last;
  return slab;
}

SlabMultigrid::SlabMultigrid(const SlabPartition& partition, const std::vector<char>& fixed, const CellMatrix& cell,
                             MPI_Comm communicator)
    : communicator_(communicator) {
  const double unit = cell.diagonal().mean();
  unit_ = 1 / unit;
  for (int l = 0; l <= partition.levels; ++l) slabs_.push_back(partition.level(l, communicator));
  LatticeLevel& finest = slabs_[0].lattice;
  for (int a = 0; a < 3; ++a)
    for (long n = 0; n < finest.points(); ++n)
      if (fixed[3 * n + a]) finest.fixed.push_back(static_cast<int>(a * finest.stride() + n));
  for (int l = 0; l < partition.levels; ++l) link(slabs_[l].lattice, slabs_[l + 1].lattice);

  LatticeLevels whole;
  whole.levels.push_back(block_level(partition.cells, partition.levels, 0,
                                     (partition.cells[2] + (1 << partition.levels) - 1) >> partition.levels));
  gather_fixed(whole.levels[0]);
  add_coarser_levels(whole);
  below_ = std::make_unique<Multigrid>(std::move(whole), cell);
  counts_.resize(size_of(communicator));
  begins_.resize(size_of(communicator));
  const int own = static_cast<int>(slabs_.back().own_points()),
            begin = static_cast<int>(place_below() + slabs_.back().own_first());
  MPI_Allgather(&own, 1, MPI_INT, counts_.data(), 1, MPI_INT, communicator);
  MPI_Allgather(&begin, 1, MPI_INT, begins_.data(), 1, MPI_INT, communicator);
  below_r_ = below_x_ = Eigen::VectorXf::Zero(3 * slabs_.back().lattice.stride());

  // Eigenvalue bound of the replicated lattice, a smaller block of the same cells, and a margin.
  const double at_most = largest_scaled_eigenvalue(cell), found = below_->finest().largest_eigenvalue;
  const double bound = found > 0 ? std::min(at_most, 1.05 * found) : at_most;
  for (const SlabLevel& slab : slabs_) exchanges_.emplace_back(slab, communicator);
  for (int l = 0; l < partition.levels; ++l) {
    SmoothingLevel& level = levels_.emplace_back(slabs_[l].lattice, cell / unit);
    level.largest_eigenvalue = bound;
    level.complete = [this, l](Eigen::VectorXf& field) { exchanges_[l].complete(field.data()); };
  }
  K_ = std::make_unique<LatticeOperator<double>>(finest, cell);
}

/// Number in the replicated lattice of the first point of this process' part.
long SlabMultigrid::place_below() const {
  const LatticeLevel& part = slabs_.back().lattice;
  return part.first_cell[2] * (part.point_begin[1] - part.point_begin[0]);
}

/// Gathers the fixed unknowns of the replicated lattice from all processes.
void SlabMultigrid::gather_fixed(LatticeLevel& whole) const {
  const SlabLevel& part = slabs_.back();
  std::vector<char> held(3 * whole.points(), 0);
  const long offset = place_below();
  for (int place : part.lattice.fixed) {
    const long a = place / part.lattice.stride(), n = place % part.lattice.stride();
    if (n >= part.own_first() && n < part.own_first() + part.own_points()) held[a * whole.points() + offset + n] = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, held.data(), static_cast<int>(held.size()), MPI_CHAR, MPI_MAX, communicator_);
  for (long a = 0; a < 3; ++a)
    for (long n = 0; n < whole.points(); ++n)
      if (held[a * whole.points() + n]) whole.fixed.push_back(static_cast<int>(a * whole.stride() + n));
}

/// Every process gathers the whole right-hand side and runs the same cycle.
void SlabMultigrid::cycle_below() {
  const SlabLevel& part = slabs_.back();
  SmoothingLevel& whole = below_->finest();
  const LatticeLevel& lattice = whole.K.level();
  const long offset = place_below();
  for (int a = 0; a < 3; ++a)
    MPI_Allgatherv(below_r_.data() + a * part.lattice.stride() + part.own_first(), static_cast<int>(part.own_points()),
                   MPI_FLOAT, whole.r.data() + a * lattice.stride(), counts_.data(), begins_.data(), MPI_FLOAT,
                   communicator_);
  below_->cycle();
  for (int a = 0; a < 3; ++a)
    below_x_.segment(a * part.lattice.stride(), part.lattice.points()) =
        whole.x.segment(a * lattice.stride() + offset, part.lattice.points());
}

void SlabMultigrid::cycle(int l) {
  if (l == static_cast<int>(levels_.size())) {
    cycle_below();
    return;
  }
  SmoothingLevel& level = levels_[l];
  const bool last = l + 1 == static_cast<int>(levels_.size());
  Eigen::VectorXf &coarse_r = last ? below_r_ : levels_[l + 1].r, &coarse_x = last ? below_x_ : levels_[l + 1].x;
  const LatticeLevel& coarse = slabs_[l + 1].lattice;
  level.smooth(Smoothing::before_coarse);
  level.residual();
  coarse_r.setZero();
  restrict_field(coarse, level.K.kernels(), level.K.stride(), level.r.data(), coarse_r.data());
  cycle(l + 1);
  if (!last) exchanges_[l + 1].complete(coarse_x.data());
  prolongate_field(coarse, level.K.kernels(), coarse_x.data(), level.K.stride(), level.z.data());
  level.K.level().clear_fixed(level.z);
  level.smooth(Smoothing::after_coarse);
}

void SlabMultigrid::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) {
  double scale = r.cwiseAbs().maxCoeff();
  MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  if (!(scale > 0)) return void(z.setZero(r.size()));
  levels_[0].r = (r / scale).cast<float>();
  cycle(0);
  z = (scale * unit_) * levels_[0].x.cast<double>();
}

void SlabMultigrid::multiply(Eigen::VectorXd& x, Eigen::VectorXd& y) {
  exchanges_[0].complete(x.data());
  y.setZero(x.size());
  K_->pass(x.data(), nullptr, nullptr, [&](int a, long begin, long n, const double* values) {
    std::memcpy(y.data() + a * K_->stride() + begin, values, n * sizeof(double));
  });
}

namespace {

/// Copies the own points of nodal fields from and to PETSc's vectors.
struct Shell {
  SlabMultigrid* multigrid;
  Eigen::VectorXd x, y;

  void read(Vec v) {
    const double* values;
    require(VecGetArrayRead(v, &values));
    for_each([&](long at, long n, long from) { std::copy_n(values + from, n, x.data() + at); });
    require(VecRestoreArrayRead(v, &values));
  }
  void write(Vec v) {
    double* values;
    require(VecGetArray(v, &values));
    for_each([&](long at, long n, long from) { std::copy_n(y.data() + at, n, values + from); });
    require(VecRestoreArray(v, &values));
  }
  template <class Visit>
  void for_each(Visit visit) const {
    const SlabLevel& s = multigrid->finest();
    for (int a = 0; a < 3; ++a) visit(a * s.lattice.stride() + s.own_first(), s.own_points(), a * s.own_points());
  }
};

PetscErrorCode multiply_shell(Mat K, Vec x, Vec y) {
  Shell* shell;
  PetscCall(MatShellGetContext(K, &shell));
  shell->read(x);
  shell->multigrid->multiply(shell->x, shell->y);
  shell->multigrid->finest().lattice.clear_fixed(shell->y);
  shell->write(y);
  return 0;
}

PetscErrorCode precondition_shell(PC pc, Vec r, Vec z) {
  Shell* shell;
  PetscCall(PCShellGetContext(pc, &shell));
  shell->x.setZero();
  shell->read(r);
  shell->multigrid->apply(shell->x, shell->y);
  shell->write(z);
  return 0;
}

}  // namespace

KrylovResult SlabMultigrid::solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u) {
  Shell shell{this, Eigen::VectorXd::Zero(b.size()), b};
  finest().lattice.clear_fixed(shell.y);
  Vec rhs, solution;
  require(VecCreateMPI(communicator_, static_cast<PetscInt>(3 * finest().own_points()), PETSC_DETERMINE, &rhs));
  require(VecDuplicate(rhs, &solution));
  shell.write(rhs);
  Mat K;
  PetscInt own;
  require(VecGetLocalSize(rhs, &own));
  require(MatCreateShell(communicator_, own, own, PETSC_DETERMINE, PETSC_DETERMINE, &shell, &K));
  require(MatShellSetOperation(K, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_shell)));
  KSP ksp;
  PC pc;
  require(KSPCreate(communicator_, &ksp));
  require(KSPSetOperators(ksp, K, K));
  require(KSPSetType(ksp, KSPCG));
  require(KSPSetNormType(ksp, KSP_NORM_UNPRECONDITIONED));
  require(KSPGetPC(ksp, &pc));
  require(PCSetType(pc, PCSHELL));
  require(PCShellSetContext(pc, &shell));
  require(PCShellSetApply(pc, precondition_shell));
  require(KSPSetTolerances(ksp, tolerance, 0, PETSC_DEFAULT, max_iterations));
  require(KSPSolve(ksp, rhs, solution));
  KSPConvergedReason reason;
  PetscInt iterations;
  require(KSPGetConvergedReason(ksp, &reason));
  require(KSPGetIterationNumber(ksp, &iterations));
  // Recompute the residual.
  PetscReal scale, residual;
  Vec r;
  require(VecDuplicate(rhs, &r));
  require(MatMult(K, solution, r));
  require(VecAYPX(r, -1, rhs));
  require(VecNorm(r, NORM_2, &residual));
  require(VecNorm(rhs, NORM_2, &scale));
  shell.read(solution);
  u = shell.x;
  exchanges_[0].complete(u.data());
  require(VecDestroy(&r));
  require(VecDestroy(&rhs));
  require(VecDestroy(&solution));
  require(MatDestroy(&K));
  require(KSPDestroy(&ksp));
  KrylovResult result;
  result.iterations = static_cast<int>(iterations);
  result.residual = scale > 0 ? residual / scale : 0;
  result.negative_curvature = reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC;
  result.converged = result.residual <= 10 * tolerance;
  return result;
}

}  // namespace springproof
