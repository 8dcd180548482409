// Natural modes of the models: masses, closed-form frequencies, rigid motions, order of convergence.
#include "msm/dynamics/natural_modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "msm/algebra/lobpcg.h"
#include "msm/embedding/boundary.h"
#include "support/refined_cells.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::natural_modes_test {
namespace {

constexpr double density = 900, youngs_modulus = 1e6;

std::vector<char> nothing_fixed(const Network& network) { return std::vector<char>(3 * network.X.rows(), 0); }

NaturalModes free_modes(const std::string& name, const Mesh& mesh, double nu, double theta, int count) {
  const MassSpringModel model = build_model(test::model(name), mesh, {youngs_modulus, nu, density});
  NaturalModes modes = natural_modes(model, nothing_fixed(model.network), density, theta, count);
  EXPECT_TRUE(modes.ok) << name << ": " << modes.message;
  return modes;
}

double shear_speed(double nu) { return std::sqrt(youngs_modulus / (2 * (1 + nu)) / density); }

TEST(MassMatrix, HoldsTheBodysMassAndItsMomentsOfInertia) {
  const MassSpringModel model =
      build_model(test::model("hybmss"), block_mesh({2, 1, 1}, {4, 2, 2}), {youngs_modulus, 0.3, density});
  const auto& X = model.network.X;
  const double mass = 2 * density, second = mass * 4 / 3;  // integral of x^2
  for (const double theta : {0.0, 0.5, 1.0}) {
    const Eigen::SparseMatrix<double> M = mass_matrix(model.network, density, theta);
    EXPECT_NEAR(M.sum(), mass, 1e-12 * mass);
    // Corner masses lie too far outside: by l^2/6 per unit mass.
    EXPECT_NEAR(X.col(0).dot(M * X.col(0)), second + (1 - theta) * mass * 0.25 / 6, 1e-12 * second) << theta;
  }
  EXPECT_THROW(mass_matrix(model.network, density, 1.5), std::invalid_argument);
}

TEST(MassMatrix, OfCutCellsHasTheMomentsOfTheFilledParts) {
  const Network network = test::cut_network();
  const double l = network.cells.edge;
  double mass = 0;
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const FilledPart& part = network.cells.filled[c];
    const double m = density * part.fraction * network.cells.volume();
    const Vec3 middle =
        (network.X.row(network.cells.corners[c][0]) + network.X.row(network.cells.corners[c][6])).transpose() / 2;
    const Vec3 centroid = middle + l * part.mean;
    mass += m;
    first += m * centroid;
    second += m * (centroid.cwiseProduct(centroid) + l * l * part.variance);
  }
  for (const double theta : {0.0, 1.0}) {
    const Eigen::SparseMatrix<double> M = mass_matrix(network, density, theta);
    EXPECT_NEAR(M.sum(), mass, 1e-12 * mass);
    for (int d = 0; d < 3; ++d) {
      const Eigen::VectorXd x = network.X.col(d), ones = Eigen::VectorXd::Ones(x.size());
      EXPECT_NEAR(ones.dot(M * x), first[d], 1e-12 * mass);
      if (theta == 1) {
        EXPECT_NEAR(x.dot(M * x), second[d], 1e-12 * mass);
      }
    }
  }
}

TEST(SmallestEigenpairs, AreThoseOfADiagonalPencilWithTheNullSpaceLeftOut) {
  const int n = 60;
  Eigen::VectorXd k(n), m(n);
  for (int i = 0; i < n; ++i) {
    k[i] = i < 2 ? 0 : 1 + i / 3;  // threefold eigenvalues
    m[i] = i % 2 ? 2 : 0;          // half of the unknowns without mass
  }
  const Operator K = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y = k.cwiseProduct(x); };
  const Operator M = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y = m.cwiseProduct(x); };
  const Operator P = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y = x / 5; };
  Eigen::MatrixXd null = Eigen::MatrixXd::Zero(n, 1), start(n, 8);
  null(1, 0) = std::sqrt(0.5);
  for (int i = 0; i < start.size(); ++i) start.data()[i] = std::sin(1.0 + i * i);
  const SmallestEigenpairs found = smallest_eigenpairs(K, M, P, null, start, 4, 1e-8, 200);
  ASSERT_TRUE(found.converged) << found.residual;
  // Unknowns 3, 5, 7, 9 have mass: k = 2, 2, 3, 4.
  const double expected[] = {1.0, 1.0, 1.5, 2.0};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found.values[i], expected[i], 1e-10) << i;
}

