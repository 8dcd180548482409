// The springs that are exported.
#include "comparisons/prepare/springs_of_case.h"

#include <gtest/gtest.h>

#include "comparisons/run/prepare.h"
#include "problem/case_file/experiment.h"

namespace springproof::springs_of_case_test {
namespace {

TEST(SpringsOfCase, OfANetworkOnVerticesAreThoseThatCompareSolves) {
  const Experiment e = parse_experiment(R"([body]
geo = "l_bracket.geo"
size_m = [0.1, 0.05, 0.1]
voxels = 150
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "end"
displacement_m = [0, 0, 0]
[compare]
models = ["emsm_patch"]
)",
                                        "bracket.toml");
  const PreparedCase prepared = prepare(e);
  const SpringsFile springs = springs_of(prepared);
  const Lattice& lattice = prepared.lattices.front();
  const Network solved =
      build_on(prepared, lattice, prepared.models.front(), prepared.experiment.materials.front(), false).model.network;
  ASSERT_TRUE(lattice.tetrahedra);
  ASSERT_EQ(springs.model.network.X.rows(), lattice.tetrahedra->nodes.rows());
  EXPECT_EQ(springs.model.network.X, lattice.tetrahedra->nodes);
  ASSERT_EQ(springs.model.network.springs.size(), solved.springs.size());
  for (std::size_t s = 0; s < solved.springs.size(); ++s)
    EXPECT_EQ(springs.model.network.springs[s].stiffness, solved.springs[s].stiffness);
  EXPECT_FALSE(springs.patches.at("end").empty());
}

}  // namespace
}  // namespace springproof::springs_of_case_test
