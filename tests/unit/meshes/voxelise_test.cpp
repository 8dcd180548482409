#include "meshes/voxels/voxelise.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <stdexcept>

#include "meshes/locate/outer_facets.h"
#include "meshes/mesher/mesher.h"
#include "meshes/volume.h"
#include "meshes/voxels/scan_lines.h"
#include "support/bodies.h"

namespace springproof::voxelise_test {
namespace {

constexpr double pi = std::numbers::pi;

Mesh mapped(Mesh mesh, const std::function<Vec3(const Vec3&)>& f) {
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) mesh.nodes.row(n) = f(mesh.nodes.row(n).transpose()).transpose();
  mesh.grid.reset();
  return mesh;
}

Mesh turned(const Mesh& mesh, const Eigen::Matrix3d& R) {
  return mapped(mesh, [&](const Vec3& p) -> Vec3 { return R * p; });
}

/// [-1, 1]^3 blown up to the unit ball: cubes of radius max|x| become spheres.
Mesh ball(int n) {
  return mapped(block_mesh({2, 2, 2}, {n, n, n}), [](const Vec3& p) -> Vec3 {
    const Vec3 x = p - Vec3::Ones();
    return x.norm() == 0 ? x : Vec3(x.cwiseAbs().maxCoeff() / x.norm() * x);
  });
}

/// A torus of the radii R and r about z: a bar of 4 x 4 cells bent round, its ends glued.
Mesh torus(double R, double r, int around) {
  Mesh bar = block_mesh({2, 2, 1}, {4, 4, around});
  const int layer = 25;
  for (Hexahedron& cell : bar.hexahedra)
    for (int& n : cell) n %= layer * around;
  bar.nodes.conservativeResize(layer * around, 3);
  bar.patches.clear();
  return mapped(bar, [&](const Vec3& p) -> Vec3 {
    const double x = p.x() - 1, y = p.y() - 1,
                 s = std::hypot(x, y) == 0 ? 0 : r * std::max(std::abs(x), std::abs(y)) / std::hypot(x, y);
    const double angle = 2 * pi * p.z();
    return {(R + s * x) * std::cos(angle), (R + s * x) * std::sin(angle), -s * y};
  });
}

/// Euler's number of a union of cubes: corners - edges + faces - cubes.
int euler_number(const Mesh& mesh) {
  const auto count = [](auto list) {
    std::sort(list.begin(), list.end());
    return int(std::unique(list.begin(), list.end()) - list.begin());
  };
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 4>> faces;
  for (const Hexahedron& cell : mesh.hexahedra)
    for (int f = 0; f < 6; ++f) {
      auto face = face_of(cell, f);
      for (int c = 0; c < 4; ++c)
        edges.push_back({std::min(face[c], face[(c + 1) % 4]), std::max(face[c], face[(c + 1) % 4])});
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  return int(mesh.nodes.rows()) - count(edges) + count(faces) - int(mesh.hexahedra.size());
}

double voxel_volume(const Voxels& voxels) { return volume(voxels.mesh, voxels.mesh.nodes); }

/// Facets closed and outward: the divergence theorem holds and the area vectors cancel.
void expect_closed(const Mesh& mesh) {
  Vec3 area = Vec3::Zero();
  double flux = 0;
  for (const OuterFacet& f : outer_facets(mesh)) {
    const Vec3 a = mesh.nodes.row(f.nodes[0]), b = mesh.nodes.row(f.nodes[1]), c = mesh.nodes.row(f.nodes[2]);
    area += (b - a).cross(c - b);
    flux += (b - a).cross(c - b).dot((a + c) / 2);
  }
  EXPECT_LE(area.norm(), 1e-9);
  EXPECT_NEAR(flux / 3, volume(mesh, mesh.nodes), 1e-9 * (1 + volume(mesh, mesh.nodes)));
}

std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(VoxelGrid, HoldsTheBodyAndIsCentredOnIt) {
  const Mesh body =
      mapped(block_mesh({1, 0.5, 0.25}, {1, 1, 1}), [](const Vec3& p) -> Vec3 { return p + Vec3(3, -2, 0.5); });
  const VoxelGrid grid = voxel_grid(body, 0.2);
  EXPECT_EQ(grid.cells, (std::array<int, 3>{5, 3, 2}));
  EXPECT_LE((grid.origin - Vec3(3, -2.05, 0.425)).norm(), 1e-12);
  EXPECT_EQ(voxel_grid(body, 7).cells, (std::array<int, 3>{1, 1, 1}));
  EXPECT_THROW(voxel_grid(body, 0), std::invalid_argument);
  EXPECT_THROW(voxel_grid(body, -1), std::invalid_argument);
  EXPECT_THROW(voxel_grid(body, std::nan("")), std::invalid_argument);
  EXPECT_THROW(voxel_grid(Mesh{}, 1), std::invalid_argument);
  EXPECT_NE(message_of([&] { voxel_grid(body, 1e-9); }).find("too small"), std::string::npos);
}

TEST(VoxelGrid, NodesThatNoCellUsesDoNotCount) {
  Mesh body = block_mesh({1, 1, 1}, {1, 1, 1});
  body.nodes.conservativeResize(9, 3);
  body.nodes.row(8) << 50, 50, 50;
  EXPECT_EQ(voxel_grid(body, 0.5).cells, (std::array<int, 3>{2, 2, 2}));
}

TEST(Voxelise, GivesABlockBackAsItIs) {
  const Mesh block = block_mesh({2, 1, 1}, {4, 2, 2});
  const Mesh body = block_mesh({2, 1, 1}, {1, 1, 1});
  const Voxels voxels = voxelise(voxel_grid(body, 0.5), body);
  EXPECT_EQ(voxels.mesh.nodes, block.nodes);
  EXPECT_EQ(voxels.mesh.hexahedra, block.hexahedra);
  EXPECT_TRUE(voxels.notes.empty());
  ASSERT_TRUE(voxels.mesh.grid);
  EXPECT_EQ(voxels.mesh.grid->cells, block.grid->cells);
  EXPECT_EQ(voxels.mesh.grid->cell_index, block.grid->cell_index);
  for (const Patch& p : block.patches) {
    EXPECT_EQ(nodes_of(patch(voxels.mesh, p.name)), nodes_of(p)) << p.name;
    EXPECT_NEAR(nodal_areas(voxels.mesh, patch(voxels.mesh, p.name)).sum(), nodal_areas(block, p).sum(), 1e-14)
        << p.name;
  }
}

/// At edges that are no binary fractions, and with the surface cut into many facets and into tetrahedra.
TEST(Voxelise, GivesBlocksBackAtTheirOwnCellSize) {
  for (const double edge : {0.1, 1. / 3, 0.7e-3, 12.3})
    for (const std::array<int, 3>& cells : {std::array{7, 3, 5}, std::array{1, 1, 1}, std::array{13, 2, 9}}) {
      const Mesh block = block_mesh(edge * Vec3(cells[0], cells[1], cells[2]), cells);
      for (const Mesh& body : {block, test::tetrahedra_of(block)}) {
        const VoxelGrid grid = voxel_grid(body, edge);
        EXPECT_EQ(grid.cells, cells);
        const Mesh mesh = voxelise(grid, body).mesh;
        EXPECT_EQ(mesh.hexahedra, block.hexahedra);
        EXPECT_LE((mesh.nodes - block.nodes).cwiseAbs().maxCoeff(), 1e-12 * block.nodes.maxCoeff());
      }
    }
}

/// Facets, edges and vertices of the body on the centres themselves: half of them count, whatever the triangulation.
TEST(Voxelise, SurfaceThroughCentresIsHalfOpen) {
  const Mesh block =
      mapped(block_mesh({0.5, 0.3, 0.4}, {5, 3, 4}), [](const Vec3& p) -> Vec3 { return p + Vec3::Constant(0.05); });
  const VoxelGrid grid{Vec3::Zero(), 0.1, {6, 4, 5}};
  Mesh rounded = block;  // as coordinates come out of a file
  for (double& x : rounded.nodes.reshaped())
    x = std::round(x * 1e12) / 1e12 + 1e-12 * std::sin(1e15 * x + double(&x - rounded.nodes.data()));
  for (const Mesh& body : {block, test::tetrahedra_of(block), rounded}) {
    const Mesh mesh = voxelise(grid, body).mesh;
    EXPECT_EQ(mesh.hexahedra.size(), 60u);
    EXPECT_EQ(mesh.grid->cells, (std::array<int, 3>{5, 3, 4}));
    EXPECT_LE(mesh.nodes.colwise().minCoeff().norm(), 1e-15);
  }
}

/// Stairs whose facets all lie on planes of centres or of cube faces.
TEST(Voxelise, BodyOfHalfCubes) {
  Mesh stairs = block_mesh({4, 4, 4}, {8, 8, 8});  // of edge 0.5, half the cubes' edge
  std::vector<Hexahedron> kept;
  for (std::size_t c = 0; c < stairs.hexahedra.size(); ++c) {
    const auto [i, j, k] = stairs.grid->cell_index[c];
    if (i + j + k < 11) kept.push_back(stairs.hexahedra[c]);
  }
  stairs.hexahedra = kept;
  stairs.grid.reset();
  const Mesh mesh = voxelise({Vec3::Zero(), 1, {4, 4, 4}}, stairs).mesh;
  std::size_t expected = 0;  // the centre (i + 0.5, ...) is the lowest corner of the half cube (2 i + 1, ...)
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) expected += 2 * (i + j + k) + 3 < 11;
  EXPECT_EQ(mesh.hexahedra.size(), expected);
}

/// The centre of a cube of edge 2 is the grid's centre: no turn may lose a cube or fill one outside.
TEST(Voxelise, TurnedCubesLeakNowhere) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  const Mesh cube = mapped(block_mesh({2, 2, 2}, {3, 3, 3}), [](const Vec3& p) -> Vec3 { return p - Vec3::Ones(); });
  for (int turn = 0; turn < 100; ++turn) {
    Eigen::Quaterniond q(normal(generator), normal(generator), normal(generator), normal(generator));
    if (turn < 3) q = Eigen::AngleAxisd(pi / 4, Vec3::Unit(turn));  // edges and diagonals along the lattice
    const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
    const Mesh body = turned(turn % 2 ? test::tetrahedra_of(cube) : cube, R);
    const double edge = turn < 3 ? std::sqrt(0.125) : 0.11;
    const VoxelGrid grid = voxel_grid(body, edge);
    const Mesh mesh = voxelise(grid, body).mesh;
    std::vector<char> filled(std::size_t(grid.cells[0]) * grid.cells[1] * grid.cells[2], 0);
    for (const Hexahedron& cell : mesh.hexahedra) {
      const Vec3 low = ((mesh.nodes.row(cell[0]).transpose() - grid.origin) / edge).array().round();
      filled[(std::size_t(low[2]) * grid.cells[1] + std::size_t(low[1])) * grid.cells[0] + std::size_t(low[0])] = 1;
    }
    std::size_t n = 0;
    for (int k = 0; k < grid.cells[2]; ++k)
      for (int j = 0; j < grid.cells[1]; ++j)
        for (int i = 0; i < grid.cells[0]; ++i, ++n) {
          const double reach =
              (R.transpose() * (grid.origin + edge * Vec3(i + 0.5, j + 0.5, k + 0.5))).cwiseAbs().maxCoeff();
          if (std::abs(reach - 1) > 1e-8) {
            ASSERT_EQ(bool(filled[n]), reach < 1) << turn << ": " << i << " " << j << " " << k;
          }
        }
  }
}

