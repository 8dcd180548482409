// Smoothing on a network itself: Chebyshev polynomials of the fourth kind over the node blocks of the stiffness at
// rest.
#pragma once

#include <memory>
#include <vector>

#include "msm/algebra/tangent.h"
#include "msm/kernels/list_stiffness.h"

namespace springproof {

/// The two halves of a symmetric cycle K x = b on the finest level; vectors of 3 n, fixed unknowns stay 0.
class NetworkSmoother {
 public:
  virtual ~NetworkSmoother() = default;

  /// Smooths from zero and keeps x; r = b - K x.
  virtual void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) = 0;

  /// Adds the coarse correction to the x kept, smooths again, and gives x.
  virtual void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) = 0;
};

/// In single precision over the list of the model's stiffness; `list` null: over the assembled tangent.
std::unique_ptr<NetworkSmoother> network_smoother(const MassSpringModel& model, const std::vector<char>& fixed,
                                                  const ListStiffness<double>* list);

}  // namespace springproof
