// A rigid plane that a body can fall on.
#pragma once

#include "problem/vector.h"

namespace springproof {

/// Bodies stay on its side of the normal.
struct Plane {
  Vec3 point = Vec3::Zero();    ///< in it [m]
  Vec3 normal = Vec3::UnitZ();  ///< of length 1
  double friction = 0;          ///< Coulomb's coefficient [1]

  /// @param x a place [m]
  /// @return its distance from the plane [m], negative behind it
  double distance(const Vec3& x) const { return normal.dot(x - point); }
};

}  // namespace springproof
