// Disordered networks whose springs pass the patch test: every affine strain in equilibrium at every node.

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "msm/embedding/boundary.h"
#include "msm/embedding/surface_shares.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::patch_fit_test {
namespace {

constexpr double E = 1e4;

Mesh bar() { return block_mesh({4, 1, 1}, {20, 5, 5}); }

EmbeddedModel patch_bar(double poisson_ratio) {
  return build_embedded(test::model("emsm_patch"), bar(), {E, poisson_ratio, 1000});
}

/// Affine part G of a displacement, u = u_0 + G x, by least squares.
Eigen::Matrix3d gradient_of(const NodalVectors& X, const NodalVectors& u) {
  Eigen::MatrixXd linear(X.rows(), 4);
  linear << X, Eigen::VectorXd::Ones(X.rows());
  return linear.colPivHouseholderQr().solve(u).topRows(3).transpose();
}

int faces_at(const NodalVectors& X, int n) {
  const Eigen::RowVector3d size(4, 1, 1);
  return static_cast<int>((X.row(n).array() == 0).count() + (X.row(n).array() == size.array()).count());
}

TEST(SurfaceShares, ObeyGaussAndBelongToTheirFaces) {
  const EmbeddedModel built = patch_bar(0.25);
  const NodalVectors& X = built.model.network.X;
  const SurfaceShares shares = surface_shares(region_of(bar()), built.model.network);
  EXPECT_LE(shares.area.colwise().sum().norm(), 1e-12);
  EXPECT_LE((shares.area.transpose() * X - 4 * Eigen::Matrix3d::Identity()).norm(), 1e-11);
  const PatchShares& end = shares.patches.at("x_max");
  EXPECT_NEAR(end.area.sum(), 1, 1e-12);
  EXPECT_LE((X.transpose() * end.area - Vec3(4, 0.5, 0.5)).norm(), 1e-12);
  for (Eigen::Index n = 0; n < X.rows(); ++n)
    if (X(n, 0) < 4) {
      EXPECT_EQ(end.area[n], 0) << "x = " << X(n, 0);
    }
}

// Without what the edges give to the inside they are 9 % too large (the trapezoidal rule of five intervals: 8 %).
TEST(SurfaceShares, HaveTheSecondMomentsOfAFace) {
  const EmbeddedModel built = patch_bar(0.25);
  const NodalVectors& X = built.model.network.X;
  const PatchShares end = surface_shares(region_of(bar()), built.model.network).patches.at("x_max");
  for (int axis : {1, 2}) EXPECT_NEAR(((X.col(axis).array() - 0.5).square() * end.area.array()).sum() * 12, 1, 0.04);
}

// Two arms a tenth of a spacing apart: the faces of the gap belong to the arm that they bound.
TEST(SurfaceShares, DoNotReachAcrossAGap) {
  Network arms;
  arms.X.resize(54, 3);
  const auto number = [](int arm, int i, int j, int k) { return 27 * arm + 9 * k + 3 * j + i; };
  for (int arm = 0; arm < 2; ++arm)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) arms.X.row(number(arm, i, j, k)) << i + 2.1 * arm, j, k;
  for (int arm = 0; arm < 2; ++arm)
    for (int a = 27 * arm; a < 27 * arm + 27; ++a)
      for (int b = a + 1; b < 27 * arm + 27; ++b)
        if (const double L = (arms.X.row(a) - arms.X.row(b)).norm(); L < 1.5) arms.springs.push_back({a, b, 1, L});
  arms.volume = Eigen::VectorXd::Constant(54, 16.0 / 54);
  Region both = region_of(block_mesh({2, 2, 2}, {2, 2, 2}));
  const std::size_t points = both.surface_points.size(), triangles = both.surface_triangles.size();
  for (std::size_t p = 0; p < points; ++p) both.surface_points.push_back(both.surface_points[p] + Vec3(2.1, 0, 0));
  for (std::size_t t = 0; t < triangles; ++t) {
    auto moved = both.surface_triangles[t];
    for (int& p : moved) p += static_cast<int>(points);
    both.surface_triangles.push_back(moved);
  }
  both.upper[0] = 4.1;
  both.volume = 16;
  const NodalVectors area = surface_shares(both, arms).area;
  for (int arm = 0; arm < 2; ++arm) {
    double low = 0, high = 0;
    for (int n = 0; n < 9; ++n) {
      low += area(number(arm, 0, n % 3, n / 3), 0);
      high += area(number(arm, 2, n % 3, n / 3), 0);
    }
    EXPECT_NEAR(low, -4, 0.1) << arm;
    EXPECT_NEAR(high, 4, 0.1) << arm;
  }
}

