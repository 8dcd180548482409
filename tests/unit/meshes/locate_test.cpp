#include "meshes/locate/locate.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "support/tolerances.h"

namespace springproof::locate_test {
namespace {

Vec3 position(const Mesh& mesh, const Location& location) {
  Vec3 x = Vec3::Zero();
  for (int n = 0; n < 8; ++n) x += location.shape[n] * mesh.nodes.row(mesh.hexahedra[location.cell][n]).transpose();
  return x;
}

/// Inner nodes moved at random: cells with curved faces that still fit each other.
Mesh distorted_block() {
  Mesh mesh = block_mesh({3, 2, 2}, {3, 2, 2});
  std::mt19937 generator(1);
  for (double& x : mesh.nodes.reshaped()) x += 0.2 * (generator() / 4294967295.0 - 0.5);
  mesh.grid.reset();
  return mesh;
}

TEST(Locate, PointInABox) {
  const Mesh mesh = block_mesh({4, 2, 1}, {4, 2, 1});
  const auto location = locate(mesh, {2.25, 1.5, 0.5});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->cell, 4u + 2);
  // (1 - 0.25) (1 - 0.5) (1 - 0.5) at the lowest corner, and so on.
  const double expected[] = {0.1875, 0.0625, 0.0625, 0.1875, 0.1875, 0.0625, 0.0625, 0.1875};
  for (int n = 0; n < 8; ++n) EXPECT_NEAR(location->shape[n], expected[n], test::round_off);
}

TEST(Locate, DistortedCellsGiveThePointBack) {
  const Mesh mesh = distorted_block();
  std::mt19937 generator(2);
  for (int i = 0; i < 200; ++i) {
    Vec3 point;
    for (double& x : point) x = 0.2 + generator() / 4294967295.0 * 1.6;
    const auto location = locate(mesh, point);
    ASSERT_TRUE(location) << point.transpose();
    EXPECT_LE((position(mesh, *location) - point).norm(), test::round_off);
    EXPECT_NEAR(location->shape.sum(), 1, test::round_off);
    EXPECT_GE(location->shape.minCoeff(), -1e-9);
  }
}

TEST(Locate, EveryNodeIsFound) {
  for (const Mesh& mesh : {distorted_block(), block_mesh({0.3, 0.7, 0.1}, {7, 3, 3})})
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) EXPECT_TRUE(locate(mesh, mesh.nodes.row(n).transpose())) << n;
}

TEST(Locate, FarFromTheOrigin) {
  Mesh mesh = distorted_block();
  mesh.nodes.rowwise() += Eigen::RowVector3d(1e6, -1e6, 1e6);
  for (const double offset : {0.31, 0.77, 1.13, 1.71})
    EXPECT_TRUE(locate(mesh, Vec3(1e6, -1e6, 1e6) + Vec3::Constant(offset))) << offset;
}

TEST(Locate, NothingOutside) {
  const Mesh mesh = block_mesh({1, 1, 1}, {2, 2, 2});
  for (const Vec3& point : {Vec3(1.001, 0.5, 0.5), Vec3(0.5, -0.001, 0.5), Vec3(5, 5, 5), Vec3(0.5, 0.5, NAN)})
    EXPECT_FALSE(locate(mesh, point)) << point.transpose();
  EXPECT_FALSE(locate(Mesh{}, Vec3::Zero()));
}

/// An L of cubes, off the origin; without its grid it takes the way of any hexahedra.
Mesh ell(bool with_grid) {
  Mesh mesh = block_mesh({1.5, 1, 2}, {6, 4, 8});
  std::vector<Hexahedron> kept;
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c)
    if (mesh.grid->cell_index[c][0] < 2 || mesh.grid->cell_index[c][2] < 2) kept.push_back(mesh.hexahedra[c]);
  mesh.hexahedra = kept;
  mesh.nodes.rowwise() += Eigen::RowVector3d(-7, 3, 0.1);
  mesh.grid = with_grid ? detect_grid(mesh) : std::nullopt;
  return mesh;
}

