#include "meshes/locate/outer_facets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

#include "meshes/locate/facet_tree.h"
#include "support/bodies.h"

namespace springproof::outer_facets_test {
namespace {

/// Blocks of hexahedra, of tetrahedra, and both in one mesh (next to each other, apart), their nodes renumbered at
/// random.
Mesh body(bool hexahedra, bool tetrahedra) {
  const Mesh block = block_mesh({3, 2, 2}, {3, 2, 2}), cut = test::tetrahedra_of(block);
  const int n = static_cast<int>(block.nodes.rows());
  std::vector<int> number(2 * n);
  for (int i = 0; i < 2 * n; ++i) number[i] = i;
  std::shuffle(number.begin(), number.end(), std::mt19937(1));
  Mesh mesh;
  mesh.nodes.resize(2 * n, 3);
  for (int i = 0; i < n; ++i) {
    mesh.nodes.row(number[i]) = block.nodes.row(i);
    mesh.nodes.row(number[n + i]) = block.nodes.row(i) + Eigen::RowVector3d(5, 0, 0);
  }
  for (Hexahedron cell : block.hexahedra) {
    for (int& c : cell) c = number[c];
    if (hexahedra) mesh.hexahedra.push_back(cell);
  }
  for (Tetrahedron cell : cut.tetrahedra) {
    for (int& c : cell) c = number[n + c];
    if (tetrahedra) mesh.tetrahedra.push_back(cell);
  }
  return mesh;
}

/// By counting every face in a map: the same facets in the same order.
TEST(OuterFacets, ThoseOfOneCellByAscendingKey) {
  constexpr int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  for (const auto& [with_hexahedra, with_tetrahedra] :
       {std::pair(true, false), std::pair(false, true), std::pair(true, true)}) {
    const Mesh mesh = body(with_hexahedra, with_tetrahedra);
    std::map<std::array<int, 4>, std::vector<std::array<int, 4>>> all;
    const auto count = [&](const std::array<int, 4>& nodes) {
      auto key = nodes;
      std::sort(key.begin(), key.end());
      all[key].push_back(nodes);
    };
    for (const Hexahedron& cell : mesh.hexahedra)
      for (int f = 0; f < 6; ++f) count(face_of(cell, f));
    for (const Tetrahedron& cell : mesh.tetrahedra)
      for (const auto& f : faces) count({cell[f[0]], cell[f[1]], cell[f[2]], -1});
    std::erase_if(all, [](const auto& entry) { return entry.second.size() != 1; });
    const std::vector<OuterFacet> outer = outer_facets(mesh);
    ASSERT_EQ(outer.size(), all.size());
    std::size_t i = 0;
    for (const auto& [key, nodes] : all) {
      EXPECT_EQ(outer[i].key, key);
      EXPECT_EQ(outer[i++].nodes, nodes.front());
    }
    EXPECT_EQ(outer.size(), 32u * with_hexahedra + 64u * with_tetrahedra);
  }
}

TEST(OuterFacets, CellCentreIsBehind) {
  for (const OuterFacet& f : outer_facets(block_mesh({2, 2, 2}, {2, 2, 2}))) {
    EXPECT_EQ((f.cell_centre - Vec3::Ones()).cwiseAbs(), Vec3::Constant(0.5));
  }
  EXPECT_TRUE(outer_facets(Mesh{}).empty());
}

TEST(FacetTree, FindsTheNearestOfAll) {
  const Mesh mesh = body(true, true);
  const std::vector<OuterFacet> facets = outer_facets(mesh);
  const FacetTree tree(mesh, facets);
  std::mt19937 generator(2);
  for (int i = 0; i < 500; ++i) {
    Vec3 p;
    for (double& x : p) x = generator() / 4294967295.0 * 10 - 2;
    if (i % 5 == 0) p = p.array().round();  // ties
    double least = 1e300;
    std::size_t first = 0;
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const auto x = [&](int c) -> Vec3 { return mesh.nodes.row(facets[f].nodes[c]).transpose(); };
      double d = (closest_point(p, x(0), x(1), x(2)) - p).norm();
      if (facets[f].nodes[3] >= 0) d = std::min(d, (closest_point(p, x(0), x(2), x(3)) - p).norm());
      if (d < least) {
        least = d;
        first = f;
      }
    }
    const FacetTree::Nearest nearest = tree.nearest(p);
    EXPECT_EQ(nearest.distance, least);
    EXPECT_EQ(nearest.facet, first);
    EXPECT_EQ((nearest.point - p).norm(), least);
  }
  EXPECT_THROW(FacetTree(mesh, {}), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::outer_facets_test
