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

}  // namespace springproof::test
