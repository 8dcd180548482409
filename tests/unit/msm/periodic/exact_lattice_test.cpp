// Cubic lattices against their discrete solutions in closed form: plane waves, and a sinusoidal load.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "msm/dynamics/natural_modes.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::exact_lattice_test {
namespace {

constexpr double l = 0.3, round_off = 1e-12;

/// D(k) of u exp(i k x), -f = D u per node, the lattice's constants from E and nu alone: springs of the edges, face and
/// cube diagonals with G l = k_f + 4 k_c / 3, k_e = k_f + 8 k_c / 3 (Golec et al. 2019, eqs (5.9), (5.10)), and
/// lambda - G times the square of what a cell (HybMSS) or a node (eMSM) gains in volume, per volume.
Eigen::Matrix3d symbol(const ModelParameters& p, const IsotropicMaterial& m, const Vec3& k) {
  const double Gl = shear_modulus(m) * l, A = p.face_to_cube;
  const double k_c = std::isinf(A) ? 0 : Gl / (A + 4. / 3), k_f = std::isinf(A) ? Gl : A * k_c, k_e = k_f + 8 * k_c / 3;
  const Eigen::Array3d c = (l * k).array().cos(), s = (l * k).array().sin(), s_half = (l / 2 * k).array().sin(),
                       c_half = (l / 2 * k).array().cos();
  Eigen::Matrix3d D = (8 * k_c / 3 * (1 - c.prod())) * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, h = (i + 2) % 3;
    D(i, i) += 2 * k_e * (1 - c[i]) + 2 * k_f * (2 - c[i] * (c[j] + c[h]));
    D(i, j) = D(j, i) = (2 * k_f + 8 * k_c / 3 * c[h]) * s[i] * s[j];
  }
  Vec3 volume = Vec3::Zero();
  if (p.has(Extension::volume_correction))
    for (int i = 0; i < 3; ++i) volume[i] = 2 * s_half[i] * c_half[(i + 1) % 3] * c_half[(i + 2) % 3];
  if (p.has(Extension::momentum_dispersion)) volume = s;
  return D + (lame_lambda(m) - shear_modulus(m)) * l * volume * volume.transpose();
}

/// u at every node of a network, e cos(k x + phase).
NodalVectors wave(const Network& network, const Vec3& e, const Vec3& k, double phase = 0) {
  return ((network.X * k).array() + phase).cos().matrix() * e.transpose();
}

/// -f at rest under a displacement, forces on periodic images with those on their masters.
NodalVectors resistance(const MassSpringModel& model, const NodalVectors& u) {
  Eigen::VectorXd f;
  tangent(model, model.network.X).multiply(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()), f);
  NodalVectors sum = NodalVectors::Zero(u.rows(), 3);
  for (int n = 0; n < model.network.nodes(); ++n) sum.row(model.network.master(n)) += f.segment<3>(3 * n).transpose();
  return sum;
}

struct Row {
  const char* model;
  double poisson_ratio;
};
void PrintTo(const Row& row, std::ostream* out) { *out << row.model << ", nu = " << row.poisson_ratio; }

class ExactLattice : public testing::TestWithParam<Row> {
 protected:
  const ModelParameters p_ = test::model(GetParam().model);
  const IsotropicMaterial m_{2e5, GetParam().poisson_ratio, 900};
};

TEST_P(ExactLattice, HasTheFrequenciesOfItsPlaneWaves) {
  constexpr int n = 7;
  const MassSpringModel model = periodic_model(p_, m_, l, n * n * n);
  const double mass = m_.density * l * l * l, largest = 16 * (shear_modulus(m_) + std::abs(lame_lambda(m_))) * l;
  for (const Vec3& periods : {Vec3(1, 0, 0), Vec3(2, 2, 0), Vec3(3, 3, 3), Vec3(1, -2, 3), Vec3(0, 3, 1)}) {
    const Vec3 k = 2 * std::numbers::pi / (n * l) * periods;
    const Eigen::Matrix3d D = symbol(p_, m_, k);
    Eigen::Matrix3d found;  // at the node in the origin, of the tangent
    for (int i = 0; i < 3; ++i) {
      const NodalVectors u = wave(model.network, Vec3::Unit(i), k, 0.7), f = resistance(model, u),
                         exact = wave(model.network, D.col(i), k, 0.7);
      for (int node = 0; node < model.network.nodes(); ++node) {
        if (model.network.master(node) != node) continue;
        ASSERT_LE((f.row(node) - exact.row(node)).norm(), round_off * largest) << periods.transpose() << " " << node;
      }
      found.col(i) = resistance(model, wave(model.network, Vec3::Unit(i), k)).row(0).transpose();
    }
    const auto frequencies = [&](const Eigen::Matrix3d& of) {
      return Vec3((Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(of).eigenvalues() / mass).cwiseSqrt());
    };
    EXPECT_LE((frequencies(found) - frequencies(D)).norm(), round_off * frequencies(D).norm()) << periods.transpose();
  }
}

