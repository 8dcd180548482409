// Bodies of several materials in cells: pieces of one material, and the interfaces between them.
#include <gtest/gtest.h>

#include <map>

#include "meshes/voxels/cut_cells.h"
#include "support/tolerances.h"
#include "support/two_materials.h"

namespace springproof::cut_interfaces_test {
namespace {

CutBody ball_of(int cells, const Vec3& centre) {
  return cut_body({Vec3::Constant(-2), 4.0 / cells, {cells, cells, cells}}, test::ball_in_cube(8, centre));
}

TEST(CutInterfaces, EachMaterialKeepsItsVolume) {
  const Mesh body = test::ball_in_cube(8, {0.1, 0.2, -0.05});
  const CutBody cut = cut_body({Vec3::Constant(-2), 0.5, {8, 8, 8}}, body);
  double in_cells[2] = {0, 0}, in_body[2] = {0, 0};
  for (const CutCell& c : cut.cells) in_cells[c.material] += c.filled.fraction / 8;
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    Eigen::Matrix3d edges;
    for (int d = 0; d < 3; ++d)
      edges.col(d) = (body.nodes.row(body.tetrahedra[t][d + 1]) - body.nodes.row(body.tetrahedra[t][0])).transpose();
    in_body[body.materials[t]] += edges.determinant() / 6;
  }
  for (int m = 0; m < 2; ++m) EXPECT_NEAR(in_cells[m], in_body[m], 1e-3 * in_body[m]) << m;
}

// Both sides of an interface have its area, its normal and its moments; those of a closed one sum to 0 and its volume.
TEST(CutInterfaces, BothSidesAreTheSameSurface) {
  const CutBody cut = ball_of(8, {0.1, 0.2, -0.05});
  ASSERT_FALSE(cut.interfaces.empty());
  Vec3 sum = Vec3::Zero();
  double volume = 0, of_cells = 0;
  for (const CutCell& c : cut.cells) of_cells += c.material * c.filled.fraction / 8;
  for (const InterfaceInCells& i : cut.interfaces) {
    const PatchInCell &a = i.sides[0], &b = i.sides[1];
    EXPECT_EQ(cut.cells[a.cell].material, 0);
    EXPECT_EQ(cut.cells[b.cell].material, 1);
    EXPECT_NEAR(a.total_area(), b.total_area(), test::round_off);
    Vec3 na = Vec3::Zero(), nb = Vec3::Zero(), xa = Vec3::Zero(), xb = Vec3::Zero();
    for (int n = 0; n < 8; ++n) {
      na += a.normal[n];
      nb += b.normal[n];
      xa += a.moment[n] + a.area[n] * cut.centre(a.cell);
      xb += b.moment[n] + b.area[n] * cut.centre(b.cell);
      volume -= a.normal[n].dot(cut.points.row(cut.cells[a.cell].corners[n])) / 3;
    }
    EXPECT_NEAR((na - nb).norm(), 0, test::round_off);
    EXPECT_NEAR((xa - xb).norm(), 0, test::round_off);
    sum += na;
  }
  EXPECT_NEAR(sum.norm(), 0, 1e-12);
  EXPECT_NEAR(volume, of_cells, 1e-3 * of_cells);  // slivers that are left out
}

/// Whether cells of two materials in one cube have a corner in common.
bool share_corners_in_a_cube(const CutBody& cut) {
  std::map<std::array<int, 3>, std::map<int, int>> material_of;  // cube, corner
  for (const CutCell& c : cut.cells)
    for (const int n : c.corners)
      if (material_of[c.index].emplace(n, c.material).first->second != c.material) return true;
  return false;
}

// A plate between two planes of the lattice that ends within cubes: there bonds hold it from above and below too, as
// cells that are added on the same corners are too stiff.  Elsewhere the planes are shared.
TEST(CutInterfaces, WhereAMaterialEndsWithinCubesItSharesNoPlaneOfTheLattice) {
  const auto plate = [](const Vec3& x) { return x[0] < 2.5 && x[2] > 1 && x[2] < 2; };
  const Mesh body = test::with_materials(test::solid_of(block_mesh({4, 3, 3}, {8, 6, 6})), plate);
  const CutBody cut = cut_body({Vec3::Zero(), 1, {4, 3, 3}}, body);
  EXPECT_FALSE(share_corners_in_a_cube(cut));
  double area = 0;
  for (const InterfaceInCells& i : cut.interfaces) area += i.sides[0].total_area();
  EXPECT_NEAR(area, 3 + 2 * 3 * (0.5 + 1), 1e-9);  // the end, and below and above it and the cubes beside
  const CutBody fine = cut_body({Vec3::Zero(), 0.5, {8, 6, 6}}, body);
  EXPECT_TRUE(fine.interfaces.empty());
}

TEST(CutInterfaces, CellsOfTwoMaterialsInOneCubeShareNoCorner) {
  const CutBody cut = ball_of(8, {0.1, 0.2, -0.05});
  for (const InterfaceInCells& i : cut.interfaces)
    for (const int a : cut.cells[i.sides[0].cell].corners)
      for (const int b : cut.cells[i.sides[1].cell].corners) EXPECT_NE(a, b);
}

// Within 1e-9 of a plane of the lattice there is no interface within cubes: the cells share the corners of the face.
TEST(CutInterfaces, InAPlaneOfTheLatticeShareCorners) {
  for (const double off : {0.0, 5e-10, 1e-8}) {
    const Mesh body = test::layered_block({4, 2, 2}, {4, 2, 2}, 0, 1 + off);
    const CutBody cut = cut_body({Vec3::Zero(), 1, {4, 2, 2}}, body);
    EXPECT_EQ(cut.cells.size(), 16u);
    EXPECT_EQ(cut.interfaces.size(), off > 1e-9 ? 4u : 0u);
    EXPECT_EQ(cut.points.rows(), off > 1e-9 ? 54 : 45);
    for (const CutCell& c : cut.cells) EXPECT_EQ(c.material, c.index[0] >= 1);
  }
}

// A sheet of material 1, .3 of a cube thick, and what lies on both sides of it: three cells in each of its cubes.
TEST(CutInterfaces, AMaterialOnBothSidesOfASheetIsTwoCells) {
  const Mesh body = test::with_materials(test::solid_of(block_mesh({2, 2, 1.5}, {2, 2, 15})),
                                         [](const Vec3& x) { return x[2] > 0.6 && x[2] < 0.9; });
  const CutBody cut = cut_body({Vec3::Zero(), 1, {2, 2, 2}}, body);
  int low = 0;
  for (const CutCell& c : cut.cells) low += c.index[2] == 0;
  EXPECT_EQ(low, 12);
  EXPECT_EQ(cut.interfaces.size(), 8u);
}

// An interface .0005 of a cube off a plane leaves slivers of a material, which go: the cells beyond meet in their
// place.
TEST(CutInterfaces, GoToTheCellBeyondASliver) {
  const Mesh body = test::layered_block({4, 2, 2}, {4, 2, 2}, 0, 1.9995);
  const CutBody cut = cut_body({Vec3::Zero(), 1, {4, 2, 2}}, body);
  EXPECT_EQ(cut.cells.size(), 16u);
  ASSERT_EQ(cut.interfaces.size(), 4u);
  for (const InterfaceInCells& i : cut.interfaces) {
    EXPECT_EQ(cut.cells[i.sides[0].cell].index[0], 1);
    EXPECT_EQ(cut.cells[i.sides[1].cell].index[0], 2);
    EXPECT_NEAR(i.sides[0].total_area(), 1, 1e-12);
  }
}

TEST(CutInterfaces, AMaterialWithoutACellIsRefused) {
  const Mesh body = test::with_materials(test::solid_of(block_mesh({2, 2, 2}, {20, 20, 20})), [](const Vec3& x) {
    return (x - Vec3(0.55, 0.55, 0.55)).cwiseAbs().maxCoeff() < 0.05;
  });
  EXPECT_THROW(cut_body({Vec3::Zero(), 2, {1, 1, 1}}, body), std::invalid_argument);
  EXPECT_NO_THROW(cut_body({Vec3::Zero(), 0.5, {4, 4, 4}}, body));
}

}  // namespace
}  // namespace springproof::cut_interfaces_test
