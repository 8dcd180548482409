#include "meshes/locate/tetrahedron_locator.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "meshes/mesher/mesher.h"

namespace springproof::tetrahedron_locator_test {
namespace {

Mesh tetrahedral_block() {
  return mesh_geo(find_geo({"block.geo", {}, {}, {}}, "case.toml"), {1, 2, 3}, {4, 5, 6}, {.tetrahedra = true});
}

Vec3 at(const Mesh& mesh, const TetrahedronLocator::Place& place) {
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 4; ++i) x += place.weights[i] * mesh.nodes.row(mesh.tetrahedra[place.cell][i]).transpose();
  return x;
}

TEST(TetrahedronLocator, PointsInsideHaveWeightsOfTheirCell) {
  const Mesh mesh = tetrahedral_block();
  const TetrahedronLocator locate(mesh.nodes, mesh.tetrahedra);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(x(random), 2 * x(random), 3 * x(random));
    const auto place = locate(p);
    EXPECT_EQ(place.outside, 0);
    EXPECT_GE(place.weights.minCoeff(), -1e-8);
    EXPECT_LT((at(mesh, place) - p).norm(), 1e-13);
  }
  for (const auto& node : mesh.nodes.rowwise()) EXPECT_EQ(locate(node.transpose()).outside, 0);
}

TEST(TetrahedronLocator, PointsOutsideGetACellThatTheyAreNear) {
  const Mesh mesh = tetrahedral_block();
  const TetrahedronLocator locate(mesh.nodes, mesh.tetrahedra);
  const auto above = locate({0.3, 0.7, 3.2});
  EXPECT_NEAR(above.outside, 0.2, 1e-12);
  EXPECT_LT((at(mesh, above) - Vec3(0.3, 0.7, 3.2)).norm(), 1e-12);  // continued linearly
  EXPECT_NEAR(locate({-5, 1, 1}).outside, 5, 1e-12);
}

// So that processes that look among parts of a mesh find together what one finds.
TEST(TetrahedronLocator, FindsTheNearestCellAndOfSeveralTheFirst) {
  const Mesh mesh = tetrahedral_block();
  std::vector<Tetrahedron> scattered;
  std::vector<TetrahedronLocator> alone;
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); c += 9) {
    scattered.push_back(mesh.tetrahedra[c]);
    alone.emplace_back(mesh.nodes, std::vector{mesh.tetrahedra[c]});
  }
  const TetrahedronLocator locate(mesh.nodes, scattered);
  std::vector<Vec3> points;
  for (const auto& node : mesh.nodes.rowwise()) points.emplace_back(node.transpose());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-1, 2);
  for (int i = 0; i < 2000; ++i) points.emplace_back(x(random), 2 * x(random), 3 * x(random));
  for (const Vec3& p : points) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < alone.size(); ++c)
      if (const double outside = alone[c](p).outside; outside < least) {
        least = outside;
        nearest = c;
      }
    const auto place = locate(p);
    EXPECT_EQ(place.outside, least);
    EXPECT_EQ(place.cell, nearest);
  }
}

TEST(TetrahedronLocator, NeedsTetrahedra) {
  EXPECT_THROW(TetrahedronLocator(NodalVectors(0, 3), {}), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::tetrahedron_locator_test
