#include "comparisons/results/records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "problem/files/files.h"
#include "support/sample_case.h"

namespace springproof::results_test {
namespace {

using Json = nlohmann::json;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(ResultsCsv, ColumnsAreTheAgreedOnes) {
  EXPECT_EQ(to_csv({}),
            "case,kinematics,model,poisson_ratio,cells,measure,value,unit,reference,reference_uncertainty,error,"
            "samples,spread,published,published_where,listed\n");
}

TEST(ResultsCsv, RowKeepsEveryDigitAndLeavesUnknownEmpty) {
  CaseResult c;
  c.rows.push_back({{"emsm", -0.2, {24, 4, 4}}, "beam", "linear", "volume_change", 1.0 / 3, "1", 0.1 + 0.2, {}, {}});
  const auto lines = lines_of(to_csv({c}));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1], "beam,linear,emsm,-0.2,24x4x4,volume_change,0.3333333333333333,1,0.30000000000000004,,,1,,,,");
}

TEST(ResultsCsv, TextWithCommasQuotesAndLineBreaksIsQuoted) {
  CaseResult c;
  c.rows.push_back({{"say \"A=1\"", 0.25, {1, 1, 1}}, "a,b", "linear", "two\nlines", 1, "N", {}, {}, {}});
  EXPECT_NE(to_csv({c}).find("\n\"a,b\",linear,\"say \"\"A=1\"\"\",0.25,1x1x1,\"two\nlines\",1,N,,,,1,,,,\n"),
            std::string::npos);
}

TEST(ResultsCsv, NumbersThatAreNotFiniteAreEmpty) {
  CaseResult c;
  c.rows.push_back({{"m", 0.25, {1, 1, 1}}, "a", "linear", "x", std::nan(""), "N", INFINITY, {}, {}});
  EXPECT_EQ(lines_of(to_csv({c}))[1], "a,linear,m,0.25,1x1x1,x,,N,,,,1,,,,");
}

TEST(ResultsCsv, PrintedValuesStandBesideOursOrOnALineOfTheirOwn) {
  CaseResult c;
  c.experiment.name = "cube";
  c.experiment.kinematics = "linear";
  c.rows.push_back({{"m", 0.25, {1, 1, 1}}, "cube", "linear", "x", 1, "N", {}, {}, {}});
  c.rows.push_back({{"m", 0.25, {2, 2, 2}}, "cube", "linear", "x", 2, "N", {}, {}, {}});
  c.published.push_back({{"m", 0.25, {2, 2, 2}}, "x", "N", 2.5, 2, "Table 1, m", ""});
  c.published.push_back({{"lost", 0.25, {1, 1, 1}}, "x", "N", 3.5, {}, "Table 1", "no result"});
  c.checks.push_back({{"m", 0.25, {1, 1, 1}}, "x", "N", "published", 1.25, 1.0, 0.5, {}, Verdict::pass, "Fig. 2"});
  c.checks.push_back({{"m", 0.25, {1, 1, 1}}, "x", "N", "analytic", 7, 1.0, 0.5, {}, Verdict::fail, "nowhere"});
  const auto lines = lines_of(to_csv({c}));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[1], "cube,linear,m,0.25,1x1x1,x,1,N,,,,1,,1.25,Fig. 2,");
  EXPECT_EQ(lines[2], "cube,linear,m,0.25,2x2x2,x,2,N,,,,1,,2.5,\"Table 1, m\",");
  EXPECT_EQ(lines[3], "cube,linear,lost,0.25,1x1x1,x,,N,,,,1,,3.5,Table 1,");
}

TEST(CellsText, GridsAndTetrahedra) {
  EXPECT_EQ(cells_text({24, 4, 4}), "24x4x4");
  EXPECT_EQ(cells_text({24, 4, 4}, "×"), "24×4×4");
  EXPECT_EQ(cells_text({812, 0, 0}), "812 tets");
  EXPECT_EQ(cell_count({812, 0, 0}), 812);
  EXPECT_EQ(cell_count({24, 4, 4}), 384);
  CaseResult c;
  c.rows.push_back({{"fem_p1", 0.25, {812, 0, 0}}, "a", "linear", "x", 1, "N", {}, {}, {}});
  EXPECT_EQ(lines_of(to_csv({c}))[1], "a,linear,fem_p1,0.25,812 tets,x,1,N,,,,1,,,,");
}

