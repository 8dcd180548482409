// Internal forces over a finite step that do exactly the work of the energy's change and have no torque.
#pragma once

#include "msm/laws/averaged_springs.h"
#include "msm/laws/laws.h"

namespace springproof {

/// f(x0, x1) = -B^T s, B the derivative of quadratic invariants z(x) at (x0 + x1)/2 and s a discrete gradient of the
/// energy in them, s . (z1 - z0) = E1 - E0 (Gonzalez 1996; Simo and Tarnow 1992).  As B (x1 - x0) = z1 - z0 for a
/// quadratic z,
///   f . (x1 - x0) = E0 - E1,   sum f = 0,   sum (x0 + x1)/2 x f = 0,
/// so that a step of m (v1 - v0) = dt f, x1 - x0 = dt (v0 + v1)/2 conserves energy and both momenta at any size.
///  - springs, momentum dispersion: z the squared length; tension of the mean length, along the mean spring;
///  - volume correction: z = C = F^T F of the mean edges;
///  - averaged springs: z = (C, v), v the hourglass components in the covariant frame;
///  - measured cells: the same z, the stress of the mean of their deformations.
/// s in C is the mean of the stress at the two Gauss points of the straight line from C0 to C1, corrected along it by
/// what the work lacks where that is more than round-off.
class EnergyMomentum {
 public:
  /// Keeps a reference to the model.
  /// @throws std::invalid_argument if the model lacks Capability::energy_momentum.
  explicit EnergyMomentum(const MassSpringModel& model);

  /// At positions x0 and x1 with carried nodes in their places [N]; NaN where a cell is flat.
  NodalVectors forces(const NodalVectors& x0, const NodalVectors& x1) const;

 private:
  const MassSpringModel& model_;
  CellForms forms_;  ///< of averaged springs
};

}  // namespace springproof
