#include "meshes/patches/cut_mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "meshes/facets.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr double surface_tolerance =
    3e-2;                        // of the shortest edge: far below what separates facets from a smooth surface
constexpr double smooth = 0.85;  // least cosine between normals of facets of one
constexpr double border_tolerance = 1e-9;  // of the edges of a patch's border
constexpr double worse_shape = 0.3;        // of the shape it was, the worst that a moved node may make

template <class Cell>
bool has(const Cell& cell, int node) {
  return std::find(cell.begin(), cell.end(), node) != cell.end();
}

/// Splits those of `items` at a and b: each becomes one with m for b, and adds one with m for a.
template <class Item, class Added>
void split(std::vector<Item>& items, std::vector<std::vector<int>>& at, int a, int b, int m, const Added& added) {
  const std::vector<int> around = at[b];
  for (const int i : around) {
    if (!has(items[i], a)) continue;
    Item other = items[i];
    std::replace(items[i].begin(), items[i].end(), b, m);
    std::replace(other.begin(), other.end(), a, m);
    const int number = static_cast<int>(items.size());
    std::erase(at[b], i);
    at[m].push_back(i);
    for (const int n : other) at[n].push_back(number);
    items.push_back(other);
    added(i);
  }
}

}  // namespace

CutMesh::CutMesh(const Mesh& mesh)
    : cells_(mesh.tetrahedra), materials_(mesh.materials), cells_at_(mesh.nodes.rows()), facets_at_(mesh.nodes.rows()) {
  for (const auto& X : mesh.nodes.rowwise()) surface_.points.push_back(X.transpose());
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (const int n : cells_[c]) cells_at_[n].push_back(static_cast<int>(c));
  std::vector<std::array<int, 4>> keys;  // ascending
  for (const OuterFacet& f : outer_facets(mesh)) {
    for (int c = 0; c < 3; ++c) facets_at_[f.nodes[c]].push_back(static_cast<int>(keys.size()));
    surface_.triangles.push_back({f.nodes[0], f.nodes[1], f.nodes[2]});
    keys.push_back(f.key);
  }
  patches_.resize(keys.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (const auto& facet : mesh.patches[p].facets) {
      const auto found = std::lower_bound(keys.begin(), keys.end(), ascending(facet));
      if (found != keys.end() && *found == ascending(facet)) add_to_patch(found - keys.begin(), static_cast<int>(p));
    }
}

int CutMesh::bisect(int a, int b, const Vec3& at) {
  const int m = static_cast<int>(points().size());
  surface_.points.push_back(at);
  cells_at_.emplace_back();
  facets_at_.emplace_back();
  split(cells_, cells_at_, a, b, m, [&](int cell) {
    if (!materials_.empty()) materials_.push_back(std::uint8_t(materials_[cell]));
  });
  split(surface_.triangles, facets_at_, a, b, m,
        [&](int facet) { patches_.push_back(std::vector<int>(patches_[facet])); });
  return m;
}

bool CutMesh::is_edge(int a, int b) const {
  return std::any_of(cells_at_[a].begin(), cells_at_[a].end(), [&](int c) { return has(cells_[c], b); });
}

/// Of edges of one length that of the lowest nodes, so that everyone who asks finds the same.
std::array<int, 2> CutMesh::longest_edge_around(int a, int b) const {
  std::array<int, 2> longest = {std::min(a, b), std::max(a, b)};
  double most = length(a, b) * (1 + 1e-9);
  for (const int c : cells_at_[a]) {
    if (!has(cells_[c], b)) continue;
    for (const int n : cells_[c])
      for (const int other : cells_[c])
        if (n < other && length(n, other) > most) {
          most = length(n, other);
          longest = {n, other};
        }
  }
  return longest;
}

void CutMesh::refine(int a, int b) {
  while (is_edge(a, b)) {
    std::array<int, 2> edge = {std::min(a, b), std::max(a, b)}, longer = longest_edge_around(a, b);
    while (longer != edge) {
      edge = longer;
      longer = longest_edge_around(edge[0], edge[1]);
    }
    bisect(edge[0], edge[1], (points()[edge[0]] + points()[edge[1]]) / 2);
  }
}

double CutMesh::shape(const Tetrahedron& cell) const {
  Eigen::Matrix<double, 4, 3> x;
  for (int i = 0; i < 4; ++i) x.row(i) = points()[cell[i]].transpose();
  double squares = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) squares += (x.row(i) - x.row(j)).squaredNorm() / 6;
  return 6 * std::sqrt(2) * tetrahedron_volume(x) / std::pow(squares, 1.5);
}

