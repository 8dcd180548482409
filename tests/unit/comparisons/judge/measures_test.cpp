// Measures of reactions, of patches, and of how far a body is deformed.
#include "comparisons/judge/measures.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <numbers>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/patch_mean.h"
#include "meshes/mesh.h"
#include "support/voxel_case.h"

namespace springproof::measures_test {
namespace {

using Values = std::map<std::string, double>;

std::map<std::string, ReferenceValue> reactions(const Vec3& force, const Vec3& torque, double uncertainty) {
  std::map<std::string, ReferenceValue> out;
  for (int d = 0; d < 3; ++d) {
    out[std::string("force.end.") + "xyz"[d]] = {force[d], uncertainty, {}, ""};
    out[std::string("torque.end.") + "xyz"[d]] = {torque[d], uncertainty, {}, ""};
  }
  return out;
}

std::optional<ReactionDifference> difference(const std::map<std::string, ReferenceValue>& truth, const Vec3& force,
                                             const Vec3& torque) {
  return reaction_difference(values_of(reactions(force, torque, 0)), values_of(truth), truth, {"end"}, 8.0);
}

TEST(ReactionDifference, IsThatOfTheForceOrTorqueThatIsFurtherOff) {
  const auto pull = reactions({0, 0, 10}, {20, 0, 0}, 1e-6);
  EXPECT_NEAR(difference(pull, {0, 1, 10}, {20, 0, 0})->error, 0.1, 1e-12);
  EXPECT_EQ(difference(pull, {0, 1, 10}, {20, 0, 0})->of, "force.end");
  EXPECT_NEAR(difference(pull, {0, 1, 10}, {20, 0, 6})->error, 0.3, 1e-12);
  EXPECT_EQ(difference(pull, {0, 1, 10}, {20, 0, 6})->of, "torque.end");
}

TEST(ReactionDifference, WhatVanishesInTheReferenceIsLeftOut) {
  const auto twist = reactions({0, 0, 0}, {0, 0, 5}, 1e-6);
  EXPECT_NEAR(difference(twist, {0.05, 0, 0}, {0, 0, 7.1})->error, 0.42, 1e-12)
      << "there is no force to be relative to";
  const auto slight = reactions({0.01, 0, 0}, {0, 0, 5}, 1e-6);
  EXPECT_NEAR(difference(slight, {0.05, 0, 0}, {0, 0, 7.1})->error, 0.42, 1e-12)
      << "0.01 N on 8 m is little beside 5 N m";
  const auto noise = reactions({1e-9, 0, 0}, {0, 2e-9, 0}, 1e-8);
  EXPECT_FALSE(difference(noise, {1, 0, 0}, {0, 0, 0})) << "a rigid motion";
  EXPECT_FALSE(reaction_difference({}, {}, {}, {"end"}, 8.0));
}

// ---- the mean displacement of a patch

TEST(PatchMean, IsWeightedByArea) {
  Mesh mesh = block_mesh({1, 2, 3}, {1, 2, 2});
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
    if (std::abs(mesh.nodes(n, 1) - 1) < 1e-12) mesh.nodes(n, 1) = 0.3;  // facets of unequal size
  const auto patches = samples_of_patches(mesh);
  ASSERT_EQ(patches.size(), 6u);
  Eigen::Index points = 0;
  for (const auto& p : patches) points += p.points.rows();
  NodalVectors u(points, 3);
  Eigen::Index at = 0;
  for (const auto& p : patches)
    for (const auto& X : p.points.rowwise()) u.row(at++) << X[1], X[2] * X[2], X[1] * X[2];
  const Values mean = mean_displacements(patches, u);
  EXPECT_NEAR(mean.at("mean_displacement.x_max.x"), 1, 1e-13);
  EXPECT_NEAR(mean.at("mean_displacement.x_max.y"), 3, 1e-13) << "of z^2 over 0 to 3";
  EXPECT_NEAR(mean.at("mean_displacement.x_max.z"), 1.5, 1e-13);
  EXPECT_NEAR(mean.at("mean_displacement.x_max.magnitude"), Vec3(1, 3, 1.5).norm(), 1e-13);
  EXPECT_NEAR(mean.at("mean_displacement.y_min.x"), 0, 1e-13);
  EXPECT_EQ(unit_of("mean_displacement.x_max.x"), "m");
  EXPECT_TRUE(wanted("mean_displacement.x_max.x", {"mean_displacement"}));
  EXPECT_FALSE(wanted("mean_displacement.x_max.x", {"probe"}));
}

TEST(PatchMean, OfTrianglesIsExactForQuadraticDisplacements) {
  Mesh mesh;
  mesh.nodes.resize(3, 3);
  mesh.nodes << 0, 0, 0, 2, 0, 0, 0, 1, 0;
  mesh.patches = {{"face", {{0, 1, 2, -1}}}};
  const auto patches = samples_of_patches(mesh);
  ASSERT_EQ(patches.size(), 1u);
  NodalVectors u(3, 3);
  for (int i = 0; i < 3; ++i) {
    const auto X = patches[0].points.row(i);
    u.row(i) << X[0] * X[0], X[0] * X[1], 1;
  }
  const Values mean = mean_displacements(patches, u);
  EXPECT_NEAR(mean.at("mean_displacement.face.x"), 4.0 / 6, 1e-14);
  EXPECT_NEAR(mean.at("mean_displacement.face.y"), 2.0 / 12, 1e-14);
  EXPECT_NEAR(mean.at("mean_displacement.face.z"), 1, 1e-14);
}

// ---- how far a body is deformed

NodalVectors moved_by(const Mesh& mesh, const Eigen::Matrix3d& gradient) { return mesh.nodes * gradient.transpose(); }

TEST(DeformationSize, OfHomogeneousFieldsIsExact) {
  const Mesh mesh = block_mesh({1, 2, 3}, {2, 3, 4});
  Eigen::Matrix3d H;
  H << 0.01, 0.04, 0, 0, -0.02, 0, 0, 0, 0.005;
  const Eigen::Matrix3d strain = (H + H.transpose()) / 2;
  const DeformationSize linear = deformation_size(mesh, moved_by(mesh, H), Kinematics::linear);
  EXPECT_NEAR(linear.principal_strain, strain.selfadjointView<Eigen::Lower>().eigenvalues().cwiseAbs().maxCoeff(),
              1e-14);
  EXPECT_NEAR(linear.rotation, 0.02, 1e-14);
  const double angle = 100 * std::numbers::pi / 180;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Vec3(1, 2, 2) / 3).toRotationMatrix(),
                        U = Vec3(0.8, 1.1, 1.05).asDiagonal();
  const DeformationSize finite =
      deformation_size(mesh, moved_by(mesh, R * U - Eigen::Matrix3d::Identity()), Kinematics::finite);
  EXPECT_NEAR(finite.principal_strain, 0.2, 1e-13);
  EXPECT_NEAR(finite.rotation, angle, 1e-13);
}

TEST(DeformationSize, OnePerCentOfTheVolumeHasNoSay) {
  const Mesh mesh = block_mesh({1, 1, 1}, {20, 20, 20});
  NodalVectors u = moved_by(mesh, Vec3(0.01, 0, 0).asDiagonal());
  u(0, 0) -= 0.05;  // one cell of 8000
  EXPECT_NEAR(deformation_size(mesh, u, Kinematics::linear).principal_strain, 0.01, 1e-12);
  for (Eigen::Index n = 0; n < u.rows(); ++n)
    if (mesh.nodes(n, 2) > 0.99) u(n, 2) = 0.01;  // and a layer of a twentieth
  EXPECT_NEAR(deformation_size(mesh, u, Kinematics::linear).principal_strain, 0.2, 1e-12);
}

// ---- refused before any work

std::string refusal(const std::string& text) {
  try {
    prepare(parse_experiment(text, "case.toml"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string block = R"([body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [2, 2, 2]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.25
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, 0.01]
[compare]
models = ["emsm",
          "hybmss_bt"]
measures = ["mean_displacement"]
)";

TEST(Prepare, RefusesAModelThatCannotDoTheKinematics) {
  EXPECT_EQ(refusal(block), "accepted");
  const std::string message = refusal("kinematics = \"hencky\"\n" + block);
  EXPECT_EQ(message.find("case.toml:17:11: compare.models: hybmss_bt holds under kinematics = \"linear\" only"), 0u)
      << message;
  EXPECT_NE(message.find("emsm, "), std::string::npos) << message;
  EXPECT_EQ(message.find("hybmss_b,"), std::string::npos) << message;
}

TEST(Prepare, RefusesTheMeanDisplacementOfNoPatch) {
  const auto expecting = [](const std::string& patch) {
    return block + "[[expect]]\nmodel = \"emsm\"\nmeasure = \"mean_displacement." + patch +
           ".z\"\nsource = \"analytic\"\nvalue = 0\nwithin = 1\n";
  };
  EXPECT_EQ(refusal(expecting("x_max")), "accepted") << "no load names it, but the body has it";
  const std::string message = refusal(expecting("x_maxi"));
  EXPECT_EQ(message.find("case.toml:18:1: measure: the body has no patch 'x_maxi'"), 0u) << message;
  EXPECT_NE(message.find("did you mean 'x_max'?"), std::string::npos) << message;
}

}  // namespace
}  // namespace springproof::measures_test
