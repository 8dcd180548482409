// Masses that are no part of the body, but hung on it or glued to it.
#pragma once

#include <string>
#include <vector>

#include "problem/loads.h"

namespace springproof {

/// A mass without extent of its own: it moves with the body at a point, along a segment or on a patch.
struct AttachedMass {
  std::string name;
  std::string on;             ///< patch over whose area it is spread; empty: it is at `at`
  std::vector<Vec3> at = {};  ///< a point, or the two ends of a segment along which it is spread [m]
  double mass = 0;            ///< [kg]
  bool weighs = true;         ///< gravity acts on it; false: inertia alone
};

/// Points that have equal shares of a mass which is on no patch [m].
std::vector<Vec3> points_of(const AttachedMass& mass);

/// Loads that accelerate a mass by `acceleration` [m/s^2]: their forces on a discretisation's nodes are its inertia
/// there.
std::vector<Load> loads_of(const AttachedMass& mass, const Vec3& acceleration);

/// Its weight under the gravity among the loads.
std::vector<Load> weight_of(const AttachedMass& mass, const std::vector<Load>& loads);

}  // namespace springproof
