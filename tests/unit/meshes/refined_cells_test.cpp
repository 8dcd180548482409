// Cells of several sizes: grids that are halved at random.
#include "meshes/voxels/refined_grid.h"

#include <gtest/gtest.h>

#include "meshes/voxels/cut_cells.h"
#include "support/refined_cells.h"
#include "support/solids.h"
#include "support/tolerances.h"

namespace springproof::refined_cells_test {
namespace {

Mesh turned_ball(double edge) { return test::mapped(test::ball_of_tetrahedra(8), test::random_placement(3, edge)); }

std::array<int, 3> plus(const std::array<int, 3>& a, int i, int j, int k) { return {a[0] + i, a[1] + j, a[2] + k}; }

TEST(RefinedGrid, NeighboursDifferByAFactorOfTwoAtMost) {
  const VoxelGrid grid = test::halved_at_random({{0, 0, 0}, 1, {6, 4, 4}}, 3, 1);
  EXPECT_EQ(grid.cells, (std::array<int, 3>{48, 32, 32}));
  int sizes = 0;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        const std::array<int, 3> cube = {i, j, k};
        const int size = cell_size(grid, cube);
        sizes |= size;
        for (int n = 0; n < 27; ++n) {
          const std::array<int, 3> beside = plus(cube, n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
          bool inside = true;
          for (int d = 0; d < 3; ++d) inside &= beside[d] >= 0 && beside[d] < grid.cells[d];
          if (inside) {
            EXPECT_LE(size, 2 * cell_size(grid, beside));
          }
        }
      }
  EXPECT_EQ(sizes, 1 + 2 + 4 + 8);
}

// Volume and first moment of the cells, and every corner where the average of those that carry it is.
TEST(RefinedCells, FillTheBodyAndCarryTheirPoints) {
  const Mesh body = turned_ball(0.25);
  const CutBody uniform = cut_body(test::grid_about(body, 0.25), body);
  const CutBody cut = cut_body(test::halved_at_random(test::grid_about(body, 0.25), 2, 4), body);
  const auto integral = [](const CutBody& of) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::size_t c = 0; c < of.cells.size(); ++c) {
      const double l = of.grid.edge * of.cells[c].size, volume = of.cells[c].filled.fraction * l * l * l;
      sum[0] += volume;
      sum.tail<3>() += volume * (of.centre(static_cast<int>(c)) + l * of.cells[c].filled.mean);
    }
    return sum;
  };
  EXPECT_GT(cut.cells.size(), uniform.cells.size());
  EXPECT_LE((integral(cut) - integral(uniform)).norm(), 1e-4 * integral(uniform).norm());
  ASSERT_FALSE(cut.carried.empty());
  NodalVectors points = cut.points;
  for (const CarriedPoint& p : cut.carried) points.row(p.point).setZero();
  carry(cut.carried, points);
  EXPECT_LE((points - cut.points).cwiseAbs().maxCoeff(), test::round_off);
  EXPECT_TRUE(uniform.carried.empty());
}

/// The largest difference of the integral of a weight's gradient over the cells from that of the weight times the
/// normal over the surface, once carried points have handed theirs back.
double out_of_balance(const CutBody& cut) {
  NodalVectors sum = NodalVectors::Zero(cut.points.rows(), 3);
  for (const CutCell& c : cut.cells) {
    const FilledPart& f = c.filled;
    const double l = cut.grid.edge * c.size;
    for (int n = 0; n < 8; ++n)
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const auto s = [&](int d) { return 2.0 * hexahedron_corners[n][d] - 1; };
        const double g = 0.25 + (s(j) * f.mean[j] + s(k) * f.mean[k]) / 2 + s(j) * s(k) * f.mixed[i];
        sum(c.corners[n], i) += f.fraction * l * l * s(i) * g;
      }
  }
  for (const PatchInCell& p : cut.patches.at("surface"))
    for (int n = 0; n < 8; ++n) sum.row(cut.cells[p.cell].corners[n]) -= p.normal[n].transpose();
  hand_back(cut.carried, sum);
  return sum.cwiseAbs().maxCoeff();
}

TEST(RefinedCells, TheDivergenceTheoremHoldsAtEveryPoint) {
  const Mesh body = test::solid_of(block_mesh({1, 0.9, 0.8}, {2, 2, 2}));
  // The third grid has small cells below large ones at a plane that facets lie in.
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const CutBody cut = cut_body(test::halved_at_random(test::grid_about(body, 0.25), 2, 7, seed), body);
    EXPECT_LE(out_of_balance(cut), 1e-13) << seed;
  }
}

TEST(RefinedCells, PointsHaveTheWeightsOfTheirCell) {
  const Mesh body = turned_ball(0.25);
  const CutBody cut = cut_body(test::halved_at_random(test::grid_about(body, 0.25), 2, 4), body);
  for (Eigen::Index n = 0; n < body.nodes.rows(); n += 7) {
    const Vec3 X = body.nodes.row(n).transpose();
    const CutBody::Place at = cut.place(X);
    Vec3 sum = Vec3::Zero();
    for (int m = 0; m < 8; ++m) sum += at.weights[m] * cut.points.row(cut.cells[at.cell].corners[m]).transpose();
    EXPECT_LE((sum - X).norm(), test::round_off);
  }
}

// Two arms in one large cell are two cells, and share no corner with each other's small neighbours either.
TEST(RefinedCells, ArmsInOneCellStayApart) {
  const Mesh block = block_mesh({3, 1, 0.6}, {6, 5, 3});
  const Mesh body = test::solid_of(test::voxels_of(block, [](int i, int j, int) { return i < 2 || j != 2; }));
  VoxelGrid grid = with_halved_cubes({{0, -0.3, -0.2}, 1, {3, 2, 1}});
  halve_cell(grid, {2, 0, 0});
  const CutBody cut = cut_body(grid, body);
  const auto y_of = [&](std::size_t c) {
    return cut.centre(static_cast<int>(c))[1] + cut.grid.edge * cut.cells[c].size * cut.cells[c].filled.mean[1];
  };
  int twins = 0;
  for (std::size_t a = 0; a < cut.cells.size(); ++a)
    for (std::size_t b = 0; b < cut.cells.size(); ++b) {
      const CutCell &low = cut.cells[a], &high = cut.cells[b];
      if (low.index[0] < 4 || high.index[0] < 4 || y_of(a) > 0.45 || y_of(b) < 0.55) continue;
      twins += low.index == high.index;
      for (const int n : low.corners) EXPECT_EQ(std::count(high.corners.begin(), high.corners.end(), n), 0);
    }
  EXPECT_GT(twins, 0);
  EXPECT_FALSE(cut.carried.empty());
}

}  // namespace
}  // namespace springproof::refined_cells_test
