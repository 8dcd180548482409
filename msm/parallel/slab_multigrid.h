// Static equilibrium of a block lattice distributed over MPI processes in slabs across its last axis, with PETSc.
#pragma once

#include <mpi.h>

#include "msm/dynamics/lattice_motion.h"
#include "msm/multigrid/multigrid.h"

namespace springproof {

/// The planes of one level on this process: its own and the ghost planes on either side, which others own.
struct SlabLevel {
  LatticeLevel lattice;
  int own_begin = 0, own_end = 0;  ///< its own planes of points, counted from the lattice's first

  long own_first() const { return lattice.point_begin[own_begin]; }
  long own_points() const { return lattice.point_begin[own_end] - own_first(); }
};

/// Exchange of the ghost planes of a slab with the processes that own them.
class PlaneExchange {
 public:
  PlaneExchange(const SlabLevel& level, MPI_Comm communicator);
  template <class Real>
  void complete(Real* field) const;            ///< a nodal field of the level
  void complete(LatticeMotion& motion) const;  ///< positions and velocities

 private:
  /// Sends the outermost own planes and receives the ghost planes: pack(begin, end, buffer) and unpack of points begin
  /// ... end.
  template <class Real, class Pack, class Unpack>
  void exchange(int values_per_point, Pack pack, Unpack unpack) const;

  const SlabLevel* level_;
  MPI_Comm communicator_;
  int below_, above_;  ///< processes, MPI_PROC_NULL at the ends
};

/// Distribution of a block: each process owns whole planes of cells of the coarsest level in slabs.
struct SlabPartition {
  std::array<int, 3> cells{};
  int levels = 0;              ///< number of levels in slabs; the lattice below them is replicated on every process
  int z_begin = 0, z_end = 0;  ///< own planes of cells of that lattice

  /// @throws std::invalid_argument if there are more processes than planes to share.
  SlabPartition(const std::array<int, 3>& block_cells, MPI_Comm communicator);
  SlabLevel level(int l, MPI_Comm communicator) const;
};

/// Displacement form of HybMSS (the cycle of Multigrid): distributed levels of slabs above, the rest of the hierarchy
/// replicated on every process.
class SlabMultigrid {
 public:
  /// `fixed`: per unknown 3 * point + axis of this process' finest level.
  SlabMultigrid(const SlabPartition& partition, const std::vector<char>& fixed, const CellMatrix& cell,
                MPI_Comm communicator);

  const SlabLevel& finest() const { return slabs_[0]; }
  /// Solves K u = b, u = 0 on fixed unknowns; nodal fields of the finest level, valid on own points, u also on ghost
  /// planes.
  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u);
  /// y = K x on own points; updates the ghost planes of x.
  void multiply(Eigen::VectorXd& x, Eigen::VectorXd& y);
  /// z = M^-1 r on own points.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z);

 private:
  void cycle(int l);
  void cycle_below();
  long place_below() const;
  void gather_fixed(LatticeLevel& whole) const;

  MPI_Comm communicator_;
  double unit_ = 1;
  std::vector<SlabLevel> slabs_;  ///< the last is this process' part of the lattice below
  std::vector<PlaneExchange> exchanges_;
  std::vector<SmoothingLevel> levels_;
  Eigen::VectorXf below_r_, below_x_;
  std::unique_ptr<Multigrid> below_;
  std::vector<int> counts_, begins_;  ///< own points of each process in the lattice below
  std::unique_ptr<LatticeOperator<double>> K_;
};

}  // namespace springproof
