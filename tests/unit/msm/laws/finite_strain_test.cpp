// Momentum dispersion of finite strain: the symmetric form at small strain, a material law at any other.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "meshes/volume.h"
#include "msm/laws/nodal_gradients.h"
#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::finite_strain_test {
namespace {

MassSpringModel model_of(const std::string& name, double nu, Dispersion form, const Mesh& mesh,
                         StrainCurve curve = StrainCurve::hencky) {
  ModelParameters p = test::model(name);
  p.dispersion = form;
  p.curve = curve;
  p.homogenised = false;
  return build_model(p, mesh, {1e4, nu, 1000});
}

/// Rows with momentum dispersion in three dimensions.
std::vector<std::string> rows() {
  std::vector<std::string> names;
  for (const ModelRow& row : model_table())
    if (row.extension == Extension::momentum_dispersion && row.topology != Topology::hexagonal)
      names.push_back(row.name);
  return names;
}

// The weights of disordered networks are exact to a slack, so that B is not quite isotropic at some nodes.
TEST(FiniteStrain, IsTheSymmetricFormAtSmallStrain) {
  const Mesh mesh = block_mesh({3, 2.5, 2}, {6, 5, 4});
  for (const std::string& name : rows())
    for (double nu : {-0.5, 0.25, 0.45}) {
      const MassSpringModel finite = model_of(name, nu, Dispersion::finite_strain, mesh),
                            symmetric = model_of(name, nu, Dispersion::symmetric, mesh);
      const NodalVectors& X = finite.network.X;
      const NodalVectors u = test::noise(X.rows(), 5e-8);
      const NodalVectors expected = forces(symmetric, X + u);
      EXPECT_LE((forces(finite, X + u) - expected).norm(), (name == "emsm" ? 1e-5 : 0.02) * expected.norm())
          << name << " nu = " << nu;
      EXPECT_LE(forces(finite, X).norm(), 1e-6 * expected.norm()) << name << " nu = " << nu;
    }
}

// Every node is in equilibrium in a homogeneous strain, and the body has the law's energy.
TEST(FiniteStrain, AHomogeneousStrainHasTheEnergyOfTheLaw) {
  const Mesh mesh = block_mesh({3, 2.5, 2}, {6, 5, 4});
  Eigen::Matrix3d F;
  F << 1.2, 0.1, -0.2, 0.05, 0.8, 0.1, 0.1, -0.1, 1.1;
  for (double nu : {0.25, 0.4, 0.499})
    for (const StrainCurve curve : {StrainCurve::hencky, StrainCurve::neo_hooke, StrainCurve::neo_hooke_isochoric,
                                    StrainCurve::springs_hencky, StrainCurve::springs_neo_hooke}) {
      const MassSpringModel model = model_of("emsm", nu, Dispersion::finite_strain, mesh, curve);
      const IsotropicMaterial m{1e4, nu, 1000};
      StrainEnergy W = springs_energy(curve, shear_modulus(m), F, Derivative::first);
      add_volume_term(curve, lame_lambda(m) - shear_modulus(m), F, Derivative::first, W);
      const NodalVectors x = model.network.X * F.transpose(), f = forces(model, x);
      EXPECT_NEAR(energy(model, x) / (W.value * 15), 1, 1e-11) << nu << " " << static_cast<int>(curve);
      double inside = 0;
      for (Eigen::Index n = 0; n < x.rows(); ++n) {
        const Vec3 X = model.network.X.row(n), depth = X.cwiseMin(Vec3(3, 2.5, 2) - X);
        if (depth.minCoeff() > 0.1) inside = std::max(inside, f.row(n).norm());
      }
      EXPECT_LE(inside, 1e-11 * W.stress.norm()) << nu << " " << static_cast<int>(curve);
    }
}

// A clamped cube shortened by a fifth: the symmetric form loses volume, this one as much as cells that know their own.
TEST(FiniteStrain, KeepsTheVolumeNearOneHalf) {
  const Mesh mesh = block_mesh({1, 1, 1}, {6, 6, 6});
  const LoadPath path = [&](double factor) {
    const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                                     PrescribedDisplacement{"z_max", {0.0, 0.0, -0.2}}};
    return transfer(loads, mesh, 1000, Kinematics::finite, factor);
  };
  const auto change = [&](const MassSpringModel& model) {
    const Equilibrium e = solve_finite(model, path);
    EXPECT_TRUE(e.ok) << e.message;
    return volume_change(mesh, e.displacement);
  };
  const double nu = 0.49, of_cells = change(build_model(test::model("hybmss_avg"), mesh, {1e4, nu, 1000}));
  EXPECT_NEAR(change(model_of("emsm", nu, Dispersion::finite_strain, mesh)), of_cells, 0.004);
  EXPECT_LT(change(model_of("emsm", nu, Dispersion::symmetric, mesh)), of_cells - 0.03);
}

TEST(FiniteStrain, NeedsSpringsInThreeDimensions) {
  Network sheet = test::bent_triangles();
  sheet.X.col(2).setZero();
  const MomentumDispersion law{0.3, Dispersion::finite_strain};
  EXPECT_THROW(NodalGradients(law, sheet), std::invalid_argument);
  EXPECT_THROW(resolve({"emsm_hexagonal", {{"dispersion", std::string("finite_strain")}}, "", {}}), InputError);
}

}  // namespace
}  // namespace springproof::finite_strain_test
