// What a region is where it is no physical volume: a shape by its borders.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "meshes/facets.h"
#include "meshes/locate/facet_tree.h"
#include "meshes/patches/rule_region.h"
#include "meshes/surface/surface.h"
#include "problem/region.h"

namespace springproof {

/// Depths in a closed surface, and its sharp edges.
class Enclosed {
 public:
  /// @param surface closed, its facets outward (surface_check.h) [m]
  /// @throws std::invalid_argument if there are no facets.
  explicit Enclosed(const Surface& surface);

  const Box& box() const { return box_; }  ///< around the surface

  /// Distance from the surface [m]; outside negative.
  double depth(const Vec3& point) const;

  /// The nearest point of an edge at which facets meet at more than 40 degrees; nothing if it is farther than `within`
  /// [m].
  std::optional<Vec3> on_sharp_edge(const Vec3& point, double within) const;

 private:
  Vec3 normal_at(std::size_t facet, const Vec3& point) const;

  Surface surface_;
  Box box_;
  std::vector<Vec3> of_facets_, of_points_;  ///< normals; of points weighted by the facets' angles
  std::vector<std::array<int, 3>> beyond_;   ///< the facet beyond each side of a facet
  std::vector<std::array<Vec3, 2>> sharp_;   ///< edges
  FacetTree tree_;
};

/// A plane, a sphere or a closed surface: depth is counted from it to its inner side.
struct RegionBorder {
  Border plain = {};
  std::shared_ptr<const Enclosed> surface = nullptr;

  bool is_sphere() const { return !surface && plain.is_sphere(); }
  double depth(const Vec3& x) const { return surface ? surface->depth(x) : plain.depth(x); }
};

/// Whether a cell may reach into a closed surface; of a hexahedron by its corners and middle alone.
template <std::size_t n>
bool reaches_into(const Enclosed& surface, const std::array<Vec3, n>& corners, double slack) {
  const Box &box = surface.box(), own = box_of(corners);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : corners) middle += x / n;
  if (((own.low - box.high).array() > slack).any() || ((box.low - own.high).array() > slack).any()) return false;
  double farthest = 0;
  for (const Vec3& x : corners) farthest = std::max(farthest, (x - middle).norm());
  return surface.depth(middle) + (n == 4 ? farthest : 0) > slack ||
         std::any_of(corners.begin(), corners.end(), [&](const Vec3& x) { return surface.depth(x) > slack; });
}

/// A box, a ball, a half-space or what a surface encloses, by its borders.
struct SolidShape {
  std::vector<RegionBorder> borders;
  double across = 0;  ///< its shortest extent [m]
  double volume = 0;  ///< [m^3]; 0: infinite

  /// Whether a cell reaches into it, of a ball by the box around the cell's corners.
  template <std::size_t n>
  bool is_reached_by(const std::array<Vec3, n>& corners, double slack) const {
    return std::all_of(borders.begin(), borders.end(), [&](const RegionBorder& border) {
      if (border.surface) return reaches_into(*border.surface, corners, slack);
      if (!border.is_sphere())
        return std::any_of(corners.begin(), corners.end(), [&](const Vec3& x) { return border.depth(x) > slack; });
      const Box box = box_of(corners);
      return border.depth(border.plain.point.cwiseMax(box.low).cwiseMin(box.high)) > slack;
    });
  }

  template <std::size_t n>
  bool holds(const std::array<Vec3, n>& corners, double slack) const {
    return std::all_of(corners.begin(), corners.end(), [&](const Vec3& x) {
      return std::all_of(borders.begin(), borders.end(), [&](const RegionBorder& b) { return b.depth(x) >= -slack; });
    });
  }
};

SolidShape shape_of(const PatchRule::Box& box);
SolidShape shape_of(const PatchRule::Near& ball);
SolidShape shape_of(const PatchRule::Beyond& side);
/// Its extent is that of a ball of the same ratio of volume to area, if its box is not shorter.
SolidShape shape_of(const Surface& facets);
/// @throws InputError for a file without a closed surface
SolidShape shape_of(const EnclosedPlace& place);

}  // namespace springproof