TEST(NaturalModes, OfAFreeCubeHoldLamesModesWithOrderTwo) {
  // u = (cos x sin y, -sin x cos y, 0), x and y in units of a / pi: isochoric and traction-free for every nu, with
  // f = c_s / (sqrt(2) a).  Found by its shape: the mean of the frequencies, weighted by what the modes hold of it.
  const double a = 1, pi = std::numbers::pi;
  for (const auto& [name, nu] : {std::pair("msm_18", 0.25), std::pair("hybmss", 0.3), std::pair("hybmss_bt", 0.0),
                                 std::pair("hybmss_bt", 0.45), std::pair("emsm", 0.4)}) {
    const double exact = shear_speed(nu) / (std::sqrt(2.0) * a);
    double before = 0;
    for (const int n : {6, 12}) {
      const Mesh mesh = block_mesh({a, a, a}, {n, n, n});
      const NaturalModes modes = free_modes(name, mesh, nu, 0, 20);
      EXPECT_EQ(modes.rigid_motions, 6);
      const MassSpringModel model = build_model(test::model(name), mesh, {youngs_modulus, nu, density});
      const Eigen::SparseMatrix<double> M = mass_matrix(model.network, density, 0);
      NodalVectors lame(mesh.nodes.rows(), 3);
      for (Eigen::Index i = 0; i < lame.rows(); ++i) {
        const double x = pi / a * model.network.X(i, 0), y = pi / a * model.network.X(i, 1);
        lame.row(i) << std::cos(x) * std::sin(y), -std::sin(x) * std::cos(y), 0;
      }
      const NodalVectors inertia = M * lame;
      double held = 0, frequency = 0;
      for (std::size_t j = 0; j < modes.shapes.size(); ++j) {
        const double share =
            std::pow(modes.shapes[j].cwiseProduct(inertia).sum(), 2) / lame.cwiseProduct(inertia).sum();
        held += share;
        frequency += share * modes.frequencies[j];
      }
      EXPECT_GT(held, 0.99) << name << nu;
      const double error = frequency / held / exact - 1;
      if (before != 0) {
        EXPECT_NEAR(std::log2(before / error), 2, 0.15) << name << nu;
      }
      // Dispersion of lumped masses in S waves along [110], -(k h)^2/16, k = sqrt(2) pi / a, and terms of higher order.
      EXPECT_LT(std::abs(error), 1.05 * pi * pi / 8 / (n * n)) << name << nu;
      before = error;
    }
  }
}

TEST(NaturalModes, OfABarBetweenLubricatedWallsAreItsStandingWaves) {
  // nu = 0, held along y and z everywhere, along x at one end: f_k = (2 k - 1) c / (4 L).  A chain of masses and
  // springs: sin instead of its argument, exactly.
  const int n = 8;
  const double length = 2, h = length / n, c = std::sqrt(youngs_modulus / density);
  const Mesh mesh = block_mesh({length, h, h}, {n, 1, 1});
  const MassSpringModel model = build_model(test::model("hybmss"), mesh, {youngs_modulus, 0, density});
  std::vector<char> fixed = nothing_fixed(model.network);
  for (int i = 0; i < model.network.nodes(); ++i) {
    fixed[3 * i] = model.network.X(i, 0) < 1e-9;
    fixed[3 * i + 1] = fixed[3 * i + 2] = 1;
  }
  // Of the four nodes of a section only the mean moves in the first modes: the others shear.
  for (const double theta : {0.0, 0.5, 1.0}) {
    const NaturalModes modes = natural_modes(model, fixed, density, theta, 1);
    ASSERT_TRUE(modes.ok) << modes.message;
    EXPECT_EQ(modes.rigid_motions, 0);
    const double s = std::pow(std::sin(std::numbers::pi / (4 * n)), 2);
    const double chain = 2 * c / h * std::sqrt(s / (1 - theta * s * 2 / 3)) / (2 * std::numbers::pi);
    EXPECT_NEAR(modes.frequencies[0], chain, 1e-8 * chain) << theta;
    EXPECT_NEAR(modes.frequencies[0], c / (4 * length), 0.01 * c / (4 * length)) << theta;
  }
}

