#include "comparisons/results/picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "meshes/locate/locate.h"
#include "meshes/locate/outer_facets.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

using Facet = std::array<int, 4>;

std::vector<Facet> surface_of(const Mesh& mesh) {
  std::vector<Facet> facets;
  for (const OuterFacet& f : outer_facets(mesh)) facets.push_back(f.nodes);
  return thinned(mesh.nodes, facets);
}

/// Mean of V'/V - 1 over the cells at each node [1].
Eigen::VectorXd nodal_volume_change(const Field& field) {
  const Mesh& mesh = *field.mesh;
  const Eigen::VectorXd change =
      (cell_volumes(mesh, mesh.nodes + field.displacement).array() / cell_volumes(mesh, mesh.nodes).array() - 1)
          .matrix();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.nodes.rows()), cells = sum;
  Eigen::Index number = 0;
  const auto add = [&](const auto& cell) {
    for (int n : cell) {
      sum[n] += change[number];
      cells[n] += 1;
    }
    ++number;
  };
  for (const Hexahedron& cell : mesh.hexahedra) add(cell);
  for (const Tetrahedron& cell : mesh.tetrahedra) add(cell);
  return sum.cwiseQuotient(cells);
}

void append(const Eigen::RowVector3d& v, std::vector<float>& out) {
  for (double value : v) out.push_back(static_cast<float>(value));
}

/// The outer facets and patches of a mesh: numbers their nodes in order of appearance; `add` appends the values of one
/// node to the picture.
template <class Add>
void add_facets(const Mesh& mesh, Picture& p, const Add& add) {
  const NodalVectors& points = mesh.nodes;
  const std::vector<Facet> facets = surface_of(mesh);
  std::vector<int> number(static_cast<std::size_t>(points.rows()), -1);
  int used = 0;
  for (const Facet& facet : facets)
    for (int n : facet) {
      if (n >= 0 && number[n] < 0) {
        number[n] = used++;
        append(points.row(n), p.rest);
        add(n);
      }
      p.quads.push_back(n < 0 ? -1 : number[n]);
    }
  for (const Patch& patch : mesh.patches) {
    std::vector<int>& nodes = p.patches[patch.name];
    for (int n : nodes_of(patch))
      if (number[n] >= 0) nodes.push_back(number[n]);
    std::ranges::sort(nodes);
  }
}

using Triangle = std::array<int, 3>;

std::vector<Triangle> triangles_of(const std::vector<std::array<int, 4>>& facets) {
  std::vector<Triangle> triangles;
  for (const auto& f : facets) {
    triangles.push_back({f[0], f[1], f[2]});
    if (f[3] >= 0) triangles.push_back({f[0], f[2], f[3]});
  }
  return triangles;
}

double area(const NodalVectors& points, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 ab = points.row(b) - points.row(a), ac = points.row(c) - points.row(a);
    sum += 0.5 * ab.cross(ac).norm();
  }
  return sum;
}

/// For each node the representative of its lattice cube, the node nearest to the mean of the cube's nodes; -1 for nodes
/// of no triangle.
std::vector<int> representatives(const NodalVectors& points, const std::vector<Triangle>& triangles, double edge) {
  std::map<std::array<long, 3>, std::vector<int>> cubes;
  std::vector<int> of(static_cast<std::size_t>(points.rows()), -1);
  for (const Triangle& t : triangles)
    for (int n : t) {
      if (of[n] >= 0) continue;
      of[n] = n;
      std::array<long, 3> cube;
      for (int d = 0; d < 3; ++d) cube[d] = std::lround(std::floor(points(n, d) / edge));
      cubes[cube].push_back(n);
    }
  for (const auto& [cube, nodes] : cubes) {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (int n : nodes) mean += points.row(n) / double(nodes.size());
    const int chosen = *std::ranges::min_element(nodes, [&](int a, int b) {
      return (points.row(a) - mean).squaredNorm() < (points.row(b) - mean).squaredNorm();
    });
    for (int n : nodes) of[n] = chosen;
  }
  return of;
}

}  // namespace

Picture picture(const RunKey& key, const Field& field, const NodalVectors* truth) {
  Picture p{key, {}, {}, {}, {}, {}, "cells"};
  const Eigen::VectorXd volume_change = nodal_volume_change(field);
  add_facets(*field.mesh, p, [&](int n) {
    append(field.displacement.row(n), p.displacement);
    p.volume_change.push_back(static_cast<float>(volume_change[n]));
    if (truth) p.difference.push_back(static_cast<float>((field.displacement.row(n) - truth->row(n)).norm()));
  });
  return p;
}

NodalVectors pictured_points(const Mesh& mesh) {
  Picture p;
  std::vector<int> nodes;
  add_facets(mesh, p, [&](int n) { nodes.push_back(n); });
  return mesh.nodes(nodes, Eigen::all);
}

Picture smooth_picture(const RunKey& key, const Field& field, const Mesh& body, const NodalVectors* truth) {
  Picture p{key, {}, {}, {}, {}, {}, "smooth"};
  const Eigen::VectorXd volume_change = nodal_volume_change(field);
  Locator locator(*field.mesh);
  add_facets(body, p, [&](int n) {
    const Location at = locator(body.nodes.row(n).transpose());
    Eigen::RowVector3d u = Eigen::RowVector3d::Zero(), v = u;
    double change = 0;
    for (int c = 0; c < 8; ++c) {
      const int node = field.mesh->hexahedra[at.cell][c];
      u += at.shape[c] * field.displacement.row(node);
      if (truth) v += at.shape[c] * truth->row(node);
      change += at.shape[c] * volume_change[node];
    }
    append(u, p.displacement);
    p.volume_change.push_back(static_cast<float>(change));
    if (truth) p.difference.push_back(static_cast<float>((u - v).norm()));
  });
  return p;
}

std::vector<std::array<int, 4>> thinned(const NodalVectors& points, const std::vector<std::array<int, 4>>& facets,
                                        std::size_t most) {
  const std::vector<Triangle> triangles = triangles_of(facets);
  if (triangles.size() <= most) return facets;
  std::vector<std::array<int, 4>> kept;
  for (double edge = std::sqrt(2 * area(points, triangles) / double(most)); edge > 0; edge *= 1.1) {
    const std::vector<int> of = representatives(points, triangles, edge);
    std::set<Triangle> seen;
    kept.clear();
    for (const auto& [a, b, c] : triangles) {
      const Triangle t = {of[a], of[b], of[c]};
      Triangle key = t;
      std::ranges::sort(key);
      if (key[0] == key[1] || key[1] == key[2] || !seen.insert(key).second) continue;
      kept.push_back({t[0], t[1], t[2], -1});
    }
    if (kept.size() <= most) return kept;
  }
  return kept;
}

}  // namespace springproof
