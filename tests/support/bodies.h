// Bodies for tests that meshes of gmsh are too much for.
#pragma once

#include "meshes/mesh.h"

namespace springproof::test {

/// Each hexahedron cut into six tetrahedra about its diagonal 0-6; neighbours match on blocks.
inline Mesh tetrahedra_of(const Mesh& blocks) {
  constexpr int cut[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  Mesh mesh;
  mesh.nodes = blocks.nodes;
  for (const Hexahedron& cell : blocks.hexahedra)
    for (const auto& c : cut) mesh.tetrahedra.push_back({cell[c[0]], cell[c[1]], cell[c[2]], cell[c[3]]});
  return mesh;
}

/// The cells of a block that `keep(i, j, k)` keeps, without patches: a voxel body.
template <class Keep>
Mesh voxels_of(const Mesh& block, Keep keep) {
  Mesh mesh;
  std::vector<int> number(block.nodes.rows(), -1), used;
  for (std::size_t c = 0; c < block.hexahedra.size(); ++c) {
    const auto [i, j, k] = block.grid->cell_index[c];
    if (!keep(i, j, k)) continue;
    for (int& n : mesh.hexahedra.emplace_back(block.hexahedra[c])) {
      if (number[n] < 0) {
        number[n] = static_cast<int>(used.size());
        used.push_back(n);
      }
      n = number[n];
    }
  }
  mesh.nodes.resize(static_cast<Eigen::Index>(used.size()), 3);
  for (std::size_t n = 0; n < used.size(); ++n) mesh.nodes.row(static_cast<Eigen::Index>(n)) = block.nodes.row(used[n]);
  mesh.grid = detect_grid(mesh);
  return mesh;
}

}  // namespace springproof::test