TEST(NaturalModes, DoNotDependOnTheSolver) {
  // So many cells that multigrid is the preconditioner; checked against the model's own forces.
  const Mesh mesh = block_mesh({1.4, 1.3, 1.2}, {14, 13, 12});
  const MassSpringModel model = build_model(test::model("hybmss_bt"), mesh, {youngs_modulus, 0.3, density});
  const NaturalModes modes = natural_modes(model, nothing_fixed(model.network), density, 0.5, 6);
  ASSERT_TRUE(modes.ok) << modes.message;
  EXPECT_NE(modes.solver.find("multigrid"), std::string::npos) << modes.solver;
  EXPECT_EQ(modes.rigid_motions, 6);
  const Eigen::SparseMatrix<double> M = mass_matrix(model.network, density, 0.5);
  for (std::size_t i = 0; i < modes.shapes.size(); ++i) {
    const NodalVectors& u = modes.shapes[i];
    const double kinetic = u.cwiseProduct(NodalVectors(M * u)).sum();
    const double step = 1e-7;
    const NodalVectors force = -forces(model, model.network.X + step * u) / step;
    const double omega = 2 * std::numbers::pi * modes.frequencies[i];
    EXPECT_NEAR(kinetic, 1, 1e-9);
    EXPECT_NEAR(std::sqrt(u.cwiseProduct(force).sum()), omega, 1e-5 * omega) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(modes.shapes[j].cwiseProduct(NodalVectors(M * u)).sum(), 0, 1e-9);
  }
}

TEST(NaturalModes, OfCutCellsHaveNoSlowCornersOutsideOfTheBody) {
  // A free round bar that lies anyhow.  With a fraction of the mass of a full cell on corners that a sliver hardly
  // moves, or with lumped mass, these corners vibrate more slowly than the bar.
  const Mesh bar = test::mapped(test::cylinder(2, 16, 8), test::random_placement(1, 0.25));
  std::vector<std::vector<double>> found;
  for (const double edge : {0.25, 0.125}) {
    const MassSpringModel model = build_cut(test::model("hybmss_bt"), cut_body(test::grid_about(bar, edge), bar), {},
                                            Mesh{}, {youngs_modulus, 0.3, density})
                                      .model;
    const NaturalModes modes = natural_modes(model, nothing_fixed(model.network), density, 1, 6);
    ASSERT_TRUE(modes.ok) << modes.message;
    EXPECT_EQ(modes.rigid_motions, 6);
    found.push_back(modes.frequencies);
  }
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(found[0][i] / found[1][i], 1, 0.03) << i;
}

/// A round bar that lies anyhow, in cut cells of which some are halved twice.
MassSpringModel halved_bar() {
  const Mesh bar = test::mapped(test::cylinder(2, 16, 8), test::random_placement(1, 0.25));
  const VoxelGrid grid = test::halved_at_random(test::grid_about(bar, 0.25), 2, 12);
  return build_cut(test::model("hybmss_bt"), cut_body(grid, bar), {}, Mesh{}, {youngs_modulus, 0.3, density}).model;
}

