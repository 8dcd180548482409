#include "meshes/gmsh/read_mesh.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "meshes/facets.h"

namespace springproof {
namespace {

using Triangle = std::array<std::size_t, 3>;
using Facets = std::vector<std::vector<std::size_t>>;

/// Facets of gmsh's cells by their numbers of corners, outward.
const std::map<std::size_t, Facets> facets_of_cells = {
    {4, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},
    {5, {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}},
    {6, {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
    {8, {{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}}};

/// Calls act(corners, facets, material) for each cell.
template <class Act>
void for_each_cell(const std::vector<ElementBlock>& blocks, const Act& act) {
  for (const ElementBlock& b : blocks)
    for (std::size_t i = 0; i < b.node_tags.size(); i += b.nodes)
      act(std::vector<std::size_t>(&b.node_tags[i], &b.node_tags[i] + b.corners), facets_of_cells.at(b.corners),
          b.materials.empty() ? std::nullopt : std::optional(b.materials[i / b.nodes]));
}

}  // namespace

std::vector<Triangle> triangles_of(const std::array<std::size_t, 4>& q) {
  const auto first = static_cast<std::size_t>(std::min_element(q.begin(), q.end()) - q.begin());
  const auto at = [&](std::size_t n) { return q[(first + n) % 4]; };
  return {{at(0), at(1), at(2)}, {at(0), at(2), at(3)}};
}

ElementBlock split_into_tetrahedra(const std::filesystem::path& file, const std::vector<ElementBlock>& blocks) {
  for (const ElementBlock& b : blocks)
    if (!facets_of_cells.contains(b.corners))
      refuse(file, fmt::format("{} cells are of the kind '{}' (allowed: tetrahedra, hexahedra, prisms, pyramids)",
                               b.count(), b.name));
  std::set<Triangle> known;  // of cells with triangular facets, beside which quadrilaterals are cut alike
  for_each_cell(blocks, [&](const std::vector<std::size_t>& corners, const Facets& facets, const auto&) {
    for (const std::vector<std::size_t>& f : facets)
      if (f.size() == 3) known.insert(ascending(Triangle{corners[f[0]], corners[f[1]], corners[f[2]]}));
  });
  const std::map<std::size_t, Vec3> position = node_positions();
  std::size_t middle = position.rbegin()->first;
  std::vector<std::size_t> middles;
  std::vector<double> coordinates;
  ElementBlock all{.type = 4, .name = "Tetrahedron 4", .order = 1, .nodes = 4, .corners = 4, .node_tags = {}};
  const auto split = [&](const std::vector<std::size_t>& corners, const Facets& facets) {
    if (corners.size() == 4) {
      all.node_tags.insert(all.node_tags.end(), corners.begin(), corners.end());
      return;
    }
    middles.push_back(++middle);
    Vec3 at = Vec3::Zero();
    for (const std::size_t n : corners) at += position.at(n) / static_cast<double>(corners.size());
    coordinates.insert(coordinates.end(), at.begin(), at.end());
    for (const std::vector<std::size_t>& f : facets) {
      std::vector<Triangle> triangles = {{corners[f[0]], corners[f[1]], corners[f[2]]}};
      if (f.size() == 4) {
        const auto c = [&](std::size_t n) { return corners[f[n]]; };
        const std::vector<Triangle> others = {{c(0), c(1), c(2)}, {c(0), c(2), c(3)}},
                                    across = {{c(1), c(2), c(3)}, {c(1), c(3), c(0)}};
        triangles = known.contains(ascending(others[0]))   ? others
                    : known.contains(ascending(across[0])) ? across
                                                           : triangles_of({c(0), c(1), c(2), c(3)});
      }
      for (const auto& [a, b, d] : triangles) all.node_tags.insert(all.node_tags.end(), {a, d, b, middle});
    }
  };
  for_each_cell(blocks, [&](const std::vector<std::size_t>& corners, const Facets& facets,
                            const std::optional<std::uint8_t>& material) {
    const std::size_t before = all.count();
    split(corners, facets);
    if (material) all.materials.resize(all.materials.size() + all.count() - before, *material);
  });
  if (!middles.empty()) gmsh::model::mesh::addNodes(3, entities(3).front(), middles, coordinates);
  return all;
}

}  // namespace springproof
