#include "msm/parallel/lattice_transfers.h"

#include <memory>

namespace springproof {
namespace {

constexpr double regularisation = 1e-9;  // of the coarsest lattice, whose points may be more than its cells need
constexpr double damped = 2;             // of the inverse diagonal blocks in the Schur complement
constexpr PetscInt schur_sweeps = 3;     // there and back

PetscMatrix triple_product(Mat A, Mat P) {
  PetscMatrix coarse;
  require(MatPtAP(A, P, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &coarse));
  return coarse;
}

/// P^T A P, with the identity in unknowns that no finer one follows.
PetscMatrix galerkin(Mat A, Mat P, bool coarsest, MPI_Comm communicator) {
  PetscMatrix coarse = triple_product(A, P);
  PetscVector diagonal;
  PetscScalar* value;
  PetscInt rows;
  require(MatCreateVecs(coarse, &diagonal, nullptr));
  require(MatGetDiagonal(coarse, diagonal));
  require(VecGetLocalSize(diagonal, &rows));
  require(VecGetArray(diagonal, &value));
  double own = 0;
  for (PetscInt i = 0; i < rows; ++i) own += value[i];
  const Sum total{communicator};
  const double mean = total(own) / total(rows);
  for (PetscInt i = 0; i < rows; ++i)
    if (!(value[i] > 0))
      value[i] = mean;
    else if (coarsest)
      value[i] += regularisation * mean;
  require(VecRestoreArray(diagonal, &value));
  require(MatDiagonalSet(coarse, diagonal, INSERT_VALUES));
  require(MatSetOption(coarse, MAT_SPD, PETSC_TRUE));
  return coarse;
}

/// A nested matrix whose vectors are plain ones.
PetscMatrix nested(Mat a, Mat b, Mat c, Mat d, MPI_Comm communicator) {
  PetscMatrix all;
  Mat blocks[4] = {a, b, c, d};
  require(MatCreateNest(communicator, 2, nullptr, 2, nullptr, blocks, &all));
  require(MatNestSetVecType(all, VECSTANDARD));
  return all;
}

Mat block_of(Mat nested, PetscInt row, PetscInt column) {
  Mat block;
  require(MatNestGetSubMat(nested, row, column, &block));
  return block;
}

/// Symmetric Gauss-Seidel from zero, in between the unknowns at anchors together; each process as if it were alone,
/// so that the whole is positive definite.
class Relaxation {
 public:
  Relaxation(Mat A, IS anchored) : anchored_(anchored) {
    require(MatGetDiagonalBlock(A, &A_));
    require(MatCreateVecs(A_, &x_, &b_));
    PetscInt count;
    require(ISGetSize(anchored, &count));
    if (count == 0) return;
    PetscMatrix block;
    require(MatCreateSubMatrix(A_, anchored, anchored, MAT_INITIAL_MATRIX, &block));
    require(MatCreateSubMatrix(A_, anchored, nullptr, MAT_INITIAL_MATRIX, &rows_));
    require(MatCreateVecs(block, &d_, &r_));
    require(KSPCreate(PETSC_COMM_SELF, &together_));
    require(KSPSetOptionsPrefix(together_, "anchored_"));
    require(KSPSetOperators(together_, block, block));
    require(KSPSetFromOptions(together_));
  }

  void apply(Vec b, Vec x) const {
    require(VecGetLocalVectorRead(b, b_));
    require(VecGetLocalVector(x, x_));
    if (!together_) {
      sweep(SOR_SYMMETRIC_SWEEP | SOR_ZERO_INITIAL_GUESS);
    } else {
      sweep(SOR_FORWARD_SWEEP | SOR_ZERO_INITIAL_GUESS);
      Vec of_b;
      require(MatMult(rows_, x_, r_));
      require(VecGetSubVector(b_, anchored_, &of_b));
      require(VecAYPX(r_, -1, of_b));
      require(VecRestoreSubVector(b_, anchored_, &of_b));
      require(KSPSolve(together_, r_, d_));
      require(VecISAXPY(x_, anchored_, 1, d_));
      sweep(SOR_BACKWARD_SWEEP);
    }
    require(VecRestoreLocalVector(x, x_));
    require(VecRestoreLocalVectorRead(b, b_));
  }

