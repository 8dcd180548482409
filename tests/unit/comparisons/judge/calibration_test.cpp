// Stated uncertainties held against known values.
#include "comparisons/judge/calibration.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace springproof::calibration_test {
namespace {

namespace fs = std::filesystem;

/// A case beside a table of these lines, with one force of 10 +- 1 N at each Poisson's ratio, element and kinematics.
struct Calibration : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  CaseResult result;

  void SetUp() override {
    fs::create_directories(folder);
    result.experiment.name = "cube";
    result.experiment.file = folder / "cube.toml";
    for (const double nu : {0.25, 0.4999})
      for (const char* element : {"q2", "p2"})
        result.references.push_back({nu, "force.top.z", "N", {}, {}, {}, 10, 1, "Richardson, GCI", element});
  }
  void TearDown() override { fs::remove_all(folder); }

  std::vector<KnownQuantity> with(const std::string& lines) {
    std::ofstream(folder / "known.csv") << "case,poisson_ratio,element,measure,value,uncertainty,where\n" << lines;
    return known_quantities(result);
  }
};

TEST_F(Calibration, NeedsATableBesideTheCase) {
  EXPECT_TRUE(known_quantities(result).empty());
  EXPECT_TRUE(calibration_json({}).is_null());
  EXPECT_EQ(calibration_table({}), "");
}

TEST_F(Calibration, CountsByKindOfReference) {
  const auto known = with(
      "cube,0.25,q2,force.top.z,10.5,0,a cube, in closed form\n"
      "cube,0.25,p2,force.top.z,12,0,the same\n"
      "cube,0.4999,q2,force.top.z,9.2,0.01,3 times finer\n"
      "sphere,0.25,q2,force.top.z,0,0,another case\n"
      "cube,0.25,q2,force.top.y,0,0,another measure\n");
  ASSERT_EQ(known.size(), 3u);
  EXPECT_EQ(known[0].where, "a cube, in closed form");
  EXPECT_TRUE(known[0].inside());
  EXPECT_FALSE(known[1].inside());
  const auto shares = calibration_shares(known);
  ASSERT_EQ(shares.size(), 4u);
  const char* kinds[] = {"hexahedra", "tetrahedra", "near-incompressible", "all"};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(shares[i].kind, kinds[i]);
  EXPECT_EQ(shares[3].quantities, 3);
  EXPECT_EQ(shares[3].inside, 2);
  EXPECT_NEAR(shares[3].median_ratio, 0.8, 1e-12);
  EXPECT_NEAR(shares[3].largest_ratio, 2, 1e-12);
  EXPECT_NE(
      calibration_table(known).find("outside: cube, nu = 0.25, p2, force.top.z: 10 +- 1.0e+00 N, known 12 (the same)"),
      std::string::npos);
  result.experiment.body.geo = "organ.stl";
  EXPECT_EQ(with("cube,0.25,p2,force.top.z,9.2,0,x\n").front().kind, "bodies in files");
  EXPECT_EQ(with("cube,0.4999,p2,force.top.z,9.2,0,x\n").front().kind, "near-incompressible");
  result.experiment.kinematics = "hencky";
  EXPECT_EQ(with("cube,0.4999,q2,force.top.z,9.2,0,x\n").front().kind, "finite strain");
}

TEST_F(Calibration, TakesReferencesInTimeFromTheRowsOfModelsInMotion) {
  result.references.clear();
  for (const char* model : {"hybmss in motion", "emsm in motion"}) {
    Row row;
    row.model = model;
    row.poisson_ratio = 0.25;
    row.measure = "motion.period";
    row.unit = "s";
    row.value = 1.3;  // the model's own
    row.reference = 1.2;
    row.reference_uncertainty = 0.1;
    result.rows.push_back(row);
  }
  const auto known = with("cube,0.25,q2,motion.period,1.25,0,two times finer\n");
  ASSERT_EQ(known.size(), 1u);
  EXPECT_EQ(known[0].kind, "in motion");
  EXPECT_EQ(known[0].value, 1.2);
  EXPECT_EQ(known[0].uncertainty, 0.1);
  result.experiment.body.voxel_counts = {100};
  EXPECT_EQ(with("cube,0.25,p2,motion.period,1.25,0,two times finer\n").size(), 1u);
}

TEST_F(Calibration, TakesFrequenciesAsRecordsOfTheirNumber) {
  result.references = {{0.25, "frequency.2", "Hz", {}, {}, {}, 440, 1, "Richardson, GCI", "p2"}};
  const auto known = with("cube,0.25,p2,frequency.2,440.5,0,Lamb\n");
  ASSERT_EQ(known.size(), 1u);
  EXPECT_EQ(known[0].kind, "frequencies");
  EXPECT_EQ(known[0].unit, "Hz");
}

TEST_F(Calibration, LeavesOutWhatIsKnownTooBadlyToJudge) {
  EXPECT_EQ(with("cube,0.25,q2,force.top.z,10.5,0.25,x\n").size(), 1u);
  EXPECT_EQ(with("cube,0.25,q2,force.top.z,10.5,0.26,x\n").size(), 0u);
  EXPECT_EQ(with("cube,0.25,q2,force.top.z,18,1.9,clearly outside all the same\n").size(), 1u);
}

TEST_F(Calibration, SaysWhatIsWrongWithATable) {
  const auto message = [&](const std::string& lines) -> std::string {
    try {
      with(lines);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message("cube,0.25,q2\n").find("known.csv:2:1: 3 columns"), std::string::npos);
  EXPECT_NE(message("cube,0.25,q2,force.top.z,ten,0,x\n").find("known.csv:2:1: value: 'ten' is no number"),
            std::string::npos);
  EXPECT_NE(message("cube,0.25,q2,force.top.z,nan,0,x\n").find("'nan' is no number"), std::string::npos);
}

}  // namespace
}  // namespace springproof::calibration_test
