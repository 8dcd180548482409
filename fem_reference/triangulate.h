// Mesh -> deal.II triangulation with a multigrid hierarchy.  Hexahedra only.
#pragma once

#include <deal.II/grid/tria.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "meshes/mesh.h"

namespace springproof::fem {

struct Body3 {
  dealii::Triangulation<3> triangulation{dealii::Triangulation<3>::limit_level_difference_at_vertices};
  std::map<std::string, std::set<dealii::types::boundary_id>>
      patches;  ///< a facet may belong to several patches
};

/// Refines `coarse` `refinements` times; then every vertex X [m] of the finest mesh is moved to place(X), if
/// given.
/// @throws InputError if the mesh has cells that are not hexahedra, or inverted ones.
std::unique_ptr<Body3> triangulate(const Mesh& coarse, int refinements,
                                   const std::function<Vec3(const Vec3&)>& place);

}  // namespace springproof::fem
