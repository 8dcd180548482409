#include "meshes/transfer_patches.h"

#include <algorithm>

#include "meshes/facet_tree.h"

namespace springproof {
namespace {

/// (key of a facet, number of a patch that holds it), ascending.
std::vector<std::pair<std::array<int, 4>, std::size_t>> patches_by_facet(const Mesh& body) {
  std::vector<std::pair<std::array<int, 4>, std::size_t>> list;
  for (std::size_t p = 0; p < body.patches.size(); ++p)
    for (std::array<int, 4> facet : body.patches[p].facets) {
      std::sort(facet.begin(), facet.end());
      list.emplace_back(facet, p);
    }
  std::sort(list.begin(), list.end());
  return list;
}

Vec3 middle_of(const Mesh& mesh, const OuterFacet& facet) {
  const int corners = facet.nodes[3] < 0 ? 3 : 4;
  Vec3 middle = Vec3::Zero();
  for (int c = 0; c < corners; ++c) middle += mesh.nodes.row(facet.nodes[c]).transpose() / corners;
  return middle;
}

}  // namespace

void transfer_patches(const Mesh& from, const std::vector<OuterFacet>& facets, Mesh& to) {
  if (from.patches.empty()) return;
  const std::size_t first = to.patches.size();
  for (const Patch& p : from.patches) to.patches.push_back({p.name, {}});
  const auto patches = patches_by_facet(from);
  const FacetTree tree(from, facets);
  for (const OuterFacet& facet : outer_facets(to)) {
    const auto& key = facets[tree.nearest(middle_of(to, facet)).facet].key;
    for (auto it = std::lower_bound(patches.begin(), patches.end(), std::pair(key, std::size_t{0})); it != patches.end() && it->first == key; ++it)
      to.patches[first + it->second].facets.push_back(facet.nodes);
  }
}

}  // namespace springproof
