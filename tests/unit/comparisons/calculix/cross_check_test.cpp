// The verdict between two programs.
#include "comparisons/calculix/cross_check.h"

#include <gtest/gtest.h>

namespace springproof::cross_check_test {
namespace {

TEST(SecondOpinion, AgreesWithinTheSumOfBothUncertainties) {
  const ReferenceValue a{1.00, 0.02, {}, ""}, b{1.05, 0.02, {}, ""}, c{1.05, 0.04, {}, ""};
  EXPECT_FALSE(second_opinion("force.z_max.z", a, b).agrees);
  EXPECT_TRUE(second_opinion("force.z_max.z", a, c).agrees);
  EXPECT_NEAR(second_opinion("force.z_max.z", a, c).difference, -0.05, 1e-15);
  EXPECT_EQ(second_opinion("torque.z_max.z", a, c).unit, "N m");
}

TEST(SecondOpinion, IsNotGivenByANumberThatIsNone) {
  const ReferenceValue a{1, 0.1, {}, ""}, none{std::nan(""), 0.1, {}, ""};
  EXPECT_FALSE(second_opinion("force.z_max.z", a, none).agrees);
}

TEST(CrossCheck, TakesTheCasesOwnPoissonsRatios) {
  Experiment e;
  e.materials = {{1e4, 0.25, 1000}, {1e4, 0.4, 1000}};
  EXPECT_EQ(at_wanted(e, {}).materials.front().poisson_ratio, 0.25);
  EXPECT_EQ(at_wanted(e, 0.4).materials.front().poisson_ratio, 0.4);
  EXPECT_THROW(at_wanted(e, 0.3), InputError);
}

}  // namespace
}  // namespace springproof::cross_check_test
