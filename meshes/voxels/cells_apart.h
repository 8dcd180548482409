// Cells of several materials whose nodes are of one each.
#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/voxels/cut_cells.h"

namespace springproof {

/// Cells with nodes of each material's own: what jumps where materials meet has a value there for each.
struct CellsApart {
  std::vector<Hexahedron> corners;  ///< of each cell
  std::vector<int> node;            ///< that each is: all nodes, of the least material there, then once more for others
};

/// @param corners of cells
/// @param materials of each; empty: one
/// @return the cells apart
inline CellsApart apart(std::vector<Hexahedron> corners, const std::vector<std::uint8_t>& materials) {
  std::map<std::pair<int, int>, int> row;  // of node and material
  CellsApart out{std::move(corners), {}};
  int nodes = 0;
  for (std::size_t c = 0; c < out.corners.size(); ++c)
    for (const int n : out.corners[c]) {
      nodes = std::max(nodes, n + 1);
      if (!materials.empty()) row[{n, materials[c]}] = n;
    }
  out.node.resize(static_cast<std::size_t>(nodes));
  std::iota(out.node.begin(), out.node.end(), 0);
  for (auto at = row.begin(); at != row.end(); ++at)
    if (at != row.begin() && std::prev(at)->first.first == at->first.first) {  // a greater material of the same node
      at->second = static_cast<int>(out.node.size());
      out.node.push_back(at->first.first);
    }
  for (std::size_t c = 0; c < materials.size(); ++c)
    for (int& n : out.corners[c]) n = row.at({n, materials[c]});
  return out;
}

/// @param body in cut cells
/// @return its cells apart
inline CellsApart apart(const CutBody& body) {
  std::vector<Hexahedron> corners;
  std::vector<std::uint8_t> materials;
  for (const CutCell& cell : body.cells) {
    corners.push_back(cell.corners);
    materials.push_back(static_cast<std::uint8_t>(cell.material));
  }
  return apart(std::move(corners), materials);
}

}  // namespace springproof
