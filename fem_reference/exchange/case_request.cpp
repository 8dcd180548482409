#include "fem_reference/exchange/case_request.h"

#include <algorithm>

#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "meshes/regions/mark_regions.h"

namespace springproof::fem {
namespace {

/// The cells after halving them as long as all counts are even, coarsest first: levels of the multigrid.
std::vector<Cells> halved(Cells cells) {
  std::vector<Cells> levels = {cells};
  const auto can_be_halved = [](int n) { return n % 2 == 0; };
  while (std::all_of(cells.begin(), cells.end(), can_be_halved)) {
    for (int& n : cells) n /= 2;
    levels.insert(levels.begin(), cells);
  }
  return levels;
}

/// The coarsest of a block's levels on whose lines the borders of the patches run, with the refinements that lead to
/// `grid`; curved bodies have one level.
Mesh hexahedra_for(const Request& request, Discretisation& grid) {
  const std::vector<Cells> levels = halved(grid.cells);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const std::vector<std::string> volumes = volumes_of(request.regions);
    Mesh mesh = mesh_geo(request.geo, request.size, levels[level], {}, volumes);
    if (!mesh.grid) return mesh_geo(request.geo, request.size, grid.cells, {.second_order = true}, volumes);
    grid.refinements = static_cast<int>(levels.size() - level) - 1;
    if (grid.refinements == 0 || (end_at_edges_of(mesh, request.patches) && end_at_faces_of(mesh, request.regions)))
      return mesh;
  }
  return {};
}

Mesh mesh_for(const Request& request, Discretisation& grid) {
  Mesh mesh = grid.element.starts_with('p')
                  ? mesh_geo(request.geo, request.size, grid.cells, {.tetrahedra = true}, volumes_of(request.regions))
                  : hexahedra_for(request, grid);
  mark_regions(request.regions, 1, mesh);
  select_whole_facets(request.patches, mesh);
  return mesh;
}

}  // namespace

Request request_of(const Experiment& experiment, const IsotropicMaterial& material) {
  Request request;
  request.name = experiment.file.string();
  if (!experiment.body.is_voxels()) {
    request.geo = find_geo(experiment.body, experiment.file);
    request.patches = experiment.patches;
  }
  request.size = experiment.body.size;
  request.law = experiment.kinematics;
  request.material = experiment.at_rest(material);
  request.regions = experiment.regions;
  request.loads = experiment.loads;
  request.masses = experiment.masses;
  request.tolerance = 1e-8;
  request.cost = experiment.cost;
  return request;
}

void mesh_grids(Request& request) {
  for (Discretisation& grid : request.grids) {
    if (grid.mesh >= 0) continue;
    request.meshes.push_back(std::make_shared<Mesh>(mesh_for(request, grid)));
    grid.mesh = static_cast<int>(request.meshes.size()) - 1;
  }
}

}  // namespace springproof::fem
