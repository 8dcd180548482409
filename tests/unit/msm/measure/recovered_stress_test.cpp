// Stress recovered at the nodes of averaged springs.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "meshes/voxels/cells_apart.h"
#include "msm/measure/promised_error.h"
#include "support/manufactured.h"
#include "support/zoo.h"

namespace springproof::recovered_stress_test {
namespace {

const IsotropicMaterial material{1e4, 0.3, 1000};

NodalVectors displacement(const MassSpringModel& model, const test::ClosedMotion& x) {
  const NodalVectors& X = model.network.X;
  NodalVectors u = X;
  for (Eigen::Index n = 0; n < X.rows(); ++n) u.row(n) = (x(X.row(n), 0) - X.row(n).transpose()).transpose();
  return u;
}

/// Largest error over the nodes of a model, relative to the largest stress.
double error(const MassSpringModel& model, const test::ClosedMotion& x) {
  const NodalVectors& X = model.network.X;
  const auto stress = recovered_stress(model, displacement(model, x));
  double off = 0, most = 0;
  for (Eigen::Index n = 0; n < stress.rows(); ++n) {
    const Eigen::Matrix3d S = test::linear_elastic(material)(test::deformation_gradient(x, X.row(n), 0));
    Eigen::Matrix<double, 1, 6> exact;
    exact << S.diagonal().transpose(), S(0, 1), S(1, 2), S(0, 2);
    off = std::max(off, (stress.row(n) - exact).norm());
    most = std::max(most, exact.norm());
  }
  return off / most;
}

/// The same of the stress in the middle of a cell, taken for that at its corners.
double raw_error(const MassSpringModel& model, const test::ClosedMotion& x) {
  const NodalVectors& X = model.network.X;
  const NodalVectors u = displacement(model, x);
  double off = 0, most = 0;
  for (const Hexahedron& cell : model.network.cells.corners) {
    const NodalVectors corners = X(cell, Eigen::all);
    const Eigen::RowVector3d middle = corners.colwise().mean();
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    for (int n = 0; n < 8; ++n) F += u.row(cell[n]).transpose() * (corners.row(n) - middle).cwiseInverse() / 8;
    const Eigen::Matrix3d S = test::linear_elastic(material)(F);
    for (const int n : cell) {
      const Eigen::Matrix3d exact = test::linear_elastic(material)(test::deformation_gradient(x, X.row(n), 0));
      off = std::max(off, (S - exact).norm());
      most = std::max(most, exact.norm());
    }
  }
  return off / most;
}

MassSpringModel averaged(const Mesh& mesh) { return build_model(test::model("hybmss_avg"), mesh, material); }

MassSpringModel averaged_in_cut_cells() {
  const Network network = test::cut_network();
  return {network, build_model(test::model("hybmss_avg"), block_mesh({1, 1, 1}, {2, 2, 2}), material).laws};
}

Vec3 affine(const Vec3& X, double) { return X + 1e-3 * Vec3(X[0] + 2 * X[1], X[2] - 3 * X[1], X[0]); }
Vec3 quadratic(const Vec3& X, double) {
  return X + 1e-3 * Vec3(X[0] * X[0] - X[1] * X[2], 2 * X[0] * X[1] + X[2], X[2] * X[2] + 3 * X[0]);
}

TEST(RecoveredStress, IsExactWhereItIsLinearAlsoOnFacesEdgesAndCorners) {
  EXPECT_LE(error(averaged(test::notched_block()), affine), 1e-9);
  EXPECT_LE(error(averaged_in_cut_cells(), affine), 1e-9);
  EXPECT_LE(error(averaged(block_mesh({1, 1, 1}, {4, 3, 5})), quadratic), 1e-8);
  EXPECT_LE(error(averaged(block_mesh({4, 1, 1}, {2, 2, 2})), quadratic), 1e-8);  // flat cells, two across
}

// Strains that differ where materials meet, each linear on its side.
TEST(RecoveredStress, IsOfEachMaterialWhereTwoMeet) {
  Mesh mesh = block_mesh({1, 1, 1}, {4, 4, 4});
  for (const Hexahedron& cell : mesh.hexahedra) mesh.materials.push_back(mesh.nodes(cell[6], 2) > 0.6);
  const IsotropicMaterial stiff{1e5, 0.2, 1000};
  const MassSpringModel model = build_embedded(test::model("hybmss_avg"), mesh, material, nullptr, {stiff}).model;
  const auto x = [](const Vec3& X, double) {
    return Vec3(X[0], X[1], X[2] + 1e-3 * std::abs(X[2] - 0.5) * (1 + X[2]));
  };
  const NodalStresses stress = recovered_stress(model, displacement(model, x));
  const CellsApart cells = apart(mesh.hexahedra, mesh.materials);
  ASSERT_EQ(stress.rows(), mesh.nodes.rows() + 25);
  for (std::size_t c = 0; c < cells.corners.size(); ++c)
    for (const int n : cells.corners[c]) {
      const double z = mesh.nodes(cells.node[n], 2), side = mesh.materials[c] ? 1 : -1;
      const IsotropicMaterial& own = mesh.materials[c] ? stiff : material;
      const double strain = side * 1e-3 * (0.5 + 2 * z);
      EXPECT_NEAR(stress(n, 2), (lame_lambda(own) + 2 * shear_modulus(own)) * strain, 1e-9 * own.youngs_modulus);
      EXPECT_NEAR(stress(n, 0), lame_lambda(own) * strain, 1e-9 * own.youngs_modulus);
    }
}

Vec3 waves(const Vec3& X, double) {
  return X + 1e-3 * Vec3(std::sin(2 * X[0] + X[1]), std::cos(X[1] - 2 * X[2]), std::sin(X[0] * X[2]));
}

double order(const char* stress, int theory, double (*of)(const MassSpringModel&, const test::ClosedMotion&)) {
  const double coarse = of(averaged(block_mesh({1, 1, 1}, {6, 6, 6})), waves),
               fine = of(averaged(block_mesh({1, 1, 1}, {12, 12, 12})), waves);
  return test::recorded_order(std::string("`hybmss_avg`, ") + stress, "waves, ν = 0.3", theory, coarse, fine);
}

TEST(RecoveredStress, IsOfSecondOrderUpToTheSurface) { EXPECT_GE(order("recovered stress, largest", 2, error), 1.8); }

TEST(RecoveredStress, IsOneOrderAboveTheStressOfCells) {
  const double raw = order("stress of cells, largest", 1, raw_error);
  EXPECT_GE(raw, 0.8);
  EXPECT_LE(raw, 1.2);
}

}  // namespace
}  // namespace springproof::recovered_stress_test
