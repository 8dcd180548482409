// Forces and explicit steps of networks without a lattice, by the list kernels.
#pragma once

#include <vector>

#include "msm/boundary.h"
#include "msm/kernels/instruction_set.h"
#include "msm/kernels/spring_blocks.h"
#include "msm/laws/laws.h"

namespace springproof {

/// The kernels of an instruction set.
template <class Real>
const ListKernels<Real>& list_kernels(InstructionSet set);

/// What momentum dispersion needs beside the springs.
template <class Real>
struct ListDispersionData {
  std::vector<Real> a_i, a_j, c_i, c_j;  ///< per entry
  std::vector<int> sink;                 ///< per place the place whose J takes its springs' flow; empty: its own

  ListDispersionData(const MomentumDispersion& law, const Network& network, const SpringBlocks& blocks);

  template <class Other>
  explicit ListDispersionData(const ListDispersionData<Other>& other);

  ListDispersion<Real> arrays() const { return {a_i.data(), a_j.data(), c_i.data(), c_j.data()}; }
  void share(std::vector<Real>& J) const;  ///< gives all members of a group the group's J
};

/// The internal forces of a model of springs, with or without momentum dispersion; the model may go.
/// Real = double: as laws::add_forces() to 1e-12 of the largest force; float: 1e-5 at strains of a few percent.
template <class Real>
class ListForces {
 public:
  /// Whether the model consists of nothing else.  Periodic images are nodes like others, whose inflows add up.
  static bool covers(const MassSpringModel& model);

  /// @throws std::invalid_argument if covers() is false.
  explicit ListForces(const MassSpringModel& model, InstructionSet set = instruction_set());

  /// f = internal forces [N] at x [m], in the network's order.
  void at(const NodalVectors& x, NodalVectors& f);

  /// f += internal forces, by place.  `lagged`: nodes disperse the J of the call before.
  void add(const Padded<Real>* x, Padded<Real>* f, bool lagged = false);

  const SpringBlocks& blocks() const { return blocks_; }
  const ListKernels<Real>& kernels() const { return *kernels_; }

 private:
  const ListKernels<Real>* kernels_;
  SpringBlocks blocks_;
  std::vector<Real> k_, kL_, L_;
  std::vector<ListDispersionData<Real>> dispersion_;  ///< one or none
  std::vector<Real> J_, old_J_, inverse_length_;
  std::vector<Padded<Real>> x_, f_;
};

/// A model in motion: the steps of run_dynamics() (semi-implicit Euler, damping implicit) in the order of the kernels.
template <class Real>
class ListMotion {
 public:
  ListMotion(const MassSpringModel& model, const Eigen::VectorXd& inverse_mass, double time_step, double damping,
             bool lagged = false, InstructionSet set = instruction_set());

  /// Loads from here on; prescribed unknowns are moved at the end of the next step.
  void load(const BoundaryConditions& conditions);
  void place_prescribed();           ///< moves them at once
  SquaredForces step();
  NodalVectors positions() const;    ///< [m]
  NodalVectors velocities() const;   ///< [m/s]

 private:
  NodalVectors in_network_order(const std::vector<Padded<Real>>& v) const;

  ListForces<Real> forces_;
  NodalVectors X_;
  Eigen::VectorXd inverse_mass_;
  double time_step_, damping_;
  bool lagged_, moved_ = false;
  std::vector<Padded<Real>> x_, v_, f_, gain_, external_, prescribed_;
};

extern template class ListForces<double>;
extern template class ListForces<float>;
extern template class ListMotion<double>;
extern template class ListMotion<float>;

}  // namespace springproof
