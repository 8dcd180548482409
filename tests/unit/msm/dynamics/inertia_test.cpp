// Support masses of explicit steps, and how they move with their supports.
#include "msm/dynamics/inertia.h"

#include <gtest/gtest.h>

#include "msm/models.h"
#include "support/refined_cells.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::inertia_test {
namespace {

constexpr double density = 1100;

/// A round bar held at one end, in cells of one size or two.
MassSpringModel held_bar(bool refined) {
  const double edge = 1.0 / 3;
  const Mesh body = test::mapped(test::cylinder(2, 8, 8), test::random_placement(3, edge));
  const VoxelGrid grid = test::grid_about(body, edge);
  return build_cut(test::model("hybmss_avg"), cut_body(refined ? test::halved_at_random(grid, 2, 8) : grid, body),
                   {"z_min"}, Mesh{}, {1e4, 0.3, density})
      .model;
}

TEST(SupportMass, IsAtTheCornersThatAnAnchorHoldsAlongItsAxes) {
  for (const bool refined : {false, true}) {
    MassSpringModel model = held_bar(refined);
    const MotionOptions options{.time_step = 0.01};
    const NodalVectors mass = support_masses(model.network, options);
    const auto expected = [&] {
      double all = 0;
      for (const Anchor& a : model.network.anchors) {
        double sum = 0;
        for (const double w : a.weights) sum += std::abs(w);
        all += 0.01 * 0.01 / 4 * a.stiffness.cwiseAbs().rowwise().sum().maxCoeff() * sum * sum;
      }
      return all;
    };
    EXPECT_NEAR(mass.col(1).sum(), expected(), 1e-12 * expected());
    for (const CarriedPoint& c : model.network.cells.carried) EXPECT_TRUE(mass.row(c.point).isZero(0));
    for (Anchor& a : model.network.anchors) {
      a.release(0);
      a.release(1);
    }
    const NodalVectors along_z = support_masses(model.network, options);
    EXPECT_TRUE(along_z.leftCols<2>().isZero(0));
    EXPECT_NEAR(along_z.col(2).sum(), expected(), 1e-12 * expected());
    EXPECT_LT(along_z.col(2).sum(), mass.col(2).sum());
  }
}

TEST(SupportMass, IsNoneOfLargeSteps) {
  const MassSpringModel model = held_bar(false);
  const MotionOptions options{.integrator = Integrator::energy_momentum, .time_step = 0.01};
  EXPECT_TRUE(support_masses(model.network, options).isZero(0));
  EXPECT_FALSE(SupportInertia(model.network, options, NodalVectors::Zero(model.network.nodes(), 3)).acts());
}

// Steadily accelerated: mu (a + c v), v the velocity of the step to come.
TEST(SupportMass, MovesWithItsSupport) {
  for (const bool refined : {false, true}) {
    const MassSpringModel model = held_bar(refined);
    const double dt = 0.01, damping = 3;
    const Vec3 acceleration(1, -2, 3);
    const MotionOptions options{.time_step = dt, .damping = damping};
    SupportInertia inertia(model.network, options, NodalVectors::Zero(model.network.nodes(), 3));
    const double mass = support_masses(model.network, options).col(0).sum();
    for (int step = 0; step < 5; ++step) {
      BoundaryConditions bc;
      bc.prescribed = bc.external = NodalVectors::Zero(model.network.nodes(), 3);
      for (const Anchor& a : model.network.anchors)
        bc.prescribed.row(a.node) = step * step * dt * dt / 2 * acceleration.transpose();
      inertia.add(bc);
      const Vec3 total = bc.external.colwise().sum().transpose();
      if (step < 2) continue;  // it starts from rest
      EXPECT_LE((total - mass * (1 + damping * (step - 0.5) * dt) * acceleration).norm(), 1e-9 * total.norm()) << step;
      for (const CarriedPoint& c : model.network.cells.carried) EXPECT_TRUE(bc.external.row(c.point).isZero(0));
    }
  }
}

}  // namespace
}  // namespace springproof::inertia_test