/// Random tetrahedra with corners on the lattice points: lines run through vertices, along edges and within facets.
TEST(Voxelise, VerticesOnTheLinesLeakNowhere) {
  std::mt19937 generator(3);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec3> p;
    for (int n = 0; n < 4; ++n) p.emplace_back(int(generator() % 7), int(generator() % 7), int(generator() % 7));
    const double six_volumes = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
    const auto runs = runs_inside(p, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}, {7, 7, 7});
    std::vector<char> filled(343, 0);
    for (const auto& r : runs)
      for (int i = r.begin; i < r.end; ++i) filled[r.row * 7 + i] = 1;
    for (int n = 0; n < 343; ++n) {
      const Vec3 x(n % 7, n / 7 % 7, n / 49);
      double least = 1;  // of the barycentric coordinates, times six volumes: integers, exact
      for (int v = 0; v < 4; ++v) {
        auto q = p;
        q[v] = x;
        least = std::min(least, (q[1] - q[0]).cross(q[2] - q[0]).dot(q[3] - q[0]) * (six_volumes < 0 ? -1 : 1));
      }
      if (least != 0 && six_volumes != 0) {
        ASSERT_EQ(bool(filled[n]), least > 0) << trial << " " << n;
      } else if (least < 0) {
        ASSERT_FALSE(filled[n]) << trial << " " << n;
      }
    }
  }
}

