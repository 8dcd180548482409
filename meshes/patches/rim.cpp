#include "meshes/patches/rim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "meshes/facets.h"
#include "meshes/patches/cut_mesh.h"

namespace springproof {
namespace {

constexpr double least_turn = std::numbers::pi / 6;  // of the surface at an edge of the body

Vec3 outward_normal(const Mesh& mesh, const OuterFacet& facet) {
  const auto& n = facet.nodes;
  const auto X = [&](int i) -> Vec3 { return mesh.nodes.row(n[i]).transpose(); };
  const Vec3 normal = corners_of(n) == 3 ? (X(1) - X(0)).cross(X(2) - X(0)) : (X(2) - X(0)).cross(X(3) - X(1));
  return (normal.dot(X(0) - facet.cell_centre) < 0 ? -1 : 1) * normal.normalized();
}

using SurfaceEdge = std::pair<int, int>;

class Rims {
 public:
  Rims(const std::vector<int>& patches, double longest, CutMesh& mesh)
      : patches_(patches), longest_(longest), mesh_(mesh) {}

  void refine() {
    for (std::set<SurfaceEdge> edges = too_long(); !edges.empty(); edges = too_long())
      for (const auto& [a, b] : edges) mesh_.refine(a, b);
  }

 private:
  SurfaceEdge edge(std::size_t facet, int c) const { return edge_of(mesh_.surface().triangles[facet], c); }
  double length(const SurfaceEdge& e) const { return (mesh_.points()[e.first] - mesh_.points()[e.second]).norm(); }

  /// Ends of edges between a facet in a patch and one that is not.
  std::set<int> nodes() const {
    std::set<int> on;
    for (const int patch : patches_) {
      std::set<SurfaceEdge> border;
      for (std::size_t f = 0; f < mesh_.surface().triangles.size(); ++f)
        for (int c = 0; mesh_.is_in_patch(f, patch) && c < 3; ++c)
          if (const auto [at, is_new] = border.insert(edge(f, c)); !is_new) border.erase(at);
      for (const auto& [a, b] : border) on.insert({a, b});
    }
    return on;
  }

  /// The longest edge of each facet at a rim, if it is too long.
  std::set<SurfaceEdge> too_long() const {
    const auto shorter = [&](const SurfaceEdge& p, const SurfaceEdge& q) { return length(p) < length(q); };
    std::set<SurfaceEdge> edges;
    for (const int node : nodes())
      for (const int f : mesh_.facets_at(node))
        if (const SurfaceEdge longest = std::max({edge(f, 0), edge(f, 1), edge(f, 2)}, shorter);
            length(longest) > longest_)
          edges.insert(longest);
    return edges;
  }

  const std::vector<int>& patches_;
  const double longest_;
  CutMesh& mesh_;
};

}  // namespace

std::vector<RimEdge> rim_of(const Mesh& mesh, const Patch& patch) {
  std::set<std::array<int, 4>> within;
  std::map<SurfaceEdge, int> times;
  for (const auto& facet : patch.facets) {
    within.insert(ascending(facet));
    for (int c = 0; c < corners_of(facet); ++c) ++times[edge_of(facet, c)];
  }
  std::map<SurfaceEdge, std::array<Vec3, 2>> normals;  // of the facet without, and within
  for (const OuterFacet& facet : outer_facets(mesh))
    for (int c = 0; c < corners_of(facet.nodes); ++c)
      if (const auto at = times.find(edge_of(facet.nodes, c)); at != times.end() && at->second == 1)
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

void refine_rims(const std::vector<std::string>& patches, double longest, Mesh& mesh) {
  std::vector<std::string> names;
  std::vector<int> numbers;
  for (const Patch& p : mesh.patches) {
    if (std::find(patches.begin(), patches.end(), p.name) != patches.end() && is_smooth(rim_of(mesh, p)))
      numbers.push_back(static_cast<int>(names.size()));
    names.push_back(p.name);
  }
  if (numbers.empty()) return;
  CutMesh cut(mesh);
  Rims(numbers, longest, cut).refine();
  mesh = cut.mesh(names);
}

}  // namespace springproof
