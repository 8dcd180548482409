// A rule of the case file that selects part of the surface by its position or orientation.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "problem/system/input_error.h"
#include "problem/vector.h"

namespace springproof {

/// Sides of a body along the axes: -x, x, -y, y, -z, z.
enum class BodySide { left, right, front, back, bottom, top };
constexpr std::array<const char*, 6> names_of(BodySide) { return {"left", "right", "front", "back", "bottom", "top"}; }

/// Selects the part of the outer surface where all given conditions hold; at least one is given.  Its border cuts
/// through facets (meshes/patches/rule_region.h), except for `facing`, which selects whole facets by their normals.
/// The border belongs to the selection.
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
  /// The connected part of the surface that contains the surface point nearest to `point` and lies within `radius` of
  /// it.
  struct Near {
    Vec3 point;         ///< [m]
    double radius = 0;  ///< [m]
  };

  std::string name;
  std::optional<BodySide> side;  ///< without beyond and facing, by which it is settled for a surface (settled())
  std::optional<Box> box;
  std::optional<Beyond> beyond;
  std::optional<Facing> facing;
  std::optional<Near> near;
  SourceLocation where;  ///< of the [[patch]]
};

}  // namespace springproof
