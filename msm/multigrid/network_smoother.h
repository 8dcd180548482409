// Smoother on the network itself: Chebyshev polynomials of the fourth kind with the node blocks of the stiffness at
// rest.
#pragma once

#include <memory>
#include <vector>

#include "msm/algebra/tangent.h"
#include "msm/kernels/list_stiffness.h"

namespace springproof {

/// Pre- and post-smoothing of a symmetric cycle for K x = b on the finest level; vectors of 3 n, fixed unknowns stay 0.
class NetworkSmoother {
 public:
  virtual ~NetworkSmoother() = default;

  /// Smooths from zero and stores x; r = b - K x.
  virtual void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) = 0;

  /// Adds the coarse correction to the stored x, smooths again, and returns x.
  virtual void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) = 0;
};

/// Matrix-free in single precision by `list`, the model's stiffness; null: with the assembled tangent.
std::unique_ptr<NetworkSmoother> network_smoother(const MassSpringModel& model, const std::vector<char>& fixed,
                                                  const ListStiffness<double>* list);

}  // namespace springproof
