#include "meshes/patches/refined_rims.h"

#include <algorithm>
#include <set>

#include "meshes/patches/cut_mesh.h"
#include "meshes/patches/rim.h"

namespace springproof {
namespace {

using SurfaceEdge = std::array<int, 2>;

class Rims {
 public:
  Rims(const std::vector<int>& patches, double longest, CutMesh& mesh)
      : patches_(patches), longest_(longest), mesh_(mesh) {}

  void refine() {
    for (std::set<SurfaceEdge> edges = too_long(); !edges.empty(); edges = too_long())
      for (const auto& [a, b] : edges) mesh_.refine(a, b);
  }

 private:
  SurfaceEdge edge(std::size_t facet, int c) const {
    const auto& t = mesh_.surface().triangles[facet];
    return {std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])};
  }
  double length(const SurfaceEdge& e) const { return (mesh_.points()[e[0]] - mesh_.points()[e[1]]).norm(); }

  /// Ends of edges between a facet in a patch and one that is not.
  std::set<int> nodes() const {
    std::set<int> on;
    for (const int patch : patches_) {
      std::set<SurfaceEdge> border;
      for (std::size_t f = 0; f < mesh_.surface().triangles.size(); ++f)
        for (int c = 0; mesh_.is_in_patch(f, patch) && c < 3; ++c)
          if (const auto [at, is_new] = border.insert(edge(f, c)); !is_new) border.erase(at);
      for (const SurfaceEdge& e : border) on.insert(e.begin(), e.end());
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
