// Macro-cells that a body fills in part: bodies that lie anyhow in the lattice.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "meshes/mesher/mesher.h"
#include "msm/algebra/dense.h"
#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "msm/statics/macro_newton.h"
#include "msm/topology/macro_cells.h"
#include "support/refined_cells.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::msm_cut_macro_cells_test {
namespace {

constexpr double nus[] = {-0.5, 0.0, 0.25, 0.45, 0.499};

/// A body in cut cells of the unit length over `across`, turned and moved at random.
struct Placed {
  Mesh body;
  CutBody cut;
  Vec3 axis;  ///< where the x axis went

  Placed(const Mesh& straight, double across, unsigned seed) {
    const test::Placement place = test::random_placement(seed, 1 / across);
    body = test::mapped(straight, place);
    cut = cut_body(test::grid_about(body, 1 / across), body);
    axis = place.turn * Vec3::UnitX();
  }
  EmbeddedModel model(double nu, const std::vector<std::string>& held = {}) const {
    return build_cut(test::model("hybmss_macro"), cut, held, Mesh{}, {1, nu, 1});
  }
};

/// The tip of a cantilever of unit diameter, four long, under a unit force across its end.
Equilibrium bent(const Placed& bar, double nu, double& tip) {
  const EmbeddedModel built = bar.model(nu, {"z_min"});
  const Mesh cubes = voxelise(bar.cut.grid, bar.body).mesh;
  const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", bar.axis}};
  const Equilibrium e =
      solve_linear(built.model, transfer(loads, cubes, built.embedding, built.model.network, 1, Kinematics::linear));
  EXPECT_TRUE(e.ok) << e.message;
  const Eigen::VectorXd& share = built.embedding.patches.at("z_max").area;
  tip = (share.transpose() * e.displacement / share.sum()).dot(bar.axis);
  return e;
}

// References: own 27-node elements on a fitted mesh, three levels.  The facets of the body here take 0.6 % of the
// section's stiffness.
TEST(CutMacroCells, OneAcrossBendsARoundBarAsItShould) {
  const Mesh straight = test::cylinder(4, 12, 24);
  const std::pair<double, double> exact[] = {{0, 446.31}, {0.25, 444.55}, {0.45, 435.6}, {0.499, 431.9}};
  for (const auto& [across, bound] : {std::pair{2.0, 0.025}, {3.0, 0.016}}) {
    std::vector<Placed> bars;
    for (unsigned seed = 1; seed <= 8; ++seed) bars.emplace_back(straight, across, seed);
    for (const auto& [nu, expected] : exact) {
      double sum = 0, tip = 0;
      int iterations = 0;
      for (const Placed& bar : bars) {
        iterations = std::max(iterations, bent(bar, nu, tip).iterations);
        sum += std::pow(tip / expected - 1, 2) / 8;
      }
      RecordProperty("rms_" + std::to_string(across) + "_" + std::to_string(nu), std::to_string(std::sqrt(sum)));
      RecordProperty("iterations_" + std::to_string(across) + "_" + std::to_string(nu), iterations);
      EXPECT_LE(std::sqrt(sum), bound) << across << " cubes across, nu = " << nu;
      EXPECT_LE(iterations, across == 2 ? 220 : 110) << across << " cubes across, nu = " << nu;
    }
  }
}

TEST(CutMacroCells, SupportsBearTheLoad) {
  double tip = 0;
  const Equilibrium e = bent(Placed(test::cylinder(4, 8, 16), 3, 4), 0.45, tip);
  EXPECT_NEAR(e.support.colwise().sum().norm(), 1, 1e-8);
}

/// The surface's integrals are exact, those of the points of a cell to second order only.
TEST(CutMacroCells, UniformStressIsNearlyExactInASphere) {
  for (const double nu : nus)
    for (const unsigned seed : {1u, 2u, 3u}) {
      const Placed ball(test::ball_of_tetrahedra(8), 3, seed);
      const EmbeddedModel built = ball.model(nu);
      const Network& network = built.model.network;
      Eigen::Matrix3d stress;
      stress << 1, 0.3, -0.2, 0.3, -0.5, 0.4, -0.2, 0.4, 0.2;
      const Eigen::Matrix3d strain = (1 + nu) * stress - nu * stress.trace() * Eigen::Matrix3d::Identity();
      BoundaryConditions bc{std::vector<char>(network.X.size(), 0), std::vector<int>(network.X.size(), -1),
                            NodalVectors::Zero(network.nodes(), 3),
                            built.embedding.patches.at("surface").normal * stress};
      hold_free_motions(network.X, bc);
      const Equilibrium e = solve_linear(built.model, bc);
      ASSERT_TRUE(e.ok) << e.message;
      // The displacement at the surface, but for a rigid motion, against the affine one.
      const NodalVectors X = built.embedding.surface * network.X, u = built.embedding.surface * e.displacement;
      const NodalVectors off = u - X * strain;
      Eigen::MatrixXd rigid(3 * X.rows(), 6);
      for (Eigen::Index n = 0; n < X.rows(); ++n) {
        rigid.block<3, 3>(3 * n, 0).setIdentity();
        rigid.block<3, 3>(3 * n, 3) = cross_matrix(X.row(n).transpose());
      }
      const Eigen::VectorXd flat_off = flat(off);
      const double rest = (flat_off - rigid * rigid.colPivHouseholderQr().solve(flat_off)).norm();
      const double error = rest / (X.rowwise() - X.colwise().mean()).norm() / strain.norm();
      EXPECT_LE(error, 0.01) << "nu = " << nu << ", place " << seed;
    }
}

TEST(CutMacroCells, OnlyRigidMotionsHaveNoEnergy) {
  const Placed bar(test::cylinder(1.5, 6, 9), 3, 2);
  for (const double nu : nus) {
    const EmbeddedModel built = bar.model(nu);
    const Tangent K = tangent(built.model, built.model.network.X);
    const auto n = built.model.network.X.size();
    Eigen::MatrixXd dense(n, n);
    Eigen::VectorXd column;
    for (Eigen::Index i = 0; i < n; ++i) {
      K.multiply(Eigen::VectorXd::Unit(n, i), column);
      dense.col(i) = column;
    }
    const Eigen::VectorXd values = symmetric_eigenvalues(dense);
    EXPECT_LE(std::abs(values[5]), 1e-12 * values[n - 1]) << nu;
    EXPECT_GE(values[6], 1e-7) << nu;  // 1e-16 without bonds
  }
}

// An arch within one macro-cell: two parts of one cube that are connected beside it.
TEST(CutMacroCells, PartsOfOneCubeThatMeetBesideItAreOneCell) {
  const Mesh blocks = test::voxels_of(block_mesh({2, 2, 1}, {20, 20, 10}), [](int i, int j, int) {
    return !(i >= 3 && i < 7 && j < 14);  // a slot in the first cube, not in the one behind
  });
  const CutBody cut = cut_body({Vec3::Zero(), 1, {2, 2, 2}}, test::solid_of(blocks));
  ASSERT_EQ(cut.cells.size(), 5u);
  const CutMacroCells macro = macro_cells_of(cut);
  ASSERT_EQ(macro.cells.size(), 1u);
  EXPECT_EQ(macro.points.rows(), 27);
  EXPECT_NEAR(macro.filled[0][0].fraction, 0.6, 1e-12);
  EXPECT_NEAR(macro.filled[0][0].mean[0], 0, 1e-12);
  EXPECT_EQ(macro.filled[0][1].fraction, 1);
  EXPECT_EQ(macro.filled[0][4].fraction, 0);
}

// With pressures as unknowns and without: large bodies take the one, small ones the other.
TEST(CutMacroCells, BarsOfLargeStrainBearTheirLoad) {
  const Placed bar(test::cylinder(2, 6, 10), 2, 3);
  const Mesh cubes = voxelise(bar.cut.grid, bar.body).mesh;
  for (const double nu : {0.25, 0.499}) {
    const EmbeddedModel built = bar.model(nu, {"z_min"});
    const NodalVectors& X = built.model.network.X;
    const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                                     PatchForce{"z_max", 3e-3 * bar.axis}};
    const auto path = [&](double factor) {
      return transfer(loads, cubes, built.embedding, built.model.network, 1, Kinematics::finite, factor);
    };
    const Equilibrium e = solve_finite(built.model, path);
    ASSERT_TRUE(e.ok) << nu << ": " << e.message;
    EXPECT_LE((e.support.colwise().sum().transpose() + 3e-3 * bar.axis).norm(), 1e-10) << nu;
    const Eigen::VectorXd& share = built.embedding.patches.at("z_max").area;
    EXPECT_GT((share.transpose() * e.displacement / share.sum()).dot(bar.axis), 0.1) << nu;
    if (nu < 0.4) continue;
    const BoundaryConditions all = path(1);
    MacroNewton newton(built.model, all.fixed);
    NodalVectors x = X;
    ASSERT_TRUE(newton.step(all, 1e-9, 25, x)) << nu;
    EXPECT_LE((x - X - e.displacement).norm(), 1e-6 * e.displacement.norm()) << nu;
  }
}

