#include "meshes/voxelise.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "meshes/mesher.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

std::function<bool(const Vec3&)> ball_at(const Vec3& centre, double radius) {
  return [=](const Vec3& p) { return (p - centre).norm() <= radius; };
}

TEST(Voxelise, GivesABlockBackAsItIs) {
  const Mesh block = block_mesh({2, 1, 1}, {4, 2, 2});
  const Mesh voxels = voxelise({2, 1, 1}, {4, 2, 2}, [](const Vec3&) { return true; }, block_mesh({2, 1, 1}, {1, 1, 1}));
  EXPECT_EQ(voxels.nodes, block.nodes);
  EXPECT_EQ(voxels.hexahedra, block.hexahedra);
  ASSERT_TRUE(voxels.grid);
  EXPECT_EQ(voxels.grid->cells, block.grid->cells);
  for (const Patch& p : block.patches) {
    EXPECT_EQ(nodes_of(patch(voxels, p.name)), nodes_of(p)) << p.name;
    EXPECT_NEAR(nodal_areas(voxels, patch(voxels, p.name)).sum(), nodal_areas(block, p).sum(), 1e-14) << p.name;
  }
}

/// The number of voxels of a ball is its volume's, up to the surface's share; the facets point outwards.
TEST(Voxelise, FillsASphere) {
  const Mesh body = mesh_geo(find_geo({"sphere.geo", {}, {}, {}}, "case.toml"), {2, 2, 2}, {20, 20, 20}, {.tetrahedra = true});
  EXPECT_NEAR(volume(body, body.nodes), 4 * M_PI / 3, 0.02 * 4 * M_PI / 3);
  EXPECT_LT(volume(body, body.nodes), 4 * M_PI / 3);
  const Vec3 centre(1, 1, 1);
  const Mesh voxels = voxelise({2, 2, 2}, {20, 20, 20}, ball_at(centre, 1), body);
  ASSERT_TRUE(voxels.grid);
  EXPECT_NEAR(double(voxels.hexahedra.size()), 4 * M_PI / 3 * 1000, 0.01 * 4189);
  const Patch& surface = patch(voxels, "surface");
  Vec3 area = Vec3::Zero();
  double flux = 0;
  for (const auto& f : surface.facets) {
    const Vec3 a = voxels.nodes.row(f[0]), b = voxels.nodes.row(f[1]), c = voxels.nodes.row(f[2]);
    area += (b - a).cross(c - b);
    flux += (b - a).cross(c - b).dot((a + c) / 2 - centre);
  }
  EXPECT_LE(area.norm(), 1e-12);
  EXPECT_NEAR(flux / 3, volume(voxels, voxels.nodes), 1e-10);  // closed, outward: the divergence theorem
  for (int n = 0; n < voxels.nodes.rows(); ++n)
    EXPECT_LE((voxels.nodes.row(n).transpose() - centre).norm(), 1 + 0.05 * std::sqrt(3.0) + 1e-12);
}

TEST(Voxelise, FacetsTakeTheNearestPatchOrNone) {
  Mesh body = block_mesh({1, 1, 1}, {1, 1, 1});
  std::erase_if(body.patches, [](const Patch& p) { return p.name != "x_min" && p.name != "y_max"; });
  const Mesh voxels = voxelise({1, 1, 1}, {4, 4, 4}, [](const Vec3&) { return true; }, body);
  ASSERT_EQ(voxels.patches.size(), 2u);
  EXPECT_EQ(patch(voxels, "x_min").facets.size(), 16u);
  EXPECT_EQ(patch(voxels, "y_max").facets.size(), 16u);
}

TEST(Voxelise, RefusesWhatIsNoBodyOfCubes) {
  const Mesh body = block_mesh({1, 1, 1}, {1, 1, 1});
  const auto all = [](const Vec3&) { return true; };
  EXPECT_THROW(voxelise({1, 1, 1}, {4, 4, 2}, all, body), std::invalid_argument);
  EXPECT_THROW(voxelise({1, 1, 1}, {4, 4, 4}, [](const Vec3&) { return false; }, body), std::invalid_argument);
  EXPECT_THROW(voxelise({0.5, 0.5, 0.5}, {4, 4, 4}, all, body), std::invalid_argument);
  const auto two_parts = [](const Vec3& p) { return p.x() < 0.25 || p.x() > 0.75; };
  EXPECT_THROW(voxelise({1, 1, 1}, {4, 4, 4}, two_parts, body), std::invalid_argument);
}

}  // namespace
}  // namespace springproof
