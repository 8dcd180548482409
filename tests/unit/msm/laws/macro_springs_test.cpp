// Macro-cells of springs: loads, uniform strain, bending, errors of finite elements, solvers, and what is refused.
#include "msm/laws/macro_springs.h"

#include <gtest/gtest.h>

#include "msm/algebra/dense.h"
#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/natural_modes.h"
#include "msm/exchange/springs_file.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::macro_springs_test {
namespace {

constexpr double nus[] = {-0.5, 0.0, 0.25, 0.45, 0.499};

IsotropicMaterial material(double nu) { return {1e4, nu, 1000}; }

EmbeddedModel block(const std::array<int, 3>& cells, double nu, double edge = 0.5) {
  return build_embedded(test::model("hybmss_macro"), block_mesh(edge * Vec3(cells[0], cells[1], cells[2]), cells),
                        material(nu));
}

Mesh mesh_of(const std::array<int, 3>& cells, double edge = 0.5) {
  return block_mesh(edge * Vec3(cells[0], cells[1], cells[2]), cells);
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "accepted";
}

/// Sides that bulge as parabolas: two thirds of the rise, where the cubes' bilinear faces have half.
TEST(MacroSprings, VolumeIsThatOfTheTriquadraticDisplacement) {
  Network network = block({2, 2, 2}, 0.25).model.network;
  NodalVectors u = NodalVectors::Zero(network.nodes(), 3);
  for (int n = 0; n < network.nodes(); ++n) u(n, 0) = 0.4 * network.X(n, 0) * network.X(n, 1) * (1 - network.X(n, 1));
  const VolumeChange change = volume_change(network, u);
  EXPECT_NEAR(change.exact, 0.4 / 6, 1e-14);
  EXPECT_NEAR(change.first_order, 0.4 / 6, 1e-14);
  network.macro_cells.clear();
  EXPECT_NEAR(volume_change(network, u).exact, 0.05, 1e-14);
}

TEST(MacroSprings, SharesOfAFaceAreOneFourAndSixteen) {
  const Mesh mesh = mesh_of({2, 2, 2});
  const EmbeddedModel built = block({2, 2, 2}, 0.25);
  const Eigen::VectorXd& area = built.embedding.patches.at("x_max").area;
  for (int n = 0; n < mesh.nodes.rows(); ++n) {
    const bool middle_y = mesh.nodes(n, 1) == 0.5, middle_z = mesh.nodes(n, 2) == 0.5;
    const double expected = mesh.nodes(n, 0) < 1 ? 0 : (middle_y ? 4.0 : 1.0) * (middle_z ? 4.0 : 1.0) / 36;
    EXPECT_NEAR(area[n], expected, 1e-15);
  }
  EXPECT_NEAR(built.embedding.volumes.sum(), 1, 1e-14);
  EXPECT_NEAR(built.model.network.volume.maxCoeff(), 64.0 / 216, 1e-14);
}

// The boundary of a patch need not be that of a macro-cell.
TEST(MacroSprings, APartOfAFaceHasTheMomentsOfItsArea) {
  Mesh mesh = mesh_of({2, 2, 2});
  Patch part{"part", {}};
  part.facets.push_back(patch(mesh, "x_max").facets.front());
  Vec3 centre = Vec3::Zero();
  for (const int n : part.facets[0]) centre += mesh.nodes.row(n).transpose() / 4;
  mesh.patches.push_back(part);
  const EmbeddedModel built = build_embedded(test::model("hybmss_macro"), mesh, material(0.25));
  const PatchShares& shares = built.embedding.patches.at("part");
  EXPECT_NEAR(shares.area.sum(), 0.25, 1e-15);
  EXPECT_LE((mesh.nodes.transpose() * shares.area / 0.25 - centre).norm(), 1e-14);
  const double square = shares.area.dot(mesh.nodes.col(1).cwiseAbs2()) / 0.25;
  EXPECT_NEAR(square, centre[1] * centre[1] + 0.25 / 12, 1e-14);
  EXPECT_LE((shares.normal.colwise().sum() - Eigen::RowVector3d(0.25, 0, 0)).norm(), 1e-15);
}

// Tractions of a uniform stress hold a uniform strain, small or large.
TEST(MacroSprings, UniformStrainIsInEquilibrium) {
  const Mesh mesh = mesh_of({4, 2, 2});
  for (const double nu : nus)
    for (int curve = 0; curve < 5; ++curve) {
      EmbeddedModel built = block({4, 2, 2}, nu);
      std::get<MacroSprings>(built.model.laws[0]).curve = static_cast<StrainCurve>(curve);
      Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
      F << 1.1, 0.05, -0.02, 0.03, 0.95, 0.04, -0.01, 0.02, 1.02;
      const NodalVectors f = forces(built.model, mesh.nodes * F.transpose());
      StrainEnergy W =
          springs_energy(static_cast<StrainCurve>(curve), shear_modulus(material(nu)), F, Derivative::first);
      add_volume_term(static_cast<StrainCurve>(curve), kappa(material(nu)), F, Derivative::first, W);
      NodalVectors external = NodalVectors::Zero(f.rows(), 3);
      for (const char* side : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
        external += built.embedding.patches.at(side).normal * W.stress.transpose();
      EXPECT_LE((f + external).norm(), 1e-12 * external.norm()) << "nu = " << nu << ", curve " << curve;
    }
}

TEST(MacroSprings, OnlyRigidMotionsHaveNoEnergy) {
  for (const double nu : nus) {
    const EmbeddedModel built = block({2, 2, 2}, nu);
    const Tangent K = tangent(built.model, built.model.network.X);
    Eigen::MatrixXd dense(81, 81);
    Eigen::VectorXd column;
    for (int i = 0; i < 81; ++i) {
      K.multiply(Eigen::VectorXd::Unit(81, i), column);
      dense.col(i) = column;
    }
    const Eigen::VectorXd values = symmetric_eigenvalues(dense);
    EXPECT_LE(std::abs(values[5]), 1e-12 * values[80]) << nu;
    EXPECT_GE(values[6], 1e-2 * shear_modulus(material(nu)) * 0.5) << nu;
  }
}

// Their strain is linear, so that two Gauss points along each axis of the block integrate its energy.
TEST(MacroSprings, QuadraticDisplacementsHaveTheEnergyOfTheSolid) {
  for (const double nu : nus) {
    const EmbeddedModel built = block({4, 2, 2}, nu);
    const NodalVectors& X = built.model.network.X;
    const NodalVectors random = test::noise(9, 1);
    const auto square = [&](int i) -> Eigen::Matrix3d { return random.middleRows<3>(3 * i); };
    NodalVectors u(X.rows(), 3);
    for (int n = 0; n < X.rows(); ++n)
      for (int i = 0; i < 3; ++i) u(n, i) = X.row(n).dot(square(i) * X.row(n).transpose());
    double energy = 0;
    for (int q = 0; q < 8; ++q) {
      const auto at = [&](int axis) { return 0.5 + (q >> axis & 1 ? 1 : -1) * std::sqrt(1.0 / 12); };
      const Vec3 x(2 * at(0), at(1), at(2));
      Eigen::Matrix3d strain;
      for (int i = 0; i < 3; ++i) strain.row(i) = ((square(i) + square(i).transpose()) * x).transpose();
      strain = (strain + strain.transpose()).eval() / 2;
      energy += 2.0 / 8 *
                (lame_lambda(material(nu)) / 2 * strain.trace() * strain.trace() +
                 shear_modulus(material(nu)) * strain.squaredNorm());
    }
    Eigen::VectorXd f;
    const Eigen::Map<const Eigen::VectorXd> flat_u(u.data(), u.size());
    tangent(built.model, X).multiply(flat_u, f);
    EXPECT_NEAR(flat_u.dot(f) / 2 / energy, 1, 1e-11) << nu;
  }
}

// u of pure bending is quadratic: all nodes inside and on the free sides are in equilibrium.
TEST(MacroSprings, PureBendingIsExact) {
  for (const double nu : nus) {
    const EmbeddedModel built = block({4, 2, 2}, nu);
    const NodalVectors& X = built.model.network.X;
    NodalVectors u(X.rows(), 3);
    const double k = 1e-6;
    for (int n = 0; n < X.rows(); ++n) {
      const double x = X(n, 0), y = X(n, 1) - 0.5, z = X(n, 2) - 0.5;
      u.row(n) << k * x * z, -nu * k * y * z, -k / 2 * (x * x + nu * (z * z - y * y));
    }
    Eigen::VectorXd f;
    tangent(built.model, X).multiply(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()), f);
    double largest = f.cwiseAbs().maxCoeff(), free = 0;
    for (int n = 0; n < X.rows(); ++n)
      if (X(n, 0) > 0 && X(n, 0) < 2) free = std::max(free, f.segment<3>(3 * n).cwiseAbs().maxCoeff());
    EXPECT_LE(free, 1e-10 * largest) << nu;
    const double energy = u.cwiseProduct(Eigen::Map<const NodalVectors>(f.data(), X.rows(), 3)).sum();
    EXPECT_NEAR(energy / (1e4 * 1 / 12.0 * k * k * 2), 1, 1e-9) << nu;  // E I k^2 L
  }
}

/// Deflection of the end of a clamped bar of 4 x 1 x 1 under a transverse traction, times the force.
double compliance(int across, double nu, LinearSolver solver) {
  const std::array<int, 3> cells = {4 * across, across, across};
  const Mesh mesh = mesh_of(cells, 1.0 / across);
  const EmbeddedModel built = block(cells, nu, 1.0 / across);
  const std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Traction{"x_max", {0, 0, 1}}};
  const BoundaryConditions bc = transfer(loads, mesh, built.embedding, built.model.network, 1000, Kinematics::linear);
  LinearOptions options;
  options.solver = solver;
  const Equilibrium e = solve_linear(built.model, bc, options);
  EXPECT_TRUE(e.ok) << e.message;
  EXPECT_LE((e.support.colwise().sum() + Eigen::RowVector3d(0, 0, 1)).norm(), 1e-6);
  return e.displacement.cwiseProduct(bc.external).sum();
}

