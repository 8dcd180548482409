// A plane that holds nodes at the end of large steps, as an active set.
#pragma once

#include <vector>

#include "msm/algebra/block_matrix.h"
#include "problem/plane.h"

namespace springproof {

/// The nodes that end a step on a plane.  A step is solved with them on it, free to slide; those whose reaction would
/// pull are then released, those behind the plane held, and the step is solved anew until there are none of either:
///   x_n >= 0,  r_n >= 0,  x_n r_n = 0
/// of the distance x_n and the reaction r_n at the end of the step.
class PlaneConstraint {
 public:
  /// @param plane without friction
  /// @param spacing of the nodes [m]: distances below 1e-9 of it count as none
  PlaneConstraint(const Plane& plane, Eigen::Index nodes, double spacing);

  void put(NodalVectors& x) const;      ///< the held nodes onto the plane
  void project(NodalVectors& v) const;  ///< the held nodes' components along the normal to zero
  void stiffen(BlockMatrix& K) const;   ///< along the normal of held nodes, by much: for a preconditioner

  /// Releases and holds nodes after a solution.
  /// @param x0,x1 positions at the step's two ends [m]
  /// @param unbalanced forces at the nodes, which the reactions of held ones balance [N]
  /// @param scale of the forces [N]
  /// @param fixed unknowns: a node with any is not held
  /// @return whether any was
  bool revise(const NodalVectors& x0, const NodalVectors& x1, const NodalVectors& unbalanced, double scale,
              const std::vector<char>& fixed);

  const std::vector<int>& held() const { return held_; }
  const Vec3& normal() const { return plane_.normal; }

 private:
  Plane plane_;
  double spacing_;
  std::vector<char> is_held_;
  std::vector<int> held_;
};

}  // namespace springproof
