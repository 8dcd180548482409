// The nearest of many facets.
#pragma once

#include <vector>

#include "meshes/box.h"
#include "meshes/locate/outer_facets.h"

namespace springproof {

/// A tree of boxes around the facets, quadrilaterals cut into two triangles along corners 0 and 2.
class FacetTree {
 public:
  /// @throws std::invalid_argument if there are no facets.
  FacetTree(const Mesh& mesh, const std::vector<OuterFacet>& facets);
  FacetTree(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles);

  struct Nearest {
    std::size_t facet;  ///< number in `facets`; of several at the same distance the first
    Vec3 point;         ///< of the facet [m]
    double distance;    ///< [m]
  };
  Nearest nearest(const Vec3& p) const;

 private:
  struct Triangle {
    std::array<Vec3, 3> x;
    std::size_t facet;
  };
  struct Part {
    Box box;
    std::size_t begin, end;  ///< its triangles
    std::size_t second;      ///< its halves are the next part and this one; 0: it has none

    double distance(const Vec3& p) const { return (box.low - p).cwiseMax(p - box.high).cwiseMax(0).norm(); }
  };
  std::size_t build(std::size_t begin, std::size_t end);
  void search(std::size_t part, const Vec3& p, Nearest& best) const;

  std::vector<Triangle> triangles_;
  std::vector<Part> parts_;
};

}  // namespace springproof
