// Forces between the materials of a body of springs.
#include "comparisons/models/region_means.h"

#include <gtest/gtest.h>

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
  const auto measures = interface_forces(model, {{"plate", stiff, {}, {}}}, e.displacement, Kinematics::linear);
  EXPECT_LE(measures.at("interface.plate.body.force.magnitude"), 1e-8 * bc.external.norm());
}

}  // namespace
}  // namespace springproof::region_means_test
