#include "problem/loads.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "problem/exact_field.h"
#include "support/tolerances.h"

namespace springproof::loads_test {
namespace {

const Vec3 X(0.3, -0.2, 0.7);

Vec3 all(const PrescribedValue& u) { return {u[0].value(), u[1].value(), u[2].value()}; }

TEST(Constraints, DisplacementLeavesFreeComponentsEmpty) {
  const Load load = PrescribedDisplacement{"z_max", {0.1, std::nullopt, -0.4}};
  for (const Kinematics kinematics : {Kinematics::linear, Kinematics::finite}) {
    const PrescribedValue u = prescribed_displacement(load, X, kinematics, 0.5);
    EXPECT_DOUBLE_EQ(u[0].value(), 0.05);
    EXPECT_FALSE(u[1].has_value());
    EXPECT_DOUBLE_EQ(u[2].value(), -0.2);
  }
}

TEST(Constraints, AffineScalesWithTheFactor) {
  Eigen::Matrix3d H;
  H << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  const Load load = PrescribedAffine{"x_min", H, Vec3(1, -1, 2)};
  // Row by row: 0.3 - 0.4 + 2.1 + 1, 1.2 - 1 + 4.2 - 1, 2.1 - 1.6 + 7 + 2.
  EXPECT_TRUE(all(prescribed_displacement(load, X, Kinematics::finite)).isApprox(Vec3(3, 3.4, 9.5), test::round_off));
  EXPECT_TRUE(all(prescribed_displacement(load, X, Kinematics::linear, 0.25))
                  .isApprox(0.25 * Vec3(3, 3.4, 9.5), test::round_off));
}

TEST(Constraints, QuarterTurn) {
  const Load load = PrescribedRotation{"x_max", Vec3(1, 1, 0), Vec3::UnitZ(), std::numbers::pi / 2};
  // The arm (2,0,5) turns to (0,2,5).
  const Vec3 u = all(prescribed_displacement(load, Vec3(3, 1, 5), Kinematics::finite));
  EXPECT_TRUE(u.isApprox(Vec3(-2, 2, 0), test::round_off)) << u.transpose();
}

TEST(Constraints, FiniteRotationIsRigidAndAgreesWithAngleAxis) {
  const Vec3 axis = Vec3(1, 2, -1).normalized(), point(0.1, 0.2, 0.3);
  for (const double factor : {0.0, 0.3, 1.0}) {
    const Load load = PrescribedRotation{"x_max", point, axis, 2.1};
    const Vec3 u = all(prescribed_displacement(load, X, Kinematics::finite, factor));
    const Vec3 expected = Eigen::AngleAxisd(2.1 * factor, axis) * (X - point) + point - X;
    EXPECT_LE((u - expected).norm(), test::round_off);
    EXPECT_NEAR((X + u - point).norm(), (X - point).norm(), test::round_off);
  }
}

TEST(Constraints, LinearRotationIsTheLimitOfSmallAngles) {
  const Vec3 axis = Vec3(0, 3, 4).normalized(), point(1, 0, 0);
  const double angle = 1e-5;
  const Load load = PrescribedRotation{"x_max", point, axis, angle};
  const Vec3 linear = all(prescribed_displacement(load, X, Kinematics::linear));
  EXPECT_LE((linear - angle * axis.cross(X - point)).norm(), test::round_off * angle);
  const Vec3 finite = all(prescribed_displacement(load, X, Kinematics::finite));
  // The two differ by angle^2 / 2 to leading order.
  EXPECT_LE((finite - linear).norm(), 0.6 * angle * angle * (X - point).norm());
  EXPECT_GT((finite - linear).norm(), 0);
}

TEST(Constraints, ForcesPrescribeNoDisplacement) {
  const Load loads[] = {
      Traction{"x_max", Vec3(1, 0, 0)}, PatchForce{"x_max", Vec3(1, 0, 0)}, Pressure{"x_max", 1},
      Gravity{Vec3(0, 0, -9)},          PointForce{X, Vec3(1, 0, 0)},       FieldBodyForce{"solenoidal"}};
  for (const Load& load : loads) {
    EXPECT_FALSE(prescribes_displacement(load));
    for (const auto& component : prescribed_displacement(load, X, Kinematics::linear)) EXPECT_FALSE(component);
  }
  for (const Load& load : {Load(PrescribedDisplacement{"a", {}}), Load(PrescribedAffine{"a"}),
                           Load(PrescribedRotation{"a"}), Load(PrescribedField{"a", "solenoidal"})})
    EXPECT_TRUE(prescribes_displacement(load));
}

TEST(Constraints, AFieldScalesWithTheFactor) {
  const Load load = PrescribedField{"x_max", "trigonometric"};
  const Vec3 u = exact_displacement("trigonometric", X);
  EXPECT_EQ(all(prescribed_displacement(load, X, Kinematics::linear)), u);
  EXPECT_EQ(all(prescribed_displacement(load, X, Kinematics::finite, 0.25)), 0.25 * u);
}

TEST(Constraints, PatchOfALoad) {
  EXPECT_EQ(*patch_of(Traction{"x_max", Vec3::Zero()}), "x_max");
  EXPECT_EQ(*patch_of(PrescribedRotation{"ears"}), "ears");
  EXPECT_EQ(*patch_of(Pressure{"hole", 1}), "hole");
  EXPECT_EQ(patch_of(Gravity{}), nullptr);
  EXPECT_EQ(patch_of(FieldBodyForce{}), nullptr);
  EXPECT_EQ(patch_of(PointForce{}), nullptr);
}

}  // namespace
}  // namespace springproof::loads_test
