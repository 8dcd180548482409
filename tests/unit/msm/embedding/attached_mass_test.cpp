// Masses beside the body's own: what the nodes of a network get of them, in motions, modes and springs files.
#include "problem/attached_mass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "msm/dynamics/natural_modes.h"
#include "msm/dynamics/time_step.h"
#include "msm/embedding/boundary.h"
#include "msm/exchange/springs_file.h"
#include "msm/models.h"
#include "support/solids.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::attached_mass_test {
namespace {

const IsotropicMaterial material{1e4, 0.3, 1000};

/// Of each kind: their sum, and their first moment at rest.
void expect_where_they_are(const EmbeddedModel& built, const Mesh& mesh, const std::vector<AttachedMass>& masses,
                           const std::vector<Vec3>& centres) {
  for (std::size_t m = 0; m < masses.size(); ++m) {
    SCOPED_TRACE(masses[m].name);
    Network network = built.model.network;
    attach({masses[m]}, mesh, built.embedding, network);
    ASSERT_EQ(network.attached.size(), network.nodes());
    EXPECT_NEAR(network.attached.sum(), masses[m].mass, 1e-12 * masses[m].mass);
    const Vec3 centre = network.X.transpose() * network.attached / masses[m].mass;
    EXPECT_LT((centre - centres[m]).norm(), 1e-9) << centre.transpose();
    for (const CarriedPoint& c : network.cells.carried) EXPECT_EQ(network.attached[c.point], 0);
    EXPECT_NEAR(springproof::masses(network, 1000).sum(), masses[m].mass + 1000 * network.volume.sum(), 1e-9);
  }
}

TEST(AttachedMass, OfABlockIsWhereItWasPut) {
  const Mesh mesh = block_mesh({2, 1, 1}, {6, 3, 3});
  const EmbeddedModel built = build_embedded(test::model("hybmss"), mesh, material);
  expect_where_they_are(
      built, mesh,
      {{"point", "", {{1.7, 0.2, 0.9}}, 3}, {"segment", "", {{2, 0, 0.5}, {2, 1, 0.5}}, 2}, {"patch", "x_max", {}, 5}},
      {{1.7, 0.2, 0.9}, {2, 0.5, 0.5}, {2, 0.5, 0.5}});
}

TEST(AttachedMass, OfADisorderedNetworkIsWhereItWasPut) {
  const Mesh mesh = block_mesh({2, 1, 1}, {6, 3, 3});
  const EmbeddedModel built = build_embedded(test::model("msm_random"), mesh, material);
  for (const AttachedMass& mass :
       {AttachedMass{"patch", "x_max", {}, 5}, AttachedMass{"point", "", {{2, 0.4, 0.9}}, 5}}) {
    Network network = built.model.network;
    attach({mass}, mesh, built.embedding, network);
    EXPECT_NEAR(network.attached.sum(), 5, 1e-9);
    EXPECT_GE(network.attached.minCoeff(), 0);
    const Vec3 centre = network.X.transpose() * network.attached / 5;
    EXPECT_LT((centre - (mass.on.empty() ? mass.at[0] : Vec3(2, 0.5, 0.5))).norm(), 0.1) << centre.transpose();
  }
}

TEST(AttachedMass, OfCutCellsIsHandedFromCarriedNodesToTheirCarriers) {
  const Mesh body = test::mapped(test::cylinder(2, 8, 8), test::random_placement(3, 1.0 / 3));
  const CutBody cut = cut_body(test::grid_about(body, 1.0 / 3), body);
  EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {}, body, material);
  const Vec3 centre = centroid(body, patch(body, "z_max"));
  expect_where_they_are(built, body, {{"patch", "z_max", {}, 5}}, {centre});
}

TEST(AttachedMass, OutsideOfTheBodyIsRefusedByItsName) {
  const Mesh mesh = block_mesh({2, 1, 1}, {6, 3, 3});
  EmbeddedModel built = build_embedded(test::model("hybmss"), mesh, material);
  try {
    attach({{"far", "", {{9, 0, 0}}, 1}}, mesh, built.embedding, built.model.network);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("mass 'far': "), std::string::npos) << e.what();
  }
}

TEST(AttachedMass, OnTheEndOfAColumnGivesTheExactFrequency) {
  // Sides on rollers: plane waves.  b tan b = body's mass / attached mass = 1/5.
  const Vec3 size{0.4, 0.1, 0.1};
  const Mesh mesh = block_mesh(size, {16, 4, 4});
  const double b = 0.432841, f = b / (2 * std::numbers::pi * size[0]) *
                                 std::sqrt((lame_lambda(material) + 2 * shear_modulus(material)) / material.density);
  std::vector<Load> supports = {PrescribedDisplacement{"x_min", {0, std::nullopt, std::nullopt}}};
  for (const char* on : {"y_min", "y_max"})
    supports.push_back(PrescribedDisplacement{on, {std::nullopt, 0, std::nullopt}});
  for (const char* on : {"z_min", "z_max"})
    supports.push_back(PrescribedDisplacement{on, {std::nullopt, std::nullopt, 0}});
  for (const char* name : {"hybmss_avg", "hybmss_bt", "emsm"}) {
    SCOPED_TRACE(name);
    EmbeddedModel built = build_embedded(test::model(name), mesh, material);
    const double step = safe_time_step(built.model, material.density);
    attach({{"weight", "x_max", {}, 20}}, mesh, built.embedding, built.model.network);
    EXPECT_GE(safe_time_step(built.model, material.density), step);
    const auto bc = transfer(supports, mesh, built.embedding, built.model.network, 1000, Kinematics::linear);
    const NaturalModes modes = natural_modes(built.model, bc.fixed, material.density, 0, 2);
    ASSERT_TRUE(modes.ok) << modes.message;
    EXPECT_NEAR(modes.frequencies[0], f, 1e-3 * f);
  }
}

TEST(AttachedMass, IsKeptByASpringsFile) {
  const Mesh mesh = block_mesh({2, 1, 1}, {4, 2, 2});
  EmbeddedModel built = build_embedded(test::model("hybmss"), mesh, material);
  attach({{"weight", "x_max", {}, 300}}, mesh, built.embedding, built.model.network);
  SpringsFile file;
  file.density = material.density;
  file.material = material;
  file.grip = 0.25;
  file.surface.vertices = mesh.nodes.topRows(3);
  file.surface.facets = {{0, 1, 2}};
  file.surface.weights = built.embedding.weights.topRows(3);
  file.model = built.model;
  const Network read = parse_springs(springs_as_json(file), "own.json").model.network, &own = built.model.network;
  EXPECT_LT((read.attached - own.attached).norm(), 1e-12 * own.attached.norm());
  EXPECT_LT((read.volume - own.volume).norm(), 1e-12 * own.volume.norm());
}

}  // namespace
}  // namespace springproof::attached_mass_test
