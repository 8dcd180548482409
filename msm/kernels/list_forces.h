// Forces of networks without a lattice, by the list kernels.
#pragma once

#include <vector>

#include "msm/kernels/instruction_set.h"
#include "msm/kernels/spring_blocks.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Coefficients of momentum dispersion.
template <class Real>
struct ListDispersionData {
  std::vector<Real> a_i, a_j, c_i, c_j;  ///< per entry
  std::vector<int> sink;                 ///< per place, the place whose J receives its springs' inflow; empty: its own

  ListDispersionData(const MomentumDispersion& law, const Network& network, const SpringBlocks& blocks);

  template <class Other>
  explicit ListDispersionData(const ListDispersionData<Other>& other);

  ListDispersion<Real> arrays() const { return {a_i.data(), a_j.data(), c_i.data(), c_j.data()}; }
  void share(std::vector<Real>& J) const;  ///< assigns the sum of J over a group to all its members
};

/// Internal forces of a model of springs, with or without momentum dispersion; keeps no reference to the model.
/// Real = double: equal to forces() (msm/laws/laws.h) to 1e-12 of the largest force; float: 1e-5 at strains of a few
/// percent.
template <class Real>
class ListForces : public BlockForces<Real> {
 public:
  /// Periodic images are treated as nodes, whose inflows are summed.
  /// @throws std::invalid_argument without Capability::list_kernels.
  explicit ListForces(const MassSpringModel& model, InstructionSet set = instruction_set());

  /// f = internal forces [N] at x [m], in the network's order.
  void at(const NodalVectors& x, NodalVectors& f);

  std::string name() const override { return "list kernel"; }
  BlockPlan plan() const override { return blocks_.plan(); }
  const ListKernels<Real>& kernels() const override { return *kernels_; }
  NodalVectors origin() const override { return NodalVectors::Zero(blocks_.nodes(), 3); }
  void add(const Padded<Real>* x, const Padded<Real>* s, Padded<Real>* f, bool lagged) override;
  void add_blocks(long begin, long end, const Padded<Real>* x, const Padded<Real>* s, Padded<Real>* f) override;
  bool coupled() const override { return !dispersion_.empty(); }

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
