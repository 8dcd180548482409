// What errors of the displacement are relative to.
#include "comparisons/judge/deformation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "comparisons/judge/reference_value.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"

namespace springproof::rigid_motion_test {
namespace {

Mesh block() { return block_mesh({1, 0.7, 2}, {3, 2, 4}); }

/// A strain of 1 %, less the rigid motion in it: none, as it is symmetric and about the middle.
NodalVectors strain_of(const Mesh& mesh) {
  Eigen::Matrix3d E;
  E << 3, 1, -2, 1, -1, 0.5, -2, 0.5, 2;
  const Eigen::RowVector3d middle(0.5, 0.35, 1);
  return 0.01 * (mesh.nodes.rowwise() - middle) * E;
}

TEST(RigidMotion, ASmallOneIsTakenAwayAndTheStrainIsLeft) {
  // At every node the same weight: rows and layers of a block of nodes lie about its middle.
  const Mesh mesh = block();
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(mesh.nodes.rows());
  const NodalVectors strain = strain_of(mesh);
  const Vec3 spin(0.3, -2, 1);
  NodalVectors u = strain.rowwise() + Eigen::RowVector3d(5, -1, 2);
  for (Eigen::Index n = 0; n < u.rows(); ++n) u.row(n) += spin.cross(Vec3(mesh.nodes.row(n).transpose())).transpose();
  const NodalVectors left = less_rigid_motion(mesh.nodes, u, weights, Kinematics::linear);
  const NodalVectors own = less_rigid_motion(mesh.nodes, strain, weights, Kinematics::linear);
  EXPECT_LT((left - own).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE(weighted_norm(own, weights), weighted_norm(strain, weights));
  EXPECT_GT(weighted_norm(own, weights), 0.5 * weighted_norm(strain, weights));
}

TEST(RigidMotion, ALargeTurnIsTakenAwayAtFiniteStrain) {
  const Mesh mesh = block();
  const Eigen::VectorXd weights = nodal_volumes(mesh);
  const NodalVectors strain = strain_of(mesh);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(2, Vec3(1, 2, -2) / 3).toRotationMatrix();
  const NodalVectors moved = (mesh.nodes + strain) * R.transpose();
  const NodalVectors u = (moved - mesh.nodes).rowwise() + Eigen::RowVector3d(5, -1, 2);
  const double left = weighted_norm(less_rigid_motion(mesh.nodes, u, weights, Kinematics::finite), weights);
  EXPECT_NEAR(left, weighted_norm(less_rigid_motion(mesh.nodes, strain, weights, Kinematics::finite), weights), 1e-12);
  EXPECT_GT(weighted_norm(less_rigid_motion(mesh.nodes, u, weights, Kinematics::linear), weights), 10 * left)
      << "a turn of two radians is no small one";
}

TEST(RigidMotion, CountsOnlyWhereMovedSupportsCarryTheBody) {
  const Mesh mesh = block();
  const Eigen::VectorXd weights = nodal_volumes(mesh);
  const NodalVectors strain = strain_of(mesh);
  const NodalVectors carried = strain.rowwise() + Eigen::RowVector3d(1, 0, 0);
  const DisplacementScale scale = displacement_scale(mesh, carried, true, Kinematics::linear);
  const NodalVectors left = less_rigid_motion(mesh.nodes, strain, weights, Kinematics::linear);
  EXPECT_NEAR(scale.mean, weighted_norm(left, weights), 1e-12);
  EXPECT_NEAR(scale.largest, left.rowwise().norm().maxCoeff(), 1e-12);
  EXPECT_NEAR(scale.share, weighted_norm(left, weights) / weighted_norm(carried, weights), 1e-12);
  for (const auto& [u, moved] : {std::pair(carried, false), std::pair(strain, true)}) {
    const DisplacementScale whole = displacement_scale(mesh, u, moved, Kinematics::linear);
    EXPECT_EQ(whole.mean, weighted_norm(u, weights));
    EXPECT_EQ(whole.share, 1);
  }
  const NodalVectors ride = NodalVectors::Constant(mesh.nodes.rows(), 3, 0.3);
  EXPECT_EQ(displacement_scale(mesh, ride, true, Kinematics::linear).share, 1) << "there is nothing else";
}

/// A cube between rough plates that come 1 % closer, and are carried along.
CaseResult squeezed_cube(double ride) {
  const Experiment e = parse_experiment(fmt::format(R"([body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [4, 4, 4]
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = 0.45
[[load]]
on = "z_min"
displacement_m = [{0}, 0, 0.005]
[[load]]
on = "z_max"
displacement_m = [{0}, 0, -0.005]
[compare]
models = ["hybmss", "msm_18"]
measures = ["displacement_error", "displacement_error_max"]
[reference]
cells = [8, 8, 8]
)",
                                                    ride),
                                        "cube.toml");
  CaseResult result;
  static_cast<Part&>(result) = run_part(prepare(e), 0, {});
  result.experiment = e;
  return result;
}

TEST(RigidMotion, ARideOfTheSupportsHidesNoError) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const CaseResult at_rest = squeezed_cube(0), carried = squeezed_cube(1);
  ASSERT_EQ(at_rest.rows.size(), carried.rows.size());
  int compared = 0;
  for (std::size_t r = 0; r < at_rest.rows.size(); ++r) {
    const Row &a = at_rest.rows[r], &b = carried.rows[r];
    if (!a.measure.starts_with("displacement_error")) continue;
    ++compared;
    EXPECT_NEAR(b.value, a.value, 1e-3 * a.value) << b.model << ' ' << b.measure;
    EXPECT_NEAR(*b.reference_uncertainty, *a.reference_uncertainty, 0.05 * *a.reference_uncertainty) << b.measure;
  }
  EXPECT_EQ(compared, 6) << "two measures of two models and of finite elements";
  const ReferenceRecord &a = at_rest.references.back(), &b = carried.references.back();
  ASSERT_EQ(b.measure, "displacement_error");
  for (std::size_t g = 0; g < 3; ++g) EXPECT_NEAR(b.values[g], a.values[g], 0.01 * a.values[g]);
  EXPECT_NEAR(b.uncertainty, a.uncertainty, 0.05 * a.uncertainty);
  EXPECT_EQ(at_rest.deformations[0].strained_share, 1);
  EXPECT_NEAR(carried.deformations[0].strained_share, 0.003, 0.001);
  EXPECT_TRUE(cautions(at_rest).empty());
  ASSERT_EQ(cautions(carried).size(), 1u);
  EXPECT_TRUE(cautions(carried)[0].starts_with("the supports carry the body along")) << cautions(carried)[0];
}

}  // namespace
}  // namespace springproof::rigid_motion_test
