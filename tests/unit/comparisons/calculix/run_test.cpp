// CalculiX itself: what it prints, and that its laws are the ones we think they are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <sstream>

#include "comparisons/calculix/run.h"
#include "support/tolerances.h"
#include "support/uniaxial.h"

namespace springproof::run_test {
namespace {

const std::optional<double> is_free;

TEST(CalculixDat, TakesTheLastBlockOfEachKind) {
  std::istringstream in(R"(
 displacements (vx,vy,vz) for set ALL_NODES and time  0.5000000E+00

         1  9.000000E+00  0.000000E+00  0.000000E+00
         2  9.000000E+00  0.000000E+00  0.000000E+00

 total force (fx,fy,fz) for set Z_MAX and time  0.1000000E+01

        1.292470E-26 -3.231174E-26 -2.618461E-13

 forces (fx,fy,fz) for set HELD_NODES and time  0.1000000E+01

         2 -1.500000E+00  0.000000E+00 -1.234567-101

 displacements (vx,vy,vz) for set ALL_NODES and time  0.1000000E+01

         1  1.000000E+00 -2.000000E+00  3.000000E-02
         2  4.000000E+00  5.000000E+00  6.000000E+00

 displacements (vx,vy,vz) for set PROBE_TIP and time  0.1000000E+01

         1  7.000000E+00  7.000000E+00  7.000000E+00
)");
  const calculix::Printed printed = calculix::read_dat(in, 2);
  NodalVectors u(2, 3), f(2, 3);
  u << 1, -2, 0.03, 4, 5, 6;
  f << 0, 0, 0, -1.5, 0, -1.234567e-101;
  EXPECT_EQ(printed.displacement, u);
  EXPECT_EQ(printed.force, f);
  EXPECT_EQ(printed.time, 1);
}

TEST(CalculixDat, MissesNodes) {
  std::istringstream in(" displacements (vx,vy,vz) for set ALL_NODES and time  0.1000000E+01\n\n 1 1. 1. 1.\n");
  EXPECT_THROW(calculix::read_dat(in, 2), std::runtime_error);
}

/// Runs ccx, where it is installed.
class Calculix : public testing::Test {
 protected:
  void SetUp() override {
    if (calculix::program().empty()) GTEST_SKIP() << "ccx is not installed (apt-get install calculix-ccx)";
  }

  Experiment bar(const std::string& law, double stretch) {
    Experiment e;
    e.name = "bar";
    e.kinematics = law;
    e.body.size = Vec3(2, 1, 1.5);
    e.loads = {PrescribedDisplacement{"x_min", {0.0, is_free, is_free}},
               PrescribedDisplacement{"y_min", {is_free, 0.0, is_free}},
               PrescribedDisplacement{"z_min", {is_free, is_free, 0.0}},
               PrescribedDisplacement{"z_max", {is_free, is_free, (stretch - 1) * 1.5}}};
    return e;
  }
};

TEST_F(Calculix, HasOurLaws) {
  for (const char* law : {"st_venant_kirchhoff", "neo_hooke_isochoric"})
    for (double nu : {-0.5, 0.3, 0.499})
      for (double stretch : {0.8, 1.2}) {
        const IsotropicMaterial m{1e4, nu, 1000};
        const Experiment e = bar(law, stretch);
        const calculix::Deck deck = calculix::make_deck(e, m, block_mesh(e.body.size, {1, 1, 2}));
        const calculix::Solution s = calculix::solve(deck, 60);
        ASSERT_TRUE(s.ok) << s.message;
        const auto [lateral, stress] = test::uniaxial(law, m, stretch);
        const std::string what = fmt::format("{} nu {} stretch {}", law, nu, stretch);
        EXPECT_NEAR(s.field.displacement.col(0).cwiseAbs().maxCoeff() / 2, std::abs(lateral - 1), s.floor.displacement)
            << what;
        EXPECT_NEAR(s.field.reactions[3].force[2] / 2, stress, s.floor.force) << what;
        EXPECT_NEAR(s.field.volume_change, stretch * lateral * lateral - 1, s.floor.volume) << what;
        EXPECT_LT(s.floor.force, 1e-6 * 4 * std::abs(stress)) << what;
      }
}

TEST_F(Calculix, ReactionsCarryAllLoads) {
  Experiment e = bar("linear", 1);
  e.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Gravity{Vec3(0, 1, -10)},
             Traction{"y_max", Vec3(100, 0, 50)}, PatchForce{"x_max", Vec3(0, 300, 0)}};
  const calculix::Solution s =
      calculix::solve(calculix::make_deck(e, {1e6, 0.3, 1000}, block_mesh(e.body.size, {4, 2, 3})), 60);
  ASSERT_TRUE(s.ok) << s.message;
  const Vec3 weight = 3000 * Vec3(0, 1, -10), pull = 3 * Vec3(100, 0, 50), push(0, 300, 0);
  EXPECT_LE((s.field.reactions[0].force + weight + pull + push).norm(), 3 * s.floor.force);
  const Vec3 torque = Vec3(1, 0, 0).cross(weight) + Vec3(1, 0.5, 0).cross(pull) + Vec3(2, 0, 0).cross(push);
  EXPECT_LE((s.field.reactions[0].torque + torque).norm(), 3 * s.floor.torque);
}

TEST_F(Calculix, SaysWhyThereIsNoAnswer) {
  Experiment e = bar("neo_hooke_isochoric", 0.9);
  const calculix::Deck deck = calculix::make_deck(e, {1e4, 0.3, 1000}, block_mesh(e.body.size, {6, 6, 6}));
  const calculix::Solution late = calculix::solve(deck, 0.02);
  EXPECT_FALSE(late.ok);
  EXPECT_NE(late.message.find("longer than"), std::string::npos) << late.message;
  e = bar("neo_hooke_isochoric", -0.2);  // the lid below the floor
  const calculix::Solution impossible =
      calculix::solve(calculix::make_deck(e, {1e4, 0.3, 1000}, block_mesh(e.body.size, {1, 1, 1})), 60);
  EXPECT_FALSE(impossible.ok);
  EXPECT_FALSE(impossible.message.empty());
}

}  // namespace
}  // namespace springproof::run_test