// Elements of quadratic displacement whose volume change is projected, in a program of its own: -0.03 % from four cubes
// on.
TEST(MacroSprings, AreElementsOfLinearPressure) {
  EXPECT_NEAR(compliance(2, 0.25, LinearSolver::cholesky), 0.026778482058399, 1e-12);
}

TEST(MacroSprings, SolversAgree) {
  for (const double nu : nus) {
    const double direct = compliance(4, nu, LinearSolver::cholesky);
    EXPECT_NEAR(compliance(4, nu, LinearSolver::multigrid) / direct, 1, 1e-7) << nu;
  }
}

// Pressed by a fifth; the second block is solved by iteration, at 0.499 with pressures as unknowns.
TEST(MacroSprings, LargeDisplacementsNearTheIncompressibleLimit) {
  for (const int n : {4, 10})
    for (const double nu : {0.25, 0.499}) {
      const Mesh mesh = mesh_of({n, n, n}, 1.0 / n);
      const EmbeddedModel built = block({n, n, n}, nu, 1.0 / n);
      const auto path = [&](double factor) {
        return transfer(
            {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PrescribedDisplacement{"z_max", {0.0, 0.0, -0.2}}}, mesh,
            built.embedding, built.model.network, 1000, Kinematics::finite, factor);
      };
      const Equilibrium e = solve_finite(built.model, path);
      EXPECT_TRUE(e.ok) << e.message;
      EXPECT_LE(e.residual, 1e-8);
      EXPECT_EQ(e.solver.find("pressures") != std::string::npos, n == 10 && nu == 0.499) << e.solver;
      if (n == 4) continue;
      EXPECT_LE(e.iterations, 20);
      double force = 0;
      for (const int node : built.embedding.held.at("z_max")) force += e.support(node, 2);
      EXPECT_NEAR(force / (nu == 0.25 ? -2899.8 : -3361.9), 1, 0.012);  // of 16^3 cubes
    }
}