TEST(DescribeLoad, PrescribedDisplacement) {
  EXPECT_EQ(describe(PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}), "x_min: held");
  EXPECT_EQ(describe(PrescribedDisplacement{"x_max", {0.12, 0.0, {}}}),
            "x_max: moved by 0.12 m in x, held in y, free in z");
  EXPECT_EQ(describe(PrescribedDisplacement{"z_min", {std::nullopt, std::nullopt, 0.0}}),
            "z_min: held in z, free in x and y");
}

TEST(DescribeLoad, RotationIsInDegrees) {
  PrescribedRotation load{"z_max", {0.5, 0.5, 1}, Vec3::UnitZ(), std::numbers::pi / 4};
  EXPECT_EQ(describe(load), "z_max: turned by 45 degrees about the axis (0, 0, 1) through (0.5, 0.5, 1) m");
}

TEST(DescribeLoad, AffineNamesTheRowsOfTheGradient) {
  PrescribedAffine load;
  load.on = "x_min";
  load.gradient << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  EXPECT_EQ(describe(load),
            "x_min: moved by u = A X + b with the rows of A (1, 2, 3) (4, 5, 6) (7, 8, 9) and b = (0, 0, 0) m");
}

TEST(DescribeLoad, ForcesCarryTheirUnits) {
  EXPECT_EQ(describe(Traction{"x_max", {1e3, 0, 0}}), "x_max: loaded by a traction of (1000, 0, 0) Pa");
  EXPECT_EQ(describe(Pressure{"inner", 120}), "inner: pressed by 120 Pa");
  EXPECT_EQ(describe(Pressure{"inner", 120}, Kinematics::finite),
            "inner: pressed by 120 Pa, a dead load: per area at rest, against the outward normals at rest");
  EXPECT_EQ(describe(PatchForce{"x_max", {0, 0, -2}}), "x_max: loaded by a total force of (0, 0, -2) N");
  EXPECT_EQ(describe(Gravity{{0, 0, -9.81}}), "whole body: gravity of (0, 0, -9.81) m/s²");
  EXPECT_EQ(describe(PointForce{{1, 2, 3}, {0, 4, 0}}), "point (1, 2, 3) m: loaded by a force of (0, 4, 0) N");
}

TEST(ResultsJson, ExperimentIsToldWithUnitsAndLabels) {
  const Json e = to_json(sample_case()).at("experiment");
  EXPECT_EQ(e.at("folder"), "golec_2019");
  EXPECT_EQ(e.at("body").at("cells"), Json::parse("[[1,1,1],[2,2,2]]"));
  EXPECT_EQ(e.at("materials").at(1).at("youngs_modulus"), 1e4);
  EXPECT_EQ(e.at("poisson_ratios"), Json::parse("[0.25,0.4]"));
  EXPECT_EQ(e.at("loads").at(1), "z_max: moved by -0.05 m in z, held in x and y");
  EXPECT_EQ(e.at("models").at(0).at("options").at("face_to_cube"), 1.0);
  EXPECT_TRUE(e.at("section").is_null());
}

TEST(ResultsJson, HoldsEveryRowRunReferenceCheckAndPublishedValue) {
  const Json json = to_json(sample_case());
  EXPECT_EQ(json.at("rows").size(), 32u);
  EXPECT_EQ(json.at("runs").size(), 5u);
  EXPECT_EQ(json.at("references").at(0).at("values"), Json::parse("[-0.02,-0.025,-0.0258]"));
  EXPECT_EQ(json.at("checks").at(1).at("verdict"), "fail");
  EXPECT_EQ(json.at("published").at(0).at("published"), -0.0261);
  EXPECT_FALSE(json.contains("pictures"));
}

TEST(ResultsJson, UnknownAndNotFiniteNumbersAreNull) {
  const Json json = Json::parse(to_json(sample_case()).dump());
  EXPECT_TRUE(json.at("rows").at(0).at("reference").is_null());
  EXPECT_TRUE(json.at("runs").at(4).at("residual").is_null());
}

