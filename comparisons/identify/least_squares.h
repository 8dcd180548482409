// Least squares between bounds, and what the residuals can tell of the parameters.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace springproof {

/// Residuals, each over its standard uncertainty, of parameters between bounds.
struct BoundedFit {
  using Residuals = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& parameters)>;

  Residuals residuals;                  ///< [1]; empty: there are none at these parameters
  Eigen::VectorXd start, lower, upper;  ///< lower <= start <= upper
  Eigen::VectorXd step;                 ///< of the differences that the Jacobian is made of, > 0
};

struct LeastSquaresFit {
  Eigen::VectorXd parameters;  ///< the best that were found
  Eigen::VectorXd residuals;   ///< there; empty: there are none at the start
  int iterations = 0;
  bool converged = false;
  std::string message;  ///< why not
};

/// Parameters of which one is a step off, into the bounds.
Eigen::VectorXd beside(const BoundedFit& problem, const Eigen::VectorXd& at, Eigen::Index parameter);

/// Derivatives of the residuals by one-sided differences, into the bounds.
/// @param at with residuals r
/// @return empty: at one of the neighbours there are no residuals
std::optional<Eigen::MatrixXd> jacobian_of(const BoundedFit& problem, const Eigen::VectorXd& at,
                                           const Eigen::VectorXd& r);

/// Gauss-Newton's method, damped as by Levenberg and Marquardt where a step fails; parameters at a bound stay there
/// while the residuals push them out.  Converged: the next step, undamped, would change no residual by a hundredth.
LeastSquaresFit fit(const BoundedFit& problem);

/// What residuals of standard uncertainty 1 tell of the parameters, to first order.
struct Certainty {
  Eigen::MatrixXd covariance;   ///< (J^T J)^-1; what no residual depends on is told to 1e9
  Eigen::VectorXd u;            ///< standard uncertainties
  Eigen::MatrixXd correlation;  ///< [1]
  Eigen::MatrixXd directions;   ///< in its columns, of length 1, the worst known first
  Eigen::VectorXd along;        ///< standard uncertainty along each
};

/// @param jacobian of the residuals, with as many rows as columns at least
Certainty certainty_of(const Eigen::MatrixXd& jacobian);

/// The parameter that is told least, of which more than most_of_range is open; empty: all are told.
/// @param range upper - lower bounds
std::optional<Eigen::Index> untold(const Certainty& certainty, const Eigen::VectorXd& range);

/// A parameter is told by the data if its standard uncertainty is at most this share of its range.
inline constexpr double most_of_range = 0.1;

/// A fit in which parameters that the data do not tell are held at their start.
struct HeldFit {
  LeastSquaresFit fit;       ///< of all parameters
  std::vector<bool> held;    ///< of each
  Eigen::MatrixXd jacobian;  ///< of all, at the fit; empty: unknown
};

/// Fits, holds what is untold, and fits again.
HeldFit fit_what_is_told(const BoundedFit& problem);

}  // namespace springproof
