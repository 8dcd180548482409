// [body] of voxels: what is read, written back, refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof::body_test {
namespace {

using test::message_of;

std::string case_with(const std::string& body, const std::string& reference = "") {
  return "[body]\n" + body + R"(
[material]
youngs_modulus_Pa = 1000
poisson_ratio = 0.3

[[load]]
on = "feet"
displacement_m = [0, 0, 0]

[compare]
models = ["hybmss"]
)" + reference;
}

Body body_of(const std::string& body) { return parse_experiment(case_with(body), "case.toml").body; }

TEST(VoxelBody, CountsAndEdgesAreRead) {
  const Body counts = body_of("geo = \"liver.stl\"\nscale = 0.001\nvoxels = [700, 5000]");
  EXPECT_EQ(counts.voxel_counts, (std::vector<int>{700, 5000}));
  EXPECT_EQ(counts.scale, 0.001);
  EXPECT_TRUE(counts.is_voxels());
  EXPECT_FALSE(body_of("geo = \"LIVER.STL\"\nvoxels = 700").is_script());
  const Body edges = body_of("geo = \"rabbit.geo\"\nsize_m = [1, 2, 3]\nvoxel_edge_m = 0.1");
  EXPECT_EQ(edges.voxel_edges, (std::vector<double>{0.1}));
  EXPECT_EQ(edges.size, Vec3(1, 2, 3));
  EXPECT_FALSE(body_of("geo = \"block.geo\"\nsize_m = [1, 2, 3]\ncells = [1, 2, 3]").is_voxels());
}

TEST(VoxelBody, AnAccuracyMakesOneLatticeEach) {
  const Body body = body_of("geo = \"a.stl\"\nvoxels = 300\naccuracy = [0.1, 0.05]");
  EXPECT_EQ(body.accuracies, (std::vector<double>{0.1, 0.05}));
  EXPECT_EQ(body.resolutions(), 2u);
  const Experiment e = parse_experiment(case_with("geo = \"a.stl\"\nvoxels = 300\naccuracy = 0.1"), "case.toml");
  EXPECT_NE(std::find(e.measures.begin(), e.measures.end(), "promised_error"), e.measures.end());
}

TEST(VoxelBody, MayHaveMeasuredCells) {
  EXPECT_FALSE(body_of("geo = \"a.stl\"\nvoxels = 300").coarsened);
  EXPECT_TRUE(body_of("geo = \"a.stl\"\nvoxels = [300, 900]\ncoarsened = true").coarsened);
}

TEST(VoxelBody, ItsReferenceIsOfQuadraticTetrahedra) {
  const std::string body = "geo = \"a.stl\"\nvoxels = 500";
  EXPECT_EQ(parse_experiment(case_with(body), "case.toml").reference.elements, (std::vector<std::string>{"p2"}));
  const ReferenceChoice r = parse_experiment(case_with(body, "[reference]\nedge_m = 0.02\n"), "case.toml").reference;
  EXPECT_EQ(r.elements, (std::vector<std::string>{"p2"}));
  EXPECT_EQ(r.edge, 0.02);
}

TEST(VoxelBody, MistakesAreRefused) {
  struct Mistake {
    std::string body, says;
  };
  for (const Mistake& m :
       {Mistake{"geo = \"a.stl\"",
                "body.cells: is missing (allowed: one of cells = [nx, ny, nz] (bodies of hexahedra), voxels"},
        Mistake{"geo = \"a.stl\"\nvoxels = 5\nvoxel_edge_m = 1", "says twice how fine the lattices are"},
        Mistake{"geo = \"a.stl\"\nvoxels = 0", "case.toml:3:10: body.voxels"},
        Mistake{"geo = \"a.stl\"\nvoxels = [5, 5]", "5 is named twice"},
        Mistake{"geo = \"a.stl\"\nvoxels = [5, 300.5]", "body.voxels: is 300.5 (allowed: a whole number from 1"},
        Mistake{"geo = \"a.stl\"\nsize_m = [1, 1, 1]\nvoxels = 5", "is a parameter of .geo scripts (allowed: scale"},
        Mistake{"geo = \"a.stl\"\nscale = -1\nvoxels = 5", "body.scale"},
        Mistake{"geo = \"a.geo\"\nsize_m = [1, 1, 1]\nscale = 2\nvoxels = 5", "is for files"},
        Mistake{"geo = \"a.geo\"\nvoxels = 5", "body.size_m: is missing"},
        Mistake{"geo = \"a.stl\"\nvoxels = 5\naccuracy = 0", "body.accuracy"},
        Mistake{"geo = \"a.stl\"\nvoxels = [5, 9]\naccuracy = 0.1", "starts from one lattice of cut cells"},
        Mistake{"geo = \"a.stl\"\nvoxels = 5\ncut = false\naccuracy = 0.1", "starts from one lattice of cut cells"},
        Mistake{"geo = \"a.stl\"\nvoxels = 5\ncut = false\ncoarsened = true",
                "body.coarsened: measures cut cells (allowed"},
        Mistake{"geo = \"block.geo\"\nsize_m = [1, 1, 1]\ncells = [1, 1, 1]\ncoarsened = true", "measures cut cells"},
        Mistake{"geo = \"a.stl\"\nvoxels = 5\naccuracy = 0.1\ncoarsened = true",
                "measures cells of one size, accuracy"},
        Mistake{"geo = \"a.stl\"\nvoxels = 5\ncoarsened = 1", "body.coarsened"},
        Mistake{"geo = \"a.stl\"\ncells = [2, 2, 2]", "is for bodies of hexahedra"}}) {
    const std::string message = message_of(case_with(m.body));
    EXPECT_NE(message.find(m.says), std::string::npos) << m.body << "\n" << message;
  }
  EXPECT_NE(message_of(case_with("geo = \"a.stl\"\nvoxels = 5", "[reference]\ncells = [4, 4, 4]\n"))
                .find("is for bodies of hexahedra"),
            std::string::npos);
}

}  // namespace
}  // namespace springproof::body_test