// An affine displacement of the nodes is that of all points, within the body and at its cells' corners.
TEST(CutMacroCells, DisplacementsAtPointsAreThoseOfTheNodes) {
  const Placed bar(test::cylinder(2, 6, 10), 3, 5);
  const Network network = bar.model(0.25, {"z_min"}).model.network;
  Eigen::Matrix3d H;
  H << 0.1, 0.02, -0.03, 0.04, -0.2, 0.05, 0.01, 0.06, 0.3;
  const NodalVectors u = network.X * H.transpose();
  EXPECT_LE((displacement_at(bar.cut, u, bar.body.nodes, true) - bar.body.nodes * H.transpose()).norm(), 1e-12);
  EXPECT_LE((at_points_of_cells(bar.cut, u) - bar.cut.points * H.transpose()).norm(), 1e-12);
}

TEST(CutMacroCells, RigidRotationsHaveNoForces) {
  const Placed bar(test::cylinder(2, 6, 10), 2, 3);
  for (const double nu : {0.25, 0.499}) {
    const EmbeddedModel built = bar.model(nu);
    const Eigen::Matrix3d R = Eigen::AngleAxisd(1.2, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    EXPECT_LE(forces(built.model, built.model.network.X * R.transpose()).norm(), 1e-10);
    EXPECT_FALSE(built.model.small_displacements_only);
  }
}

TEST(CutMacroCells, CellsOfSeveralSizesAreRefused) {
  const Mesh body = test::ball_of_tetrahedra(6);
  const CutBody cut = cut_body(test::halved_at_random(test::grid_about(body, 0.3), 1, 6), body);
  try {
    build_cut(test::model("hybmss_macro"), cut, {}, Mesh{}, {1, 0.25, 1});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "hybmss_macro: cells of several sizes cannot be macro-cells (allowed: voxels or voxel_edge_m without "
                 "accuracy; hybmss_avg)");
  }
}

}  // namespace
}  // namespace springproof::msm_cut_macro_cells_test
