#include "meshes/mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "meshes/volume.h"
#include "support/tolerances.h"

namespace springproof::mesh_test {
namespace {

const Vec3 size(2.4, 0.5, 0.3);

Vec3 node(const Mesh& mesh, int n) { return mesh.nodes.row(n).transpose(); }

/// The cells `keep` says, on the nodes of the whole block.
template <class Keep>
Mesh part_of(Mesh mesh, Keep keep) {
  std::vector<Hexahedron> cells;
  for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h)
    if (keep(h)) cells.push_back(mesh.hexahedra[h]);
  mesh.hexahedra = cells;
  mesh.grid.reset();
  return mesh;
}

TEST(BlockMesh, NodesRunAlongXFirst) {
  const Mesh mesh = block_mesh(size, {4, 3, 2});
  ASSERT_EQ(mesh.nodes.rows(), 5 * 4 * 3);
  EXPECT_EQ(mesh.hexahedra.size(), 24u);
  EXPECT_TRUE(node(mesh, 1).isApprox(Vec3(0.6, 0, 0), test::round_off));
  EXPECT_TRUE(node(mesh, 5).isApprox(Vec3(0, 0.5 / 3, 0), test::round_off));
  EXPECT_TRUE(node(mesh, 20).isApprox(Vec3(0, 0, 0.15), test::round_off));
  EXPECT_EQ(node(mesh, 59), size);
  EXPECT_NEAR(volume(mesh, mesh.nodes), size.prod(), test::round_off);
  EXPECT_GT(cell_volumes(mesh, mesh.nodes).minCoeff(), 0);
}

TEST(BlockMesh, RefusesNonsense) {
  EXPECT_THROW(block_mesh({1, 0, 1}, {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(block_mesh({1, std::nan(""), 1}, {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(block_mesh({1, 1, 1}, {1, 0, 1}), std::invalid_argument);
}

TEST(BlockMesh, PatchesLieOnTheirPlanesAndPointOutward) {
  const Mesh mesh = block_mesh(size, {4, 3, 2});
  const char* names[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  ASSERT_EQ(mesh.patches.size(), 6u);
  for (int p = 0; p < 6; ++p) {
    const Patch& face = patch(mesh, names[p]);
    const int axis = p / 2;
    const double plane = p % 2 ? size[axis] : 0;
    const Vec3 outward = (p % 2 ? 1 : -1) * Vec3::Unit(axis);
    double area = 0;
    for (const auto& facet : face.facets) {
      for (const int n : facet) EXPECT_DOUBLE_EQ(mesh.nodes(n, axis), plane);
      const Vec3 diagonals =
          (node(mesh, facet[2]) - node(mesh, facet[0])).cross(node(mesh, facet[3]) - node(mesh, facet[1]));
      EXPECT_NEAR(diagonals.normalized().dot(outward), 1, test::round_off);
      area += diagonals.norm() / 2;
    }
    EXPECT_NEAR(area, size.prod() / size[axis], test::round_off);
  }
}

// The faces of any cell close: their area vectors sum to zero, and each points away from the cell's middle.
TEST(HexahedronFaces, AreOutward) {
  const Mesh mesh = block_mesh({1, 1, 1}, {1, 1, 1});
  for (int f = 0; f < 6; ++f) {
    const auto face = face_of(mesh.hexahedra[0], f);
    const Vec3 normal = (node(mesh, face[1]) - node(mesh, face[0])).cross(node(mesh, face[2]) - node(mesh, face[1]));
    const Vec3 expected = (f % 2 ? 1 : -1) * Vec3::Unit(f / 2);
    EXPECT_TRUE(normal.isApprox(expected, test::round_off)) << f;
  }
}

TEST(Patch, UnknownNameListsTheKnownOnes) {
  const Mesh mesh = block_mesh(size, {1, 1, 1});
  try {
    patch(mesh, "top");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'top'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("z_max"), std::string::npos);
  }
}

TEST(Patch, NodesAscendEachOnce) {
  const Mesh mesh = block_mesh(size, {4, 3, 2});
  const std::vector<int> nodes = nodes_of(patch(mesh, "z_min"));
  EXPECT_EQ(nodes.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(nodes[i], i);
  const Patch triangle{"t", {{7, 3, 5, -1}}};
  EXPECT_EQ(nodes_of(triangle), (std::vector<int>{3, 5, 7}));
}

TEST(NodalAreas, CornersEdgesAndMiddlesOfAUniformFace) {
  const Mesh mesh = block_mesh({2, 2, 1}, {2, 2, 1});
  const Eigen::VectorXd areas = nodal_areas(mesh, patch(mesh, "z_max"));
  ASSERT_EQ(areas.size(), mesh.nodes.rows());
  const double expected[] = {0.25, 0.5, 0.25, 0.5, 1, 0.5, 0.25, 0.5, 0.25};
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(areas[i], 0);
    EXPECT_NEAR(areas[9 + i], expected[i], test::round_off);
  }
}

TEST(NodalAreas, SumIsTheAreaOfASkewPlanarQuadrilateral) {
  Mesh mesh;
  mesh.nodes.resize(4, 3);
  mesh.nodes << 0, 0, 0, 3, 0, 0, 2, 2, 0, 0, 1, 0;  // shoelace: area 4
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  mesh.nodes = (mesh.nodes * R.transpose()).eval();
  const Patch quadrilateral{"q", {{0, 1, 2, 3}}};
  EXPECT_NEAR(nodal_areas(mesh, quadrilateral).sum(), 4, test::round_off);
  // Centroid of the polygon: triangles (0,1,2) of area 3 at (5/3, 2/3) and (0,2,3) of area 1 at (2/3, 1).
  const Vec3 expected = R * Vec3((3 * 5. / 3 + 2. / 3) / 4, (3 * 2. / 3 + 1) / 4, 0);
  EXPECT_LE((centroid(mesh, quadrilateral) - expected).norm(), test::round_off);
}

TEST(NodalAreas, TriangleIsSplitEvenly) {
  Mesh mesh;
  mesh.nodes.resize(3, 3);
  mesh.nodes << 0, 0, 0, 3, 0, 0, 0, 0, 4;
  const Patch triangle{"t", {{0, 1, 2, -1}}};
  const Eigen::VectorXd areas = nodal_areas(mesh, triangle);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(areas[i], 2, test::round_off);
  EXPECT_TRUE(centroid(mesh, triangle).isApprox(Vec3(1, 0, 4. / 3), test::round_off));
}

TEST(NodalVolumes, SumToTheVolumeAndShareByCells) {
  const Mesh mesh = block_mesh({2, 1, 1}, {2, 1, 1});
  const Eigen::VectorXd shares = nodal_volumes(mesh);
  EXPECT_NEAR(shares.sum(), 2, test::round_off);
  EXPECT_NEAR(shares[0], 0.125, test::round_off);
  EXPECT_NEAR(shares[1], 0.25, test::round_off);
}

TEST(DetectGrid, Block) {
  const Mesh mesh = block_mesh(size, {4, 3, 2});
  const auto grid = detect_grid(mesh);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->cells, (std::array<int, 3>{4, 3, 2}));
  EXPECT_EQ(grid->cell_index, mesh.grid->cell_index);
  EXPECT_TRUE(grid->spacing.isApprox(Vec3(0.6, 0.5 / 3, 0.15), test::round_off));
  EXPECT_TRUE(grid->origin.isZero(test::round_off));
}

TEST(DetectGrid, AnySubsetOfCellsInAnyOrder) {
  const Mesh block = block_mesh(size, {4, 3, 2});
  Mesh voxels = part_of(block, [](std::size_t h) { return h % 3 != 1; });
  std::reverse(voxels.hexahedra.begin(), voxels.hexahedra.end());
  voxels.nodes.rowwise() += Eigen::RowVector3d(-7, 3, 0.1);
  const auto grid = detect_grid(voxels);
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->cell_index.size(), voxels.hexahedra.size());
  for (std::size_t h = 0; h < voxels.hexahedra.size(); ++h) {
    const auto& index = grid->cell_index[h];
    const Vec3 lowest = grid->origin + grid->spacing.cwiseProduct(Vec3(index[0], index[1], index[2]));
    EXPECT_LE((node(voxels, voxels.hexahedra[h][0]) - lowest).norm(), 1e-12);
  }
}

TEST(DetectGrid, OriginIsThatOfTheCellsThatAreThere) {
  const Mesh right_half = part_of(block_mesh({4, 1, 1}, {4, 1, 1}), [](std::size_t h) { return h >= 2; });
  const auto grid = detect_grid(right_half);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->cells, (std::array<int, 3>{2, 1, 1}));
  EXPECT_DOUBLE_EQ(grid->origin.x(), 2);
}

TEST(DetectGrid, RoundOffIsForgivenAndRealShiftsAreNot) {
  Mesh mesh = block_mesh(size, {4, 3, 2});
  mesh.nodes(7, 0) += 1e-11;
  EXPECT_TRUE(detect_grid(mesh));
  mesh.nodes(7, 0) += 1e-7;
  EXPECT_FALSE(detect_grid(mesh));
}

TEST(DetectGrid, WhatIsNoGrid) {
  const Mesh block = block_mesh(size, {4, 3, 2});
  EXPECT_FALSE(detect_grid(Mesh{}));

  Mesh turned = block;
  turned.nodes = (block.nodes * Eigen::AngleAxisd(0.1, Vec3::UnitZ()).toRotationMatrix()).eval();
  EXPECT_FALSE(detect_grid(turned));

  Mesh graded = block;
  graded.nodes.col(0) = block.nodes.col(0).array().square();
  EXPECT_FALSE(detect_grid(graded));

  Mesh with_tetrahedron = block;
  with_tetrahedron.tetrahedra = {{0, 1, 5, 20}};
  EXPECT_FALSE(detect_grid(with_tetrahedron));

  Mesh twice = block;
  twice.hexahedra.push_back(twice.hexahedra.front());
  EXPECT_FALSE(detect_grid(twice));

  Mesh other_corner_first = block;
  other_corner_first.hexahedra[5] = {1, 2, 3, 0, 5, 6, 7, 4};
  for (int& n : other_corner_first.hexahedra[5]) n = block.hexahedra[5][n];
  EXPECT_FALSE(detect_grid(other_corner_first));

  Mesh half_a_cell_off = part_of(block_mesh({4, 1, 1}, {4, 1, 1}), [](std::size_t h) { return h % 3 == 0; });
  for (const int n : {3, 4, 8, 9, 13, 14, 18, 19}) half_a_cell_off.nodes(n, 0) -= 0.5;
  EXPECT_FALSE(detect_grid(half_a_cell_off));
}

// Two nodes at one place: the body is cut there, and a lattice kernel would sew it together.
TEST(DetectGrid, ACrackIsNoGrid) {
  Mesh cracked = block_mesh({2, 1, 1}, {2, 1, 1});
  const Eigen::Index copy = cracked.nodes.rows();
  cracked.nodes.conservativeResize(copy + 1, 3);
  cracked.nodes.row(copy) = cracked.nodes.row(1);
  for (int& n : cracked.hexahedra[1])
    if (n == 1) n = static_cast<int>(copy);
  EXPECT_FALSE(detect_grid(cracked));
}

}  // namespace
}  // namespace springproof::mesh_test