/// Tetrahedra that fill a block share every lattice point on their common facets out: each belongs to exactly one of
/// them.
TEST(Voxelise, NeighboursShareEveryCentreOnce) {
  Mesh body = test::tetrahedra_of(block_mesh({6, 6, 6}, {2, 2, 2}));
  std::vector<int> owners(216, 0);
  for (const Tetrahedron& t : body.tetrahedra) {
    std::vector<Vec3> p;
    for (const int n : t) p.push_back(body.nodes.row(n).transpose());
    for (const auto& r : runs_inside(p, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}, {6, 6, 6}))
      for (int i = r.begin; i < r.end; ++i) ++owners[r.row * 6 + i];
  }
  EXPECT_EQ(owners, std::vector<int>(216, 1));
}

/// The volume of a ball's cubes tends to the body's own; the number of centres in a ball is off by less than h^1.5.
TEST(Voxelise, VolumeOfABallConverges) {
  const Mesh body = ball(24);
  const double exact = volume(body, body.nodes);
  EXPECT_NEAR(exact, 4 * pi / 3, 0.02 * 4 * pi / 3);
  for (const double edge : {0.2, 0.1, 0.05, 0.03}) {
    const Voxels voxels = voxelise(voxel_grid(body, edge), body);
    EXPECT_NEAR(voxel_volume(voxels), exact, exact * std::pow(edge, 1.5)) << edge;
    EXPECT_TRUE(voxels.notes.empty());
    expect_closed(voxels.mesh);
    for (Eigen::Index n = 0; n < voxels.mesh.nodes.rows(); ++n)
      ASSERT_LE(voxels.mesh.nodes.row(n).norm(), 1 + edge * std::sqrt(0.75) + 1e-12);
  }
}

