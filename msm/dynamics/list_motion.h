// Explicit dynamics by the list kernels: networks without a lattice, and cells that the body may fill in part.
#pragma once

#include "msm/dynamics/motion.h"
#include "msm/dynamics/terms/mass_average.h"
#include "msm/dynamics/wavefront.h"
#include "msm/kernels/block_forces.h"

namespace springproof {

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