Vec3 somewhere(std::mt19937& generator, const Vec3& low, const Vec3& high) {
  Vec3 p;
  for (int d = 0; d < 3; ++d) p[d] = low[d] + (high[d] - low[d]) * (generator() / 4294967295.0);
  return p;
}

TEST(Locator, GridFindsWhatTheSearchFinds) {
  const Mesh with_grid = ell(true), without = ell(false);
  ASSERT_TRUE(with_grid.grid);
  const Locator fast(with_grid), slow(without);
  std::mt19937 generator(3);
  int found = 0;
  std::vector<Vec3> points;
  for (int i = 0; i < 500; ++i) points.push_back(somewhere(generator, {-7.5, 2.5, -0.4}, {-5, 4.5, 2.6}));
  for (Eigen::Index n = 0; n < with_grid.nodes.rows(); ++n) points.push_back(with_grid.nodes.row(n).transpose());
  for (const Vec3& p : points) {
    const auto a = fast.find(p), b = slow.find(p);
    ASSERT_EQ(a.has_value(), b.has_value()) << p.transpose();
    if (!a) continue;
    ++found;
    EXPECT_EQ(a->cell, b->cell);
    EXPECT_LE((a->shape - b->shape).norm(), test::round_off);
  }
  EXPECT_GT(found, 200);
  EXPECT_LT(found, static_cast<int>(points.size()) - 100);
}

double distance_to(const Mesh& mesh, std::size_t cell, const Vec3& p) {
  const Vec3 low = mesh.nodes.row(mesh.hexahedra[cell][0]), high = mesh.nodes.row(mesh.hexahedra[cell][6]);
  return (p - p.cwiseMax(low).cwiseMin(high)).norm();
}

/// The nearest cell by looking at all; shape functions that sum to 1 and give the point, and so every linear field,
/// back.
TEST(Locator, NearestCellAndLinearFields) {
  for (const Mesh& mesh : {ell(true), ell(false)}) {
    const Locator locator(mesh);
    std::mt19937 generator(4);
    for (int i = 0; i < 400; ++i) {
      const double reach = i % 4 == 0 ? 20 : 0.5;  // from far away as well
      const Vec3 p =
          somewhere(generator, Vec3(-7, 3, 0.1) - Vec3::Constant(reach), Vec3(-5.5, 4, 2.1) + Vec3::Constant(reach));
      const Location at = locator(p);
      double least = 1e300;
      for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) least = std::min(least, distance_to(mesh, c, p));
      EXPECT_NEAR(distance_to(mesh, at.cell, p), least, 1e-12);
      EXPECT_NEAR(at.shape.sum(), 1, 1e-12);
      EXPECT_LE((position(mesh, at) - p).norm(), 1e-11);
      if (const auto inside = locate(mesh, p)) {
        EXPECT_EQ(inside->cell, at.cell);
      }
    }
  }
}

TEST(Locator, OutsideDistortedCells) {
  const Mesh mesh = distorted_block();
  const Locator locator(mesh);
  std::mt19937 generator(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = somewhere(generator, {-0.5, -0.5, -0.5}, {3.5, 2.5, 2.5});
    const Location at = locator(p);
    EXPECT_NEAR(at.shape.sum(), 1, 1e-12);
    EXPECT_LE((position(mesh, at) - p).norm(), 1e-11);
  }
}

TEST(Locator, NextToTheSurfaceShapeFunctionsAreContinuous) {
  const Mesh mesh = ell(true);
  const Vec3 on_top(-6.9, 3.3, 2.1);
  const Location inside = nearest(mesh, on_top - Vec3(0, 0, 1e-8)), outside = nearest(mesh, on_top + Vec3(0, 0, 1e-8));
  EXPECT_EQ(inside.cell, outside.cell);
  EXPECT_LE((inside.shape - outside.shape).norm(), 1e-6);
  EXPECT_LT(nearest(mesh, on_top + Vec3(0, 0, 0.05)).shape.minCoeff(), -0.01);
}

TEST(Locator, RefusesWhatHasNoPlace) {
  EXPECT_THROW(nearest(Mesh{}, Vec3::Zero()), std::invalid_argument);
  EXPECT_THROW(nearest(ell(true), Vec3(0, NAN, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::locate_test
