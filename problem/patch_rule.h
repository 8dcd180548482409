// A part of the surface that the case file names by where it lies.
#pragma once

#include <optional>
#include <string>

#include "problem/input_error.h"
#include "problem/vector.h"

namespace springproof {

/// Selects those outer facets for which every condition that is given holds; at least one is.  A facet counts by its
/// middle (mean of its corners) and its outward normal.  Boundaries belong to what is selected.
struct PatchRule {
  struct Box {
    Vec3 low, high;  ///< [m]
  };
  struct Beyond {
    Vec3 point, normal;  ///< [m], length 1: the side of the plane that the normal points to
  };
  struct Facing {
    Vec3 direction;         ///< length 1
    double within_deg = 0;  ///< largest angle to the outward normal [degrees]
  };
  /// The facet nearest to `point`, and what hangs together with it by edges among the facets whose middles lie within
  /// `radius` of the point of the surface that is nearest.
  struct Near {
    Vec3 point;         ///< [m]
    double radius = 0;  ///< [m]
  };

  std::string name;
  std::optional<Box> box;
  std::optional<Beyond> beyond;
  std::optional<Facing> facing;
  std::optional<Near> near;
  SourceLocation where;  ///< of the [[patch]]
};

}  // namespace springproof
