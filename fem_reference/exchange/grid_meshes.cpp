#include "fem_reference/exchange/grid_meshes.h"

#include <algorithm>

#include "meshes/mesher/mesher.h"

namespace springproof::fem {
namespace {

/// Halves the cells as long as all counts are even, down to the coarsest level of the multigrid; returns how often.
int halve(Cells& cells) {
  int times = 0;
  const auto can_be_halved = [](int n) { return n % 2 == 0; };
  while (std::all_of(cells.begin(), cells.end(), can_be_halved)) {
    for (int& n : cells) n /= 2;
    ++times;
  }
  return times;
}

/// Sets the refinements that the mesh needs.
Mesh mesh_for(const Request& request, Discretisation& grid) {
  if (grid.element.starts_with('p')) return mesh_geo(request.geo, request.size, grid.cells, {.tetrahedra = true});
  Cells coarse = grid.cells;
  const int refinements = halve(coarse);
  if (Mesh mesh = mesh_geo(request.geo, request.size, coarse); mesh.grid) {
    grid.refinements = refinements;
    return mesh;
  }
  return mesh_geo(request.geo, request.size, grid.cells, {.second_order = true});
}

}  // namespace

void mesh_grids(Request& request) {
  for (Discretisation& grid : request.grids) {
    if (grid.mesh >= 0) continue;
    request.meshes.push_back(std::make_shared<Mesh>(mesh_for(request, grid)));
    grid.mesh = static_cast<int>(request.meshes.size()) - 1;
  }
}

}  // namespace springproof::fem
