// Interface of the kernels for lists of springs, of networks without a lattice, and of cells, which the body may fill
// in part, on plain arrays.
#pragma once

#include "msm/kernels/lattice_kernels.h"

namespace springproof {

/// A node's vector, the fourth number 0.
template <class Real>
struct alignas(4 * sizeof(Real)) Padded {
  Real v[4];
};

constexpr int block_springs = 4;    ///< springs of a block, all from the same node i
constexpr int blocks_together = 4;  ///< the number of blocks is a multiple of it

/// Springs in blocks; entry 4 b + l is lane l of block b.  An unused lane repeats another's nodes with zero
/// coefficients.
struct ListPattern {
  long blocks = 0;
  const int* i = nullptr;  ///< per block
  const int* j = nullptr;  ///< per entry
};

/// Nonlinear springs, per entry.
template <class Real>
struct ListSprings {
  const Real* k = nullptr;   ///< [N/m]
  const Real* kL = nullptr;  ///< stiffness times rest length [N]
  const Real* L = nullptr;   ///< rest length [m]; used by dispersion only
};

/// Momentum dispersion, per entry: J_n = sum a e over the springs at n, tension += c_i J_i + c_j J_j.
template <class Real>
struct ListDispersion {
  const Real* a_i = nullptr;
  const Real* a_j = nullptr;
  const Real* c_i = nullptr;
  const Real* c_j = nullptr;
};

/// One step of semi-implicit Euler on nodes whose forces are complete: s + external = v / gain, x += dt v, and for the
/// next step s = decay (s + external), to which its forces are added.  No separate array of forces is needed.
template <class Real>
struct ListStep {
  long nodes = 0;
  Real dt = 0, decay = 1;                  ///< decay = 1 / (1 + dt damping)
  const Padded<Real>* external = nullptr;  ///< [N]; the fourth number is the gain dt / m / (1 + dt damping)
  Padded<Real>* x = nullptr;
  Padded<Real>* s = nullptr;  ///< [N]
  Padded<Real>* f = nullptr;  ///< internal forces if they are not yet added to s, else nullptr; zeroed
};

/// One step of a Chebyshev smoother over 3x3 node blocks D: r -= y, z = old z + new D^-1 r, x += z, y = 0.
template <class Real>
struct ListSmoothing {
  long nodes = 0;
  Real old_part = 0, new_part = 0;
  const Padded<Real>* inverse = nullptr;  ///< three rows per node
  Padded<Real>* y = nullptr;
  Padded<Real>* r = nullptr;
  Padded<Real>* z = nullptr;
  Padded<Real>* x = nullptr;
};

/// Correction of a step for a share of consistent mass: corners of cells move on, x += factor share (v - average of v
/// over the cell), as a trilinear field is averaged with consistent mass.
template <class Real>
struct CellAverages {
  long cells = 0;
  const int* corners = nullptr;     ///< places; eight of each cell, at x + 2 y + 4 z
  const Real* factors = nullptr;    ///< of cells [s]
  const Real* shares = nullptr;     ///< of places
  const Padded<Real>* v = nullptr;  ///< [m/s]
  Padded<Real>* x = nullptr;
};

template <class Real>
struct ListKernels {
  /// f += forces of the springs at x.
  void (*spring_forces)(const ListPattern&, const ListSprings<Real>&, const Padded<Real>* x, Padded<Real>* f);
  /// J += sum a e; stores 1 / length per entry.
  void (*inflow)(const ListPattern&, const ListSprings<Real>&, const ListDispersion<Real>&, const Padded<Real>* x,
                 Real* J, Real* inverse_length);
  /// f += forces of springs and dispersion together, with the inverse lengths of inflow() at the same x.
  void (*dispersed_forces)(const ListPattern&, const ListSprings<Real>&, const ListDispersion<Real>&,
                           const Padded<Real>* x, const Real* J, const Real* inverse_length, Padded<Real>* f);
  /// Sum of (f + external)^2 [N^2]; 0 without f.
  double (*step)(const ListStep<Real>&);
  void (*average)(const CellAverages<Real>&);