double CutMesh::worst_shape(int node) const {
  double worst = std::numeric_limits<double>::infinity();
  for (const int c : cells_at_[node]) worst = std::min(worst, shape(cells_[c]));
  return worst;
}

double CutMesh::worst_shape() const {
  double worst = std::numeric_limits<double>::infinity();
  for (const Tetrahedron& cell : cells_) worst = std::min(worst, shape(cell));
  return worst;
}

bool CutMesh::keeps_surface(int node, const Vec3& to) const {
  const Vec3 by = to - points()[node];
  double shortest = std::numeric_limits<double>::infinity(), off = 0;
  std::vector<Vec3> normals;
  std::vector<std::pair<int, std::vector<int>>> neighbours;  // along edges of facets, and the facet's patches
  for (const int f : facets_at_[node]) {
    const auto& t = surface_.triangles[f];
    normals.push_back((points()[t[1]] - points()[t[0]]).cross(points()[t[2]] - points()[t[0]]).normalized());
    off = std::max(off, std::abs(by.dot(normals.back())));
    for (const int other : t)
      if (other != node) {
        shortest = std::min(shortest, length(node, other));
        neighbours.emplace_back(other, patches_[f]);
      }
  }
  const bool is_smooth =
      std::all_of(normals.begin(), normals.end(), [&](const Vec3& n) { return n.dot(normals[0]) > smooth; });
  if (off > (is_smooth ? surface_tolerance : border_tolerance) * shortest) return false;
  for (const auto& [a, of_a] : neighbours)
    for (const auto& [b, of_b] : neighbours) {
      const Vec3 edge = points()[a] - points()[node];
      if (a == b && of_a != of_b && by.cross(edge).norm() > border_tolerance * edge.squaredNorm()) return false;
    }
  return true;
}

bool CutMesh::is_between_materials(int node) const {
  if (materials_.empty()) return false;
  const std::vector<int>& around = cells_at_[node];
  return std::any_of(around.begin(), around.end(), [&](int c) { return materials_[c] != materials_[around[0]]; });
}

bool CutMesh::slide(int node, const Vec3& to) {
  if (is_between_materials(node) || !keeps_surface(node, to)) return false;
  const double before = worst_shape(node);
  const Vec3 from = points()[node];
  surface_.points[node] = to;
  if (worst_shape(node) >= worse_shape * before) return true;
  surface_.points[node] = from;
  return false;
}

bool CutMesh::move(const std::vector<int>& nodes, const std::vector<Vec3>& to) {
  const std::vector<Vec3> before = points();
  std::vector<double> shapes;
  for (const int n : nodes) shapes.push_back(worst_shape(n));
  for (std::size_t i = 0; i < nodes.size(); ++i) surface_.points[nodes[i]] = to[i];
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!(worst_shape(nodes[i]) > worse_shape * shapes[i])) {
      surface_.points = before;
      return false;
    }
  return true;
}

Mesh CutMesh::mesh(const std::vector<std::string>& patches) const {
  Mesh mesh;
  mesh.nodes = rows_of(points());
  mesh.tetrahedra = cells_;
  mesh.materials = materials_;
  for (const std::string& name : patches) mesh.patches.push_back({name, {}});
  for (std::size_t f = 0; f < patches_.size(); ++f)
    for (const int p : patches_[f])
      mesh.patches[p].facets.push_back(
          {surface_.triangles[f][0], surface_.triangles[f][1], surface_.triangles[f][2], -1});
  return mesh;
}

}  // namespace springproof
