// What engines take for a material: each conversion against what the engine computes with it.
#include "comparisons/engines/engine_constants.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "meshes/volume.h"
#include "msm/algebra/dense.h"

namespace springproof::engine_constants_test {
namespace {

using Mat3 = Eigen::Matrix3d;

/// First Piola-Kirchhoff stress of btDeformableNeoHookeanForce (Bullet 3.24).
Mat3 bullet_stress(const BulletNeoHooke& c, const Mat3& F) {
  const double trace = (F.transpose() * F).trace(), J = F.determinant();
  const Mat3 cofactor = J * F.inverse().transpose();
  return c.mu * (1 - 1 / (trace + 1)) * F + (c.lambda * (J - 1) - 0.75 * c.mu) * cofactor;
}

TEST(EngineConstants, BulletsNeoHookeHasTheMaterialsModuliAtRest) {
  for (const double nu : {-0.4, 0.0, 0.25, 0.45, 0.49}) {
    const IsotropicMaterial m{2e5, nu, 1000};
    const BulletNeoHooke c = bullet_neo_hooke(m);
    EXPECT_LE(bullet_stress(c, Mat3::Identity()).norm(), 1e-9 * m.youngs_modulus);
    Mat3 strain;
    strain << 1, 0.3, -0.2, 0.3, -0.5, 0.7, -0.2, 0.7, 0.4;
    const double h = 1e-5;
    const Mat3 slope =
        (bullet_stress(c, Mat3::Identity() + h * strain) - bullet_stress(c, Mat3::Identity() - h * strain)) / (2 * h);
    const Mat3 hooke = 2 * shear_modulus(m) * strain + lame_lambda(m) * strain.trace() * Mat3::Identity();
    EXPECT_LE((slope - hooke).norm(), 1e-7 * hooke.norm()) << nu;
  }
}

TEST(EngineConstants, ConstraintOnSixVolumesAddsTheBulkModulus) {
  Eigen::Matrix<double, 4, 3> x;
  x << 0, 0, 0, 0.2, 0, 0.1, 0, 0.3, 0, 0.1, 0, 0.25;
  const double V = tetrahedron_volume(x), K = 7e4, strain = 1e-6;
  const double C = 6 * (tetrahedron_volume(x * std::cbrt(1 + strain)) - V);
  EXPECT_NEAR(C * C / (2 * volume_compliance(V, K)), K / 2 * strain * strain * V, 1e-8 * K / 2 * strain * strain * V);
}

TEST(EngineConstants, ImplicitEulerDampsByPiFrequencyStep) {
  const double frequency = 0.7, h = 1.0 / 240, omega = 2 * std::numbers::pi * frequency;
  double x = 1, v = 0;
  const int steps = static_cast<int>(std::lround(10 / frequency / h));
  for (int s = 0; s < steps; ++s) {
    v = (v - h * omega * omega * x) / (1 + h * h * omega * omega);
    x += h * v;
  }
  const double energy = x * x + v * v / (omega * omega);  // exp(-2 zeta omega t)
  const double zeta = -std::log(energy) / (2 * omega * steps * h);
  EXPECT_NEAR(implicit_euler_damping(frequency, h) / zeta, 1, 0.01);
}

TEST(EngineConstants, SinglePrecisionStopsBelowTheLeastStep) {
  const float x = 4;
  const double h = least_single_precision_step(x, 0.3);
  EXPECT_NEAR(h, 1.26e-3, 5e-6);
  const auto moved = [&](double step) { return x + static_cast<float>(0.3 * step * step); };
  EXPECT_GT(moved(h), x);
  EXPECT_EQ(moved(0.7 * h), x);
}

TEST(EngineConstants, SafeStepOfTetrahedraIsABoundNotFarFromTheBlocks) {
  const IsotropicMaterial m{1e6, 0.4, 1000};
  const double edge = 0.5;
  const Mesh mesh = block_mesh({4 * edge, 3 * edge, 3 * edge}, {4, 3, 3});
  const double lambda = lame_lambda(m), G = shear_modulus(m);
  const Eigen::Index n = mesh.nodes.rows();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (const Tetrahedron& t : five_tetrahedra(mesh.nodes, mesh.hexahedra, edge)) {
    Mat3 D;
    for (int a = 0; a < 3; ++a) D.col(a) = (mesh.nodes.row(t[a + 1]) - mesh.nodes.row(t[0])).transpose();
    Eigen::Matrix<double, 3, 4> g;
    g.rightCols(3) = D.inverse().transpose();
    g.col(0) = -g.rightCols(3).rowwise().sum();
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        K.block<3, 3>(3 * t[a], 3 * t[b]) +=
            D.determinant() / 6 *
            (lambda * g.col(a) * g.col(b).transpose() + G * g.col(b) * g.col(a).transpose() +
             G * g.col(a).dot(g.col(b)) * Mat3::Identity());
  }
  const Eigen::VectorXd volumes = nodal_volumes(mesh);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double s = 1 / std::sqrt(m.density * volumes[i]);
    K.middleRows(3 * i, 3) *= s;
    K.middleCols(3 * i, 3) *= s;
  }
  const double exact = 2 / std::sqrt(symmetric_eigenvalues(K)[3 * n - 1]),
               bound = safe_time_step_of_tetrahedra(m, edge);
  EXPECT_LE(bound, exact);
  EXPECT_GE(bound, 0.7 * exact);
}

TEST(EngineFacts, CompliancesAreThoseOfTheSharesOfASpring) {
  const IsotropicMaterial m{1e6, 0.25, 1000};
  const nlohmann::json facts = json_of({facts_of(EngineFacts{m, 0.5, {2e5, 1e5, 0}, 0, 2})})["engines"];
  EXPECT_EQ(facts["compliance_m_N"]["k_e"], (nlohmann::json{{"inside", 5e-6}, {"surface", 1e-5}, {"edge", 2e-5}}));
  EXPECT_EQ(facts["compliance_m_N"]["k_f"], (nlohmann::json{{"inside", 1e-5}, {"surface", 2e-5}}));
  EXPECT_FALSE(facts["compliance_m_N"].contains("k_c"));
  EXPECT_TRUE(facts["volume_compliance_m5_N"].is_null());
  EXPECT_NEAR(facts["implicit_euler"]["damping"][0]["zeta"], std::numbers::pi / 30, 1e-12);
  const std::string text = text_of({facts_of(EngineFacts{m, 0.5, {2e5, 1e5, 0}, 1e5, 2})});
  EXPECT_NE(text.find("7.5e-06 m^5/N   36 V / kappa"), std::string::npos) << text;
  EXPECT_NE(text.find("5e-06        1e-05        2e-05 m/N   inside, surface, edge"), std::string::npos) << text;
}

}  // namespace
}  // namespace springproof::engine_constants_test
