// Smoother on the network itself: Chebyshev polynomials of the fourth kind with the node blocks of the stiffness at
// rest.
#pragma once

#include <memory>
#include <vector>

#include "msm/laws/laws.h"

namespace springproof {

/// The stiffness K at rest of a model and the smoothing of a symmetric cycle for K x = b on the network; vectors of 3
/// n, fixed unknowns of x stay 0.
class NetworkSmoother {
 public:
  virtual ~NetworkSmoother() = default;

  virtual void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const = 0;  ///< y = K x
  virtual Eigen::VectorXd diagonal() const = 0;                                   ///< of K

  /// Smooths from zero and stores x; r = b - K x.
  virtual void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) = 0;

  /// Adds the coarse correction to the stored x, smooths again, and returns x.
  virtual void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) = 0;
};

/// Matrix-free, smoothing in single precision, if ListStiffness covers the model; else with the assembled tangent.
std::unique_ptr<NetworkSmoother> network_smoother(const MassSpringModel& model, const std::vector<char>& fixed);

}  // namespace springproof
