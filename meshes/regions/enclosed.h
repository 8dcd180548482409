// What a closed surface encloses.
#pragma once

#include <optional>
#include <vector>

#include "meshes/locate/facet_tree.h"
#include "meshes/surface/surface.h"

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

}  // namespace springproof
