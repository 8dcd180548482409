// The transfers of a lattice's own multigrid as matrices of PETSc, each process with the rows of its own points.
#pragma once

#include <vector>

#include "msm/parallel/petsc.h"
#include "msm/topology/network.h"

namespace springproof {

/// From each coarser lattice to the next finer one, finest first.  All empty: the network is no lattice.
struct LatticeTransfers {
  /// Weights of the coarser points, 3 x 3 blocks; zero in fixed unknowns.  Of the finest level the rows are those of
  /// the nodes with equations (number_equations).
  std::vector<PetscMatrix> displacements;
  std::vector<PetscMatrix> pressures;  ///< of cells: 1 in the column of the cell that contains each
  /// Own unknowns, from 0, of nodes and points at anchors, which are stiffer than others; on all but the coarsest
  /// level.
  std::vector<PetscIndices> anchored;
};

/// Transfers of the lattices of doubled edge below a network of cubes, whole, cut or of several sizes (cut_levels):
/// weights of the corners of the coarser cell, of an anchored node those of the place that it holds.  A coarse point or
/// cell is the process' of the finer one that follows it most; without one it has no equation.
/// @param network the same on every process
/// @param fixed per unknown of the network, carried ones included
/// @param nodes process of each node, -1: it has no equation
/// @param cells process of each cell with a pressure; empty: there are no pressures of cells
LatticeTransfers lattice_transfers(const Network& network, const std::vector<char>& fixed,
                                   const std::vector<int>& nodes, const std::vector<int>& cells, MPI_Comm communicator);

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