TEST(Voxelise, TorusHasItsHoleAndItsVolume) {
  const Mesh body = torus(1, 0.4, 48);
  const Mesh turned_body = turned(body, Eigen::AngleAxisd(0.9, Vec3(1, 2, 3).normalized()).toRotationMatrix());
  EXPECT_NEAR(volume(body, body.nodes), 2 * pi * pi * 0.16, 0.12 * 2 * pi * pi * 0.16);
  for (const Mesh& b : {body, turned_body}) {
    const Voxels voxels = voxelise(voxel_grid(b, 0.04), b);
    EXPECT_EQ(euler_number(voxels.mesh), 0);  // of a solid torus; 1 for a ball
    EXPECT_NEAR(voxel_volume(voxels), volume(b, b.nodes), 0.005 * volume(b, b.nodes));
    expect_closed(voxels.mesh);
  }
  EXPECT_EQ(euler_number(voxelise(voxel_grid(ball(8), 0.2), ball(8)).mesh), 1);
}

TEST(Voxelise, GridIsTheOneThatWouldBeDetected) {
  const Mesh mesh = voxelise({Vec3(-1.3, -1.2, -1.6), 0.25, {11, 12, 13}}, ball(6)).mesh;
  const auto grid = detect_grid(mesh);
  ASSERT_TRUE(grid && mesh.grid);
  EXPECT_EQ(grid->cells, mesh.grid->cells);
  EXPECT_EQ(grid->cell_index, mesh.grid->cell_index);
  EXPECT_LE((grid->origin - mesh.grid->origin).norm(), 1e-14);
  EXPECT_LE((grid->spacing - mesh.grid->spacing).norm(), 1e-14);
}

