#include "comparisons/lattice_body.h"

#include "meshes/mesher.h"
#include "meshes/voxelise.h"

namespace springproof {

LatticeBody lattice_body(const std::filesystem::path& geo, const Body& body, const Cells& cells) try {
  if (!body.voxels) return {std::make_shared<Mesh>(mesh_geo(geo, body.size, cells)), nullptr};
  const Mesh tetrahedra = mesh_geo(geo, body.size, cells, {.tetrahedra = true});
  const auto region = std::make_shared<Region>(region_of(tetrahedra));
  return {std::make_shared<Mesh>(voxelise(body.size, cells, region->inside, tetrahedra)), region};
} catch (const std::invalid_argument& e) {
  throw InputError(body.where, e.what());
}

}  // namespace springproof
