// Interface of the lattice kernels: plain arrays, with springs stored by their position in the lattice.
//
// Node (x, y, z) is stored at x + row y + plane z, x in blocks of as many nodes as the processor has lanes; lengths in
// cell edges.  A spring belongs to the row that it starts from.  Each row forms five pairs, with itself and with the
// rows at (y, z) + row_pairs[]; the last four hold up to three springs per node: straight (x to x), rising (x to x + 1)
// and falling (x + 1 to x).  Blocks with equal coefficients share one entry of a table, so there is no stiffness per
// spring.
#pragma once

namespace springproof {

constexpr int lattice_pairs = 5;
constexpr int lattice_directions = 13;  ///< along x; then straight, rising, falling of each other pair
constexpr int row_pairs[lattice_pairs][2] = {{0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};  ///< (dy, dz)
constexpr int kappa_coefficient =
    lattice_directions;  ///< after the spring constants: of the volume correction of cells
constexpr int hourglass_coefficient =
    kappa_coefficient +
    1;  ///< 1 if a cell's hourglass modes are corrected, its springs averaged or there are dashpots in it, else 0
constexpr int lattice_coefficients = hourglass_coefficient + 1;
constexpr int flow_coefficients =
    2 * lattice_directions;           ///< per direction: at the start and at the end of its springs
constexpr int node_coefficients = 6;  ///< 1 / mass of the three unknowns (0 if fixed), external force

/// Blocks begin <= b < end of a row that have nodes.
struct LatticeRun {
  int begin, end;
  unsigned springs;  ///< bit d: there are springs of direction d
  unsigned flows;    ///< the same for springs with momentum dispersion; within a pair, the straight ones whenever the
                     ///< others are marked
  bool volume, hourglass;  ///< there are cells that start from this row and correct their volume; and what
                           ///< hourglass_coefficient says
};

/// HourglassCorrection::Stiffness over 8, times the edge [N].  Real is float or double.
template <class Real>
struct LatticeHourglass {
  Real bending, coupling, torsion, torsion_coupling;
};

/// The strain curves of msm/laws/strain_energy.h that the kernels have.
enum class LatticeCurve { none, hencky, neo_hooke, neo_hooke_isochoric };

/// Averaged springs: moduli, and AveragedSprings::hourglass times G / 8; in a lattice all times edge^2 [N].
template <class Real>
struct LatticeAveraged {
  LatticeCurve curve;
  Real shear, lambda, bulk;
  Real bending, coupling, torsion, twist, warping;
};

template <class Real>
struct LatticeView {
  Real* u[3];       ///< displacement [edges]
  Real* v[3];       ///< velocity [edges/s]
  long row, plane;  ///< strides from row to row, from plane to plane
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
  bool corrected;  ///< hourglass modes are, by `hourglass`
  LatticeAveraged<Real> averaged;
  bool viscous;                    ///< cells have `dashpots`
  LatticeAveraged<Real> dashpots;  ///< the constants of Viscosity::cells times its time [N s]; without a curve
  Real* J;                         ///< inflow of momentum dispersion, at row (y + rows z) + x; nullptr: there is none
  const int* inflow_entry;
  const Real* inflow;  ///< flow_coefficients vectors per entry, times elongations [edges]: the inflow
  const int* outflow_entry;
  const Real* outflow;  ///< the same, times J: tension [N]
  Real outflow_sign;
  Real* inverse_lengths;  ///< of the springs [1/edges], in a ring of kept_planes planes
  int kept_planes;
};

/// Planes of one thread.  Forces are kept in a ring of rows + 2 rows, three components each, all zero before a step;
/// after it only the contributions to the plane at `end` are left.
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

/// The correction of a step for a share of consistent mass, on a box of full cells.
template <class Real>
struct LatticeAverage {
  int nodes;    ///< of a row
  Real factor;  ///< share times time step [s]
  Real* work;   ///< three planes and two vectors more than a row, all of whole vectors
};

/// Sums over the nodes of |force|^2 [N^2] at free and at fixed unknowns.
struct LatticeSums {
  double free, fixed;
};

template <class Real>
struct LatticeKernels {
  int lanes;
  /// Adds the inflow of the springs that start in plane z to J of this plane and the next, and stores their inverse
  /// lengths.
  void (*inflow)(const LatticeView<Real>&, int z);
  /// Computes the forces of planes begin <= z < end and moves the rows whose forces are complete.
  void (*sweep)(const LatticeView<Real>&, const LatticeSlab<Real>&, int begin, int end, const LatticeStep<Real>&,
                LatticeSums&);
  /// Completes and moves the first plane of a slab, once the slab below is swept.
  void (*finish_first)(const LatticeView<Real>&, const LatticeSlab<Real>&, const LatticeSlab<Real>& below,
                       const LatticeStep<Real>&, LatticeSums&);
  /// u += factor (v - average of v over the cells) on planes begin <= z < end.
  void (*average)(const LatticeView<Real>&, const LatticeAverage<Real>&, int begin, int end);
};

}  // namespace springproof
