// Where homogeneous states of a lattice are lost, and the motion that an equilibrium resists least.
#include "msm/measure/validity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msm/measure/waves.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::validity_test {
namespace {

IsotropicMaterial material(double nu) { return {2 * (1 + nu), nu, 1}; }  // G = 1

std::optional<double> limit(const char* model, double nu, Sides sides, double strain,
                            VolumeEnergy energy = VolumeEnergy::bounded) {
  ModelParameters p = test::model(model);
  p.volume_energy = energy;
  const auto found = strain_limit(p, material(nu), sides, strain);
  return found ? std::optional(found->strain) : std::nullopt;
}

TEST(Validity, StrainedCellAtRestIsTheStiffnessWithoutStress) {
  for (const char* name : {"hybmss", "hybmss_avg", "msm_18"}) {
    const MassSpringModel model = build_model(test::model(name), block_mesh({1, 1, 1}, {2, 2, 2}), material(0.25));
    const StrainedCell cell = strained_cell(model, Eigen::Matrix3d::Identity());
    EXPECT_LT((cell.tangent - cell_stiffness(model).total).norm(), 1e-12 * cell.tangent.norm()) << name;
    EXPECT_LT(cell.stress.norm(), 1e-12) << name;
    // The stress is the derivative of the energy: small strain gives Hooke's law.
    const double e = 1e-6;
    const Eigen::Matrix3d stress = strained_cell(model, Vec3(1, 1, 1 + e).asDiagonal()).stress;
    EXPECT_NEAR(stress(2, 2) / e, 3, 1e-4) << name;  // lambda + 2 G
    EXPECT_NEAR(stress(0, 0) / e, 1, 1e-4) << name;  // lambda
  }
}

TEST(Validity, ALatticeWithoutFaceDiagonalsIsLostAtOnceInTheWaveOfTheWrinkles) {
  for (const double strain : {-0.2, 0.2}) {
    const auto found = strain_limit(test::model("hybmss_fd"), material(0.25), Sides::free, strain);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->strain, 0);
    EXPECT_EQ(std::lround(10 * found->k.sum()), 20) << "two axes along which neighbours move against each other";
    EXPECT_NE(describe_wave(found->k).find("neighbours move against each other along x and"), std::string::npos);
  }
}

// Springs on their own lengths push sideways when they are pressed, and no constant of volume holds a single axis.
TEST(Validity, AveragedSpringsKeepTheStatesThatOthersLose) {
  for (const double nu : {-0.5, 0.0, 0.25, 0.45}) {
    EXPECT_FALSE(limit("hybmss_avg", nu, Sides::free, 0.4)) << nu;
    EXPECT_FALSE(limit("hybmss_avg", nu, Sides::held, 0.4)) << nu;
  }
  for (const Sides sides : {Sides::free, Sides::held}) {
    EXPECT_NEAR(limit("hybmss", -0.5, sides, -0.4).value_or(0), -0.21, 0.01);
    EXPECT_NEAR(limit("hybmss", 0, sides, -0.4).value_or(0), -0.307, 0.01);
    EXPECT_FALSE(limit("hybmss", 0.25, sides, -0.4));
  }
}

// The paper's energy of volume: one free cell has the lateral instability of a lattice, but not its waves.
TEST(Validity, ALimitIsThatOfOneCellOrSmaller) {
  for (const double nu : {-0.5, 0.0}) {
    const double cell = strain_limits(test::model("hybmss"), material(nu)).paper_energy;
    const double lattice = limit("hybmss", nu, Sides::free, 0.5, VolumeEnergy::paper).value_or(1);
    EXPECT_LT(cell, 0.5) << nu;
    EXPECT_LT(lattice, cell + 0.002) << nu;
  }
}

/// A cube between clamped plates, shortened by `strain`.
Equilibrium shortened(const char* model, double nu, int cells, double strain) {
  const Mesh mesh = block_mesh({1, 1, 1}, {cells, cells, cells});
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                                   PrescribedDisplacement{"z_max", {0.0, 0.0, -strain}}};
  return solve_finite(build_model(test::model(model), mesh, material(nu)),
                      [&](double factor) { return transfer(loads, mesh, 1, Kinematics::finite, factor); },
                      {.softest_motion = true});
}

TEST(Validity, TheSoftestMotionIsThatOfRestAtRest) {
  const Equilibrium e = shortened("hybmss", 0.25, 4, 1e-9);
  ASSERT_TRUE(e.softest);
  EXPECT_NEAR(e.softest->stiffness, 1, 1e-6);
}

TEST(Validity, AnEquilibriumThatWrinklesTellsTheWaveBeforeItIsLost) {
  const Equilibrium far = shortened("hybmss_fd", 0.25, 6, 0.001), lost = shortened("hybmss_fd", 0.25, 6, 0.2);
  ASSERT_TRUE(far.ok && far.softest);
  EXPECT_FALSE(lost.ok);
  EXPECT_EQ(lost.loss, Loss::unstable);
  EXPECT_LT(lost.load_reached, 0.5);
  ASSERT_TRUE(lost.softest);
  EXPECT_LT(lost.softest->stiffness, 0.1);
  EXPECT_LT(lost.softest->stiffness, 0.2 * far.softest->stiffness);
  int against = 0;  // axes along which neighbours move against each other
  for (const double a : lost.softest->alternation) against += a > 1;
  EXPECT_GE(against, 2) << lost.softest->alternation.transpose();
  const Equilibrium kept = shortened("hybmss_avg", 0.25, 6, 0.2);
  ASSERT_TRUE(kept.ok && kept.softest);
  EXPECT_EQ(kept.loss, Loss::none);
  EXPECT_GT(kept.softest->stiffness, 0.2);
}

}  // namespace
}  // namespace springproof::validity_test
