// Explicit dynamics of networks without a lattice, by the list kernels.
#pragma once

#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/wavefront.h"
#include "msm/kernels/list_forces.h"

namespace springproof {

struct ListMotionOptions {
  double time_step = 0;  ///< [s]
  double damping = 0;    ///< [1/s]
  bool lagged = false;   ///< dispersion uses the J of the previous step
  int threads = 1;       ///< they take the steps of advance() in turn, so a single step has one; at most one per three
                         ///< layers or so of nodes; momentum dispersion uses one
  InstructionSet instructions = instruction_set();
};

/// Time integration of a model: the steps of run_dynamics() (semi-implicit Euler, damping implicit) in the kernels'
/// order.  A node moves as soon as its forces are complete, and the next step starts before the first is finished
/// (run_steps()).
template <class Real>
class ListMotion {
 public:
  ListMotion(const MassSpringModel& model, const Eigen::VectorXd& inverse_mass, const ListMotionOptions& options);

  /// Sets the loads of the following steps; prescribed unknowns are moved at the end of the next step.
  void load(const BoundaryConditions& conditions);
  void place_prescribed();                                       ///< moves them at once
  void set_state(const NodalVectors& x, const NodalVectors& v);  ///< [m], [m/s]
  /// @return the norms at the beginning of the last step.
  ForceNorms advance(long steps);
  NodalVectors positions() const;   ///< [m]
  NodalVectors velocities() const;  ///< [m/s]
  int threads() const { return workers_->count(); }

 private:
  struct Held {
    int place, component;
    Real x;  ///< prescribed [m]
  };
  struct Squares {
    double unbalanced = 0, support = 0;  ///< [N^2]
  };

  Squares run(long steps);
  Squares dispersed_step();
  Squares move(int begin, int end, bool last);
  NodalVectors in_network_order(const std::vector<Padded<Real>>& v) const;

  ListForces<Real> forces_;
  Wavefront wavefront_;
  std::unique_ptr<Workers> workers_;
  NodalVectors X_;
  ListMotionOptions options_;
  double decay_;
  bool moved_ = false;
  std::vector<Padded<Real>> x_, s_, f_, external_;
  std::vector<Held> held_;  ///< sorted by place
};

extern template class ListMotion<double>;
extern template class ListMotion<float>;

}  // namespace springproof
