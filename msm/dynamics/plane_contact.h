// Contact of a moving network with a rigid plane, by impulses on its nodes.
#pragma once

#include <optional>
#include <vector>

#include "problem/plane.h"
#include "problem/vector.h"

namespace springproof {

/// The first time that a body touches the plane, as a whole.
struct Bounce {
  double begin = 0, end = 0;                       ///< [s]
  double velocity_before = 0, velocity_after = 0;  ///< of the centre of mass along the normal [m/s]
};

/// After an explicit step every free node that has passed the plane is put onto it, by the impulse along the normal
/// that gives it the velocity to arrive there (Carpenter et al. 1991: a Lagrange multiplier of the position at the end
/// of the step).  Friction takes an impulse of up to the coefficient times that from its motion along the plane.  A
/// node that lands loses its velocity along the normal, so that an elastic body loses the kinetic energy of one layer
/// of nodes: less on finer lattices.  The plane has the opposite impulse; the time step is bounded as without it.
class PlaneContact {
 public:
  /// @param plane that the body stays on one side of
  /// @param mass of each node [kg]
  /// @param pause contacts that are this far apart belong to two bounces [s]
  PlaneContact(const Plane& plane, const Eigen::VectorXd& mass, double pause);

  const Plane& plane() const { return plane_; }

  /// Corrects the state at the end of a step of dt at `time`.
  /// @param fixed unknowns, three of each node: a node with any is left alone
  /// @return whether anything was changed
  bool correct(double time, double dt, const std::vector<char>& fixed, NodalVectors& x, NodalVectors& v);

  /// Impulse on the body since the last call [N s].
  Vec3 take_impulse();

  /// The first one; empty: it has not begun, or has not ended.
  std::optional<Bounce> bounce() const;

 private:
  double velocity_of_centre(const NodalVectors& v) const;

  Plane plane_;
  Eigen::VectorXd mass_;
  double pause_;
  Vec3 impulse_ = Vec3::Zero();
  std::optional<Bounce> first_;
  bool ended_ = false;
};

}  // namespace springproof
