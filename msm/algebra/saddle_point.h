// Saddle points  K u + B^T p = f,  B u - C p = g  of displacements u and pressures p, with a diagonal C.
#pragma once

#include <vector>

#include "msm/algebra/krylov.h"

namespace springproof {

/// Displacements and pressures, or what they are set against: forces and changes of volume.
struct MixedVector {
  Eigen::VectorXd u, p;
};

/// The parts of a saddle point, in units in which both equations have entries of order one.
class SaddlePoint {
 public:
  virtual ~SaddlePoint() = default;

  virtual Eigen::VectorXd force(const MixedVector& x) = 0;              ///< K u + B^T p, fixed unknowns included
  virtual Eigen::VectorXd volume_change(const Eigen::VectorXd& u) = 0;  ///< B u
  virtual const Eigen::VectorXd& compliance() const = 0;                ///< the diagonal of C
  virtual MixedVector cycle(const MixedVector& b) = 0;  ///< nearly the solution for (f, g): the preconditioner
};

/// Solves for (u, p) of b = (f, g), u = 0 on the `fixed` unknowns, by GMRES over the cycle.
KrylovResult solve_saddle_point(SaddlePoint& system, const std::vector<char>& fixed, const MixedVector& b,
                                double tolerance, int max_iterations, MixedVector& x);

}  // namespace springproof
