#include "msm/topology/cubic_lattice.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace springproof {

CubicPattern isotropic_pattern(double face_to_cube) {
  if (!(face_to_cube >= 0)) throw std::invalid_argument("face_to_cube: A must be >= 0 (or infinite)");
  if (std::isinf(face_to_cube)) return {1.0, 1.0, 0.0};
  return {8.0 / 3.0 + face_to_cube, face_to_cube, 1.0};
}

double cube_edge(const Mesh& mesh) {
  if (!mesh.grid || mesh.hexahedra.empty())
    throw std::invalid_argument("a cubic lattice needs a mesh of equal cubes; this mesh is not cut from one lattice");
  const Vec3 edge = mesh.grid->spacing;
  if ((edge.array() - edge[0]).abs().maxCoeff() > 1e-6 * edge[0])
    throw std::invalid_argument(fmt::format(
        "a cubic lattice needs cubes; the cells are {:.6g} x {:.6g} x {:.6g} m (choose cells in proportion to size)",
        edge[0], edge[1], edge[2]));
  return edge[0];
}

Network cubic_lattice(const Mesh& mesh, const CubicPattern& pattern) {
  const double edge = cube_edge(mesh);
  Network network;
  network.X = mesh.nodes;
  network.cells = mesh.hexahedra;
  network.cell_edge = edge;
  network.volume = nodal_volumes(mesh);
  network.grid = mesh.grid;

  const double share[4] = {0, pattern.k_e / 4, pattern.k_f / 2, pattern.k_c};  // by number of differing axes
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b) {
      int axes = 0;
      for (int d = 0; d < 3; ++d) axes += hexahedron_corners[a][d] != hexahedron_corners[b][d];
      if (share[axes] > 0) network.cell_springs.push_back({a, b, share[axes], edge * std::sqrt(double(axes))});
    }
  std::vector<Spring> springs;
  springs.reserve(network.cell_springs.size() * mesh.hexahedra.size());
  for (const Hexahedron& cell : mesh.hexahedra)
    for (const Spring& s : network.cell_springs)
      springs.push_back({cell[s.i], cell[s.j], s.stiffness, s.rest_length});
  network.springs = merge_springs(std::move(springs));
  return network;
}

}  // namespace springproof
