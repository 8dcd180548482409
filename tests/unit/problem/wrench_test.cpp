// The wrench that a load carries, and the rigid field that gives it to a region.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "problem/loads.h"

namespace springproof::wrench_test {
namespace {

TEST(Wrench, OfARigidFieldIsTheOneAskedFor) {
  RegionMoments region;
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i < 7; ++i) {
    points.push_back(Vec3(std::sin(i), std::cos(3 * i), 0.2 * i));
    weights.push_back(1 + 0.1 * i);
    region.add(weights.back(), points.back());
  }
  const Wrench wanted{{1, -2, 3}, {0.3, 0.5, -0.7}, {10, 20, 30}};
  const RigidField field = rigid_field(region, wanted);
  Wrench got{Vec3::Zero(), Vec3::Zero(), wanted.about};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 f = weights[i] * field.at(points[i]);
    got.force += f;
    got.moment += (points[i] - wanted.about).cross(f);
  }
  EXPECT_LT((got.force - wanted.force).norm(), 1e-13 * 10);
  EXPECT_LT((got.moment - wanted.moment).norm(), 1e-13 * 400);
}

TEST(Wrench, MovesWithItsForce) {
  const Wrench w{{0, 0, 2}, {1, 1, 1}, {1, 0, 0}};
  const Wrench at_origin = moved(w, Vec3::Zero());
  EXPECT_EQ(at_origin.moment, Vec3(1, 1 - 2, 1));
  EXPECT_EQ(moved(at_origin, w.about).moment, w.moment);
}

TEST(Wrench, NeedsARegion) {
  EXPECT_THROW(rigid_field({}, {}), std::invalid_argument);
  RegionMoments line;
  for (int i = 0; i < 5; ++i) line.add(1, Vec3(i, 2 * i, 0));
  EXPECT_THROW(rigid_field(line, {Vec3::UnitX(), Vec3::Zero(), Vec3::Zero()}), std::invalid_argument);
}

TEST(Wrench, IsCarriedByForcesAlone) {
  Load force = PatchForce{"top", Vec3::UnitX()}, held = PrescribedDisplacement{"top", {0.0, {}, {}}};
  EXPECT_NE(wrench_of(force), nullptr);
  EXPECT_EQ(wrench_of(held), nullptr);
  EXPECT_FALSE(wrench_of(force)->has_value());
}

}  // namespace
}  // namespace springproof::wrench_test
