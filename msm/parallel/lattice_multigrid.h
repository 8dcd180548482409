// Preconditioners for lattices on several processes: the multigrid of their own cells.
#pragma once

#include "msm/parallel/lattice_transfers.h"

namespace springproof {

/// Preconditions a solver of A x = b by a symmetric V-cycle: Galerkin's matrices P^T A P, Chebyshev's polynomials over
/// symmetric Gauss-Seidel within each process, which relaxes the unknowns at anchors together, and a factorisation on
/// the coarsest lattice.  The solver refers to the transfers.
/// @param A of the nodes with equations, symmetric positive definite
void set_lattice_multigrid(KSP solver, Mat A, const LatticeTransfers& transfers, MPI_Comm communicator);

/// Preconditions a solver of [A B^T; B -C] (u, p) = (f, g) by a V-cycle of both: Galerkin's matrices, and inexact
/// Braess-Sarazin smoothing (Braess and Sarazin 1997): Gauss-Seidel for A, then pressures q, (C + B D B^T) q = r by
/// Gauss-Seidel, that restore the volumes, D twice the inverse diagonal blocks of A.
/// @param system nested matrix; a pressure per cell
void set_mixed_lattice_multigrid(KSP solver, Mat system, const LatticeTransfers& transfers, MPI_Comm communicator);

}  // namespace springproof
