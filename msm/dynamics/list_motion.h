// Explicit dynamics by the list kernels: networks without a lattice, and cells that the body may fill in part.
#pragma once

#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/mass_average.h"
#include "msm/dynamics/wavefront.h"
#include "msm/kernels/block_forces.h"

namespace springproof {

struct ListMotionOptions {
  double time_step = 0;  ///< [s]
  double damping = 0;    ///< [1/s]
  bool lagged = false;   ///< dispersion uses the J of the previous step
  int threads = 1;       ///< they take the steps of advance() in turn, so a single step has one; at most one per three
                         ///< layers or so of nodes; momentum dispersion, carried nodes and a share of consistent
                         ///< mass use one
};

/// Time integration: the steps of run_dynamics() (semi-implicit Euler, damping implicit) in the kernels' order.  A node
/// moves as soon as its forces are complete, and the next step starts before the first is finished (run_steps()).
template <class Real>
class ListMotion {
 public:
  /// At rest at X [m].  Nodes without mass [1/kg] must be held.  With a share of consistent mass velocities are momenta
  /// over lumped masses.
  ListMotion(std::unique_ptr<BlockForces<Real>> forces, const NodalVectors& X, const Eigen::VectorXd& inverse_mass,
             const ListMotionOptions& options, const MassAverage& average = {});

  /// Sets the loads of the following steps; prescribed unknowns are moved at the end of the next step.
  void load(const BoundaryConditions& conditions);
  void place_prescribed();                                       ///< moves them at once
  void set_state(const NodalVectors& x, const NodalVectors& v);  ///< [m], [m/s]
  /// @return the norms at the beginning of the last step.
  ForceNorms advance(long steps);
  NodalVectors positions() const;   ///< [m]
  NodalVectors velocities() const;  ///< [m/s]
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
  void move_prescribed();
  NodalVectors in_network_order(const std::vector<Padded<Real>>& v) const;

  std::unique_ptr<BlockForces<Real>> forces_;
  std::vector<int> order_;  ///< node at each place
  Wavefront wavefront_;
  std::unique_ptr<Workers> workers_;
  NodalVectors X_, origin_;  ///< [m]; x_ is counted from the second
  ListMotionOptions options_;
  double decay_;
  bool moved_ = false;
  std::vector<Padded<Real>> x_, s_, f_, external_;
  std::vector<Held> held_;  ///< sorted by place
  // Of a share of consistent mass; empty without.
  std::vector<int> corners_;  ///< CellAverages
  std::vector<Real> factors_, shares_;
  std::vector<Padded<Real>> v_;  ///< velocities over the step [m/s]
};

extern template class ListMotion<double>;
extern template class ListMotion<float>;

}  // namespace springproof