TEST(MacroSprings, AreRefusedByNameWhereTheyDoNotApply) {
  const auto odd = [] { block({4, 3, 2}, 0.25); };
  EXPECT_EQ(message_of(odd),
            "hybmss_macro: body.cells: [4, 3, 2]: a macro-cell is two cubes along each axis (allowed: even numbers)");
  const auto notched = [] {
    build_model(test::model("hybmss_macro"),
                test::voxels_of(mesh_of({4, 2, 2}), [](int i, int j, int) { return i > 0 || j > 0; }), material(0.25));
  };
  EXPECT_EQ(
      message_of(notched),
      "hybmss_macro: macro-cells of whole cubes fill blocks only (allowed: a body of `cells`, or a cut body at rest; "
      "hybmss_avg takes any body)");
  const MassSpringModel model = block({2, 2, 2}, 0.25).model;
  const std::string rest = ": hybmss_macro has cells of 27 nodes, which are for bodies at rest (allowed: hybmss_avg)";
  EXPECT_EQ(message_of([&] { checked_time_step(model, 1000, {}); }), "motion" + rest);
  EXPECT_EQ(message_of([&] { natural_modes(model, std::vector<char>(81, 0), 1000, 0, 1); }), "natural modes" + rest);
  SpringsFile file;
  file.model = model;
  EXPECT_EQ(message_of([&] { springs_as_json(file); }), "springs file" + rest);
}

}  // namespace
}  // namespace springproof::macro_springs_test
