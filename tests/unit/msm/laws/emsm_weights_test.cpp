// Exact dispersion weights, and how a network carries a body.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meshes/volume.h"
#include "msm/cells/dispersion_weights.h"
#include "msm/measure/statistics.h"
#include "msm/statics/equilibrium.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::emsm_weights_test {
namespace {

const IsotropicMaterial material{1e4, 0.45, 1000};

struct Body {
  Mesh mesh;
  EmbeddedModel built;

  explicit Body(const std::string& name, const Mesh& of = block_mesh({3, 2.5, 2}, {6, 5, 4})) : mesh(of) {
    ModelParameters p = test::model(name);
    p.homogenised = false;
    p.exact_volumes = p.has(Extension::momentum_dispersion) ? std::optional(true) : std::nullopt;
    built = build_embedded(p, mesh, material);
  }
  const Network& network() const { return built.model.network; }
  const MomentumDispersion& law() const { return *dispersion_of(built.model); }
  NodalVectors gradient() const { return built.embedding.weights.transpose() * volume_gradient(mesh); }

  /// dJ of a displacement, per volume as the weights have it: over 2 (d + 2) G.
  Eigen::VectorXd inflow(const NodalVectors& u) const {
    const Tangent K = tangent(built.model, network().X);
    const double d = network().triangles.empty() ? 3 : 2;
    return K.inflow * Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()) / (2 * (d + 2) * shear_modulus(material));
  }
};

Eigen::VectorXd group_volumes(const Body& b) {
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(b.network().nodes());
  for (int n = 0; n < b.network().nodes(); ++n) volume[b.law().group[n]] += b.network().volume[n];
  return volume;
}

/// Traceful, unsymmetric; with no z for planar networks.
Eigen::Matrix3d some_gradient(bool planar) {
  Eigen::Matrix3d H;
  H << 0.3, 1.1, -0.7, 0.2, 0.5, 0.9, 1.3, -0.4, -0.1;
  if (planar) H.row(2).setZero(), H.col(2).setZero();
  return H;
}

// Networks without cells take their conditions with a slack of 1e-3.
TEST(VolumeWeights, SumOfInflowsIsTheChangeOfVolume) {
  for (const auto& [name, tolerance] : {std::pair{"emsm", 1e-10}, {"emsm_centred", 1e-6}, {"emsm_random", 1e-3}}) {
    const Body b(name);
    const NodalVectors u = test::noise(b.network().nodes(), 1);
    const double change = b.gradient().cwiseProduct(u).sum(), size = b.gradient().norm() * u.norm();
    EXPECT_LE(std::abs(b.inflow(u).sum() - change), tolerance * size) << name;
  }
}

// The corners of a sheet of triangles and surface nodes of a disordered network have too few springs for all
// conditions.
TEST(VolumeWeights, AffineFieldsGiveEachGroupItsShareAndShearNone) {
  for (const auto& [name, tolerance] :
       {std::pair{"emsm", 1e-10}, {"emsm_centred", 5e-4}, {"emsm_hexagonal", 0.03}, {"emsm_random", 3e-3}}) {
    const Body b(name);
    const Eigen::Matrix3d H = some_gradient(name == std::string("emsm_hexagonal"));
    const Eigen::VectorXd J = b.inflow(b.network().X * H.transpose()), V = group_volumes(b);
    EXPECT_LE((J - H.trace() * V).norm(), tolerance * H.norm() * V.norm()) << name;
  }
}

// Cells give their volume to their corners whatever their neighbours: no solve, and no residual on ragged bodies.
TEST(VolumeWeights, AreExactOnAnyBodyOfCells) {
  const Mesh ragged = test::voxels_of(block_mesh({3, 2.5, 2}, {6, 5, 4}), [](int i, int j, int k) {
    return (i < 4 || k < 2) && (i != 1 || j > 1) && (j != 3 || k != 1);
  });
  const Body b("emsm", ragged);
  const Eigen::Matrix3d H = some_gradient(false);
  const Eigen::VectorXd V = group_volumes(b);
  EXPECT_LE((b.inflow(b.network().X * H.transpose()) - H.trace() * V).norm(), 1e-12 * H.norm() * V.norm());
  const NodalVectors u = test::noise(b.network().nodes(), 1);
  EXPECT_LE(std::abs(b.inflow(u).sum() - b.gradient().cwiseProduct(u).sum()), 1e-12 * b.gradient().norm() * u.norm());
  EXPECT_EQ(volume_weights(b.network(), b.gradient(), shear_modulus(material)).iterations, 0);
}

TEST(VolumeWeights, OnlySurfaceNodesShareAnothersInflow) {
  for (const char* name : {"emsm", "emsm_random"}) {
    const Body b(name);
    const std::vector<int> group = volume_groups(b.network());
    const Vec3 size(3, 2.5, 2);
    int shared = 0, surface = 0;
    for (int n = 0; n < b.network().nodes(); ++n) {
      const Vec3 p = b.network().X.row(n).transpose();
      const double depth = std::min(p.minCoeff(), (size - p).minCoeff());
      surface += depth < 1e-9;
      shared += group[n] != n;
      EXPECT_TRUE(group[n] == n || depth < 0.35) << name << " node " << n;  // 0.5 is a node distance
      EXPECT_EQ(group[group[n]], group[n]) << name;
    }
    EXPECT_GT(shared, surface / 2) << name;
  }
}

