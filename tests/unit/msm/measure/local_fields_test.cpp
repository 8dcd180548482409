#include "msm/measure/local_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "msm/parameters/calibrate.h"
#include "msm/statics/equilibrium.h"
#include "msm/topology/cubic_lattice.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::local_fields_test {
namespace {

Eigen::Matrix3d some_gradient() {
  Eigen::Matrix3d g;
  g << 1.1, -0.4, 0.3, 0.8, -0.5, 0.2, -0.6, 0.9, 0.7;
  return 1e-3 * g;
}

Eigen::Matrix3d strain_of(const Eigen::Matrix3d& gradient) { return (gradient + gradient.transpose()) / 2; }

/// lambda = mu = G.
Eigen::Matrix3d cauchy_stress(double G, const Eigen::Matrix3d& strain) {
  return G * strain.trace() * Eigen::Matrix3d::Identity() + 2 * G * strain;
}

MassSpringModel lattice(int cells, double edge, double A, double G) {
  Network network = cubic_lattice(block_mesh(edge * cells * Vec3::Ones(), {cells, cells, cells}), isotropic_pattern(A));
  calibrate(G, network);
  return {network, {Springs{}}};
}

TEST(LocalStrain, AffineFieldsAreExactOnAnyNetwork) {
  Network network = cubic_lattice(test::notched_block(0.5), isotropic_pattern(2));
  network.X += test::noise(network.X.rows(), 0.15);
  const NodalVectors u = (network.X * some_gradient().transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  for (const Vec3& at : {Vec3(0.7, 0.5, 0.4), Vec3(1.5, 0, 1)})
    EXPECT_LE((displacement_gradient(network, u, at, 1.1) - some_gradient()).norm(), 1e-11 * some_gradient().norm());
  EXPECT_THROW(displacement_gradient(network, u, {0.7, 0.5, 0.4}, 0.3), std::invalid_argument);
  EXPECT_THROW(displacement_gradient(network, u, {50, 0, 0}, 0.3), std::invalid_argument);
}

TEST(LocalStrain, OfAPlaneHasNoDerivativeAcross) {
  Network network = test::bent_triangles();
  network.X.col(2).setConstant(0.3);
  NodalVectors u = network.X * some_gradient().transpose();
  Eigen::Matrix3d expected = some_gradient();
  expected.col(2).setZero();
  EXPECT_LE((displacement_gradient(network, u, {1, 0.7, 0.3}, 0.9) - expected).norm(), 1e-11 * expected.norm());
}

// The parts of parallel springs inside a ball are chords.  Poisson's sum: their error is about
// 3/(2 pi R/a)^2 per shortest reciprocal vector, of which a square set of lines has four; R is in cells.
double chord_bound(double cells) { return 12 / std::pow(2 * std::numbers::pi * cells, 2); }

TEST(LocalStress, OfAnAffineFieldIsTheContinuums) {
  const double edge = 0.25, G = 900;
  const MassSpringModel model = lattice(16, edge, 2, G);
  const NodalVectors u = model.network.X * some_gradient().transpose();
  const std::vector<double> T = linear_tensions(model, u);
  const Eigen::Matrix3d expected = cauchy_stress(G, strain_of(some_gradient()));
  for (double cells : {3.0, 6.0})
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0.5, 0.5, 0.5), Vec3(0.2, 0.7, 0.4)}) {
      const Vec3 at = edge * (Vec3::Constant(8) + shift);
      const Eigen::Matrix3d stress = hardy_stress(model.network, model.network.X, T, at, edge * cells);
      EXPECT_LE((stress - expected).norm() / expected.norm(), chord_bound(cells)) << cells;
      EXPECT_EQ(stress, stress.transpose().eval());
    }
}

// Averaged over the places of the ball in a cell every spring has its share: only the quadrature over places is left.
TEST(LocalStress, IsExactInTheMeanOverPlaces) {
  const double edge = 0.25, G = 900;
  const MassSpringModel model = lattice(6, edge, 1, G);
  const NodalVectors u = model.network.X * some_gradient().transpose();
  const std::vector<double> T = linear_tensions(model, u);
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  const int n = 8;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        mean += hardy_stress(model.network, model.network.X, T, edge * (Vec3::Constant(2.5) + Vec3(i, j, k) / n),
                             1.3 * edge) /
                (n * n * n);
  const Eigen::Matrix3d expected = cauchy_stress(G, strain_of(some_gradient()));
  EXPECT_LE((mean - expected).norm() / expected.norm(), chord_bound(1.3 * n));
}

TEST(LocalStress, TensionsAreTheModelsForces) {
  const MassSpringModel model = [] {
    MassSpringModel m = lattice(3, 0.5, 2, 900);
    m.laws.push_back(MomentumDispersion{0.3});
    return m;
  }();
  const NodalVectors u = test::noise(model.network.X.rows(), 1e-6);
  const std::vector<double> T = linear_tensions(model, u);
  NodalVectors f = NodalVectors::Zero(u.rows(), 3);
  for (std::size_t s = 0; s < T.size(); ++s) {
    const Spring& spring = model.network.springs[s];
    const Eigen::RowVector3d n = (model.network.X.row(spring.j) - model.network.X.row(spring.i)).normalized();
    f.row(spring.i) += T[s] * n;
    f.row(spring.j) -= T[s] * n;
  }
  EXPECT_LE((f - forces(model, model.network.X + u)).norm(), 1e-5 * f.norm());  // u: 1e-6, springs of 0.5
}

