// Tetrahedra that are cut without their faces ceasing to match.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/surface/surface.h"

namespace springproof {

/// Tetrahedra with their outer facets, of which each knows its patches.  Every change keeps the cells' volumes
/// positive.
class CutMesh {
 public:
  /// @param mesh of tetrahedra; facets of its patches that are not outer ones are dropped
  explicit CutMesh(const Mesh& mesh);

  const std::vector<Vec3>& points() const { return surface_.points; }
  const Surface& surface() const { return surface_; }  ///< all nodes and the outer facets
  const std::vector<int>& facets_at(int node) const { return facets_at_[node]; }
  std::size_t cells() const { return cells_.size(); }
  const std::vector<Tetrahedron>& tetrahedra() const { return cells_; }

  /// Of each cell, as Mesh::materials; empty: one.
  const std::vector<std::uint8_t>& materials() const { return materials_; }
  void set_materials(std::vector<std::uint8_t> materials) { materials_ = std::move(materials); }

  /// Puts a facet into a patch: the next number is that of a new one.
  void add_to_patch(std::size_t facet, int patch) { patches_[facet].push_back(patch); }
  bool is_in_patch(std::size_t facet, int patch) const {
    return std::find(patches_[facet].begin(), patches_[facet].end(), patch) != patches_[facet].end();
  }

  /// Cuts all cells and facets at the edge a-b in two, at a point of the edge.
  /// @return the new node
  int bisect(int a, int b, const Vec3& at);

  /// Bisects the edge in the middle, longer ones beside it first: shapes stay as they are (Rivara).
  void refine(int a, int b);

  /// Whether cells of several materials meet in a node.
  bool is_between_materials(int node) const;

  /// Moves a node if that keeps the cells' shapes, the borders of patches and regions and, to 0.03 of the shortest
  /// edge, a smooth surface.
  bool slide(int node, const Vec3& to);

  /// Moves nodes, or none if a cell would turn over.
  bool move(const std::vector<int>& nodes, const std::vector<Vec3>& to);

  /// Nodes, tetrahedra and patches as they have become.
  Mesh mesh(const std::vector<std::string>& patches) const;

  /// Least 6 sqrt(2) V / (root mean square of the edges)^3: 1 for a regular one.
  double worst_shape() const;

 private:
  bool is_edge(int a, int b) const;
  double length(int a, int b) const { return (points()[a] - points()[b]).norm(); }
  double shape(const Tetrahedron& cell) const;
  double worst_shape(int node) const;
  bool keeps_surface(int node, const Vec3& to) const;
  std::array<int, 2> longest_edge_around(int a, int b) const;

  Surface surface_;
  std::vector<Tetrahedron> cells_;
  std::vector<std::uint8_t> materials_;
  std::vector<std::vector<int>> patches_;               ///< of each facet, ascending
  std::vector<std::vector<int>> cells_at_, facets_at_;  ///< of each node
};

}  // namespace springproof