/// Of equal springs: omega^2 m = 12 and 4 k sin^2(k_x l / 2) along an axis.
TEST(ExactLattice18, HasTheWavesOfEqualSprings) {
  const double k = 0.4 * 2e5 * l, sine = std::sin(0.55);
  const Eigen::Matrix3d D = symbol(test::model("msm_18"), {2e5, 0.25, 900}, Vec3(1.1 / l, 0, 0));
  EXPECT_LE((D - 4 * k * sine * sine * Eigen::Matrix3d(Vec3(3, 1, 1).asDiagonal())).norm(), 1e-12 * k);
}

/// Nodes inside of a block have all springs, and inflows that none on the surface shares (volume_groups()): with the
/// lattice's own wave on its surface it is a part of the infinite one.
TEST_P(ExactLattice, CarriesASinusoidalLoad) {
  constexpr int n = 8;
  const Mesh mesh = block_mesh(n * l * Vec3::Ones(), {n, n, n});
  const MassSpringModel model = build_model(p_, mesh, m_);
  const Vec3 k = Vec3(0.9, -0.5, 1.3) / l, force = 1e-3 * m_.youngs_modulus * l * l * Vec3(1, 0.4, -0.7),
             amplitude = symbol(p_, m_, k).ldlt().solve(force);
  const NodalVectors u = wave(model.network, amplitude, k);
  const int nodes = model.network.nodes(), reach = p_.has(Extension::momentum_dispersion) ? 3 : 1;
  BoundaryConditions bc{std::vector<char>(3 * nodes, 0), std::vector<int>(3 * nodes, -1), NodalVectors::Zero(nodes, 3),
                        wave(model.network, force, k)};
  for (int i = 0; i < nodes; ++i) {
    const auto X = model.network.X.row(i).array();
    if (X.minCoeff() > (reach - 0.5) * l && X.maxCoeff() < (n - reach + 0.5) * l) continue;
    std::fill_n(bc.fixed.begin() + 3 * i, 3, 1);
    std::fill_n(bc.owner.begin() + 3 * i, 3, 0);
    bc.prescribed.row(i) = u.row(i);
  }
  const Equilibrium e = solve_linear(model, bc, {LinearSolver::cholesky, 1e-13, 100});
  ASSERT_TRUE(e.ok) << e.message;
  EXPECT_LE((e.displacement - u).cwiseAbs().maxCoeff(), round_off * amplitude.norm());
}

INSTANTIATE_TEST_SUITE_P(Models, ExactLattice,
                         testing::Values(Row{"msm_18", 0.25}, Row{"msm_14", 0.25}, Row{"hybmss_cf", 0.25},
                                         Row{"hybmss", -0.5}, Row{"hybmss", 0.4}, Row{"emsm", 0.25},
                                         Row{"emsm", 0.45}));

/// A block on rollers is a part of an infinite lattice too, whose waves are mirrored in its faces.
TEST(ExactLatticeOnRollers, HasTheFrequenciesOfStandingWaves) {
  constexpr int n = 5;
  const IsotropicMaterial m{2e5, 0.3, 900};
  const ModelParameters p = test::model("hybmss");
  const MassSpringModel model = build_model(p, block_mesh(n * l * Vec3::Ones(), {n, n, n}), m);
  std::vector<char> fixed(3 * model.network.nodes(), 0);
  for (int i = 0; i < model.network.nodes(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double X = model.network.X(i, c);
      fixed[3 * i + c] = X < l / 2 || X > (n - 0.5) * l;
    }
  const NaturalModes modes = natural_modes(model, fixed, m.density, 0, 6);
  ASSERT_TRUE(modes.ok) << modes.message;
  const double mass = m.density * l * l * l;
  std::vector<double> exact;
  for (int a = 0; a <= n; ++a)
    for (int b = 0; b <= n; ++b)
      for (int c = 0; c <= n; ++c) {
        if (a + b + c == 0) continue;
        const Vec3 k = std::numbers::pi / (n * l) * Vec3(a, b, c);
        // A component that is a sine along its own axis is none where that axis is not waved, or waved from node to
        // node.
        Eigen::Matrix3d D = symbol(p, m, k);
        for (int i = 0; i < 3; ++i)
          if (const double waves = k[i] * n * l / std::numbers::pi; waves < 0.5 || waves > n - 0.5) {
            D.row(i).setZero();
            D.col(i).setZero();
          }
        for (const double omega2 : Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(D).eigenvalues() / mass)
          if (omega2 > 1e-6 * m.youngs_modulus * l / mass) exact.push_back(std::sqrt(omega2) / (2 * std::numbers::pi));
      }
  std::sort(exact.begin(), exact.end());
  for (std::size_t i = 0; i < modes.frequencies.size(); ++i)
    EXPECT_NEAR(modes.frequencies[i] / exact[i], 1, round_off) << i;
}

}  // namespace
}  // namespace springproof::exact_lattice_test
