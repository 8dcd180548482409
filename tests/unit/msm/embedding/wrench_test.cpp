// Loads keep the wrench that they carry, on any mesh and through any network.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "msm/embedding/boundary.h"
#include "msm/models.h"

namespace springproof::wrench_test {
namespace {

Wrench of(const NodalVectors& force, const NodalVectors& X, const Vec3& about) {
  Wrench w{Vec3::Zero(), Vec3::Zero(), about};
  for (Eigen::Index n = 0; n < force.rows(); ++n) {
    const Vec3 f = force.row(n).transpose(), x = X.row(n).transpose();
    w.force += f;
    w.moment += (x - about).cross(f);
  }
  return w;
}

const Wrench carried{{1, -2, 3}, {0.2, 0.1, -0.4}, {0.5, 0.2, 1.1}};

class CarriedWrench : public testing::TestWithParam<Load> {};

TEST_P(CarriedWrench, IsThatOfTheNodalForces) {
  const Mesh mesh = block_mesh({1, 2, 3}, {2, 3, 4});
  const Wrench got = of(transfer({GetParam()}, mesh, 1000, Kinematics::linear).external, mesh.nodes, carried.about);
  EXPECT_LT((got.force - carried.force).norm(), 1e-12 * carried.force.norm());
  EXPECT_LT((got.moment - carried.moment).norm(), 1e-12 * 3 * carried.force.norm());
}

TEST_P(CarriedWrench, GrowsWithTheLoad) {
  const Mesh mesh = block_mesh({1, 2, 3}, {2, 3, 4});
  const Wrench got =
      of(transfer({GetParam()}, mesh, 1000, Kinematics::linear, 0.25).external, mesh.nodes, carried.about);
  EXPECT_LT((got.force - 0.25 * carried.force).norm(), 1e-12);
  EXPECT_LT((got.moment - 0.25 * carried.moment).norm(), 1e-12);
}

TEST_P(CarriedWrench, PassesThroughADisorderedNetwork) {
  const Mesh mesh = block_mesh({1, 1, 1}, {4, 4, 4});
  ModelChoice choice;
  choice.name = "msm_random";
  const EmbeddedModel built = build_embedded(resolve(choice), mesh, {1000, 0.25, 1000});
  const Wrench got =
      of(transfer({GetParam()}, mesh, built.embedding, built.model.network, 1000, Kinematics::linear).external,
         built.model.network.X, carried.about);
  EXPECT_LT((got.force - carried.force).norm(), 1e-12 * 4);
  EXPECT_LT((got.moment - carried.moment).norm(), 1e-12 * 12);
}

INSTANTIATE_TEST_SUITE_P(Loads, CarriedWrench,
                         testing::Values(Load(Traction{"z_max", {1, 2, 3}, carried}),
                                         Load(Pressure{"x_max", 5, carried}),
                                         Load(PatchForce{"y_min", {1, -2, 3}, carried}),
                                         Load(Gravity{{0, 0, -1e-3}, carried})));

TEST(Wrenchless, ALoadWithoutOneIsLeftAlone) {
  const Mesh mesh = block_mesh({1, 1, 1}, {2, 2, 2});
  const NodalVectors f = transfer({Traction{"z_max", {0, 0, 4}}}, mesh, 1000, Kinematics::linear).external;
  EXPECT_NEAR(f.col(2).maxCoeff(), 1, 1e-12);  // the middle node bears a quarter
}

}  // namespace
}  // namespace springproof::wrench_test
