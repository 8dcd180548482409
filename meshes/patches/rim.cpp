#include "meshes/patches/rim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "meshes/locate/outer_facets.h"

namespace springproof {
namespace {

constexpr double least_turn = std::numbers::pi / 6;  // of the surface at an edge of the body

using FacetEdge = std::pair<int, int>;

int corner_count(const std::array<int, 4>& facet) { return facet[3] < 0 ? 3 : 4; }

FacetEdge facet_edge(const std::array<int, 4>& facet, int c) {
  return std::minmax(facet[c], facet[(c + 1) % corner_count(facet)]);
}

Vec3 outward_normal(const Mesh& mesh, const OuterFacet& facet) {
  const auto& n = facet.nodes;
  const auto X = [&](int i) -> Vec3 { return mesh.nodes.row(n[i]).transpose(); };
  const Vec3 normal = corner_count(n) == 3 ? (X(1) - X(0)).cross(X(2) - X(0)) : (X(2) - X(0)).cross(X(3) - X(1));
  return (normal.dot(X(0) - facet.cell_centre) < 0 ? -1 : 1) * normal.normalized();
}

std::array<int, 4> sorted_key(std::array<int, 4> facet) {
  std::sort(facet.begin(), facet.end());
  return facet;
}

}  // namespace

std::vector<RimEdge> rim_of(const Mesh& mesh, const Patch& patch) {
  std::set<std::array<int, 4>> within;
  std::map<FacetEdge, int> times;
  for (const auto& facet : patch.facets) {
    within.insert(sorted_key(facet));
    for (int c = 0; c < corner_count(facet); ++c) ++times[facet_edge(facet, c)];
  }
  std::map<FacetEdge, std::array<Vec3, 2>> normals;  // of the facet without, and within
  for (const OuterFacet& facet : outer_facets(mesh))
    for (int c = 0; c < corner_count(facet.nodes); ++c)
      if (const auto at = times.find(facet_edge(facet.nodes, c)); at != times.end() && at->second == 1)
        normals[at->first][within.contains(facet.key)] = outward_normal(mesh, facet);
  std::vector<RimEdge> rim;
  for (const auto& [edge, n] : normals)
    rim.push_back({mesh.nodes.row(edge.first).transpose(), mesh.nodes.row(edge.second).transpose(),
                   std::atan2(n[0].cross(n[1]).norm(), n[0].dot(n[1]))});
  return rim;
}

bool ends_at_edges(const std::vector<RimEdge>& rim) {
  return std::all_of(rim.begin(), rim.end(), [](const RimEdge& e) { return e.turn >= least_turn; });
}

bool is_smooth(const std::vector<RimEdge>& rim) {
  double balance = 0;
  for (const RimEdge& e : rim) balance += (e.turn < least_turn ? 1 : -1) * (e.b - e.a).norm();
  return balance > 0;
}

}  // namespace springproof
