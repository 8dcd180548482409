#include "meshes/regions/border_cuts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace springproof {
namespace {

constexpr double near_border = 0.3;  // of an edge: nodes so near to a border are moved onto it where they can
constexpr int passes_of_moves = 4;
constexpr double as_on = 0.1;     // of an edge: nodes so near to a surface that cannot be moved are taken as on it
constexpr double chopped = 0.06;  // of an edge between two nodes of a surface: so far off it, it cuts off a corner
constexpr double reach_of_corner = 0.75;  // of the same edge: so far its middle is moved
constexpr int passes_of_corners = 2;

/// Cuts tetrahedra along the borders of a shape, so that each lies on one side.
class BorderCuts {
 public:
  BorderCuts(const SolidShape& shape, double slack, CutMesh& mesh) : shape_(shape), slack_(slack), mesh_(mesh) {}

  void refine(double longest) {
    for (std::set<std::array<int, 2>> edges = too_long(longest); !edges.empty(); edges = too_long(longest))
      for (const auto& [a, b] : edges) mesh_.refine(a, b);
  }

  void along_borders() {
    for (const RegionBorder& border : shape_.borders) {
      if (border.surface) take_as_on(border);
      for (int pass = 0; pass < passes_of_moves && move_onto(border); ++pass) {
      }
      for (const auto& [a, b] : crossed(border))
        set_on(border, mesh_.bisect(a, b, X(a) + crossing(border, a, b) * (X(b) - X(a))));
      for (int pass = 0; border.surface && pass < passes_of_corners; ++pass) onto_sharp_edges(border);
    }
  }

  bool holds(const Tetrahedron& cell) const {
    for (const RegionBorder& border : shape_.borders) {
      double least = 0, most = 0;
      for (const int n : cell) {
        least = std::min(least, depth(border, n));
        most = std::max(most, depth(border, n));
      }
      if (least < -slack_ || (most <= slack_ && depth_of_middle(border, cell) < 0)) return false;
    }
    return true;
  }

 private:
  const Vec3& X(int node) const { return mesh_.points()[node]; }

  /// Depths in a surface are kept.
  double depth(const RegionBorder& border, int node) const {
    if (!border.surface) return border.depth(X(node));
    double& kept = kept_depth(node);
    if (std::isnan(kept)) kept = border.depth(X(node));
    return kept;
  }

  double& kept_depth(int node) const {
    if (depths_.size() <= static_cast<std::size_t>(node))
      depths_.resize(mesh_.points().size(), std::numeric_limits<double>::quiet_NaN());
    return depths_[node];
  }

  void set_on(const RegionBorder& border, int node) {
    if (border.surface) kept_depth(node) = 0;
  }

  double depth_of_middle(const RegionBorder& border, const Tetrahedron& c) const {
    return border.depth((X(c[0]) + X(c[1]) + X(c[2]) + X(c[3])) / 4);
  }

