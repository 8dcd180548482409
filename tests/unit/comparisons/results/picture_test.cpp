#include "comparisons/results/picture.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace springproof::picture_test {
namespace {

Field field_on(const Mesh& mesh, const Eigen::Matrix3d& A) {
  Field f;
  f.mesh = std::make_shared<Mesh>(mesh);
  f.displacement = mesh.nodes * A.transpose();
  return f;
}

/// One tetrahedron with a corner in the origin and edges of length `a` along the axes.
Mesh corner_tetrahedron(double a) {
  Mesh mesh;
  mesh.nodes.resize(4, 3);
  mesh.nodes << 0, 0, 0, a, 0, 0, 0, a, 0, 0, 0, a;
  mesh.tetrahedra = {{0, 1, 2, 3}};
  return mesh;
}

Eigen::Matrix3d some_gradient() {
  Eigen::Matrix3d A;
  A << 0.1, 0.02, 0, 0, -0.05, 0.01, 0.03, 0, 0.2;
  return A;
}

TEST(Picture, VolumeChangeOfAnAffineFieldIsItsDeterminant) {
  const Eigen::Matrix3d A = some_gradient();
  const double expected = (Eigen::Matrix3d::Identity() + A).determinant() - 1;
  for (const Mesh& mesh : {block_mesh({1, 2, 3}, {2, 2, 2}), corner_tetrahedron(1.5)}) {
    const Picture p = picture({"m", 0.25, {2, 2, 2}}, field_on(mesh, A), nullptr);
    ASSERT_EQ(3 * p.volume_change.size(), p.rest.size());
    for (float change : p.volume_change) EXPECT_NEAR(change, expected, 1e-6);
    EXPECT_TRUE(p.difference.empty());
    EXPECT_EQ(p.surface, "cells");
  }
}

TEST(Picture, PatchesAreNumberedAsTheSurface) {
  const Picture p =
      picture({"m", 0.25, {3, 2, 2}}, field_on(block_mesh({3, 2, 2}, {3, 2, 2}), some_gradient()), nullptr);
  ASSERT_EQ(p.patches.size(), 6u);
  const std::vector<int>& end = p.patches.at("x_max");
  EXPECT_EQ(end.size(), 9u);
  for (int n : end) EXPECT_EQ(p.rest[3 * static_cast<std::size_t>(n)], 3);
}

TEST(Picture, VolumeChangeIsTheMeanOverTheCellsAtANode) {
  Field f = field_on(block_mesh({2, 1, 1}, {2, 1, 1}), Eigen::Matrix3d::Zero());
  for (Eigen::Index n = 0; n < f.displacement.rows(); ++n)
    if (f.mesh->nodes(n, 0) > 1.5) f.displacement(n, 0) = 0.4;  // the right cell grows by 40 %
  const Picture p = picture({"m", 0.25, {2, 1, 1}}, f, nullptr);
  ASSERT_EQ(p.volume_change.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(p.volume_change[i], 0.2 * p.rest[3 * i], 1e-6) << "0, 20 and 40 %";
}

TEST(Picture, FacetsAreQuadsOfHexahedraAndTrianglesOfTetrahedra) {
  const Picture hexahedra =
      picture({"m", 0.25, {2, 2, 2}}, field_on(block_mesh({1, 1, 1}, {2, 2, 2}), some_gradient()), nullptr);
  EXPECT_EQ(hexahedra.quads.size(), 4u * 24);
  EXPECT_EQ(hexahedra.rest.size(), 3u * 26);
  const Picture tetrahedra = picture({"m", 0.25, {1, 0, 0}}, field_on(corner_tetrahedron(1), some_gradient()), nullptr);
  ASSERT_EQ(tetrahedra.quads.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(tetrahedra.quads[i] == -1, i % 4 == 3) << i;
}

TEST(SmoothPicture, LinearFieldIsExactInsideAndOutsideTheVoxels) {
  const Eigen::Matrix3d A = some_gradient();
  const Mesh voxels = block_mesh({1, 1, 1}, {4, 4, 4}),
             body = corner_tetrahedron(1.1);  // corners 0.1 beyond the voxels
  const NodalVectors truth = voxels.nodes * (0.5 * A).transpose();
  const Picture p = smooth_picture({"m", 0.25, {4, 4, 4}}, field_on(voxels, A), body, &truth);
  EXPECT_EQ(p.surface, "smooth");
  ASSERT_EQ(p.rest.size(), 12u);
  ASSERT_EQ(p.difference.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 X(p.rest[3 * i], p.rest[3 * i + 1], p.rest[3 * i + 2]), u = A * X;
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(p.displacement[3 * i + d], u[d], 1e-6);
    EXPECT_NEAR(p.difference[i], 0.5 * u.norm(), 1e-6);
    EXPECT_NEAR(p.volume_change[i], (Eigen::Matrix3d::Identity() + A).determinant() - 1, 1e-6);
  }
}

/// A sphere of radius 1 as n x 2n quads.
struct Sphere {
  NodalVectors points;
  std::vector<std::array<int, 4>> facets;
};

Sphere sphere(int n) {
  Sphere s;
  s.points.resize((n + 1) * 2 * n, 3);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double a = M_PI * i / n, b = M_PI * j / n;
      s.points.row(2 * n * i + j) << std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a);
      const int right = (j + 1) % (2 * n);
      if (i < n) s.facets.push_back({2 * n * i + j, 2 * n * (i + 1) + j, 2 * n * (i + 1) + right, 2 * n * i + right});
    }
  return s;
}

double area(const Sphere& s, const std::vector<std::array<int, 4>>& facets) {
  double sum = 0;
  for (const auto& f : facets)
    for (int k = 1; k < (f[3] < 0 ? 2 : 3); ++k) {
      const Vec3 a = s.points.row(f[0]), b = s.points.row(f[k]), c = s.points.row(f[k + 1]);
      sum += 0.5 * (b - a).cross(c - a).norm();
    }
  return sum;
}

TEST(ThinSurface, FewFacetsStayAsTheyAre) {
  const Sphere s = sphere(20);
  EXPECT_EQ(thinned(s.points, s.facets), s.facets);
}

TEST(ThinSurface, ManyFacetsBecomeFewerOfTheSameShape) {
  const Sphere s = sphere(150);  // 90,000 triangles
  const auto facets = thinned(s.points, s.facets);
  EXPECT_LE(facets.size(), 20000u);
  EXPECT_GE(facets.size(), 12000u) << "thinner than asked for";
  for (const auto& f : facets) EXPECT_EQ(f[3], -1);
  EXPECT_NEAR(area(s, facets) / (4 * M_PI), 1, 0.01);
}

}  // namespace
}  // namespace springproof::picture_test
