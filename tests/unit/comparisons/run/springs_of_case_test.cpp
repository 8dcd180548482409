// The springs that are exported.
#include "comparisons/run/springs_of_case.h"

#include <gtest/gtest.h>

#include "comparisons/run/prepare.h"
#include "problem/case_file/experiment.h"
#include "problem/system/child.h"
#include "problem/system/files.h"

namespace springproof::springs_of_case_test {
namespace {

// A quarter as high as wide: nodes at random leave parts of its surface without any.
constexpr const char* flat_tetrahedron = R"(solid flat
facet normal 0 0 -1 outer loop vertex 0 0 0 vertex 0 1 0 vertex 1 0 0 endloop endfacet
facet normal 0 -1 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex .2 .2 .25 endloop endfacet
facet normal -1 0 0 outer loop vertex 0 0 0 vertex .2 .2 .25 vertex 0 1 0 endloop endfacet
facet normal 1 1 1 outer loop vertex 1 0 0 vertex 0 1 0 vertex .2 .2 .25 endloop endfacet
endsolid flat
)";

TEST(SpringsOfCase, OfANetworkOnVerticesAreThoseThatCompareSolves) {
  const TemporaryFolder folder;
  write_file(folder.path / "flat.stl", flat_tetrahedron);
  const auto file = folder.path / "flat.toml";
  write_file(file, R"([body]
geo = "flat.stl"
voxels = 150
[[patch]]
name = "end"
beyond = { point_m = [0, 0.7, 0], normal = [0, 1, 0] }
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "end"
displacement_m = [0, 0, 0]
[compare]
models = ["emsm_patch"]
)");
  const PreparedCase prepared = prepare(read_experiment(file));
  const SpringsFile springs = springs_of(prepared);
  const Lattice& lattice = prepared.lattices.front();
  const Network solved =
      build_on(prepared, lattice, prepared.models.front(), prepared.experiment.materials.front(), false).model.network;
  ASSERT_TRUE(lattice.tetrahedra);
  EXPECT_EQ(springs.model.network.X, lattice.tetrahedra->nodes);
  ASSERT_EQ(springs.model.network.springs.size(), solved.springs.size());
  for (std::size_t s = 0; s < solved.springs.size(); ++s)
    EXPECT_EQ(springs.model.network.springs[s].stiffness, solved.springs[s].stiffness);
  EXPECT_FALSE(springs.patches.at("end").empty());
}

}  // namespace
}  // namespace springproof::springs_of_case_test
