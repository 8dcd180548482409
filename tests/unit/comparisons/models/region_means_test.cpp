// Forces between the materials of a body of springs.
#include "comparisons/models/region_means.h"

#include <gtest/gtest.h>

#include "msm/embedding/boundary.h"
#include "msm/statics/equilibrium.h"
#include "support/two_materials.h"
#include "support/zoo.h"

namespace springproof::region_means_test {
namespace {

/// A stiff plate, free of loads and supports, whose faces lie in planes of the lattice and whose end within cubes: some
/// of its cells share corners with those that they are bonded to.
TEST(InterfaceForces, OfARegionThatNothingElseHoldsAreInBalance) {
  const auto plate = [](const Vec3& x) { return x[0] < 2.5 && x[2] > 1 && x[2] < 2; };
  const Mesh body = test::with_materials(test::solid_of(block_mesh({4, 3, 3}, {8, 6, 6})), plate);
  const CutBody cut = cut_body({Vec3::Zero(), 1, {4, 3, 3}}, body);
  const IsotropicMaterial soft{1, 0.3, 1}, stiff{20, 0.2, 1};
  const MassSpringModel model = build_cut(test::model("hybmss_avg"), cut, {"z_min"}, Mesh{}, soft, {stiff}).model;
  const Network& network = model.network;
  BoundaryConditions bc{std::vector<char>(network.X.size(), 0), std::vector<int>(network.X.size(), -1),
                        NodalVectors::Zero(network.nodes(), 3), NodalVectors::Zero(network.nodes(), 3)};
  for (const Anchor& a : network.anchors) std::fill_n(bc.fixed.begin() + 3 * a.node, 3, 1);
  for (int n = 0; n < network.nodes(); ++n)
    if (network.X(n, 2) > 3 - 1e-9) bc.external.row(n) << 0.001, 0.0005, 0.002;
  const Equilibrium e = solve_linear(model, bc);
  ASSERT_TRUE(e.ok) << e.message;
  const auto measures = interface_forces(model, {{"plate", stiff, {}, {}}}, e.displacement,
                                         NodalVectors::Zero(network.nodes(), 3), Kinematics::linear);
  EXPECT_LE(measures.at("interface.plate.body.force.magnitude"), 1e-8 * bc.external.norm());
}

/// The force of the upper, light layer of a hanging block on the heavy one below it, over the weight of that.
double share_of_weight(const EmbeddedModel& built, const Mesh& mesh, const IsotropicMaterial& light,
                       const IsotropicMaterial& heavy, double volume) {
  constexpr double g = 10;
  const Network& network = built.model.network;
  const std::vector<Load> gravity = {Gravity{Vec3(0, 0, -g)}};
  std::vector<Load> loads = gravity;
  loads.push_back(PrescribedDisplacement{"z_max", {0.0, 0.0, 0.0}});
  const auto conditions = [&](const std::vector<Load>& of) {
    return transfer(of, mesh, built.embedding, network, light.density, Kinematics::linear);
  };
  const Equilibrium e = solve_linear(built.model, conditions(loads), {.solver = LinearSolver::cholesky});
  EXPECT_TRUE(e.ok) << e.message;
  const auto measures = interface_forces(built.model, {{"heavy", heavy, {}, {}}}, e.displacement,
                                         conditions(gravity).external, Kinematics::linear);
  return measures.at("interface.heavy.body.force.z") / (heavy.density * volume * g);
}

TEST(InterfaceForces, OfAHangingLayerAreItsWeight) {
  const IsotropicMaterial light{1, 0.3, 1}, heavy{20, 0.2, 7};
  Mesh cubes = block_mesh({3, 2, 4}, {3, 2, 4});
  for (std::size_t c = 0; c < cubes.hexahedra.size(); ++c)
    cubes.materials.push_back(cubes.nodes(cubes.hexahedra[c][0], 2) < 0.5);
  const EmbeddedModel whole = build_embedded(test::model("hybmss_avg"), cubes, light, nullptr, {heavy});
  EXPECT_NEAR(share_of_weight(whole, cubes, light, heavy, 6), 1, 1e-9);
  // Sides that lie askew in the lattice; the interface in one of its planes, and within cubes.
  for (const double at : {1.0, 1.3}) {
    Mesh body = test::mapped(test::layered_block({3, 2, 4}, {3, 2, 8}, 2, at), [](const Vec3& x) -> Vec3 {
      return {x[0] + 0.07 * x[1], x[1] - 0.1 * x[0], x[2]};
    });
    for (std::uint8_t& material : body.materials) material = 1 - material;
    const CutBody cut = cut_body({Vec3(-0.2, -0.4, 0), 1, {4, 3, 4}}, body);
    const Mesh mesh = voxelise(cut.grid, body).mesh;
    const EmbeddedModel built = build_cut(test::model("hybmss_avg"), cut, {"z_max"}, mesh, light, {heavy});
    EXPECT_EQ(built.model.network.bonds.empty(), at == 1);
    EXPECT_NEAR(share_of_weight(built, mesh, light, heavy, 6 * 1.007 * at), 1, 1e-9) << at;
  }
}

}  // namespace
}  // namespace springproof::region_means_test
