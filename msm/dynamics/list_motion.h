// Explicit dynamics by the list kernels: networks without a lattice, and cells that the body may fill in part.
#pragma once

#include <functional>

#include "msm/dynamics/motion.h"
#include "msm/dynamics/terms/mass_average.h"
#include "msm/kernels/block_forces.h"
#include "msm/kernels/workers.h"

namespace springproof {

/// Partition of the blocks into pieces, in their order.  A node is complete when all blocks that touch it have been
/// computed; a piece of the next step may be computed as soon as all nodes it touches are complete, which is `lag`
/// pieces later.
struct Wavefront {
  std::vector<long> begin;    ///< first block of each piece, and the end
  std::vector<int> complete;  ///< nodes below are complete before the piece; one more: all nodes
  long lag = 1;               ///< [pieces] a step has computed piece c + lag - 1 before the next computes piece c

  explicit Wavefront(const BlockPlan& plan);

  long pieces() const { return static_cast<long>(begin.size()) - 1; }
};

/// Computes one piece of one step, its blocks first and then the nodes that it completes.  Must not throw.
using PieceOfStep = std::function<void(long step, long piece)>;

/// Computes all pieces of steps 0, 1, ...: one thread computes two steps at a time, so that the second finds in the
/// cache what the first has fetched; several threads take the steps in turn.  The order of the pieces of a step does
/// not depend on the number of threads, and neither does the result, to the last bit.
void run_steps(const Wavefront& wavefront, long steps, Workers& workers, const PieceOfStep& compute);

/// The steps of PlainMotion in the kernels' order.  A node moves as soon as its forces are complete, and the next step
/// starts before the first is finished (run_steps()).
template <class Real>
class ListMotion : public Motion {
 public:
  /// @param forces of the model
  /// @param model a model; nodes without mass must be held
  /// @param density [kg/m^3]
  /// @param options with a time step, of which damping, mass_consistency and lagged are read, and threads.  These take
  ///   the steps of advance() in turn, so a single step has one; at most one per three layers or so of nodes; momentum
  ///   dispersion, carried nodes and a share of consistent mass use one
  ListMotion(std::unique_ptr<BlockForces<Real>> forces, const MassSpringModel& model, double density,
             const MotionOptions& options);

  void set_conditions(const BoundaryConditions& conditions) override;
  void move_supports() override;
  void set_state(const NodalVectors& x, const NodalVectors& v) override;
  void relax() override;
  NodalVectors relaxing_forces() const override;
  std::optional<BranchEnergies> branch_energies() const override;
  ForceNorms advance(long steps) override;
  NodalVectors positions() const override;
  NodalVectors velocities() const override;
  std::string description() const override;

  int threads() const { return workers_->count(); }
  std::string kernel() const { return forces_->name(); }

 private:
  struct Held {
    int place, component;
    Real x;  ///< prescribed place [m]
  };
  struct Squares {
    double unbalanced = 0, support = 0;  ///< [N^2]
  };

  Squares run(long steps);
  Squares whole_step();
  void set_up(const MassAverage& average);
  void move_by_averages();
  Squares move(int begin, int end, bool apart);
  void move_with_speed();
  void watch_branches(double duration);
  NodalVectors in_network_order(const std::vector<Padded<Real>>& v) const;

  std::unique_ptr<BlockForces<Real>> forces_;
  std::vector<int> order_;  ///< node at each place
  Wavefront wavefront_;
  std::unique_ptr<Workers> workers_;
  const Network& network_;
  NodalVectors origin_;  ///< [m], that x_ is counted from
  InstructionSet instructions_;
  double time_step_, decay_;
  bool lagged_, supports_wait_ = false;
  std::vector<Padded<Real>> x_, s_, f_, external_;
  std::vector<Held> held_;                 ///< sorted by place
  std::vector<RelaxationBranch> watched_;  ///< branches whose energies are asked for
  BranchEnergies energies_;
  double power_ = 0;  ///< that they dissipate [W]
  // Of a share of consistent mass; empty without.
  std::vector<int> corners_;  ///< CellAverages
  std::vector<Real> factors_, shares_;
  std::vector<Padded<Real>> v_;  ///< velocities over the step [m/s]
};

extern template class ListMotion<double>;
extern template class ListMotion<float>;

/// By the kernels for lists of springs or of cells; nullptr: these lack the model or an option.
/// @param model a model, to which a reference is kept
/// @param density [kg/m^3]
/// @param options with a time step
/// @return the motion, at rest at X
std::unique_ptr<Motion> list_motion(const MassSpringModel& model, double density, const MotionOptions& options);

}  // namespace springproof
