#include "meshes/locate/facet_tree.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace springproof {
namespace {

constexpr std::size_t leaf = 4;       // triangles
constexpr double margin = 1 + 1e-12;  // for round-off, so that equal distances are all looked at

}  // namespace

FacetTree::FacetTree(const Mesh& mesh, const std::vector<OuterFacet>& facets) {
  const auto x = [&](int n) -> Vec3 { return mesh.nodes.row(n).transpose(); };
  triangles_.reserve(2 * facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto& n = facets[f].nodes;
    triangles_.push_back({{x(n[0]), x(n[1]), x(n[2])}, f});
    if (n[3] >= 0) triangles_.push_back({{x(n[0]), x(n[2]), x(n[3])}, f});
  }
  build(0, triangles_.size());
}

FacetTree::FacetTree(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles) {
  for (const auto& [a, b, c] : triangles) triangles_.push_back({{points[a], points[b], points[c]}, triangles_.size()});
  build(0, triangles_.size());
}

std::size_t FacetTree::build(std::size_t begin, std::size_t end) {
  if (begin == end) throw std::invalid_argument("FacetTree: no facets");
  const std::size_t number = parts_.size();
  Box box = empty_box();
  for (std::size_t t = begin; t < end; ++t)
    for (const Vec3& p : triangles_[t].x) add_to(box, p);
  parts_.push_back({box, begin, end, 0});
  if (end - begin <= leaf) return number;
  int axis;
  (box.high - box.low).maxCoeff(&axis);
  const auto key = [axis](const Triangle& t) { return t.x[0][axis] + t.x[1][axis] + t.x[2][axis]; };
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const Triangle& a, const Triangle& b) { return key(a) < key(b); });
  build(begin, middle);
  const std::size_t second = build(middle, end);
  parts_[number].second = second;
  return number;
}

void FacetTree::search(std::size_t number, const Vec3& p, Nearest& best) const {
  const Part& part = parts_[number];
  if (part.second == 0) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const Triangle& t = triangles_[i];
      const Vec3 point = closest_point(p, t.x[0], t.x[1], t.x[2]);
      const double distance = (point - p).norm();
      if (distance < best.distance || (distance == best.distance && t.facet < best.facet))
        best = {t.facet, point, distance};
    }
    return;
  }
  std::size_t near = number + 1, far = part.second;
  double to_near = parts_[near].distance(p), to_far = parts_[far].distance(p);
  if (to_far < to_near) {
    std::swap(near, far);
    std::swap(to_near, to_far);
  }
  if (to_near <= margin * best.distance) search(near, p, best);
  if (to_far <= margin * best.distance) search(far, p, best);
}

FacetTree::Nearest FacetTree::nearest(const Vec3& p) const {
  Nearest best{0, p, std::numeric_limits<double>::infinity()};
  search(0, p, best);
  return best;
}

}  // namespace springproof