  bool reaches(const Tetrahedron& c) const {
    return shape_.is_reached_by(std::array{X(c[0]), X(c[1]), X(c[2]), X(c[3])}, slack_);
  }

  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (const Tetrahedron& cell : mesh_.tetrahedra()) {
      if (!reaches(cell)) continue;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) visit(std::min(cell[i], cell[j]), std::max(cell[i], cell[j]));
    }
  }

  std::set<std::array<int, 2>> too_long(double longest) const {
    std::set<std::array<int, 2>> edges;
    for_each_edge([&](int a, int b) {
      if ((X(a) - X(b)).norm() > longest) edges.insert({a, b});
    });
    return edges;
  }

  /// Where an edge from a node of the surface ceases to run along it; 0: at once.
  double leaving(const Enclosed& surface, const Vec3& a, const Vec3& b) const {
    constexpr double along = 0.02, least = 0.2;  // of the edge: so near is on it, so far it has to run
    constexpr int halvings = 12;
    const double near = -along * (b - a).norm();
    if (surface.depth(a + least * (b - a)) < near) return 0;
    double s = least, t = 1;
    for (int n = 0; n < halvings; ++n) {
      const double middle = (s + t) / 2;
      (surface.depth(a + middle * (b - a)) < near ? t : s) = middle;
    }
    return std::max(least, s - along);
  }

  /// By false position (Illinois).
  double crossing_of_surface(const Enclosed& surface, const Vec3& a, const Vec3& b, double da, double db) const {
    constexpr int most = 60;
    double s = 0, t = 1, at = 0.5;
    int kept = 0;
    for (int n = 0; n < most; ++n) {
      at = (da * t - db * s) / (da - db);
      const double d = surface.depth(a + at * (b - a));
      if (std::abs(d) <= slack_) break;
      const int side = (d > 0) == (db > 0) ? 1 : -1;
      (side > 0 ? t : s) = at;
      (side > 0 ? db : da) = d;
      if (side == kept) (side > 0 ? da : db) /= 2;
      kept = side;
    }
    return at;
  }

  /// Where on an edge the border is: at a + t (b - a); 0: nowhere between its ends.
  double crossing(const RegionBorder& border, int a, int b) const {
    const double da = depth(border, a), db = depth(border, b);
    if (border.surface && da == 0 && db < -slack_) return leaving(*border.surface, X(a), X(b));
    if (border.surface && db == 0 && da < -slack_) {
      const double t = leaving(*border.surface, X(b), X(a));
      return t > 0 ? 1 - t : 0;
    }
    if (std::abs(da) <= slack_ || std::abs(db) <= slack_ || (da > 0) == (db > 0)) return 0;
    if (border.surface) return crossing_of_surface(*border.surface, X(a), X(b), da, db);
    if (!border.is_sphere()) return da / (da - db);
    const Vec3 d = X(b) - X(a), from = X(a) - border.plain.point;
    const double A = d.squaredNorm(), B = from.dot(d),
                 root = std::sqrt(B * B - A * (from.squaredNorm() - std::pow(border.plain.radius, 2)));
    return (da > 0 ? -B + root : -B - root) / A;
  }

  std::set<std::array<int, 2>> crossed(const RegionBorder& border) const {
    std::set<std::array<int, 2>> edges;
    for_each_edge([&](int a, int b) {
      if (crossing(border, a, b) > 0) edges.insert({a, b});
    });
    return edges;
  }

  bool keeps_other_borders(const RegionBorder& border, int node, const Vec3& to) const {
    return std::all_of(shape_.borders.begin(), shape_.borders.end(), [&](const RegionBorder& other) {
      return &other == &border || std::abs(other.depth(X(node))) > slack_ || std::abs(other.depth(to)) <= slack_;
    });
  }

  /// Nodes near the border, along the edges that it cuts.
  /// @return whether one was moved
  bool move_onto(const RegionBorder& border) {
    std::vector<std::pair<double, std::array<int, 2>>> ends;  // distance over the edge's length; the node, the other
    for (const auto& [a, b] : crossed(border)) {
      const double t = crossing(border, a, b);
      if (t < near_border) ends.push_back({t, {a, b}});
      if (1 - t < near_border) ends.push_back({1 - t, {b, a}});
    }
    std::sort(ends.begin(), ends.end());
    std::set<int> moved;
    for (const auto& [t, ab] : ends) {
      const auto& [node, other] = ab;
      if (moved.contains(node) || moved.contains(other)) continue;
      const Vec3 to = X(node) + t * (X(other) - X(node));
      if (!keeps_other_borders(border, node, to) || !mesh_.slide(node, to)) continue;
      moved.insert(node);
      set_on(border, node);
    }
    return !moved.empty();
  }

  /// Nodes of the body's surface and of other regions that are nearly on a surface: gaps and slivers as thin are none.
  void take_as_on(const RegionBorder& border) {
    std::map<int, double> shortest;  // edge at a node
    for_each_edge([&](int a, int b) {
      const double length = (X(a) - X(b)).norm();
      for (const int n : {a, b}) {
        const auto [at, first] = shortest.emplace(n, length);
        if (!first) at->second = std::min(at->second, length);
      }
    });
    for (const auto& [n, edge] : shortest)
      if ((!mesh_.facets_at(n).empty() || mesh_.is_between_materials(n)) && std::abs(depth(border, n)) < as_on * edge)
        set_on(border, n);
  }

  /// Edges that cut off what the surface has beyond them get its sharp edge for a node.
  void onto_sharp_edges(const RegionBorder& border) {
    std::map<std::array<int, 2>, Vec3> beyond;
    for_each_edge([&](int a, int b) {
      if (depth(border, a) != 0 || depth(border, b) != 0 || beyond.contains({a, b})) return;
      const Vec3 middle = (X(a) + X(b)) / 2;
      const double length = (X(a) - X(b)).norm();
      if (std::abs(border.depth(middle)) < chopped * length) return;
      if (const auto at = border.surface->on_sharp_edge(middle, reach_of_corner * length)) beyond[{a, b}] = *at;
    });
    for (const auto& [edge, at] : beyond) {
      const int node = mesh_.bisect(edge[0], edge[1], (X(edge[0]) + X(edge[1])) / 2);
      mesh_.slide(node, at);
      set_on(border, node);
    }
  }

  const SolidShape& shape_;
  const double slack_;
  CutMesh& mesh_;
  mutable std::vector<double> depths_;  // of the nodes in the surface; nan: not known
};

}  // namespace

std::vector<std::size_t> cut_along_borders(const SolidShape& shape, double longest, double slack, CutMesh& mesh) {
  BorderCuts cuts(shape, slack, mesh);
  if (std::isfinite(longest)) cuts.refine(longest);
  cuts.along_borders();
  std::vector<std::size_t> held;
  for (std::size_t c = 0; c < mesh.cells(); ++c)
    if (cuts.holds(mesh.tetrahedra()[c])) held.push_back(c);
  return held;
}

}  // namespace springproof
