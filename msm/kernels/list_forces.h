// Forces of networks without a lattice, by the list kernels.
#pragma once

#include <vector>

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

  /// f += forces of the springs of some blocks only, by place; nothing is dispersed.
  void add_springs(long begin, long end, const Padded<Real>* x, Padded<Real>* f) const;

  bool disperses() const { return !dispersion_.empty(); }
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

extern template class ListForces<double>;
extern template class ListForces<float>;

}  // namespace springproof