  // Small displacements u about a state; m = sqrt(k) times the direction, per entry.
  /// y += sum m (m . du).
  void (*stiffness)(const ListPattern&, const Padded<Real>* m, const Padded<Real>* u, Padded<Real>* y);
  /// J += sum a t, t = m . du stored per entry.
  void (*linear_inflow)(const ListPattern&, const Padded<Real>* m, const ListDispersion<Real>&, const Padded<Real>* u,
                        Real* J, Real* t);
  /// y += sum m (t + c_i J_i + c_j J_j).
  void (*linear_forces)(const ListPattern&, const Padded<Real>* m, const ListDispersion<Real>&, const Real* J,
                        const Real* t, Padded<Real>* y);
  void (*smooth)(const ListSmoothing<Real>&);
};

/// What is stored of a cell of edge l, of FilledPart: alpha l^2 [m^2], c / 2, p and rho [1] (AveragedSprings), 1 / l
/// [1/m].
namespace cell_number {
constexpr int area = 0, mean = 1, mixed = 4, variance = 7, per_edge = 10, count = 11;
constexpr int of_form = 171;  ///< MeasuredCells
}  // namespace cell_number

/// A branch that relaxes, over a step (problem/relaxation.h): of strains E it keeps P, P <- decay P + E, and share Q =
/// gain E - loss P before that, at the end of the step; gain = share phi, loss = gain (1 - decay).
template <class Real>
struct CellBranch {
  Real share, decay, gain, loss;
};
/// Strains that branches follow: twice the deviatoric strain, whose third entry is minus the first two, and the
/// hourglass components over the edge [1]; of measured cells their deformations [m] likewise.
constexpr int overstrain_count = 17;

/// Cells in blocks of as many as a kernel computes together; an unused place of the last block repeats a cell without
/// volume.
template <class Real>
struct CellList {
  long blocks = 0;
  const int* corners = nullptr;   ///< places; per block those of each corner x + 2 y + 4 z in turn
  const Real* numbers = nullptr;  ///< per block each of cell_number in turn
  const Real* forms = nullptr;    ///< of measured cells: per block each number of MeasuredCells::form in turn [N/m]
  LatticeAveraged<Real> springs = {};   ///< moduli, hourglass stiffness times G / 8 [Pa]; of measured cells no curve
  LatticeAveraged<Real> dashpots = {};  ///< the same times the time of retardation [s]; without a curve
  Real retardation = 0;                 ///< this time, for the forms
  LatticeAveraged<Real> relaxing = {};  ///< long-time moduli of the branches; without a curve; not of measured cells
  /// Of branches beside averaged springs, whose long-time moduli but for bending are theirs: bending modes of
  /// overstrains V resist as `own` V + `other` (V of the other mode of the plane) of the springs would.
  struct {
    Real own = 1, other = 0;
  } bending_of_branches = {};
  int branch_count = 0;
  const CellBranch<Real>* branches = nullptr;
  Real* overstrains = nullptr;      ///< per vector of cells and branch each of overstrain_count in turn
  bool boxes = false;               ///< full cells that are no cubes: l that of the cube of their volume, rho p_i^2
  Real proportions[3] = {1, 1, 1};  ///< CellSet::proportions
  Real per_proportion[3] = {1, 1, 1};
};

template <class Real>
struct CellListKernels {
  int cells;  ///< of a block
  int lanes;  ///< of a vector
  /// f += forces of the cells at displacements u [m], and of dashpots: velocities are s times the fourth number of u;
  /// null s: no dashpots.  The branches' overstrains become those of the end of the step.
  void (*forces)(const CellList<Real>&, const Padded<Real>* u, const Padded<Real>* s, Padded<Real>* f);
  /// stored += energies [J] of the branches, one of each, at displacements u at the end of a step.
  void (*branch_energies)(const CellList<Real>&, const Padded<Real>* u, double* stored);
};

}  // namespace springproof