TEST(ResultsJson, EveryVerdictHasItsWords) {
  EXPECT_EQ(to_string(Verdict::pass), "pass");
  EXPECT_EQ(to_string(Verdict::fail), "fail");
  EXPECT_EQ(to_string(Verdict::reference_too_coarse), "reference too coarse");
  EXPECT_EQ(to_string(Verdict::no_reference), "no reference");
  EXPECT_EQ(to_string(Verdict::no_result), "no result");
}

TEST(PicturesJson, ArraysAreLittleEndianBase64) {
  Picture p = sample_picture("hybmss", 0.25);
  p.rest = {1.0f, -2.0f, 0.0f, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0};  // 0000803f 000000c0 00000000 0000003f
  p.difference = {0, 127, 1.4f, std::nanf("")};                // 00 7f 01 80 at scale 1
  CaseResult c;
  c.pictures = {p};
  const Json json = pictures_to_json(c);
  const Json& mesh = json.at("meshes").at(0);
  EXPECT_EQ(mesh.at("rest").get<std::string>().substr(0, 20), "AACAPwAAAMAAAAAAAAAA");
  EXPECT_EQ(mesh.at("quads").at("type"), "uint16");
  EXPECT_EQ(mesh.at("quads").at("base64"), "AAABAAIAAwA=");  // 0000 0100 0200 0300
  const Json& difference = json.at("pictures").at(0).at("difference");
  EXPECT_EQ(difference.at("scale"), 1.0);
  EXPECT_EQ(difference.at("base64"), "AH8BgA==");
}

TEST(PicturesJson, DisplacementIsScaledToItsLargestComponent) {
  Picture p = sample_picture("fem", 0.25);
  p.displacement = {-0.5f, 0, 0, 0.25f, 0, 0, 0, 0, 0, 0, 0, 0};
  CaseResult c;
  c.pictures = {p};
  const Json u = pictures_to_json(c).at("pictures").at(0).at("displacement");
  EXPECT_DOUBLE_EQ(u.at("scale"), 0.5 / 32767);
  EXPECT_EQ(u.at("base64").get<std::string>().substr(0, 8), "AYAAAAAA");  // 0180 0000 0000: -32767, 0, 0
}

TEST(PicturesJson, VolumeChangeAndSurfaceAreTold) {
  CaseResult c;
  c.pictures = {sample_picture("fem", 0.25), sample_picture("fem", 0.25)};
  c.pictures[0].volume_change = {0, -0.5f, 0.5f, 0};
  c.pictures[0].surface = "smooth";
  c.pictures[1].volume_change.clear();
  const Json pictures = pictures_to_json(c).at("pictures");
  EXPECT_EQ(pictures.at(0).at("surface"), "smooth");
  EXPECT_DOUBLE_EQ(pictures.at(0).at("volume_change").at("scale"), 0.5 / 127);
  EXPECT_EQ(pictures.at(0).at("volume_change").at("base64"), "AIF/AA==");  // 0, -127, 127, 0
  EXPECT_EQ(pictures.at(1).at("surface"), "cells");
  EXPECT_EQ(pictures.at(1).at("volume_change").at("base64"), "");
}

TEST(PicturesJson, EqualSurfacesAreStoredOnce) {
  CaseResult c;
  c.pictures = {sample_picture("hybmss", 0.25), sample_picture("fem", 0.25), sample_picture("hybmss", 0.4)};
  c.pictures[2].rest[0] = -1;
  const Json json = pictures_to_json(c);
  EXPECT_EQ(json.at("meshes").size(), 2u);
  EXPECT_EQ(json.at("pictures").at(1).at("mesh"), 0);
  EXPECT_EQ(json.at("pictures").at(2).at("mesh"), 1);
  EXPECT_EQ(json.at("pictures").at(1).at("difference").at("base64"), "");
}

