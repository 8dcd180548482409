#include "meshes/volume.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "support/tolerances.h"

namespace springproof::volume_test {
namespace {

using Corners = Eigen::Matrix<double, 8, 3>;

Corners unit_cube() {
  Corners x;
  for (int n = 0; n < 8; ++n)
    for (int c = 0; c < 3; ++c) x(n, c) = hexahedron_corners[n][c];
  return x;
}

Corners noise(double size, unsigned seed) {
  std::mt19937 generator(seed);
  Corners v;
  for (int i = 0; i < v.size(); ++i) v.data()[i] = size * (2.0 * generator() / 4294967295.0 - 1);
  return v;
}

/// Integral over the reference cube of f(gradients of the shape functions, 3 x 8) by 3 x 3 x 3 Gauss points,
/// exact for degree 5.
template <class Function>
double integrate(Function&& f) {
  const double points[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)}, weights[] = {5. / 18, 8. / 18, 5. / 18};
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        const double xi[] = {points[i], points[j], points[k]};
        Eigen::Matrix<double, 3, 8> gradients;
        for (int n = 0; n < 8; ++n)
          for (int d = 0; d < 3; ++d) {
            double g = 1;
            for (int c = 0; c < 3; ++c) {
              const bool high = hexahedron_corners[n][c] == 1;
              g *= c == d ? (high ? 1 : -1) : (high ? xi[c] : 1 - xi[c]);
            }
            gradients(d, n) = g;
          }
        sum += weights[i] * weights[j] * weights[k] * f(gradients);
      }
  return sum;
}

double volume_by_quadrature(const Corners& x) {
  return integrate([&](const auto& gradients) { return Eigen::Matrix3d(gradients * x).determinant(); });
}

Mesh one_cell(const Corners& x) {
  Mesh mesh;
  mesh.nodes = x;
  mesh.hexahedra = {{0, 1, 2, 3, 4, 5, 6, 7}};
  return mesh;
}

TEST(Volume, UnitCubeAndScaledBox) {
  EXPECT_DOUBLE_EQ(hexahedron_volume(unit_cube()), 1);
  const Corners box = unit_cube() * Vec3(2, 3, 0.5).asDiagonal();
  EXPECT_DOUBLE_EQ(hexahedron_volume(box), 3);
}

TEST(Volume, DistortedHexahedraAgainstQuadrature) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Corners x = unit_cube() + noise(0.3, seed);
    EXPECT_NEAR(hexahedron_volume(x), volume_by_quadrature(x), test::round_off);
  }
}

// Not even a cell: the formula is a polynomial identity, so it holds for any eight points.
TEST(Volume, AnyEightPointsAgainstQuadrature) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Corners x = noise(1, seed);
    EXPECT_NEAR(hexahedron_volume(x), volume_by_quadrature(x), test::round_off);
  }
}

TEST(Volume, MirroredCellIsNegative) {
  const Corners x = unit_cube() + noise(0.2, 3);
  const Corners mirrored = x * Vec3(-1, 1, 1).asDiagonal();
  EXPECT_NEAR(hexahedron_volume(mirrored), -hexahedron_volume(x), test::round_off);
  EXPECT_LT(hexahedron_volume(mirrored), 0);
}

TEST(Volume, RigidMotionAndAffineMaps) {
  const Corners x = unit_cube() + noise(0.2, 7);
  Eigen::Matrix3d F;
  F << 1.1, 0.3, 0, -0.2, 0.9, 0.4, 0.1, 0, 1.5;
  const Corners mapped = (x * F.transpose()).rowwise() + Eigen::RowVector3d(5, -3, 2);
  EXPECT_NEAR(hexahedron_volume(mapped), F.determinant() * hexahedron_volume(x),
              1e-11);  // coordinates up to 8
}

TEST(Volume, FarFromTheOriginKeepsItsDigits) {
  const Corners x = unit_cube().rowwise() + Eigen::RowVector3d(1e6, -1e6, 1e6);
  EXPECT_NEAR(hexahedron_volume(x), 1, 1e-15);  // these coordinates are exact
}

TEST(Volume, Tetrahedron) {
  Eigen::Matrix<double, 4, 3> x;
  x << 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4;
  EXPECT_DOUBLE_EQ(tetrahedron_volume(x), 4);
  x.row(1).swap(x.row(2));
  EXPECT_DOUBLE_EQ(tetrahedron_volume(x), -4);
}