TEST(LocalStress, TensionsOfFiniteStrainAreThoseOfTheSymmetricFormAtRest) {
  const Mesh mesh = block_mesh(Vec3(2, 1.5, 1), {4, 3, 2});
  ModelParameters parameters = test::model("emsm");
  const auto model = [&](Dispersion form) {
    parameters.dispersion = form;
    return build_model(parameters, mesh, {1e5, 0.4, 1000});
  };
  const MassSpringModel symmetric = model(Dispersion::symmetric), finite = model(Dispersion::finite_strain);
  const NodalVectors u = test::noise(symmetric.network.X.rows(), 1e-3);
  const std::vector<double> expected = linear_tensions(symmetric, u), found = linear_tensions(finite, u);
  for (std::size_t s = 0; s < expected.size(); ++s) EXPECT_NEAR(found[s], expected[s], 1e-9 * std::abs(expected[0]));
}

TEST(PoissonRatio, OfStressesOnAllSides) {
  const double E = 7, nu = 0.31;
  const Vec3 s(1.0, -0.3, 0.45);
  Eigen::Matrix3d stress = s.asDiagonal(), strain = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) strain(i, i) = (s[i] * (1 + nu) - nu * s.sum()) / E;  // Kot & Nagahashi (2015), eq. (28)
  EXPECT_NEAR(poisson_ratio_of(strain, stress), nu, test::round_off);
  EXPECT_GT(std::abs(poisson_ratio_as_printed(strain, stress) - nu), 0.01);
  stress = Vec3(1, 0, 0).asDiagonal();
  strain = Vec3(1 / E, -nu / E, -nu / E).asDiagonal();
  EXPECT_NEAR(poisson_ratio_of(strain, stress), nu, test::round_off);
  EXPECT_NEAR(poisson_ratio_as_printed(strain, stress), nu / (1 + nu), test::round_off);
}

class Stretched : public testing::Test {
 protected:
  /// A block along x between plates: slipping, or holding what touches them.
  static Equilibrium stretch(const MassSpringModel& model, const Mesh& mesh, bool held, double elongation) {
    const std::optional<double> side = held ? std::optional<double>(0.0) : std::nullopt;
    std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, side, side}},
                               PrescribedDisplacement{"x_max", {elongation, side, side}}};
    if (!held) {
      loads.push_back(PrescribedDisplacement{"y_min", {std::nullopt, 0.0, std::nullopt}});
      loads.push_back(PrescribedDisplacement{"z_min", {std::nullopt, std::nullopt, 0.0}});
    }
    return solve_linear(model, transfer(loads, mesh, 1000, Kinematics::linear), {LinearSolver::cholesky, 1e-14, 20});
  }
};

TEST_F(Stretched, FlowThroughAnyPlaneIsTheEndReaction) {
  const Mesh mesh = block_mesh({4, 1.5, 1}, {8, 3, 2});
  Network network = cubic_lattice(mesh, isotropic_pattern(2));
  calibrate(4000, network);
  const MassSpringModel model{network, {Springs{}}};
  const Equilibrium e = stretch(model, mesh, true, 0.01);
  ASSERT_TRUE(e.ok) << e.message;
  double reaction = 0;
  for (int n : nodes_of(patch(mesh, "x_max"))) reaction += e.support(n, 0);
  const std::vector<double> T = linear_tensions(model, e.displacement);
  for (double x : {0.1, 2.0, 2.25, 3.9})  // 2.0: nodes lie on the plane
    EXPECT_NEAR(momentum_flow(network, network.X, T, {x, 0, 0}, Vec3::UnitX()) / reaction, 1, 1e-12);
  double beyond = 0;  // what the plates hold of the part beyond a plane along the block
  for (int n = 0; n < network.nodes(); ++n)
    if (network.X(n, 1) > 0.7) beyond += e.support(n, 1);
  EXPECT_NEAR(momentum_flow(network, network.X, T, {0, 0.7, 0}, Vec3::UnitY()) / beyond, 1, 1e-11);
}

TEST_F(Stretched, BlockGivesTheModuliOfItsLattice) {
  const Mesh mesh = block_mesh({6, 3, 3}, {12, 6, 6});
  Network network = cubic_lattice(mesh, isotropic_pattern(test::model("msm_18").face_to_cube));
  calibrate(4000, network);
  const MassSpringModel model{network, {Springs{}}};
  const StretchedBlock block{{0, 0, 0}, {6, 3, 3}, 0.006};
  const Equilibrium slipping = stretch(model, mesh, false, block.elongation);
  ASSERT_TRUE(slipping.ok) << slipping.message;
  const BlockModuli m = measure_block(model, slipping.displacement, block, 1.2);
  EXPECT_NEAR(m.youngs_modulus_nominal / 10000, 1, 1e-9);
  EXPECT_NEAR(m.youngs_modulus_local / 10000, 1, 1e-9);
  EXPECT_NEAR(m.poisson_ratio, 0.25, 1e-9);
  // The ball's lattice noise, chord_bound, enters the side stresses only: sxx cancels where syy = szz = 0.
  EXPECT_NEAR(m.poisson_ratio_of_fields, 0.25, 0.01);
  EXPECT_NEAR(m.poisson_ratio_as_printed, 0.2, 0.01);
  // Held ends stiffen the block; the local strain sees less of it, and in the middle nu is the lattice's again.
  const Equilibrium held = stretch(model, mesh, true, block.elongation);
  const BlockModuli h = measure_block(model, held.displacement, block, 1.2);
  EXPECT_GT(h.youngs_modulus_nominal, h.youngs_modulus_local);
  EXPECT_NEAR(h.poisson_ratio_of_fields, 0.25, 0.02);
}

}  // namespace
}  // namespace springproof::local_fields_test
