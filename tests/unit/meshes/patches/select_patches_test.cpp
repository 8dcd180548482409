#include "meshes/patches/select_patches.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/bodies.h"

namespace springproof::select_patches_test {
namespace {

PatchRule rule(const std::string& name) {
  PatchRule r;
  r.name = name;
  r.where = {"case.toml", 7, 1};
  return r;
}

PatchRule boxed(const Vec3& low, const Vec3& high) {
  PatchRule r = rule("p");
  r.box = PatchRule::Box{low, high};
  return r;
}

PatchRule facing(const Vec3& direction, double degrees) {
  PatchRule r = rule("p");
  r.facing = PatchRule::Facing{direction.normalized(), degrees};
  return r;
}

PatchRule beyond(const Vec3& point, const Vec3& normal) {
  PatchRule r = rule("p");
  r.beyond = PatchRule::Beyond{point, normal.normalized()};
  return r;
}

PatchRule near(const Vec3& point, double radius) {
  PatchRule r = rule("p");
  r.near = PatchRule::Near{point, radius};
  return r;
}

PatchRule on_side(int number) {
  PatchRule r = rule("p");
  r.side = static_cast<BodySide>(number);
  return r;
}

Patch selected(const PatchRule& r, Mesh mesh) {
  select_patches({r}, mesh);
  return mesh.patches.back();
}

double area(const PatchRule& r, Mesh mesh) {
  select_patches({r}, mesh);
  return nodal_areas(mesh, mesh.patches.back()).sum();
}

std::string message_of(const std::vector<PatchRule>& rules, Mesh mesh) {
  try {
    select_patches(rules, mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

Mesh bare_block() {
  Mesh block = block_mesh({4, 2, 2}, {8, 4, 4});
  block.patches.clear();
  return block;
}

/// Without a share of the faces beside the one that it is on.
PatchRule flat_box(const Vec3& on_it, const Vec3& outward) {
  const Vec3 wide = 4 * (Vec3::Ones() - outward.cwiseAbs()), corner = on_it + outward;
  return boxed(on_it.cwiseMin(corner) - wide, on_it.cwiseMax(corner) + wide);
}

/// Each face of a block, by each way to name it, for hexahedra and tetrahedra.
TEST(SelectPatches, FacesOfABlock) {
  const Mesh block = block_mesh({4, 2, 2}, {8, 4, 4});
  Mesh bricks = bare_block(), tetrahedra = test::tetrahedra_of(bricks);
  for (int face = 0; face < 6; ++face) {
    const Patch& expected = block.patches[face];
    const Vec3 outward = (face % 2 ? 1 : -1) * Vec3::Unit(face / 2);
    const Vec3 on_it = centroid(block, expected);
    for (const Mesh& mesh : {bricks, tetrahedra})
      for (const PatchRule& r : {facing(outward, 1), beyond(on_it, outward), flat_box(on_it, outward), on_side(face)}) {
        const Patch p = selected(r, mesh);
        EXPECT_EQ(nodes_of(p), nodes_of(expected)) << face;
        EXPECT_NEAR(nodal_areas(mesh, p).sum(), nodal_areas(block, expected).sum(), 1e-12);
        Vec3 normal = Vec3::Zero();
        for (const auto& f : p.facets) {
          const Vec3 a = mesh.nodes.row(f[0]), b = mesh.nodes.row(f[1]), c = mesh.nodes.row(f[2]);
          normal += (b - a).cross(c - a);
        }
        EXPECT_GT(normal.dot(outward), 0);
      }
  }
}

/// The cap of a twentieth of the diameter, of area 2 pi R h; along its border tetrahedra are cut.
TEST(SelectPatches, ASideOfARoundBodyIsItsOuterTwentieth) {
  Mesh ball = block_mesh({2, 2, 2}, {24, 24, 24});
  for (Eigen::Index n = 0; n < ball.nodes.rows(); ++n) {
    const Vec3 x = ball.nodes.row(n).transpose() - Vec3::Ones();
    if (x.norm() > 0) ball.nodes.row(n) = (x.cwiseAbs().maxCoeff() / x.norm() * x).transpose();
  }
  ball.patches.clear();
  const Mesh tetrahedra = test::tetrahedra_of(ball);
  for (int side = 0; side < 6; ++side) EXPECT_NEAR(area(on_side(side), tetrahedra), 2 * M_PI * 0.1, 0.01) << side;
}

TEST(SelectPatches, AllConditionsMustHold) {
  PatchRule r = facing({0, 0, 1}, 10);
  r.beyond = PatchRule::Beyond{Vec3(3, 0, 0), Vec3::UnitX()};
  EXPECT_NEAR(area(r, bare_block()), 1 * 2, 1e-12);
  r.box = PatchRule::Box{Vec3(0, 0, 0), Vec3(4, 1, 2)};
  EXPECT_NEAR(area(r, bare_block()), 1 * 1, 1e-12);
}

TEST(SelectPatches, BoundariesBelongToTheSelection) {
  EXPECT_NEAR(area(beyond({0, 0, 2}, {0, 0, 1}), bare_block()), 4 * 2, 1e-12);
  EXPECT_NEAR(area(boxed({0.25, 0, 0.25}, {0.75, 1e-6, 0.75}), bare_block()), 4 * 0.25,
              1e-12);  // middles on the box's edges
  EXPECT_NEAR(area(facing({1, 1, 0}, 45), bare_block()), 2 * 2 + 4 * 2, 1e-12);
}

/// Round a sphere, facing within an angle is a cap of area 2 pi (1 - cos): by facets, to the width of one.
TEST(SelectPatches, FacingIsACapOfASphere) {
  Mesh ball = block_mesh({2, 2, 2}, {24, 24, 24});
  for (Eigen::Index n = 0; n < ball.nodes.rows(); ++n) {
    const Vec3 x = ball.nodes.row(n).transpose() - Vec3::Ones();
    if (x.norm() > 0) ball.nodes.row(n) = (x.cwiseAbs().maxCoeff() / x.norm() * x).transpose();
  }
  ball.grid.reset();
  for (const double degrees : {20.0, 60.0, 120.0})
    EXPECT_NEAR(area(facing({1, 2, -1}, degrees), ball), 2 * M_PI * (1 - std::cos(degrees * M_PI / 180)), 0.1)
        << degrees;
  EXPECT_EQ(selected(facing({1, 2, -1}, 180), ball).facets.size(), 6u * 24 * 24);
}

TEST(SelectPatches, NearTakesThePieceThatHangsTogether) {
  // Middles within 1.01 of (1, 1, 2) on the top face: 2 x 2 + 8 facets of 0.5 x 0.5 (at 0.354 and 0.791; 1.06 is out).
  EXPECT_NEAR(area(near({1, 1, 3}, 1.01), bare_block()), 12 * 0.25, 1e-12);
  // A thin plate: the other side is within the radius, but hangs on only around the rim.
  Mesh plate = block_mesh({10, 10, 0.1}, {20, 20, 1});
  plate.patches.clear();
  EXPECT_NEAR(area(near({5, 5, 4}, 2), plate), M_PI * 4, 1.5);
  const Patch top = selected(near({5, 5, 4}, 2), plate);
  for (const int n : nodes_of(top)) EXPECT_EQ(plate.nodes(n, 2), 0.1);
  // The nearest facet is always there, however small the radius.
  EXPECT_EQ(selected(near({5.2, 5.2, 4}, 1e-6), plate).facets.size(), 1u);
}

TEST(SelectPatches, RulesAddToWhatThereIs) {
  Mesh mesh = block_mesh({4, 2, 2}, {8, 4, 4});
  PatchRule a = facing({0, 0, 1}, 1), b = near({0, 0, 0}, 0.5);
  a.name = "top";
  b.name = "corner";
  select_patches({a, b}, mesh);
  ASSERT_EQ(mesh.patches.size(), 8u);
  EXPECT_EQ(mesh.patches[6].name, "top");
  EXPECT_EQ(nodes_of(mesh.patches[6]), nodes_of(patch(mesh, "z_max")));
  EXPECT_EQ(mesh.patches[7].name, "corner");
}

TEST(SelectPatches, WhatSelectsNothingIsExplained) {
  EXPECT_EQ(message_of({boxed({5, 0, 0}, {6, 2, 2})}, bare_block()),
            "case.toml:7:1: patch: 'p' selects no facet of the surface: box_m holds for none, the nearest one has its "
            "middle 1 m from the box "
            "(the body spans (0, 0, 0) to (4, 2, 2) m)");
  EXPECT_NE(message_of({beyond({0, 0, 2.5}, {0, 0, 1})}, bare_block())
                .find("beyond holds for none, the nearest one has its middle 0.5 m short of the plane"),
            std::string::npos);
  EXPECT_NE(message_of({facing({1, 1, 0}, 40)}, bare_block())
                .find("facing holds for none, the nearest one is turned 5 degrees too far away"),
            std::string::npos);
  PatchRule both = facing({0, 0, 1}, 1);
  both.near = PatchRule::Near{Vec3(2, 1, -1), 0.1};
  EXPECT_NE(message_of({both}, bare_block()).find("facing holds for 32 of 160; near holds for 1 of 160 (the body"),
            std::string::npos)
      << message_of({both}, bare_block());
}

TEST(SelectPatches, NamesThatAreTakenAreRefused) {
  PatchRule taken = facing({0, 0, 1}, 1);
  taken.name = "z_max";
  const std::string message = message_of({taken}, block_mesh({4, 2, 2}, {8, 4, 4}));
  EXPECT_EQ(message.rfind(
                "case.toml:7:1: patch.name: the body already has a patch 'z_max' (allowed: a name other than x_min", 0),
            0u)
      << message;
  EXPECT_NE(message_of({facing({0, 0, 1}, 1), facing({0, 0, 1}, 1)}, bare_block()), "accepted");
}

/// Half of a face, on grids that have its border as a line, and on one that has not.
TEST(SelectPatches, OfHexahedraABorderIsALineOfTheGrid) {
  PatchRule half = boxed({-1, -1, -1}, {2, 3, 0});
  for (const Cells& cells : {Cells{2, 1, 1}, Cells{8, 3, 5}}) {
    Mesh block = block_mesh({4, 2, 2}, cells);
    EXPECT_TRUE(end_at_edges_of(block, {half}));
    select_whole_facets({half}, block);
    EXPECT_NEAR(nodal_areas(block, block.patches.back()).sum(), 4, 1e-12);
  }
  Mesh odd = block_mesh({4, 2, 2}, {7, 4, 4});
  EXPECT_FALSE(end_at_edges_of(odd, {half}));
  try {
    select_whole_facets({half}, odd);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the border of 'p' runs through 4 facets"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace springproof::select_patches_test