 private:
  void sweep(int directions) const { require(MatSOR(A_, b_, 1, static_cast<MatSORType>(directions), 0, 1, 1, x_)); }

  Mat A_ = nullptr;  // own rows and columns; the solver's
  IS anchored_;      // the transfers'
  PetscMatrix rows_;
  PetscVector x_, b_, r_, d_;
  PetscSolver together_;
};

/// Inexact Braess-Sarazin smoothing of one level, of a nested [A B^T; B -C], from zero.
class BraessSarazin {
 public:
  BraessSarazin(Mat system, IS anchored) : relaxation_(block_of(system, 0, 0), anchored) {
    const Mat A = block_of(system, 0, 0), minus_C = block_of(system, 1, 1);
    B_ = block_of(system, 1, 0);
    require(MatNestGetISs(system, fields_, nullptr));
    MPI_Comm communicator;
    require(PetscObjectGetComm(reinterpret_cast<PetscObject>(A), &communicator));
    PetscMatrix D, B_transposed;
    PetscInt rows;
    require(MatGetLocalSize(A, &rows, nullptr));
    require(MatCreate(communicator, &D));
    require(MatSetSizes(D, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
    require(MatSetType(D, MATAIJ));
    require(MatSetBlockSize(D, 3));
    require(MatInvertBlockDiagonalMat(A, D));
    require(MatTranspose(B_, MAT_INITIAL_MATRIX, &B_transposed));
    require(MatMatMult(D, B_transposed, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &DB_transposed_));
    require(MatScale(DB_transposed_, damped));
    require(MatMatMult(B_, DB_transposed_, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &S_));
    require(MatAXPY(S_, -1, minus_C, DIFFERENT_NONZERO_PATTERN));  // cells without a pressure have no row in B
    require(MatCreateVecs(S_, &r_, nullptr));
  }

  void apply(Vec b, Vec x) const {
    Vec f, g, u, p;
    require(VecGetSubVector(b, fields_[0], &f));
    require(VecGetSubVector(b, fields_[1], &g));
    require(VecGetSubVector(x, fields_[0], &u));
    require(VecGetSubVector(x, fields_[1], &p));
    const auto from_zero = static_cast<MatSORType>(SOR_LOCAL_SYMMETRIC_SWEEP | SOR_ZERO_INITIAL_GUESS);
    relaxation_.apply(f, u);
    require(MatMult(B_, u, r_));
    require(VecAXPY(r_, -1, g));
    require(MatSOR(S_, r_, 1, from_zero, 0, schur_sweeps, 1, p));
    require(VecScale(p, -1));
    require(MatMultAdd(DB_transposed_, p, u, u));
    require(VecScale(p, -1));
    require(VecRestoreSubVector(b, fields_[0], &f));
    require(VecRestoreSubVector(b, fields_[1], &g));
    require(VecRestoreSubVector(x, fields_[0], &u));
    require(VecRestoreSubVector(x, fields_[1], &p));
  }

 private:
  Relaxation relaxation_;
  Mat B_ = nullptr;  // the solver's
  IS fields_[2] = {};
  PetscMatrix DB_transposed_, S_;
  PetscVector r_;
};

/// Preconditions the smoother by `step`, which it then owns.
template <class Step>
void set_step(KSP smoother, std::unique_ptr<Step> step) {
  PC preconditioner;
  require(KSPGetPC(smoother, &preconditioner));
  require(PCSetType(preconditioner, PCSHELL));
  require(PCShellSetContext(preconditioner, step.release()));
  require(PCShellSetApply(preconditioner, [](PC pc, Vec b, Vec x) -> PetscErrorCode {
    void* context;
    require(PCShellGetContext(pc, &context));
    static_cast<const Step*>(context)->apply(b, x);
    return 0;
  }));
  require(PCShellSetDestroy(preconditioner, [](PC pc) -> PetscErrorCode {
    void* context;
    require(PCShellGetContext(pc, &context));
    delete static_cast<Step*>(context);
    return 0;
  }));
}

/// Preconditions a solver of the finest matrix by a V-cycle that smooths by `Step` and factorises the coarsest matrix.
/// @param interpolation (l) from level l + 1 to l, the finest being 0
/// @param coarsen (l, matrix of level l, whether the next is the coarsest) to that of level l + 1
template <class Step, class Interpolation, class Coarsen>
void set_cycle(KSP solver, Mat finest, const LatticeTransfers& transfers, Interpolation interpolation,
               Coarsen coarsen) {
  const auto coarser = static_cast<PetscInt>(transfers.displacements.size());
  PC cycle, direct;
  require(KSPGetPC(solver, &cycle));
  require(PCSetType(cycle, PCMG));
  require(PCMGSetLevels(cycle, coarser + 1, nullptr));
  require(PCMGSetGalerkin(cycle, PC_MG_GALERKIN_NONE));
  const auto smoother_of = [&](PetscInt l, Mat A) {  // PETSc numbers the levels from the coarsest
    KSP smoother;
    require(PCMGGetSmoother(cycle, coarser - l, &smoother));
    require(KSPSetOperators(smoother, A, A));
    return smoother;
  };
  PetscMatrix level;
  Mat fine = finest;
  for (PetscInt l = 0; l < coarser; ++l) {
    set_step(smoother_of(l, fine), std::make_unique<Step>(fine, transfers.anchored[l]));
    require(PCMGSetInterpolation(cycle, coarser - l, interpolation(l)));
    level = coarsen(l, fine, l + 1 == coarser);
    fine = level;
  }
  const KSP coarsest = smoother_of(coarser, fine);
  require(KSPSetType(coarsest, KSPPREONLY));
  require(KSPGetPC(coarsest, &direct));
  require(PCSetType(direct, PCREDUNDANT));
}

}  // namespace

void set_lattice_multigrid(KSP solver, Mat A, const LatticeTransfers& transfers, MPI_Comm communicator) {
  const auto& P = transfers.displacements;
  set_cycle<Relaxation>(
      solver, A, transfers, [&](PetscInt l) -> Mat { return P[l]; },
      [&](PetscInt l, Mat fine, bool coarsest) { return galerkin(fine, P[l], coarsest, communicator); });
}

void set_mixed_lattice_multigrid(KSP solver, Mat system, const LatticeTransfers& transfers, MPI_Comm communicator) {
  const auto& P = transfers.displacements;
  const auto& Q = transfers.pressures;
  const auto coarsen = [&](PetscInt l, Mat fine, bool coarsest) {
    const Mat A = block_of(fine, 0, 0), B = block_of(fine, 1, 0), minus_C = block_of(fine, 1, 1);
    PetscMatrix BP, coarse_B, coarse_B_transposed, factored;
    require(MatMatMult(B, P[l], MAT_INITIAL_MATRIX, PETSC_DEFAULT, &BP));
    require(MatTransposeMatMult(Q[l], BP, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &coarse_B));
    const PetscMatrix coarse_A = galerkin(A, P[l], coarsest, communicator),
                      coarse_minus_C = triple_product(minus_C, Q[l]);
    coarsest ? require(MatTranspose(coarse_B, MAT_INITIAL_MATRIX, &coarse_B_transposed))
             : require(MatCreateTranspose(coarse_B, &coarse_B_transposed));
    PetscMatrix level = nested(coarse_A, coarse_B_transposed, coarse_B, coarse_minus_C, communicator);
    if (!coarsest) return level;
    require(MatConvert(level, MATAIJ, MAT_INITIAL_MATRIX, &factored));
    return factored;
  };
  set_cycle<BraessSarazin>(
      solver, system, transfers, [&](PetscInt l) { return nested(P[l], nullptr, nullptr, Q[l], communicator); },
      coarsen);
}

}  // namespace springproof
