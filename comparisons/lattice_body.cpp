#include "comparisons/lattice_body.h"

#include <fmt/format.h>

#include "meshes/gmsh_io.h"
#include "meshes/voxelise.h"

namespace springproof {
namespace {

/// The box [0, size] cut into those cells.
VoxelGrid grid_of(const Body& body, const Cells& cells) {
  const Vec3 edges = body.size.cwiseQuotient(Vec3(cells[0], cells[1], cells[2]));
  if (edges.maxCoeff() > (1 + 1e-6) * edges.minCoeff())
    throw std::invalid_argument(fmt::format("voxels: cells of {:.6g} x {:.6g} x {:.6g} m are no cubes", edges[0], edges[1], edges[2]));
  return {Vec3::Zero(), edges.x(), cells};
}

}  // namespace

LatticeBody lattice_body(const std::filesystem::path& geo, const Body& body, const Cells& cells) try {
  if (!body.voxels) return {std::make_shared<Mesh>(mesh_geo(geo, body.size, cells)), nullptr, {}};
  const Mesh tetrahedra = mesh_geo(geo, body.size, cells, {.tetrahedra = true});
  const auto region = std::make_shared<Region>(region_of(tetrahedra));
  Voxels voxels = voxelise(grid_of(body, cells), tetrahedra);
  return {std::make_shared<Mesh>(std::move(voxels.mesh)), region, std::move(voxels.notes)};
} catch (const std::invalid_argument& e) {
  throw InputError(body.where, e.what());
}

}  // namespace springproof
