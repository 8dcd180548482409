#include "comparisons/engines/five_tetrahedra.h"

#include <cmath>

namespace springproof {
namespace {

// Of a cube whose first corner is an even node of the lattice; of the others the mirror image x -> 1 - x.
constexpr std::array<Tetrahedron, 5> five_of_cube = {
    {{0, 2, 7, 5}, {1, 0, 5, 2}, {3, 0, 2, 7}, {4, 0, 7, 5}, {6, 2, 5, 7}}};
constexpr std::array<int, 8> mirror_corner = {1, 0, 3, 2, 5, 4, 7, 6};

}  // namespace

std::vector<Tetrahedron> five_tetrahedra(const NodalVectors& X, const std::vector<Hexahedron>& cells, double edge) {
  std::vector<Tetrahedron> tetrahedra;
  tetrahedra.reserve(five_of_cube.size() * cells.size());
  for (const Hexahedron& cell : cells) {
    const Eigen::RowVector3d place = (X.row(cell[0]) - X.row(cells.front()[0])) / edge;
    const bool odd = (std::lround(place[0]) + std::lround(place[1]) + std::lround(place[2])) % 2 != 0;
    for (const Tetrahedron& t : five_of_cube)
      if (odd)
        tetrahedra.push_back({cell[mirror_corner[t[1]]], cell[mirror_corner[t[0]]], cell[mirror_corner[t[2]]],
                              cell[mirror_corner[t[3]]]});
      else
        tetrahedra.push_back({cell[t[0]], cell[t[1]], cell[t[2]], cell[t[3]]});
  }
  return tetrahedra;
}

}  // namespace springproof
