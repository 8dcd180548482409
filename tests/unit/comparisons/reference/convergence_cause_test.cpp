// Where a reference does not converge, its cause and a remedy are named.
#include "comparisons/reference/reference_grids.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "comparisons/prepare/rims.h"
#include "comparisons/run/prepare.h"

namespace springproof::convergence_cause_test {
namespace {

std::string case_of(const std::string& body, const std::string& reference, double nu) {
  return fmt::format(R"([body]
{}
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = {}
[[load]]
on = "low"
displacement_m = [0, 0, 0]
[[load]]
on = "high"
force_N = [0, 0, 1]
[compare]
models = ["hybmss"]
measures = ["probe"]
[reference]
{}
)",
                     body, nu, reference);
}

constexpr const char* ball = R"(geo = "sphere.geo"
size_m = [1, 1, 1]
voxels = 200
[[patch]]
name = "low"
beyond = { point_m = [0.5, 0.5, 0.2], normal = [0, 0, -1] }
[[patch]]
name = "high"
facing = { direction = [0, 0, 1], within_deg = 30 }
[[probe]]
name = "rim"
at_m = [0.9, 0.5, 0.25]
[[probe]]
name = "middle"
at_m = [0.5, 0.5, 0.5]
)";

constexpr const char* plate = R"(geo = "block.geo"
size_m = [1, 1, 0.1]
voxels = 800
[[patch]]
name = "low"
beyond = { point_m = [0.2, 0, 0], normal = [-1, 0, 0] }
[[patch]]
name = "high"
beyond = { point_m = [0.8, 0, 0], normal = [1, 0, 0] }
[[probe]]
name = "middle"
at_m = [0.5, 0.5, 0.05]
)";

/// Grids of an element that have been solved with these numbers of cells.
ElementGrids grids_of(const std::string& element, const std::vector<Cells>& cells) {
  ElementGrids e{element, {}};
  for (const Cells& c : cells) e.grids.emplace_back().grid.cells = c;
  return e;
}

const std::vector<Cells> refined = {{1000, 0, 0}, {3400, 0, 0}, {11400, 0, 0}};

std::string cause(const PreparedCase& prepared, const ElementGrids& grids, const std::string& measure) {
  return cause_and_remedy(prepared, prepared.experiment.materials[0], grids, measure);
}

TEST(ConvergenceCause, OfABodyIsTheMeshTheElementTheRimOrTheSurface) {
  const PreparedCase prepared = prepare(parse_experiment(case_of(ball, "edge_m = 0.2", 0.45), "ball.toml"));
  const auto says = [&](const ElementGrids& grids, const std::string& measure, const std::string& words) {
    const std::string cause_given = cause(prepared, grids, measure);
    EXPECT_NE(cause_given.find(words), std::string::npos) << cause_given;
  };
  const ElementGrids p2 = grids_of("p2", refined);
  says(grids_of("p2", {{1000, 0, 0}, {1010, 0, 0}, {1100, 0, 0}}), "displacement.middle.z",
       "the surface sets the size");
  says(grids_of("p1", refined), "displacement.middle.z", "[reference] elements = [\"p2\"]");
  says(p2, "displacement.rim.z", "from the rim of patch 'low'");
  says(p2, "displacement.middle.z", "the surface differs from mesh to mesh");
  says(p2, "displacement_error", "[reference] edge_m = ");
}

// A plate a tenth as thick as it is wide.
TEST(ConvergenceCause, OfAThinBodyIsTheCoarsestMesh) {
  const auto of_plate = [](double edge) {
    const PreparedCase prepared =
        prepare(parse_experiment(case_of(plate, fmt::format("edge_m = {}", edge), 0.3), "plate.toml"));
    return cause(prepared, grids_of("p2", refined), "mean_displacement.high.z");
  };
  EXPECT_NE(of_plate(0.06).find("has one across parts of 0.083 m: [reference] edge_m = 0.0"), std::string::npos)
      << of_plate(0.06);
  EXPECT_EQ(of_plate(0.025).find("across parts"), std::string::npos) << of_plate(0.025);
}

TEST(ConvergenceCause, OfABlockIsTheGridOrTheRimOfTheSupport) {
  const char* block = "geo = \"block.geo\"\nsize_m = [1, 1, 4]\ncells = [1, 1, 4]";
  std::string text = case_of(block, "cells = [4, 4, 16]", 0.3);
  for (const auto& [from, to] : {std::pair("\"low\"", "\"z_min\""), std::pair("\"high\"", "\"z_max\"")})
    text.replace(text.find(from), std::string(from).size(), to);
  text.replace(text.find("\"probe\""), 7, "\"reaction\"");
  const PreparedCase prepared = prepare(parse_experiment(text, "block.toml"));
  EXPECT_EQ(cause(prepared, grids_of("q2", {{1, 1, 4}, {2, 2, 8}, {4, 4, 16}}), "force.z_min.z"),
            "the coarsest grid has one cell across: [reference] cells = [8, 8, 32]");
  EXPECT_EQ(cause(prepared, grids_of("q2", {{2, 2, 8}, {4, 4, 16}, {8, 8, 32}}), "force.z_min.z"),
            "stresses are singular at the rim of z_min: [reference] cells = [16, 16, 64]");
}

constexpr const char* half_faces = R"(geo = "block.geo"
size_m = [1, 1, 1]
voxels = 200
[[patch]]
name = "low"
facing = { direction = [0, 0, -1], within_deg = 5 }
[[patch]]
name = "high"
facing = { direction = [0, 0, 1], within_deg = 5 }
beyond = { point_m = [0.4, 0.5, 0.5], normal = [1, 0, 0] }
[[probe]]
name = "middle"
at_m = [0.5, 0.5, 0.5]
)";

TEST(Rims, OfPatchesByNormalsDifferOnCurvedBodiesOnly) {
  EXPECT_TRUE(ragged_patches(prepare(parse_experiment(case_of(half_faces, "edge_m = 0.2", 0.3), "faces.toml"))).empty())
      << "they end at edges of the body, and at a plane across its upper face";
  const PreparedCase prepared = prepare(parse_experiment(case_of(ball, "edge_m = 0.2", 0.3), "ball.toml"));
  EXPECT_EQ(ragged_patches(prepared), std::vector<std::string>{"high"});
  const auto near = rims_near(prepared, {{"side", Vec3(0.9, 0.5, 0.25)}, {"middle", Vec3(0.5, 0.5, 0.5)}});
  ASSERT_TRUE(near.at(0));
  EXPECT_EQ(near[0]->patch, "low");
  EXPECT_NEAR(near[0]->distance, 0.05, 0.03);
  EXPECT_FALSE(near.at(1));
}

}  // namespace
}  // namespace springproof::convergence_cause_test
