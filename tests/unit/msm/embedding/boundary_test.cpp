#include "msm/embedding/boundary.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "support/tolerances.h"

namespace springproof::boundary_test {
namespace {

NodalVectors external(const std::vector<Load>& loads, const Mesh& mesh, double factor = 1) {
  return transfer(loads, mesh, 1000, Kinematics::linear, factor).external;
}

/// No facet is flat, no two are alike.
Mesh warped_block() {
  Mesh mesh = block_mesh({1, 1.2, 0.8}, {3, 3, 3});
  for (int n = 0; n < mesh.nodes.rows(); ++n)
    for (int d = 0; d < 3; ++d) mesh.nodes(n, d) += 0.05 * std::sin(5 * n + 2 * d);
  return mesh;
}

TEST(Pressure, OnAFlatPatchIsATractionAgainstTheNormal) {
  const Mesh mesh = block_mesh({1, 2, 3}, {2, 3, 4});
  const NodalVectors f = external({Pressure{"y_max", 5}}, mesh, 0.5);
  const NodalVectors t = external({Traction{"y_max", {0, -5, 0}}}, mesh, 0.5);
  EXPECT_LE((f - t).norm(), test::round_off * t.norm());
  EXPECT_NEAR(f.col(1).sum(), -0.5 * 5 * 3, 10 * test::round_off);
}

TEST(Pressure, OnAClosedSurfaceHasNoResultantAndNoMoment) {
  const Mesh mesh = warped_block();
  std::vector<Load> loads;
  for (const Patch& p : mesh.patches) loads.push_back(Pressure{p.name, 7});
  const NodalVectors f = external(loads, mesh);
  Vec3 moment = Vec3::Zero();
  for (int n = 0; n < f.rows(); ++n) moment += Vec3(mesh.nodes.row(n)).cross(Vec3(f.row(n)));
  EXPECT_LE(f.colwise().sum().norm(), test::round_off * f.norm());
  EXPECT_LE(moment.norm(), test::round_off * f.norm());
  EXPECT_GT(f.norm(), 1);
}

TEST(Pressure, DoesTheWorkOfThePressureOnAnyLinearMotion) {
  // Divergence theorem: the work on u = H X is -pressure * trace(H) * volume.
  const Mesh mesh = block_mesh({1, 2, 3}, {2, 2, 2});
  std::vector<Load> loads;
  for (const Patch& p : mesh.patches) loads.push_back(Pressure{p.name, 7});
  Eigen::Matrix3d H;
  H << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  const double work = external(loads, mesh).cwiseProduct(mesh.nodes * H.transpose()).sum();
  EXPECT_NEAR(work, -7 * H.trace() * 6, 1e3 * test::round_off);
}

TEST(Pressure, OnATriangleIsSharedEqually) {
  Mesh mesh;
  mesh.nodes.resize(3, 3);
  mesh.nodes << 0, 0, 0, 2, 0, 0, 0, 3, 0;
  mesh.patches = {{"top", {{0, 1, 2, -1}}}};
  const NodalVectors f = external({Pressure{"top", 4}}, mesh);
  for (int n = 0; n < 3; ++n) EXPECT_LE((Vec3(f.row(n)) - Vec3(0, 0, -4)).norm(), test::round_off);
}

TEST(BodyForceOfAField, IsRefused) {
  const Mesh mesh = block_mesh({1, 1, 1}, {1, 1, 1});
  try {
    external({FieldBodyForce{"solenoidal"}}, mesh);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("load 1: body_force_of"), std::string::npos) << error.what();
  }
}

TEST(PrescribedExactField, IsHeldAtEveryNodeOfThePatch) {
  const Mesh mesh = block_mesh({1, 1, 1}, {2, 2, 2});
  const BoundaryConditions bc = transfer({PrescribedField{"x_max", "trigonometric"}}, mesh, 1000, Kinematics::linear);
  EXPECT_EQ(std::count(bc.fixed.begin(), bc.fixed.end(), 1), 27);
  EXPECT_GT(bc.prescribed.norm(), 0);
}

}  // namespace
}  // namespace springproof::boundary_test
