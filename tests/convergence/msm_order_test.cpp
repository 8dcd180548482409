// Observed order of the lattices under refinement, and what the hourglass correction gains: a cantilever under its
// weight.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "msm/statics/equilibrium.h"
#include "support/zoo.h"

namespace springproof::msm_order_test {
namespace {

/// Tip deflection of a 4 x 1 x 1 beam with n cells across.
double tip(const std::string& name, double nu, int n) {
  const Mesh mesh = block_mesh({4, 1, 1}, {4 * n, n, n});
  const std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Gravity{{0, 0, -1}}};
  const Equilibrium e = solve_linear(build_model(test::model(name), mesh, {1e6, nu, 1000}),
                                     transfer(loads, mesh, 1000, Kinematics::linear));
  EXPECT_TRUE(e.ok) << e.message;
  double sum = 0;
  const std::vector<int> end = nodes_of(patch(mesh, "x_max"));
  for (int node : end) sum += e.displacement(node, 2);
  return sum / static_cast<double>(end.size());
}

TEST(Order, OfTheSpringLatticesIsTwoInBending) {
  // Two, less what the singular clamped edges take: little at nu = 0, more as the sides want to contract.
  for (const char* name : {"hybmss", "hybmss_fd"})
    for (const auto& [nu, least] : {std::pair(0.0, 1.8), std::pair(0.25, 1.7), std::pair(0.4, 1.6)}) {
      const double coarse = tip(name, nu, 4), middle = tip(name, nu, 8), fine = tip(name, nu, 16);
      EXPECT_GE(std::log2((middle - coarse) / (fine - middle)), least) << name << " nu = " << nu;
    }
}

TEST(HourglassCorrection, TakesMostOfTheBendingErrorAway) {
  // What is left at nu = 0.499 is the clamped end: there the lattice resolves a boundary layer, not bending.
  for (const auto& [nu, left] :
       {std::pair(-0.5, 0.1), std::pair(0.0, 0.1), std::pair(0.25, 0.15), std::pair(0.4, 0.3), std::pair(0.499, 0.4)}) {
    const double converged = tip("hybmss_bt", nu, 12);
    const double corrected = tip("hybmss_bt", nu, 2) - converged, plain = tip("hybmss", nu, 2) - converged;
    EXPECT_LE(std::abs(corrected), left * std::abs(plain)) << "nu = " << nu;
  }
}

}  // namespace
}  // namespace springproof::msm_order_test
