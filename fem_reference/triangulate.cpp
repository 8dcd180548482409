#include "fem_reference/triangulate.h"

#include <deal.II/grid/grid_tools.h>

#include <algorithm>

#include "problem/experiment.h"

namespace springproof::fem {
namespace {

using Corners = std::array<unsigned int, 4>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Each set of patches that some facet belongs to becomes one boundary id; 0 is "no patch".
void mark_patches(const Mesh& mesh, Body3& body) {
  std::map<Corners, std::set<std::string>> patches_of_facet;
  for (const Patch& patch : mesh.patches) {
    body.patches[patch.name];
    for (const auto& f : patch.facets)
      patches_of_facet[sorted({unsigned(f[0]), unsigned(f[1]), unsigned(f[2]), unsigned(f[3])})].insert(
          patch.name);
  }
  std::map<std::set<std::string>, dealii::types::boundary_id> ids = {{{}, 0}};
  for (const auto& face : body.triangulation.active_face_iterators()) {
    if (!face->at_boundary()) continue;
    const Corners corners =
        sorted({face->vertex_index(0), face->vertex_index(1), face->vertex_index(2), face->vertex_index(3)});
    const auto found = patches_of_facet.find(corners);
    const std::set<std::string> names =
        found == patches_of_facet.end() ? std::set<std::string>{} : found->second;
    const auto id = ids.emplace(names, ids.size()).first->second;
    face->set_boundary_id(id);
    for (const std::string& name : names) body.patches[name].insert(id);
  }
}

}  // namespace

std::unique_ptr<Body3> triangulate(const Mesh& coarse, int refinements,
                                   const std::function<Vec3(const Vec3&)>& place) {
  if (!coarse.tetrahedra.empty()) throw InputError("the finite element reference takes hexahedra only");
  auto body = std::make_unique<Body3>();

  std::vector<dealii::Point<3>> vertices;
  for (const auto& X : coarse.nodes.rowwise()) vertices.emplace_back(X[0], X[1], X[2]);
  std::vector<dealii::CellData<3>> cells;
  constexpr std::array<int, 8> gmsh_corner = {0, 1, 3, 2, 4, 5, 7, 6};  // deal.II counts corners x fastest
  for (const Hexahedron& hexahedron : coarse.hexahedra) {
    dealii::CellData<3> cell;
    for (int v = 0; v < 8; ++v) cell.vertices[v] = hexahedron[gmsh_corner[v]];
    cells.push_back(cell);
  }
  if (dealii::GridTools::invert_cells_with_negative_measure(vertices, cells) > 0)
    throw InputError("the mesh has inverted cells");
  dealii::GridTools::consistently_order_cells(cells);
  body->triangulation.create_triangulation(vertices, cells, dealii::SubCellData());

  mark_patches(coarse, *body);
  body->triangulation.refine_global(refinements);
  if (place) {
    const auto move = [&](const dealii::Point<3>& X) {
      const Vec3 x = place(Vec3(X[0], X[1], X[2]));
      return dealii::Point<3>(x[0], x[1], x[2]);
    };
    dealii::GridTools::transform(move, body->triangulation);
  }
  return body;
}

}  // namespace springproof::fem
