#include "meshes/voxels/cut_cells.h"

#include <gtest/gtest.h>

#include "meshes/volume.h"
#include "support/solids.h"
#include "support/tolerances.h"

namespace springproof::cut_cells_test {
namespace {

Mesh turned_ball(unsigned seed, double edge) {
  return test::mapped(test::ball_of_tetrahedra(8), test::random_placement(seed, edge));
}

/// Integral of 1, x and x x^T over a body.
struct Integrals {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Integrals integrals(const Mesh& body) {
  Integrals sum;
  for (const Tetrahedron& t : body.tetrahedra) {
    Eigen::Matrix<double, 3, 4> X;
    for (int i = 0; i < 4; ++i) X.col(i) = body.nodes.row(t[i]).transpose();
    const double v = (X.rightCols<3>().colwise() - X.col(0)).determinant() / 6;
    const Vec3 s = X.rowwise().sum();
    sum.volume += v;
    sum.first += v / 4 * s;
    sum.second += v / 20 * (X * X.transpose() + s * s.transpose());
  }
  return sum;
}

Integrals integrals(const CutBody& cut) {
  Integrals sum;
  const double l = cut.grid.edge;
  for (std::size_t c = 0; c < cut.cells.size(); ++c) {
    const FilledPart& f = cut.cells[c].filled;
    const Vec3 centre = cut.centre(static_cast<int>(c));
    const double v = f.fraction * l * l * l;
    Eigen::Matrix3d own;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      own(i, i) = f.variance[i] + f.mean[i] * f.mean[i];
      own(j, k) = own(k, j) = f.mixed[i];
    }
    sum.volume += v;
    sum.first += v * (centre + l * f.mean);
    sum.second += v * (centre * centre.transpose() + l * (centre * f.mean.transpose() + f.mean * centre.transpose()) +
                       l * l * own);
  }
  return sum;
}

TEST(CutBody, MomentsAddUpToThoseOfTheBody) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const double edge = 0.21;
    const Mesh body = turned_ball(seed, edge);
    const Integrals a = integrals(body), b = integrals(cut_body(test::grid_about(body, edge), body));
    // Parts of less than 1/1000 of a cube are left out.
    EXPECT_LE(b.volume, a.volume * (1 + test::round_off));
    EXPECT_NEAR(b.volume, a.volume, 1e-4 * a.volume);
    EXPECT_LE((b.first - a.first).norm(), 1e-4 * a.volume);
    EXPECT_LE((b.second - a.second).norm(), 2e-4 * a.second.norm());
  }
}

TEST(CutBody, ABlockOnTheLatticeIsFullCells) {
  const Mesh body = test::solid_of(block_mesh({1, 0.5, 0.75}, {3, 2, 4}));
  const CutBody cut = cut_body(voxel_grid(body, 0.25), body);
  EXPECT_EQ(cut.cells.size(), 24u);
  EXPECT_EQ(cut.points.rows(), 5 * 3 * 4);
  for (const CutCell& c : cut.cells) EXPECT_EQ(c.filled.fraction, 1);
  EXPECT_TRUE(cut.notes.empty());
}

TEST(CutBody, PatchesHaveTheirAreaAndTheirNormals) {
  const Mesh body = test::mapped(test::cylinder(2, 8, 6), test::random_placement(5, 0.3));
  const CutBody cut = cut_body(test::grid_about(body, 0.3), body);
  for (const Patch& p : body.patches) {
    double area = 0;
    Vec3 normal = Vec3::Zero(), expected = Vec3::Zero();
    for (const PatchInCell& c : cut.patches.at(p.name)) {
      area += c.total_area();
      for (const Vec3& n : c.normal) normal += n;
    }
    for (const auto& f : p.facets) {
      const auto X = [&](int i) -> Vec3 { return body.nodes.row(f[i]).transpose(); };
      expected += (X(1) - X(0)).cross(X(2) - X(0)) / 2;
    }
    EXPECT_NEAR(area, nodal_areas(body, p).sum(), 1e-12) << p.name;
    EXPECT_LE((normal - expected).norm(), 1e-12) << p.name;
  }
}