TEST(PicturesJson, PatchesOfLoadsAndTheirMarksAreTold) {
  CaseResult c = sample_case();
  c.pictures = {sample_picture("fem", 0.25)};
  c.pictures[0].patches = {{"z_max", {1, 3}}, {"x_min", {0}}};
  const Json json = pictures_to_json(c);
  EXPECT_EQ(json.at("meshes").at(0).at("patches"), Json::parse(R"({"z_max": [1, 3]})")) << "x_min is not loaded";
  EXPECT_EQ(json.at("marks").at(0).at("kind"), "held");
  EXPECT_EQ(json.at("marks").at(1).at("kind"), "moved");
  EXPECT_EQ(json.at("marks").at(1).at("vector"), Json::parse("[0, 0, -0.05]"));
}

TEST(LoadMarks, HaveAKindAndAVector) {
  EXPECT_EQ(mark(Pressure{"top", 12.0}).kind, "pressure");
  EXPECT_EQ(mark(Pressure{"top", 12.0}).vector.x(), 12);
  EXPECT_EQ(mark(Traction{"top", {1, 2, 3}}).vector, Vec3(1, 2, 3));
  EXPECT_EQ(mark(PointForce{{1, 2, 3}, {0, 4, 0}}).at, Vec3(1, 2, 3));
  EXPECT_EQ(mark(PrescribedRotation{"end", Vec3::Zero(), Vec3::UnitZ(), 0.5}).vector, Vec3(0, 0, 0.5));
  EXPECT_EQ(mark(FieldBodyForce{"trigonometric"}).kind, "");
}

TEST(PicturesJson, TrianglesRepeatTheirLastCorner) {
  CaseResult c;
  c.pictures = {sample_picture("fem", 0.25)};
  c.pictures[0].quads = {0, 1, 2, -1};
  EXPECT_EQ(pictures_to_json(c).at("meshes").at(0).at("quads").at("base64"), "AAABAAIAAgA=");
}

TEST(PicturesJson, ManyNodesNeedWiderNumbers) {
  CaseResult c;
  c.pictures = {sample_picture("fem", 0.25)};
  c.pictures[0].volume_change.clear();
  c.pictures[0].rest.resize(3 * 65537);
  c.pictures[0].displacement.resize(3 * 65537);
  c.pictures[0].quads = {65536, 0, 0, 0};
  const Json quads = pictures_to_json(c).at("meshes").at(0).at("quads");
  EXPECT_EQ(quads.at("type"), "uint32");
  EXPECT_EQ(quads.at("base64").get<std::string>().substr(0, 6), "AAABAA");  // 00000100 00...
}

TEST(PicturesJson, ArraysThatDoNotFitAreRefused) {
  CaseResult c;
  c.pictures = {sample_picture("fem", 0.25)};
  c.pictures[0].displacement.pop_back();
  EXPECT_THROW(pictures_to_json(c), std::invalid_argument);
  c.pictures = {sample_picture("fem", 0.25)};
  c.pictures[0].quads[2] = 4;
  EXPECT_THROW(pictures_to_json(c), std::invalid_argument);
  c.pictures = {sample_picture("hybmss", 0.25)};
  c.pictures[0].difference.pop_back();
  EXPECT_THROW(pictures_to_json(c), std::invalid_argument);
  c.pictures = {sample_picture("hybmss", 0.25)};
  c.pictures[0].volume_change = {0};
  EXPECT_THROW(pictures_to_json(c), std::invalid_argument);
}

class WriteFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::size_t entries() const {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  }
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      ("springproof_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(WriteFile, ReplacesWhatWasThere) {
  write_file(folder / "a.txt", "first, and longer");
  write_file(folder / "a.txt", "second");
  std::ifstream in(folder / "a.txt");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "second");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(WriteFile, FailureNamesTheFileAndLeavesNothing) {
  std::filesystem::create_directories(folder / "taken" / "inside");
  try {
    write_file(folder / "taken", "text");
    FAIL() << "a directory was replaced by a file";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("taken"), std::string::npos) << error.what();
  }
  EXPECT_EQ(entries(), 1u);
  EXPECT_THROW(write_file(folder / "no_such_folder" / "a.txt", "text"), std::runtime_error);
}

}  // namespace
}  // namespace springproof::results_test
