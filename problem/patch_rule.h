// A part of the surface that the case file names by where it lies.
#pragma once

#include <optional>
#include <string>

#include "problem/system/input_error.h"
#include "problem/vector.h"

namespace springproof {

/// Selects the part of the outer surface where every condition that is given holds; at least one is.  Its border runs
/// through facets (meshes/patches/rule_region.h), but for `facing`, which takes whole ones by their normals.  Borders
/// belong to what is selected.
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
  /// What lies within `radius` of the point of the surface that is nearest to `point`, as far as it hangs together with
  /// that point.
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
