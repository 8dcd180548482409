// A body that dries, from its case to rows, curves, pictures and files.
#include "comparisons/models/fracture_run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "comparisons/results/crack_picture.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/sweep.h"
#include "problem/case_file/measures.h"

namespace springproof::fracture_run_test {
namespace {

namespace fs = std::filesystem;

std::string drying_block(const std::string& models, const std::string& shrinkage = "0.15") {
  return R"([body]
geo = "block.geo"
size_m = [12, 12, 4]
cells = [12, 12, 4]
[material]
youngs_modulus_Pa = 1
poisson_ratio = 0.25
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[fracture]
shrinkage = )" +
         shrinkage + R"(
steps = 30
depth_m = 1
threshold = 0.05
scatter = 0.1
apart = 2
seeds = 2
[compare]
models = [)" +
         models + R"(]
measures = ["fracture", "network"]
)";
}

PreparedCase prepared_block(const std::string& models, const std::string& shrinkage = "0.15") {
  return prepare(parse_experiment(drying_block(models, shrinkage), "case.toml"));
}

const Row* row_of(const Part& part, const std::string& model, const std::string& measure) {
  for (const Row& row : part.rows)
    if (row.model == model && row.measure == measure) return &row;
  return nullptr;
}

TEST(FractureRun, GivesEveryRowCurveAndFile) {
  const PreparedCase prepared = prepared_block("\"msm_18\", \"msm_centred\", \"msm_random\"");
  const fs::path folder = fs::temp_directory_path() / ("springproof-fracture-" + std::to_string(getpid()));
  const Part part = run_part(prepared, 0, {folder});
  ASSERT_EQ(part.runs.size(), 6u);
  for (const auto& run : part.runs) EXPECT_TRUE(run.ok) << run.message;
  ASSERT_EQ(part.cracks.size(), 3u);
  for (const CrackRecord& c : part.cracks) {
    for (const std::string& measure : rows_of_measure("fracture", prepared.experiment)) {
      const Row* row = row_of(part, c.model, measure);
      ASSERT_TRUE(row) << c.model << ' ' << measure;
      EXPECT_EQ(row->samples, 2);
    }
    EXPECT_LT(row_of(part, c.model, "fracture.imbalance")->value, 1e-6);
    EXPECT_EQ(c.shrinkage.size(), 20u);
    EXPECT_DOUBLE_EQ(c.shrinkage.back(), 0.15);
    EXPECT_NEAR(c.released.back(), row_of(part, c.model, "fracture.released")->value, 1e-12);
    EXPECT_NEAR(c.broken.back(), row_of(part, c.model, "fracture.broken")->value, 1e-12);
    EXPECT_GT(c.broken.back(), 0);
    EXPECT_TRUE(c.svg.starts_with("<svg "));
    EXPECT_TRUE(fs::exists(folder / (c.model + "_nu0.25_12x12x4.vtu")));
  }
  EXPECT_EQ(unit_of("fracture.released_per_area"), "J/m2");
  const fs::path file = folder / "part.cbor";
  save_part(file, "stamp", part);
  EXPECT_EQ(load_part(file, "stamp")->cracks.at(1).svg, part.cracks[1].svg);
  fs::remove_all(folder);
}

TEST(FractureRun, OfABodyThatDoesNotDryHasNoCrack) {
  const Part part = run_part(prepared_block("\"msm_centred\"", "0"), 0, {});
  EXPECT_EQ(row_of(part, "msm_centred", "fracture.broken")->value, 0);
  EXPECT_EQ(row_of(part, "msm_centred", "fracture.released")->value, 0);
  EXPECT_EQ(row_of(part, "msm_centred", "fracture.fragments")->value, 1);
  EXPECT_FALSE(row_of(part, "msm_centred", "fracture.first_shrinkage"));
  EXPECT_FALSE(row_of(part, "msm_centred", "fracture.along_4"));
}

TEST(FractureRun, RefusesModelsThatCannotBreak) {
  EXPECT_THROW(prepared_block("\"emsm\""), InputError);
  EXPECT_THROW(prepared_block("\"msm_hexagonal\""), InputError);
  EXPECT_THROW(prepared_block("{ model = \"msm_random\", seeds = 3 }"), InputError);
  EXPECT_THROW(prepared_block("{ model = \"msm_18\", hold_rigid_motions = true }"), InputError);
  EXPECT_THROW(prepared_block("{ model = \"msm_18\", turned_deg = 45 }"), InputError);
}

TEST(CrackPicture, DrawsSpringsAndCracksByAge) {
  const std::string svg = crack_svg({{0, 0, 2, 0}}, {{1, -1, 1, 1, 0}, {0, -1, 0, 1, 1}});
  EXPECT_NE(svg.find("stroke=\"#b4bcc5\" stroke-width=\"3\" d=\"M0 1000L2000 1000\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("stroke=\"#67000d\" stroke-width=\"7\" d=\"M1000 2000L1000 0\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("stroke=\"#fdae6b\" stroke-width=\"7\" d=\"M0 2000L0 0\""), std::string::npos) << svg;
  EXPECT_TRUE(crack_svg({}, {}).ends_with("</svg>\n"));
  for (const std::string& ours : {svg, crack_svg({}, {})}) EXPECT_TRUE(is_crack_svg(ours));
}

/// Whatever stands between what we write could run in the page that shows it.
TEST(CrackPicture, WithAnythingElseInItIsNone) {
  const std::string svg = crack_svg({{0, 0, 2, 0}}, {{1, -1, 1, 1, 0}, {0, -1, 0, 1, 1}});
  for (std::size_t at = 0; at <= svg.size(); ++at) {
    std::string other = svg;
    EXPECT_FALSE(is_crack_svg(other.insert(at, "<script>"))) << at;
  }
  EXPECT_FALSE(is_crack_svg(svg.substr(0, svg.size() - 1)));
  EXPECT_FALSE(is_crack_svg(""));
}

}  // namespace
}  // namespace springproof::fracture_run_test