// Under uniform stretch the dispersion's forces are those of a pressure K* div u, K* = lambda - G, at every node.
TEST(VolumeWeights, UniformPressureIsInEquilibriumAtEveryNode) {
  const Body b("emsm");
  const NodalVectors X = b.network().X;
  NodalVectors f = NodalVectors::Zero(X.rows(), 3);
  const double stretch = 1e-6;
  b.law().add_forces(b.network(), X * (1 + stretch), f);
  const NodalVectors direction = b.gradient();
  const double pressure = -f.cwiseProduct(direction).sum() / direction.squaredNorm();
  EXPECT_LE((f + pressure * direction).norm(), 1e-6 * f.norm());
  EXPECT_NEAR(-pressure / (3 * stretch * (lame_lambda(material) - shear_modulus(material))), -1, 1e-5);
}

TEST(EmbeddingOfANetwork, CarriesAffineFieldsExactly) {
  for (const char* name : {"emsm_random", "emsm_centred", "emsm_hexagonal"}) {
    const Body b(name);
    const Eigen::Matrix3d H = some_gradient(name == std::string("emsm_hexagonal"));
    const NodalVectors carried =
        b.built.embedding.weights * ((b.network().X * H.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3)).eval();
    const NodalVectors exact = (b.mesh.nodes * H.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
    EXPECT_LE((carried - exact).cwiseAbs().maxCoeff(), 1e-12 * exact.cwiseAbs().maxCoeff() * 10) << name;
  }
}

TEST(EmbeddingOfANetwork, KeepsForceAndMoment) {
  const Body b("emsm_random");
  const auto resultant = [](const NodalVectors& X, const NodalVectors& f) {
    Eigen::Matrix<double, 6, 1> r = Eigen::Matrix<double, 6, 1>::Zero();
    for (int n = 0; n < f.rows(); ++n) {
      r.head<3>() += f.row(n).transpose();
      r.tail<3>() += Vec3(X.row(n)).cross(Vec3(f.row(n)));
    }
    return r;
  };
  for (const Load& load : std::vector<Load>{Traction{"x_max", {5, 6, 7}}, Pressure{"y_min", 3}, Gravity{{1, -2, 3}},
                                            PointForce{{0.3, 1.7, 1.9}, {1, -2, 3}}}) {
    const auto on_network = resultant(
        b.network().X, transfer({load}, b.mesh, b.built.embedding, b.network(), 1000, Kinematics::linear).external);
    const auto on_mesh = resultant(b.mesh.nodes, transfer({load}, b.mesh, 1000, Kinematics::linear).external);
    EXPECT_LE((on_network - on_mesh).norm(), 1e-12 * on_mesh.norm()) << "load " << load.index();
    EXPECT_GT(on_mesh.norm(), 1);
  }
}

TEST(EmbeddingOfANetwork, PatchesHoldTheNodesAtTheirFaces) {
  const Body random("emsm_random"), centred("emsm_centred");
  for (const auto& [patch, axis, at] : {std::tuple{"x_min", 0, 0.0}, {"x_max", 0, 3.0}, {"z_max", 2, 2.0}}) {
    EXPECT_GT(random.built.embedding.held.at(patch).size(), 15u);
    for (int n : random.built.embedding.held.at(patch)) EXPECT_NEAR(random.network().X(n, axis), at, 1e-8);
    for (int n : centred.built.embedding.held.at(patch))
      EXPECT_NEAR(std::abs(centred.network().X(n, axis) - at), 0.25, 1e-12);
  }
  EXPECT_EQ(centred.built.embedding.held.at("x_min").size(), 20u);  // one layer of 5 x 4
}

TEST(FreeMotions, AreHeldBySixUnknownsWithoutForce) {
  for (const char* name : {"emsm", "emsm_random"}) {
    const Body b(name);
    const std::vector<Load> loads = {Traction{"x_min", {-50, 0, 0}}, Traction{"x_max", {50, 0, 0}}};
    BoundaryConditions bc = transfer(loads, b.mesh, b.built.embedding, b.network(), 1000, Kinematics::linear);
    EXPECT_THROW(require_supported(bc, b.network().X), InputError);
    hold_free_motions(b.network().X, bc);
    EXPECT_EQ(std::count(bc.fixed.begin(), bc.fixed.end(), 1), 6) << name;
    require_supported(bc, b.network().X);
    const Equilibrium e = solve_linear(b.built.model, bc, {LinearSolver::cholesky, 1e-12, 100});
    ASSERT_TRUE(e.ok) << e.message;
    EXPECT_LE(e.support.norm(), 1e-8 * bc.external.norm()) << name;
    const NodalVectors u = b.built.embedding.weights * e.displacement;
    const auto mean = [&](const char* face) {
      const std::vector<int> nodes = nodes_of(patch(b.mesh, face));
      return u(nodes, 0).mean();
    };
    if (name == std::string("emsm")) {
      EXPECT_NEAR((mean("x_max") - mean("x_min")) / (3 * 50 / 1e4), 1, 1e-6);
    }
    // A body held in part needs only the rest.
    const std::optional<double> open;
    const std::vector<Load> slip = {PrescribedDisplacement{"x_min", {0.0, open, open}}};
    BoundaryConditions part = transfer(slip, b.mesh, b.built.embedding, b.network(), 1000, Kinematics::linear);
    const auto before = std::count(part.fixed.begin(), part.fixed.end(), 1);
    hold_free_motions(b.network().X, part);
    EXPECT_EQ(std::count(part.fixed.begin(), part.fixed.end(), 1) - before, 3) << name;
  }
}

}  // namespace
}  // namespace springproof::emsm_weights_test
