// What the lattice kernels work on: plain arrays, springs by their place in the lattice.
//
// Nodes stand at x + stride (y + rows z), x in blocks of as many nodes as the processor has lanes; lengths in cell
// edges. A spring belongs to the row that it starts from.  From each row go five pairs of rows: along the row itself,
// and to the rows at (y, z) + row_pairs[]; the last four hold up to three springs per node: straight (x to x), rising
// (x to x + 1) and falling (x + 1 to x).  Blocks with equal coefficients share one entry of a table, so there is no
// stiffness per spring.
#pragma once

namespace springproof {

constexpr int lattice_pairs = 5;
constexpr int lattice_directions = 13;  ///< along x; then straight, rising, falling of each other pair
constexpr int row_pairs[lattice_pairs][2] = {{0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};  ///< (dy, dz)
constexpr int kappa_coefficient =
    lattice_directions;  ///< after the spring constants: of the volume correction of cells
constexpr int hourglass_coefficient =
    kappa_coefficient + 1;  ///< how often a cell's hourglass modes are corrected: once or not
constexpr int lattice_coefficients = hourglass_coefficient + 1;
constexpr int flow_coefficients =
    2 * lattice_directions;           ///< per direction: at the start and at the end of its springs
constexpr int node_coefficients = 6;  ///< 1 / mass of the three unknowns (0 if fixed), external force

/// Blocks begin <= b < end of a row that have nodes.
struct LatticeRun {
  int begin, end;
  unsigned springs;  ///< bit d: there are springs of direction d
  unsigned flows;  ///< the same of those that take part in momentum dispersion; of a pair's, the straight ones with the
                   ///< others
  bool volume, hourglass;  ///< there are cells that start from this row and correct their volume, their hourglass modes
};

/// HourglassCorrection::Stiffness over 8, times the edge [N].  Real is float or double.
template <class Real>
struct LatticeHourglass {
  Real bending, coupling, torsion, torsion_coupling;
};

template <class Real>
struct LatticeView {
  Real* u[3];       ///< displacement [edges]
  Real* v[3];       ///< velocity [edges/s]
  long row, plane;  ///< from row to row, from plane to plane
  int rows;         ///< per plane
  int planes;
  int row_blocks;
  const int* first_run;  ///< per row and one more
  const LatticeRun* runs;
  const int* spring_entry;  ///< per block: where its coefficients start in `springs`
  const Real* springs;      ///< lattice_coefficients vectors per entry: k times edge [N], kappa edge^2 [N], 0 or 1
  const int* node_entry;
  const Real* nodes;  ///< node_coefficients vectors per entry: 1 / (mass edge), force [N]
  bool bounded;       ///< VolumeEnergy::bounded
  LatticeHourglass<Real> hourglass;
  Real* J;  ///< inflow of momentum dispersion, at row (y + rows z) + x; nullptr: there is none
  const int* inflow_entry;
  const Real* inflow;  ///< flow_coefficients vectors per entry, times elongations [edges]: what flows in
  const int* outflow_entry;
  const Real* outflow;  ///< the same, times J: tension [N]
  Real outflow_sign;
  Real* inverse_lengths;  ///< of the springs [1/edges], of so many planes by turns
  int kept_planes;
};

/// Planes of one thread.  Forces live in a ring of rows + 2 rows, three components each, all zero before a step; after
/// it only what the plane at `end` has got is left.
template <class Real>
struct LatticeSlab {
  int begin, end;
  Real* ring;
  Real* first;  ///< forces of the first plane, which waits for the slab below; nullptr: there is none below
};

enum class LatticeFinish { move, move_and_measure, store_forces };

template <class Real>
struct LatticeStep {
  LatticeFinish finish;
  Real time_step;  ///< [s]
  Real decay;      ///< 1 / (1 + damping * time_step)
  Real* force[3];  ///< where forces are stored [N]
};

/// Sums over the nodes of |force|^2 [N^2] at free and at fixed unknowns.
struct LatticeSums {
  double free, fixed;
};

template <class Real>
struct LatticeKernels {
  int lanes;
  /// Adds what the springs of the nodes of plane z flow in to J, of this plane and the next, and keeps their inverse
  /// lengths.
  void (*inflow)(const LatticeView<Real>&, int z);
  /// Forces of planes begin <= z < end and the motion of those rows that have all of theirs.
  void (*sweep)(const LatticeView<Real>&, const LatticeSlab<Real>&, int begin, int end, const LatticeStep<Real>&,
                LatticeSums&);
  /// The first plane of a slab, once the slab below is swept.
  void (*finish_first)(const LatticeView<Real>&, const LatticeSlab<Real>&, const LatticeSlab<Real>& below,
                       const LatticeStep<Real>&, LatticeSums&);
};

namespace portable {
void get_lattice_kernels(LatticeKernels<float>&);
void get_lattice_kernels(LatticeKernels<double>&);
}  // namespace portable
namespace avx2 {
void get_lattice_kernels(LatticeKernels<float>&);
void get_lattice_kernels(LatticeKernels<double>&);
}  // namespace avx2
namespace avx512 {
void get_lattice_kernels(LatticeKernels<float>&);
void get_lattice_kernels(LatticeKernels<double>&);
}  // namespace avx512

}  // namespace springproof