TEST(Voxelise, FacetsTakeTheNearestPatchOrNone) {
  Mesh body = block_mesh({1, 1, 1}, {1, 1, 1});
  std::erase_if(body.patches, [](const Patch& p) { return p.name != "x_min" && p.name != "y_max"; });
  const Mesh mesh = voxelise(voxel_grid(body, 0.25), body).mesh;
  ASSERT_EQ(mesh.patches.size(), 2u);
  EXPECT_EQ(patch(mesh, "x_min").facets.size(), 16u);
  EXPECT_EQ(patch(mesh, "y_max").facets.size(), 16u);
}

/// Against a search through all facets, on a body whose facets are of very different sizes.
TEST(Voxelise, PatchesAreThoseOfTheNearestFacet) {
  Mesh body = mapped(ball(6), [](const Vec3& p) -> Vec3 { return {p.x() * std::exp(p.x()), p.y(), p.z()}; });
  body.patches.clear();
  for (const OuterFacet& f : outer_facets(body))
    body.patches.push_back({std::to_string(body.patches.size()), {f.nodes}});
  const Mesh mesh = voxelise(voxel_grid(body, 0.15), body).mesh;
  const auto corner = [&](int n) -> Vec3 { return body.nodes.row(n).transpose(); };
  std::size_t facets = 0;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    for (const auto& facet : mesh.patches[p].facets) {
      ++facets;
      Vec3 middle = Vec3::Zero();
      for (const int n : facet) middle += mesh.nodes.row(n).transpose() / 4;
      const auto distance = [&](const Patch& patch) {
        const auto& f = patch.facets.front();
        return std::min((closest_point(middle, corner(f[0]), corner(f[1]), corner(f[2])) - middle).norm(),
                        (closest_point(middle, corner(f[0]), corner(f[2]), corner(f[3])) - middle).norm());
      };
      double least = 1e300;
      for (const Patch& other : body.patches) least = std::min(least, distance(other));
      ASSERT_EQ(distance(body.patches[p]), least);
    }
  EXPECT_EQ(facets, outer_facets(mesh).size());
}

TEST(Voxelise, RefusesWhatIsNoBodyOfCubes) {
  const Mesh body = block_mesh({1, 1, 1}, {1, 1, 1});
  EXPECT_NE(message_of([&] {
              voxelise({Vec3::Zero(), 0.25, {4, 4, 3}}, body);
            }).find("which is not within the box"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              voxelise({Vec3(0.1, 0, 0), 0.25, {4, 4, 4}}, body);
            }).find("which is not within the box"),
            std::string::npos);
  EXPECT_THROW(voxelise({Vec3::Zero(), 0.25, {4, 4, 0}}, body), std::invalid_argument);
  EXPECT_THROW(voxelise({Vec3::Zero(), 0, {4, 4, 4}}, body), std::invalid_argument);
  const Mesh sliver = block_mesh({1, 1, 0.1}, {1, 1, 1});
  EXPECT_NE(message_of([&] {
              voxelise({Vec3::Zero(), 0.5, {2, 2, 2}}, sliver);
            }).find("no cube of 0.5 m has its centre in the body"),
            std::string::npos);
}

}  // namespace
}  // namespace springproof::voxelise_test
