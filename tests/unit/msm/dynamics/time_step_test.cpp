// Time steps that are safe for every network, and what dispersion from the step before needs.
#include "msm/dynamics/time_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/inertia.h"
#include "support/refined_cells.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::time_step_test {
namespace {

constexpr double density = 900;

/// A network of some 200 nodes of a model of the table.
MassSpringModel small_model(const std::string& name, double nu, Dispersion form = Dispersion::symmetric,
                            std::optional<bool> exact = {}) {
  ModelParameters p = test::model(name);
  p.dispersion = form;
  p.exact_volumes = exact;
  p.homogenised = false;  // the bulk's moduli are no matter here
  return build_model(p, block_mesh({2.5, 2, 1.5}, {5, 4, 3}), {1e4, nu, density});
}

/// Largest |eigenvalue| of M^-1/2 K M^-1/2, or of its dispersive part, by power iteration: below it, not above.
/// M: with the support masses of the safe step; nodes without a mass are held.
double spectral_radius(const MassSpringModel& model, bool dispersion_alone = false) {
  MassSpringModel part = model;
  if (dispersion_alone)
    std::erase_if(part.laws, [](const ForceLaw& law) { return !std::holds_alternative<MomentumDispersion>(law); });
  const Tangent K = tangent(part, model.network.X);
  const NodalVectors per_mass = inverse_inertia(model.network, density, {.time_step = safe_time_step(model, density)});
  const Eigen::VectorXd scale = flat(per_mass).cwiseSqrt();
  Eigen::VectorXd y;
  const NodalVectors start = test::noise(model.network.nodes(), 1);
  Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(start.data(), start.size()).normalized();
  for (int i = 0; i < 1000; ++i) {
    K.multiply(scale.cwiseProduct(v), y);
    v = scale.cwiseProduct(y).normalized();
  }
  K.multiply(scale.cwiseProduct(v), y);
  return scale.cwiseProduct(y).norm();
}

TEST(SafeTimeStep, IsSafeOnEveryNetworkAndNotWastefulOnAny) {
  for (const ModelRow& row : model_table())
    for (double nu : {-0.5, 0.25, 0.4, 0.49}) {
      if (row.extension == Extension::none && nu != 0.25) continue;
      if (row.topology == Topology::random && nu == 0.49) continue;
      const MassSpringModel model = small_model(row.name, nu);
      const double used = safe_time_step(model, density) * std::sqrt(spectral_radius(model)) / 2;
      EXPECT_LE(used, 1 + 1e-9) << row.name << " nu = " << nu;
      EXPECT_GE(used, 0.4) << row.name << " nu = " << nu;
    }
}

/// Slivers have little mass and stiffness, and share nodes with whole cells, of one size or two.
TEST(SafeTimeStep, IsSafeOnCutBodiesAndNotWasteful) {
  for (const ModelRow& row : model_table()) {
    if (!has_cut_cells(row)) continue;
    for (double nu : {-0.5, 0.0, 0.25, 0.45, 0.49})
      for (unsigned seed : {1u, 2u}) {
        if (row.extension == Extension::none && nu != 0.25) continue;
        const double edge = 0.3;
        const Mesh body = test::mapped(test::ball_of_tetrahedra(6), test::random_placement(seed, edge));
        const VoxelGrid grid = test::grid_about(body, edge);
        const bool refined = seed == 2;
        const CutBody cut = cut_body(refined ? test::halved_at_random(grid, 1, 6) : grid, body);
        for (const bool held : {false, true}) {  // by the points of its surface, which have no mass
          const std::vector<std::string> patches =
              held ? std::vector<std::string>{"surface"} : std::vector<std::string>{};
          const MassSpringModel model =
              build_cut(test::model(row.name), cut, patches, Mesh{}, {1e4, nu, density}).model;
          const double used = safe_time_step(model, density) * std::sqrt(spectral_radius(model)) / 2;
          EXPECT_LE(used, 1 + 1e-9) << row.name << " nu = " << nu << ", place " << seed << (held ? ", held" : "");
          EXPECT_GE(used, held ? 0.3 : 0.5)
              << row.name << " nu = " << nu << ", place " << seed << (held ? ", held" : "");
        }
      }
  }
}

TEST(SafeTimeStep, HoldsForEveryFormOfDispersionAndItsWeights) {
  for (const char* name : {"emsm", "emsm_centred", "emsm_random"})
    for (double nu : {-0.9, 0.0, 0.4, 0.49})
      for (Dispersion form :
           {Dispersion::symmetric, Dispersion::share_weighted, Dispersion::published, Dispersion::finite_strain})
        for (bool exact : {false, true}) {
          if (exact && (!has_energy(form) || nu < 0)) continue;
          const MassSpringModel model = small_model(name, nu, form, exact);
          const double used = safe_time_step(model, density) * std::sqrt(spectral_radius(model)) / 2;
          EXPECT_LE(used, 1 + 1e-9) << name << " nu = " << nu << " form " << static_cast<int>(form);
          EXPECT_GE(used, 0.4) << name << " nu = " << nu << " form " << static_cast<int>(form);
          if (form == Dispersion::finite_strain) continue;
          const double share = spectral_radius(model, true) / dispersion_frequency_squared(model, density);
          if (nu > 0.25) {
            EXPECT_LE(share, 1 + 1e-9) << name << " nu = " << nu;
            EXPECT_GE(share, 0.1) << name << " nu = " << nu;
          } else if (form == Dispersion::symmetric) {
            EXPECT_EQ(dispersion_frequency_squared(model, density), 0);
          }
        }
}

// The infinite lattice at nu = 1/4: omega^2 = 4 (lambda + 2 G) / (rho l^2), which its blocks give to the last digit.
TEST(SafeTimeStep, IsExactForTheInsideOfALattice) {
  const double l = 0.5, E = 1e4;
  const IsotropicMaterial m{E, 0.25, density};
  MassSpringModel model = build_model(test::model("msm_18"), block_mesh(l * Vec3(5, 5, 5), {5, 5, 5}), m);
  model.network.volume.setConstant(l * l * l);  // heavy surfaces: the inside decides
  EXPECT_NEAR(safe_time_step(model, density) / (l * std::sqrt(density / (3 * shear_modulus(m)))), 1, 1e-12);
}

TEST(SafeTimeStep, RefusesNodesWithoutMass) {
  MassSpringModel model = small_model("msm_18", 0.25);
  model.network.volume[7] = 0;
  EXPECT_THROW(safe_time_step(model, density), std::invalid_argument);
}

TEST(SafeTimeStep, KnowsAngularSprings) {
  MassSpringModel model;
  model.network = test::bent_triangles();
  model.laws = {Springs{}, AngularSprings{40}};
  const double used = safe_time_step(model, density) * std::sqrt(spectral_radius(model)) / 2;
  EXPECT_LE(used, 1);
  EXPECT_GE(used, 0.4);
}

}  // namespace
}  // namespace springproof::time_step_test
