// Tetrahedra are small where held patches end on a smooth surface.
#include "meshes/patches/rim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshes/locate/outer_facets.h"
#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "meshes/quality.h"
#include "meshes/volume.h"

namespace springproof::refined_rims_test {
namespace {

/// A unit cube of tetrahedra with a patch on its upper face.
Mesh cube_with(const std::string& name, const PatchRule::Box& box) {
  Mesh cube = mesh_geo(find_geo({"block.geo", {}, {}, {}}, "case.toml"), {1, 1, 1}, {4, 4, 4}, {.tetrahedra = true});
  PatchRule rule;
  rule.name = name;
  rule.box = box;
  select_patches({rule}, cube);
  return cube;
}

/// The square in the middle of the upper face, all of whose rim lies in that face.
Mesh cube_with_a_square() { return cube_with("square", {{0.25, 0.25, 1 - 1e-9}, {0.75, 0.75, 2}}); }

/// The longest edge of the facets with a corner on the square's rim.
double longest_at_rim(const Mesh& mesh) {
  double longest = 0;
  for (const OuterFacet& f : outer_facets(mesh)) {
    const auto X = [&](int c) -> Vec3 { return mesh.nodes.row(f.nodes[c % 3]).transpose(); };
    const auto on_rim = [&](const Vec3& x) {
      return x[2] > 1 - 1e-9 && std::abs(std::max(std::abs(x[0] - 0.5), std::abs(x[1] - 0.5)) - 0.25) < 1e-9;
    };
    const bool at_rim = on_rim(X(0)) || on_rim(X(1)) || on_rim(X(2));
    for (int c = 0; at_rim && c < 3; ++c) longest = std::max(longest, (X(c) - X(c + 1)).norm());
  }
  return longest;
}

TEST(RefinedRims, AreAsFineAsAskedFor) {
  Mesh mesh = cube_with_a_square();
  const Mesh before = mesh;
  refine_rims({"square"}, 0.05, mesh);
  EXPECT_GT(longest_at_rim(before), 0.2);
  EXPECT_LE(longest_at_rim(mesh), 0.05);
  EXPECT_GT(mesh.tetrahedra.size(), 5 * before.tetrahedra.size());
  EXPECT_LT(mesh.tetrahedra.size(), std::pow(0.25 / 0.05, 3) * double(before.tetrahedra.size()) / 2)
      << "not everywhere";
}

TEST(RefinedRims, TheBodyAndItsPatchesStay) {
  Mesh mesh = cube_with_a_square();
  const double worst = quality_of(mesh).worst;
  refine_rims({"square"}, 0.05, mesh);
  EXPECT_NEAR(volume(mesh, mesh.nodes), 1, 1e-12);
  EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "square")).sum(), 0.25, 1e-12);
  EXPECT_NEAR(nodal_areas(mesh, patch(mesh, "z_max")).sum(), 1, 1e-12);
  EXPECT_GT(quality_of(mesh).worst, 0.3 * worst);
}

TEST(RefinedRims, OfPatchesThatEndAtEdgesOfTheBodyStay) {
  Mesh mesh = cube_with("half", {{-1, -1, 1 - 1e-9}, {0.5, 2, 2}});
  const std::size_t before = mesh.tetrahedra.size();
  refine_rims({"half", "z_min", "no such patch"}, 0.05, mesh);
  EXPECT_EQ(mesh.tetrahedra.size(), before) << "two thirds of the half's rim are edges of the cube";
}

}  // namespace
}  // namespace springproof::refined_rims_test