TEST(PatchFit, HoldsAffineStrainsAtEveryNodeButTheCorners) {
  EmbeddedModel built = patch_bar(0.25);
  Network& network = built.model.network;
  const double G = E / 2.5;
  const NodalVectors A = surface_shares(region_of(bar()), network).area;
  double mean = 0;
  for (const Spring& s : network.springs) EXPECT_GT(s.stiffness, 0);
  for (const Vec3& a : {Vec3(1, 0, 0), Vec3(0, 1, -1), Vec3(1, 2, 3)}) {
    const Eigen::Matrix3d strain = a * a.transpose() / a.squaredNorm();
    const Eigen::Matrix3d stress = G * (2 * strain + strain.trace() * Eigen::Matrix3d::Identity());
    NodalVectors force = NodalVectors::Zero(network.nodes(), 3);
    for (const Spring& s : network.springs) {
      const Vec3 n = (network.X.row(s.j) - network.X.row(s.i)).transpose() / s.rest_length;
      const Vec3 pull = s.stiffness * s.rest_length * n.dot(strain * n) * n;
      force.row(s.i) += pull.transpose();
      force.row(s.j) -= pull.transpose();
    }
    const NodalVectors left = force + A * stress;
    const double of_node = stress.norm() * std::pow(4.0 / network.nodes(), 2.0 / 3);
    for (int n = 0; n < network.nodes(); ++n)
      if (faces_at(network.X, n) < 3) {
        EXPECT_LE(left.row(n).norm(), 0.03 * of_node) << network.X.row(n);
      }
    mean += left.squaredNorm() / network.nodes() / (of_node * of_node) / 3;
  }
  EXPECT_LE(std::sqrt(mean), 3e-3);
}

TEST(PatchFit, RefusesNetworksOfTooFewSprings) {
  ModelParameters p = test::model("emsm_patch");
  p.random.springs_per_node = 12;
  p.random.least_springs = 0;
  EXPECT_THROW(build_embedded(p, bar(), {E, 0.25, 1000}), std::runtime_error);
}

// With weights k L, below nu = 1/4, the inflow of a node is its volume change only on average.
TEST(PatchFit, GivesABarItsModuli) {
  for (const double nu : {-0.5, 0.25, 0.49}) {
    const EmbeddedModel built = patch_bar(nu);
    const std::optional<double> free;
    const std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, free, free}}, Traction{"x_max", {1, 0, 0}}};
    const Network& network = built.model.network;
    BoundaryConditions bc = transfer(loads, bar(), built.embedding, network, 1000, Kinematics::linear);
    hold_free_motions(network.X, bc);
    const Equilibrium e = solve_linear(built.model, bc, {LinearSolver::cholesky, 1e-10, 300});
    ASSERT_TRUE(e.ok) << e.message;
    const Eigen::Matrix3d gradient = gradient_of(network.X, e.displacement);
    const double within = nu < 0.25 ? 0.015 : 2e-3;
    EXPECT_NEAR(1 / gradient(0, 0) / E, 1, within) << nu;
    EXPECT_NEAR(-(gradient(1, 1) + gradient(2, 2)) / 2 / gradient(0, 0), nu, within) << nu;
  }
}

/// Stiffness of the bar whose ends turn by opposite angles about `axis` (x: in their planes, else out of them), of G or
/// E times the section's moment.
double stiffness_in_turning(const EmbeddedModel& built, int axis) {
  const NodalVectors& X = built.model.network.X;
  BoundaryConditions bc{std::vector<char>(3 * X.rows(), 0), std::vector<int>(3 * X.rows(), -1),
                        NodalVectors::Zero(X.rows(), 3), NodalVectors::Zero(X.rows(), 3)};
  for (int n = 0; n < X.rows(); ++n) {
    if (X(n, 0) > 0 && X(n, 0) < 4) continue;
    const Vec3 turned = Vec3::Unit(axis).cross(Vec3(0, X(n, 1) - 0.5, X(n, 2) - 0.5)) * (X(n, 0) > 0 ? 1 : 0);
    for (int d = 0; d < 3; ++d) {
      if ((d == 0) == (axis == 0)) continue;
      bc.fixed[3 * n + d] = 1;
      bc.owner[3 * n + d] = 0;
      bc.prescribed(n, d) = turned[d];
    }
  }
  hold_free_motions(X, bc);
  const Equilibrium e = solve_linear(built.model, bc, {LinearSolver::cholesky, 1e-10, 300});
  EXPECT_TRUE(e.ok) << e.message;
  const double moment = axis == 0 ? 0.140577 * E / 2.5 : E / 12;  // Saint-Venant's torsion of a square
  return (e.support.array() * bc.prescribed.array()).sum() / (moment / 4);
}

TEST(PatchFit, BendsAndTwistsABar) {
  const EmbeddedModel built = patch_bar(0.25);
  for (const int axis : {1, 2}) EXPECT_NEAR(stiffness_in_turning(built, axis), 1, 0.025) << axis;
  EXPECT_NEAR(stiffness_in_turning(built, 0), 1, 0.05);
}

}  // namespace
}  // namespace springproof::patch_fit_test
