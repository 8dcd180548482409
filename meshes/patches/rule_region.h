// The part of a surface that a rule of the case file names, cut through facets where its border runs.
#pragma once

#include <optional>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/surface/surface.h"
#include "problem/patch_rule.h"

namespace springproof {

/// A plane, or the sphere of a `near`: depth is counted from it to its inner side.
struct Border {
  Vec3 point = Vec3::Zero();   ///< of the plane, or the sphere's centre [m]
  Vec3 normal = Vec3::Zero();  ///< of the plane, inwards, length 1
  double radius = 0;           ///< of the sphere [m]; 0: a plane

  bool is_sphere() const { return radius > 0; }
  double depth(const Vec3& x) const { return is_sphere() ? radius - (x - point).norm() : normal.dot(x - point); }
};

/// A rule on a surface: its sphere is about the nearest point.
struct RuleRegion {
  std::vector<Border> planes;
  std::optional<Border> sphere;
  std::optional<PatchRule::Facing> facing;
  double slack = 0;  ///< what is so near to a border is on it: 1e-9 of the body [m]
};

/// A rule by its `side`, of this surface: facets that face it within 1/1000 of the body's depth, if they are a
/// hundredth of the box's face or more; else all beyond a twentieth of the depth.  Other rules stay.
PatchRule settled(PatchRule rule, const Surface& surface);

RuleRegion rule_region(const PatchRule& given, const Surface& surface);

/// Part of a facet.
struct FacetPart {
  Vec3 area = Vec3::Zero();  ///< along the facet's normal [m^2]; zero: no part
  Vec3 centroid = Vec3::Zero();
  std::vector<Vec3> polygon;  ///< the facet within the planes
};

/// What of each facet lies within the region: clipped at planes, and in closed form at the circle in which the sphere
/// cuts the facet's plane.  Of `near` only what hangs together with the nearest point, by edges that reach into the
/// sphere.
std::vector<FacetPart> parts_within(const RuleRegion& region, const Surface& surface);

/// The parts that a rule names of the facets; none is without area.
std::vector<FacetPart> parts_of(const PatchRule& rule, const Surface& surface);

/// The same of the outer facets.
std::vector<FacetPart> parts_of(const PatchRule& rule, const Mesh& mesh);

}  // namespace springproof