TEST(MassMatrix, OfCellsOfSeveralSizesHasTheirMassesAndNoneAtCarriedNodes) {
  const Network network = halved_bar().network;
  ASSERT_GT(network.cells.carried.size(), 20u);
  double mass = 0;
  Vec3 first = Vec3::Zero();
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const double l = network.cells.edge_of(c), m = density * network.cells.filled[c].fraction * l * l * l;
    const Vec3 middle =
        (network.X.row(network.cells.corners[c][0]) + network.X.row(network.cells.corners[c][6])).transpose() / 2;
    mass += m;
    first += m * (middle + l * network.cells.filled[c].mean);
  }
  for (const double theta : {0.0, 1.0}) {
    const Eigen::SparseMatrix<double> M = mass_matrix(network, density, theta);
    const Eigen::VectorXd rows = M * Eigen::VectorXd::Ones(network.nodes());
    EXPECT_NEAR(rows.sum(), mass, 1e-12 * mass);
    EXPECT_LT((network.X.transpose() * rows - first).norm(), 1e-12 * mass);
    for (const CarriedPoint& c : network.cells.carried) EXPECT_EQ(rows[c.point], 0);
  }
}

TEST(NaturalModes, OfCellsOfSeveralSizesLieBesideThoseOfOneSize) {
  const Mesh bar = test::mapped(test::cylinder(2, 16, 8), test::random_placement(1, 0.25));
  const MassSpringModel fine = build_cut(test::model("hybmss_bt"), cut_body(test::grid_about(bar, 0.125), bar), {},
                                         Mesh{}, {youngs_modulus, 0.3, density})
                                   .model;
  const NaturalModes small = natural_modes(fine, nothing_fixed(fine.network), density, 1, 6);
  const MassSpringModel model = halved_bar();
  const Network& network = model.network;
  for (const double theta : {0.5, 1.0}) {
    const NaturalModes modes = natural_modes(model, nothing_fixed(network), density, theta, 6);
    ASSERT_TRUE(modes.ok) << modes.message;
    EXPECT_EQ(modes.rigid_motions, 6);
    const Eigen::SparseMatrix<double> M = mass_matrix(network, density, theta);
    for (int i = 0; i < 6; ++i) {
      if (theta == 1) {
        EXPECT_NEAR(modes.frequencies[i] / small.frequencies[i], 1, 0.03) << i;
      }
      // The force of a small displacement along a mode is its inertia, and carried nodes follow.
      const NodalVectors& u = modes.shapes[i];
      NodalVectors followed = u, force = -forces(model, network.X + 1e-7 * u) / 1e-7;
      carry(network.cells.carried, followed);
      EXPECT_EQ(followed, u);
      hand_back(network.cells.carried, force);
      const NodalVectors inertia = std::pow(2 * std::numbers::pi * modes.frequencies[i], 2) * (M * u);
      EXPECT_LT((force - inertia).norm(), 1e-4 * inertia.norm()) << i;
    }
  }
}

TEST(NaturalModes, OfForcesWithoutAPotentialAreRefused) {
  ModelParameters p = test::model("emsm");
  p.dispersion = Dispersion::published;
  const MassSpringModel model = build_model(p, block_mesh({1, 1, 1}, {3, 3, 3}), {youngs_modulus, 0.4, density});
  const NaturalModes modes = natural_modes(model, nothing_fixed(model.network), density, 0, 3);
  EXPECT_FALSE(modes.ok);
  EXPECT_NE(modes.message.find("potential"), std::string::npos) << modes.message;
}

TEST(NaturalModes, OfDisorderedNetworksHaveSixRigidMotionsToo) {
  const MassSpringModel model =
      build_model(test::model("msm_random"), block_mesh({1, 1, 1}, {6, 6, 6}), {youngs_modulus, 0.25, density});
  const NaturalModes modes = natural_modes(model, nothing_fixed(model.network), density, 0.5, 4);
  ASSERT_TRUE(modes.ok) << modes.message;
  EXPECT_EQ(modes.rigid_motions, 6);
  EXPECT_NEAR(modes.frequencies[0] / free_modes("msm_18", block_mesh({1, 1, 1}, {6, 6, 6}), 0.25, 0, 1).frequencies[0],
              1, 0.1);
}

}  // namespace
}  // namespace springproof::natural_modes_test
