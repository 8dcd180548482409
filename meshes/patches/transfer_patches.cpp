#include "meshes/patches/transfer_patches.h"

#include <algorithm>

#include "meshes/locate/facet_tree.h"

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

const OuterFacet& nearest_to(const Vec3& p, const Mesh& mesh, const std::vector<OuterFacet>& facets) {
  const auto distance = [&](const OuterFacet& f) { return (middle_of(mesh, f) - p).squaredNorm(); };
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
    const auto& key = facets[tree.nearest(middle_of(to, facet)).facet].key;
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
