// Levels of cubes as other solvers take them: weights of whole cubes.
#include "msm/multigrid/cut/cut_levels.h"

#include <gtest/gtest.h>

#include "msm/models.h"
#include "support/bodies.h"
#include "support/zoo.h"

namespace springproof::cut_levels_test {
namespace {

/// A field linear in the place, of the points of a level.
Eigen::VectorXf linear(const CutLevel& level, float ratio) {
  Eigen::VectorXf u(level.unknowns());
  for (std::size_t i = 0; i < level.point.size(); ++i)
    for (int a = 0; a < 3; ++a)
      u[static_cast<Eigen::Index>(3 * i) + a] =
          ratio * static_cast<float>(level.point[i][a] + 2 * level.point[i][(a + 1) % 3]);
  return u;
}

// 12 x 9 x 7 cubes, which no coarser lattice fits.
TEST(CutLevels, OfWholeCubesReproduceLinearFields) {
  const Network network =
      build_model(test::model("hybmss"), block_mesh({1.2, 0.9, 0.7}, {12, 9, 7}), {1, 0.25, 1}).network;
  ASSERT_FALSE(network.cells.cut());
  const std::vector<CutLevel> levels =
      cut_levels(network, AnchoredNodes(network, std::vector<char>(network.X.size(), 0)));
  ASSERT_EQ(levels.size(), 2);
  EXPECT_EQ(levels[0].filled.size(), network.cells.size());
  EXPECT_EQ(levels[1].cubes.size(), 6 * 5 * 4);
  double volume = 0;
  for (const FilledPart& part : levels[1].filled) volume += 8 * part.fraction;
  EXPECT_NEAR(volume, 12 * 9 * 7, 1e-9);
  Eigen::VectorXf coarse = linear(levels[1], 2), u = Eigen::VectorXf::Zero(levels[0].unknowns());
  levels[0].prolongate(coarse, levels[1], u);
  EXPECT_LE((u - linear(levels[0], 1)).lpNorm<Eigen::Infinity>(), 1e-5);
}

}  // namespace
}  // namespace springproof::cut_levels_test
