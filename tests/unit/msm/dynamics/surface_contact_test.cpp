// Bodies of cut cells that touch a rigid plane by points of their true surface.
#include <gtest/gtest.h>

#include <cmath>

#include "support/flight.h"

namespace springproof::surface_contact_test {
namespace {

constexpr double density = 1000, g = 9.81;
using test::cut_flyer, test::CutFlyer, test::Flight, test::FlightPlan, test::fly;

/// 1 m x 0.1 x 0.1 m along x, nu = 0, E = 1e5 Pa, so that sound has 10 m/s; laid in the lattice by `place`.
Flight bar_against_wall(int cells, const test::Placement& place) {
  const Mesh body = test::mapped(test::solid_of(block_mesh({1, 0.1, 0.1}, {10, 1, 1})), place);
  const CutFlyer bar = cut_flyer(body, 1.0 / cells, {1e5, 0, density});
  FlightPlan plan{.duration = 0.3, .points = bar.points};
  plan.plane.normal = place.turn * Vec3::UnitX();
  plan.plane.point = place(Vec3(-1e-4, 0, 0));
  plan.velocity = -0.01 * plan.plane.normal;
  return fly(bar.model, density, plan);
}

// As whole cubes do, of which these are a third of a cell off in the lattice, or lie anyhow.
TEST(SurfaceContact, AnElasticBarLeavesAWallAsItCame) {
  for (const bool turned : {false, true}) {
    double first = 0;
    for (const int cells : {10, 20, 40}) {
      test::Placement place = test::random_placement(3, 1.0 / cells);
      if (!turned) place = {Eigen::Matrix3d::Identity(), Vec3(0.37, 0.21, 0.64) / cells};
      const Flight f = bar_against_wall(cells, place);
      ASSERT_TRUE(f.bounce) << cells;
      const double loss = 1 + f.bounce->velocity_after / f.bounce->velocity_before;
      EXPECT_LT(f.deepest, 1e-3 * f.largest_step);
      if (cells == 10) first = loss;
      if (cells < 40) continue;
      EXPECT_LT(loss, 0.5 * first) << "first order";
      EXPECT_NEAR(f.bounce->end - f.bounce->begin, 0.2, 0.02 * 0.2);
      EXPECT_NEAR(loss, 0, 0.04);
    }
  }
}

// Whatever touches, the body has what the plane gave it; without friction the plane gives no spin about its normal.
TEST(SurfaceContact, MomentaAreTheImpulsesAndEnergyIsNotGained) {
  const double edge = 0.2;
  const Mesh body = test::mapped(test::cylinder(1.2, 6, 8), test::random_placement(5, edge));
  const CutFlyer bar = cut_flyer(body, edge, {1e5, 0.3, density});
  FlightPlan plan{.duration = 0.4, .points = bar.points};
  plan.plane.normal = Vec3(0.3, -0.2, 1).normalized();
  double nearest = 1e9;
  for (const auto& x : body.nodes.rowwise()) nearest = std::min(nearest, plan.plane.normal.dot(Vec3(x.transpose())));
  plan.plane.point = (nearest - 1e-3) * plan.plane.normal;
  plan.velocity = Vec3(0.3, 0.2, -1);
  for (const double friction : {0.0, 0.3}) {
    plan.plane.friction = friction;
    const Flight f = fly(bar.model, density, plan);
    const Vec3 n = plan.plane.normal, change = f.momentum() - f.mass.sum() * plan.velocity,
               turned = f.spin() - f.spin_at_start;
    EXPECT_LT((change - f.impulse.linear).norm(), 1e-11 * change.norm());
    EXPECT_LT((turned - f.impulse.angular).norm(), 1e-11 * turned.norm());
    const double along = n.dot(change), across = (change - along * n).norm();
    EXPECT_GT(along, 0);
    EXPECT_LE(across, (friction + 1e-11) * along);
    if (friction > 0) {
      EXPECT_GT(across, 1e-3 * along);
    }
    EXPECT_LT(std::abs(n.dot(turned)), (friction + 1e-11) * turned.norm());
    EXPECT_LT(f.energy, f.energy_at_start);
    EXPECT_GT(f.energy, 0.5 * f.energy_at_start);
    EXPECT_LT(f.deepest, 1e-3 * f.largest_step);
  }
}

// A block that is turned in the lattice touches with all of its face at once: it leaves without spin.
TEST(SurfaceContact, ATurnedBlockLandsFlat) {
  const double edge = 0.1;
  const test::Placement place = test::random_placement(7, edge);
  const Mesh body = test::mapped(test::solid_of(block_mesh({0.4, 0.4, 0.4}, {2, 2, 2})), place);
  const CutFlyer block = cut_flyer(body, edge, {1e5, 0.25, density});
  FlightPlan plan{.duration = 0.2, .points = block.points};
  plan.plane.normal = place.turn * Vec3::UnitZ();
  plan.plane.point = place(Vec3(0, 0, -1e-3));
  plan.velocity = -0.1 * plan.plane.normal;
  const Flight f = fly(block.model, density, plan);
  const Vec3 centre = f.x.transpose() * f.mass / f.mass.sum();
  const Vec3 spin = f.spin() - centre.cross(f.momentum());
  ASSERT_TRUE(f.bounce);
  EXPECT_LT(spin.norm(), 0.02 * 0.4 * f.mass.sum() * 0.1);
  // The plane pushes under the middle of the face.
  const Vec3 middle = place(Vec3(0.2, 0.2, 0)), arm = f.impulse.angular - middle.cross(f.impulse.linear);
  EXPECT_LT(arm.norm(), 0.02 * 0.4 * f.impulse.linear.norm());
}

FlightPlan resting(const CutFlyer& body, const Vec3& normal, const Vec3& point) {
  FlightPlan plan{.acceleration = Vec3(0, 0, -g), .points = body.points};
  plan.plane.normal = normal;
  plan.plane.point = point;
  return plan;
}

// A ball touches in one point, flattens, and comes to rest: what the plane gives is the weight.
TEST(SurfaceContact, ARestingBallHasItsWeightBelowItsMiddle) {
  const Mesh body =
      test::mapped(test::ball_of_tetrahedra(12), [](const Vec3& x) -> Vec3 { return x + Vec3(0.07, 0.02, 0.05); });
  const CutFlyer ball = cut_flyer(body, 1.0 / 8, {5e5, 0.3, density});
  FlightPlan plan = resting(ball, Vec3::UnitZ(), Vec3(0, 0, -0.45));
  plan.damping = 6;
  plan.duration = 4;
  const Flight first = fly(ball.model, density, plan);
  plan.duration = 6;
  const Flight second = fly(ball.model, density, plan);
  const Vec3 weight = first.mass.sum() * plan.acceleration;
  const auto centre = [](const Flight& f, const NodalVectors& x) -> Vec3 {
    return x.transpose() * f.mass / f.mass.sum();
  };
  const Vec3 sunk = centre(first, first.x) - centre(first, ball.model.network.X);
  const Vec3 balance =
      first.impulse.linear + weight * (first.duration - first.step / 2) - plan.damping * first.mass.sum() * sunk;
  EXPECT_LT((balance - first.momentum()).norm(), 1e-9 * weight.norm());
  const Vec3 later = second.impulse.linear - first.impulse.linear,
             turning = second.impulse.angular - first.impulse.angular;
  const double in_between = second.duration - first.duration;
  EXPECT_LT((later + in_between * weight).norm(), 1e-3 * in_between * weight.norm());
  EXPECT_NEAR(-turning[1] / later[2], centre(second, second.x)[0], 1e-3);
  EXPECT_NEAR(turning[0] / later[2], centre(second, second.x)[1], 1e-3);
}

// a = g (sin - mu cos): Coulomb, once all slides.
TEST(SurfaceContact, ABlockSlidesDownAnInclineAsCoulombSays) {
  const double edge = 0.1, slope = 0.5, friction = 0.3;
  const test::Placement place = test::random_placement(9, edge);
  const Mesh body = test::mapped(test::solid_of(block_mesh({0.6, 0.4, 0.2}, {3, 2, 1})), place);
  const CutFlyer block = cut_flyer(body, edge, {1e6, 0.3, density});
  const Vec3 normal = place.turn * Vec3::UnitZ(), down = place.turn * Vec3::UnitX();
  FlightPlan plan = resting(block, normal, place(Vec3::Zero()));
  plan.acceleration = g * (std::sin(slope) * down - std::cos(slope) * normal);
  plan.plane.friction = friction;
  plan.duration = 0.5;
  const Flight f = fly(block.model, density, plan);
  const double speed = down.dot(f.momentum()) / f.mass.sum();
  EXPECT_NEAR(speed, g * (std::sin(slope) - friction * std::cos(slope)) * plan.duration, 0.01 * speed);
  plan.plane.friction = 0.7;  // more than tan(slope): it stays
  const Flight held = fly(block.model, density, plan);
  EXPECT_LT(std::abs(down.dot(held.momentum()) / held.mass.sum()), 0.02 * speed);
}

}  // namespace
}  // namespace springproof::surface_contact_test
