#include "meshes/patches/transfer_patches.h"

#include <algorithm>

#include "meshes/facets.h"
#include "meshes/locate/facet_tree.h"

namespace springproof {
namespace {

/// (key of a facet, number of a patch that holds it), ascending.
std::vector<std::pair<std::array<int, 4>, std::size_t>> patches_by_facet(const Mesh& body) {
  std::vector<std::pair<std::array<int, 4>, std::size_t>> list;
  for (std::size_t p = 0; p < body.patches.size(); ++p)
    for (const auto& facet : body.patches[p].facets) list.emplace_back(ascending(facet), p);
  std::sort(list.begin(), list.end());
  return list;
}

const OuterFacet& nearest_to(const Vec3& p, const Mesh& mesh, const std::vector<OuterFacet>& facets) {
  const auto distance = [&](const OuterFacet& f) { return (middle_of(mesh, f.nodes) - p).squaredNorm(); };
  return *std::min_element(facets.begin(), facets.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
}

}  // namespace

std::vector<std::string> transfer_patches(const Mesh& from, const std::vector<OuterFacet>& facets, Mesh& to) {
  if (from.patches.empty()) return {};
  const std::size_t first = to.patches.size();
  for (const Patch& p : from.patches) to.patches.push_back({p.name, {}});
  const auto patches = patches_by_facet(from);
  const FacetTree tree(from, facets);
  const std::vector<OuterFacet> onto = outer_facets(to);
  for (const OuterFacet& facet : onto) {
    const auto& key = facets[tree.nearest(middle_of(to, facet.nodes)).facet].key;
    for (auto it = std::lower_bound(patches.begin(), patches.end(), std::pair(key, std::size_t{0}));
         it != patches.end() && it->first == key; ++it)
      to.patches[first + it->second].facets.push_back(facet.nodes);
  }
  std::vector<std::string> small;
  for (std::size_t p = 0; p < from.patches.size(); ++p) {
    Patch& patch = to.patches[first + p];
    if (!patch.facets.empty() || from.patches[p].facets.empty()) continue;
    patch.facets.push_back(nearest_to(centroid(from, from.patches[p]), to, onto).nodes);
    small.push_back(patch.name);
  }
  return small;
}

}  // namespace springproof