TEST(Volume, HexahedraBeforeTetrahedra) {
  Mesh mesh;
  mesh.nodes.resize(9, 3);
  mesh.nodes.topRows(8) = unit_cube();
  mesh.nodes.row(8) << 0, 0, 4;  // tetrahedron on the top face's corner triangle, height 3
  mesh.hexahedra = {{0, 1, 2, 3, 4, 5, 6, 7}};
  mesh.tetrahedra = {{4, 5, 7, 8}};
  const Eigen::VectorXd volumes = cell_volumes(mesh, mesh.nodes);
  ASSERT_EQ(volumes.size(), 2);
  EXPECT_DOUBLE_EQ(volumes[0], 1);
  EXPECT_DOUBLE_EQ(volumes[1], 0.5);
  EXPECT_DOUBLE_EQ(volume(mesh, mesh.nodes), 1.5);
  // A dilation changes both kinds of cell alike.
  EXPECT_NEAR(volume_change(mesh, 0.1 * mesh.nodes), 1.1 * 1.1 * 1.1 - 1, test::round_off);
  EXPECT_NEAR(volume_change_first_order(mesh, 0.1 * mesh.nodes), 0.3, test::round_off);
}

TEST(VolumeChange, IsTheDifferenceOfVolumes) {
  const Mesh mesh = one_cell(unit_cube() + noise(0.2, 1));
  const NodalVectors u = noise(0.3, 2);
  const double V = volume_by_quadrature(mesh.nodes);
  const double deformed = volume_by_quadrature(mesh.nodes + u);
  EXPECT_NEAR(volume_change(mesh, u), (deformed - V) / V, test::round_off);
}

TEST(VolumeChange, FirstOrderIsTheIntegralOfTheDivergence) {
  const Corners X = unit_cube() + noise(0.2, 4), u = noise(0.3, 5);
  const double divergence = integrate([&](const auto& gradients) {
    const Eigen::Matrix3d J = gradients * X;
    return (J.inverse() * (gradients * u)).trace() * J.determinant();
  });
  EXPECT_NEAR(volume_change_first_order(one_cell(X), u), divergence / volume_by_quadrature(X), test::round_off);
}

TEST(VolumeChange, SmallDisplacementsKeepTheirDigits) {
  const Mesh mesh = block_mesh({2, 1, 1}, {8, 4, 4});
  const double strain = 1e-11;
  const NodalVectors u = strain * mesh.nodes;
  // (1 + e)^3 - 1 without cancellation.
  EXPECT_NEAR(volume_change(mesh, u) / (3 * strain * (1 + strain)), 1, test::round_off);
}

TEST(VolumeChange, RotationChangesNoVolumeButTheFirstOrderOneSeesIt) {
  const Mesh mesh = block_mesh({2, 1, 1}, {4, 2, 2});
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const NodalVectors u = mesh.nodes * (R - Eigen::Matrix3d::Identity()).transpose();
  EXPECT_NEAR(volume_change(mesh, u), 0, test::round_off);
  EXPECT_NEAR(volume_change_first_order(mesh, u), 2 * (std::cos(0.7) - 1), test::round_off);  // tr R - 3
}

TEST(MinRelativeJacobian, HomogeneousDeformation) {
  const Mesh mesh = block_mesh({2, 1, 1}, {4, 2, 2});
  EXPECT_NEAR(min_relative_jacobian(mesh, mesh.nodes), 1, test::round_off);
  const NodalVectors stretched = mesh.nodes * Vec3(1.5, 0.5, 0.8).asDiagonal();
  EXPECT_NEAR(min_relative_jacobian(mesh, stretched), 0.6, test::round_off);
}

TEST(MinRelativeJacobian, IsRelativeToADistortedRestShape) {
  const Mesh mesh = one_cell(unit_cube() + noise(0.2, 6));
  Eigen::Matrix3d F;
  F << 1.1, 0.3, 0, -0.2, 0.9, 0.4, 0.1, 0, 0.5;
  EXPECT_NEAR(min_relative_jacobian(mesh, mesh.nodes * F.transpose()), F.determinant(), test::round_off);
}

TEST(MinRelativeJacobian, SeesACornerPushedThrough) {
  const Mesh mesh = one_cell(unit_cube());
  NodalVectors x = mesh.nodes;
  x.row(6) << 0.3, 0.3, 0.3;  // corner (1,1,1) beyond the plane of its neighbours
  EXPECT_LT(min_relative_jacobian(mesh, x), 0);
  EXPECT_GT(volume(mesh, x), 0) << "the cell's volume alone would not show it";
}

TEST(CornerJacobians, OfABoxAreItsVolume) {
  const Mesh mesh = one_cell(unit_cube() * Vec3(2, 3, 0.5).asDiagonal());
  for (const double jacobian : corner_jacobians(mesh.hexahedra[0], mesh.nodes)) EXPECT_DOUBLE_EQ(jacobian, 3);
}

TEST(CornerJacobians, AreTheDeterminantsAtTheCorners) {
  const Corners x = unit_cube() + noise(0.3, 8);
  // At corner 6 = (1,1,1) the axes leave towards corners 7, 5 and 2.
  Eigen::Matrix3d J;
  J << x.row(6) - x.row(7), x.row(6) - x.row(5), x.row(6) - x.row(2);
  EXPECT_NEAR(corner_jacobians({0, 1, 2, 3, 4, 5, 6, 7}, x)[6], J.determinant(), test::round_off);
}

}  // namespace
}  // namespace springproof::volume_test
