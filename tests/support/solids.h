// Solids of tetrahedra with named patches, moved about: for cut cells.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <set>

#include "meshes/locate/outer_facets.h"
#include "meshes/voxels/voxelise.h"
#include "support/bodies.h"

namespace springproof::test {

/// Tetrahedra of a block of hexahedra with its patches, and the whole surface as "surface".
inline Mesh solid_of(const Mesh& blocks) {
  Mesh mesh = tetrahedra_of(blocks);
  std::vector<std::set<int>> nodes;
  for (const Patch& p : blocks.patches) {
    mesh.patches.push_back({p.name, {}});
    const std::vector<int> of = nodes_of(p);
    nodes.emplace_back(of.begin(), of.end());
  }
  mesh.patches.push_back({"surface", {}});
  for (const OuterFacet& f : outer_facets(mesh)) {
    std::array<int, 4> facet = {f.nodes[0], f.nodes[1], f.nodes[2], -1};
    const auto X = [&](int i) -> Vec3 { return mesh.nodes.row(facet[i]).transpose(); };
    if ((X(1) - X(0)).cross(X(2) - X(0)).dot(X(0) - f.cell_centre) < 0) std::swap(facet[1], facet[2]);
    mesh.patches.back().facets.push_back(facet);
    for (std::size_t p = 0; p < nodes.size(); ++p)
      if (nodes[p].contains(facet[0]) && nodes[p].contains(facet[1]) && nodes[p].contains(facet[2]))
        mesh.patches[p].facets.push_back(facet);
  }
  return mesh;
}

/// Each point moved to map(point).
template <class Map>
Mesh mapped(Mesh mesh, const Map& map) {
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    const Vec3 x = map(Vec3(mesh.nodes.row(n).transpose()));
    mesh.nodes.row(n) = x.transpose();
  }
  return mesh;
}

/// Of diameter 1 about the z axis from z = 0 to `length`, ends "z_min" and "z_max".
inline Mesh cylinder(double length, int across, int along) {
  const Mesh block = block_mesh({2, 2, length}, {across, across, along});
  return mapped(solid_of(block), [](const Vec3& p) -> Vec3 {
    const double x = p[0] - 1, y = p[1] - 1;
    return {0.5 * x * std::sqrt(1 - y * y / 2), 0.5 * y * std::sqrt(1 - x * x / 2), p[2]};
  });
}

/// Of diameter 1 about zero.
inline Mesh ball_of_tetrahedra(int across) {
  const Mesh block = block_mesh({2, 2, 2}, {across, across, across});
  return mapped(solid_of(block), [](const Vec3& p) -> Vec3 {
    const Vec3 q = p - Vec3::Ones(), s = q.cwiseProduct(q);
    Vec3 x;
    for (int i = 0; i < 3; ++i) {
      const double a = s[(i + 1) % 3], b = s[(i + 2) % 3];
      x[i] = q[i] * std::sqrt(1 - a / 2 - b / 2 + a * b / 3) / 2;
    }
    return x;
  });
}

/// Turned and moved by up to an edge, at random.
struct Placement {
  Eigen::Matrix3d turn;
  Vec3 offset;
  Vec3 operator()(const Vec3& x) const { return turn * x + offset; }
};
inline Placement random_placement(unsigned seed, double edge) {
  std::mt19937 bits(seed);
  const auto uniform = [&] { return bits() / 4294967296.0; };
  Eigen::Quaterniond q(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
  return {q.normalized().toRotationMatrix(), edge * Vec3(uniform(), uniform(), uniform())};
}

/// A grid of cubes with a point at the origin that holds a body.
inline VoxelGrid grid_about(const Mesh& body, double edge) {
  VoxelGrid grid;
  grid.edge = edge;
  for (int d = 0; d < 3; ++d) {
    const double low = std::floor(body.nodes.col(d).minCoeff() / edge + 1e-9);
    grid.origin[d] = edge * low;
    grid.cells[d] = static_cast<int>(std::ceil(body.nodes.col(d).maxCoeff() / edge - low - 1e-9));
  }
  return grid;
}

}  // namespace springproof::test
