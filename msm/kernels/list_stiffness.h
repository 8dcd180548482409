// Matrix-free stiffness at rest of networks without a lattice, by the list kernels: one vector per spring instead of
// 3x3 blocks.
#pragma once

#include <memory>
#include <vector>

#include "msm/kernels/list_forces.h"

namespace springproof {

/// K = sum m m^T over the springs, m = sqrt(k) times the direction, + outflow^T inflow of momentum dispersion.
template <class Real>
class ListStiffness {
 public:
  /// @throws std::invalid_argument without Capability::list_stiffness.
  ListStiffness(const MassSpringModel& model, std::shared_ptr<const SpringBlocks> blocks,
                InstructionSet set = instruction_set());

  /// Copy of another operator, in units of `unit` [N/m].
  template <class Other>
  ListStiffness(const ListStiffness<Other>& other, double unit);

  /// y += K u, by place.
  void add(const Padded<Real>* u, Padded<Real>* y) const;

  /// y = K u, vectors of 3 n in the network's order.
  void multiply(const Eigen::VectorXd& u, Eigen::VectorXd& y) const;

  /// The diagonal 3x3 block of the node at each place [N/m].
  std::vector<Eigen::Matrix3d> node_blocks() const;

  /// Of K, 3 n in the network's order [N/m].
  Eigen::VectorXd diagonal() const;

  std::shared_ptr<const SpringBlocks> blocks() const { return blocks_; }
  const ListKernels<Real>& kernels() const { return *kernels_; }

 private:
  template <class Other>
  friend class ListStiffness;
  void add_flow_blocks(std::vector<Eigen::Matrix3d>& blocks) const;

  InstructionSet set_;
  const ListKernels<Real>* kernels_;
  std::shared_ptr<const SpringBlocks> blocks_;
  std::vector<Padded<Real>> m_;
  std::vector<ListDispersionData<Real>> dispersion_;  ///< one or none
  mutable std::vector<Real> J_, kept_;
  mutable std::vector<Padded<Real>> u_, y_;
};

extern template class ListStiffness<double>;
extern template class ListStiffness<float>;

}  // namespace springproof