// The integral of a weight's gradient over the cells is that of the weight times the normal over the surface.
TEST(CutBody, TheDivergenceTheoremHoldsAtEveryPoint) {
  const double l = 0.21;
  const Mesh body = turned_ball(2, l);
  const CutBody cut = cut_body(test::grid_about(body, l), body);
  NodalVectors difference = NodalVectors::Zero(cut.points.rows(), 3);
  for (const CutCell& c : cut.cells)
    for (int n = 0; n < 8; ++n)
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const auto s = [&](int d) { return 2.0 * hexahedron_corners[n][d] - 1; };
        const FilledPart& f = c.filled;
        difference(c.corners[n], i) +=
            f.fraction * l * l * s(i) * (0.25 + (s(j) * f.mean[j] + s(k) * f.mean[k]) / 2 + s(j) * s(k) * f.mixed[i]);
      }
  for (const PatchInCell& c : cut.patches.at("surface"))
    for (int n = 0; n < 8; ++n) difference.row(cut.cells[c.cell].corners[n]) -= c.normal[n].transpose();
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), 3e-3 * l * l);  // slivers that are left out
  EXPECT_LE(difference.norm(), 5e-3 * l * l);
}

// Two arms, .1 of a cube apart, that meet at one end only.
TEST(CutBody, ArmsInOneCubeStayApart) {
  const Mesh block = block_mesh({4, 2.1, 1}, {4, 21, 1});
  Mesh fork = test::voxels_of(block, [](int i, int j, int) { return i == 0 || j != 10; });
  fork.patches.clear();
  const Mesh body = test::solid_of(fork);
  const CutBody cut = cut_body({{0, -0.45, 0}, 1, {4, 3, 1}}, body);
  // Cubes of the middle row hold a part of each arm: two cells where the arms are apart, one where they meet.
  int middle = 0;
  for (const CutCell& c : cut.cells) middle += c.index[1] == 1;
  EXPECT_EQ(middle, 7);
  const int upper = cut.place({3.9, 1.15, 0.5}).cell, lower = cut.place({3.9, 0.95, 0.5}).cell;
  ASSERT_EQ(cut.cells[upper].index, cut.cells[lower].index);
  for (const int a : cut.cells[upper].corners)
    for (const int b : cut.cells[lower].corners) EXPECT_NE(a, b);
}

TEST(CutBody, PointsHaveTheWeightsOfTheirCell) {
  const Mesh body = test::mapped(test::cylinder(2, 8, 6), test::random_placement(7, 0.3));
  const CutBody cut = cut_body(test::grid_about(body, 0.3), body);
  for (Eigen::Index n = 0; n < body.nodes.rows(); ++n) {
    const Vec3 X = body.nodes.row(n).transpose();
    const CutBody::Place at = cut.place(X);
    Vec3 sum = Vec3::Zero();
    for (int c = 0; c < 8; ++c) sum += at.weights[c] * cut.points.row(cut.cells[at.cell].corners[c]).transpose();
    EXPECT_LE((sum - X).norm(), 1e-12);
  }
}

TEST(CutBody, WhatIsThinIsSaid) {
  const Mesh sheet = test::mapped(test::solid_of(block_mesh({4, 4, 0.3}, {8, 8, 1})), [](const Vec3& x) -> Vec3 {
    return Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()) * x;
  });
  const CutBody thin = cut_body(test::grid_about(sheet, 1), sheet),
                fine = cut_body(test::grid_about(sheet, 0.2), sheet);
  ASSERT_EQ(thin.notes.size(), 1u);
  EXPECT_NE(thin.notes[0].find("thinner than about a cube of 1 m"), std::string::npos) << thin.notes[0];
  EXPECT_TRUE(fine.notes.empty()) << fine.notes[0];
}

TEST(CutBody, RefusesWhatIsOutsideTheGridOrHasNoTetrahedra) {
  const Mesh body = test::cylinder(2, 4, 4);
  EXPECT_THROW(cut_body({{-1, -1, 0}, 0.5, {4, 4, 3}}, body), std::invalid_argument);
  EXPECT_THROW(cut_body({{0, 0, 0}, 1, {1, 1, 1}}, block_mesh({1, 1, 1}, {1, 1, 1})), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::cut_cells_test
