// Networks on the vertices of tetrahedra, whose springs pass the patch test.
#include "msm/vertex_models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "meshes/mesher/mesher.h"
#include "meshes/volume.h"
#include "msm/cells/dispersion_weights.h"
#include "msm/embedding/surface_shares.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::vertex_models_test {
namespace {

Mesh tetrahedra(const char* geo, const Vec3& size, double edge) {
  return mesh_body({.file = find_geo({geo, {}, {}, {}}, "case.toml"), .size = size, .edge = edge}).mesh;
}

const Mesh& bar() {
  static const Mesh mesh = tetrahedra("bar.geo", {4, 1, 1}, 0.25);
  return mesh;
}

const Mesh& round() {
  static const Mesh mesh = tetrahedra("sphere.geo", {2, 2, 2}, 0.35);
  return mesh;
}

/// Largest and mean unbalanced force of a node under affine strains, of the stress on the area of a node.
Eigen::Vector2d unbalanced(const Mesh& mesh, const Network& network) {
  const NodalVectors A = vertex_shares(mesh, network).area;
  double largest = 0, squares = 0;
  for (const Vec3& a : {Vec3(1, 0, 0), Vec3(0, 1, -1), Vec3(1, 2, 3)}) {
    const Eigen::Matrix3d strain = a * a.transpose() / a.squaredNorm();
    const Eigen::Matrix3d stress = 2 * strain + strain.trace() * Eigen::Matrix3d::Identity();
    NodalVectors force = A * stress;
    for (const Spring& s : network.springs) {
      const Vec3 n = (network.X.row(s.j) - network.X.row(s.i)).transpose() / s.rest_length;
      const Vec3 pull = s.stiffness * s.rest_length * n.dot(strain * n) * n;
      force.row(s.i) += pull.transpose();
      force.row(s.j) -= pull.transpose();
    }
    force /= stress.norm() * std::pow(network.volume.sum() / network.nodes(), 2.0 / 3);
    largest = std::max(largest, force.rowwise().norm().maxCoeff());
    squares += force.squaredNorm() / network.nodes() / 3;
  }
  return {largest, std::sqrt(squares)};
}

// What is left is the slack of the fit: with the springs' first guess it is 0.1 to 1.
TEST(VertexModels, HoldAffineStrainsAtEveryNodeOfABarAndOfABall) {
  for (const Mesh* mesh : {&bar(), &round()}) {
    const Network network = fitted_on_vertices(test::model("emsm_patch"), *mesh);
    for (const Spring& s : network.springs) EXPECT_GT(s.stiffness, 0);
    const Eigen::Vector2d left = unbalanced(*mesh, network);
    EXPECT_LE(left[0], 0.02) << network.nodes();
    EXPECT_LE(left[1], 2e-3) << network.nodes();
  }
}

TEST(VertexNetwork, JoinsEachVertexToTheNearestThatItSees) {
  const Mesh body = tetrahedra("l_bracket.geo", {0.1, 0.05, 0.1}, 0.01);
  const Network network = vertex_network(body, 30);
  std::vector<int> springs(network.nodes(), 0);
  for (const Spring& s : network.springs) {
    ++springs[s.i];
    ++springs[s.j];
    const Eigen::RowVector3d middle = (network.X.row(s.i) + network.X.row(s.j)) / 2;
    EXPECT_TRUE(middle[0] < 0.0401 || middle[2] < 0.0401) << middle;  // not through the notch
  }
  EXPECT_GE(*std::min_element(springs.begin(), springs.end()), 30);
  EXPECT_NEAR(network.volume.sum(), volume(body, body.nodes), 1e-12);
  EXPECT_THROW(vertex_network(body, network.nodes()), std::invalid_argument);
}

/// Share of the weights' size that is on springs up to 1.5 spacings.
double on_near_springs(const Network& network, const DispersionWeights& weights) {
  const double reach = 1.5 * std::cbrt(network.volume.sum() / network.nodes());
  double near = 0, all = 0;
  for (std::size_t s = 0; s < network.springs.size(); ++s) {
    const double size = std::abs(weights.weight[2 * s]) + std::abs(weights.weight[2 * s + 1]);
    all += size;
    if (network.springs[s].rest_length < reach) near += size;
  }
  return near / all;
}

TEST(VolumeWeights, OfNearSpringsAreExactAndAtEachNodeItsOwn) {
  const Network network = fitted_on_vertices(test::model("emsm_patch"), bar());
  const NodalVectors gradient = vertex_shares(bar(), network).area;
  const DispersionWeights near = volume_weights(network, gradient, 1, WeightStart::near_springs);
  EXPECT_LE(near.residual, 1e-3);
  EXPECT_GT(on_near_springs(network, near), 2 * on_near_springs(network, volume_weights(network, gradient, 1)));
  for (int n = 0; n < network.nodes(); ++n) EXPECT_EQ(near.group[n], n);
}

TEST(VertexModels, GiveABarItsModuli) {
  const Mesh& mesh = bar();
  ModelParameters model = test::model("emsm_patch");
  model.exact_volumes = true;
  const Network fitted = fitted_on_vertices(model, mesh);
  for (const double nu : {0.0, 0.25, 0.45}) {
    const EmbeddedModel built = build_on_vertices(model, mesh, {1e4, nu, 1000}, fitted);
    const std::optional<double> free;
    const std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, free, free}}, Traction{"x_max", {1, 0, 0}}};
    BoundaryConditions bc = transfer(loads, mesh, built.embedding, built.model.network, 1000, Kinematics::linear);
    hold_free_motions(mesh.nodes, bc);
    const Equilibrium e = solve_linear(built.model, bc, {LinearSolver::cholesky, 1e-10, 300});
    ASSERT_TRUE(e.ok) << e.message;
    Eigen::MatrixXd linear(mesh.nodes.rows(), 4);
    linear << mesh.nodes, Eigen::VectorXd::Ones(mesh.nodes.rows());
    const Eigen::Matrix3d gradient = linear.colPivHouseholderQr().solve(e.displacement).topRows(3).transpose();
    EXPECT_NEAR(1 / gradient(0, 0) / 1e4, 1, 1e-3) << nu;
    EXPECT_NEAR(-(gradient(1, 1) + gradient(2, 2)) / 2 / gradient(0, 0), nu, 1e-3) << nu;
  }
}

}  // namespace
}  // namespace springproof::vertex_models_test
