// Predictions from measurements alone.
#include "comparisons/advise/table_prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "problem/system/input_error.h"

namespace springproof::table_prediction_test {
namespace {

/// Errors c (1 + nu) n^-order of a model in bending.
std::vector<Measurement> measured_law(double order, const std::vector<double>& ratios) {
  std::vector<Measurement> all;
  for (const double slenderness : {4.0, 16.0})
    for (const double nu : ratios)
      for (const int n : {2, 4, 8})
        all.push_back({"bending", "block", slenderness, 0, nu, "springs", double(n),
                       0.1 * slenderness * std::pow(n, -order), 1e-6});
  return all;
}

TEST(ErrorTable, FollowsALawBetweenAndBeyondTheMeasurements) {
  const auto all = measured_law(1.5, {0.0, 0.3, 0.45});
  for (const double n : {2.0, 3.0, 6.0, 16.0}) {
    const auto p = predict(all, {"bending", "block", 8, 0}, "springs", 0.4, n);
    ASSERT_TRUE(p);
    EXPECT_NEAR(p->error, 0.8 * std::pow(n, -1.5), 1e-6) << n;
    EXPECT_EQ(p->beyond, n > 8) << n;
    EXPECT_NEAR(p->factor, p->beyond ? 1.5 : 1, 1e-6);
  }
}

TEST(ErrorTable, SaysWhatWasNotMeasured) {
  const auto all = measured_law(1, {0.0, 0.3});
  EXPECT_FALSE(predict(all, {"torsion", "block", 8, 0}, "springs", 0.2, 4));
  EXPECT_FALSE(predict(all, {"bending", "block", 8, 0}, "others", 0.2, 4));
  EXPECT_FALSE(predict(all, {"bending", "block", 8, 0.2}, "springs", 0.2, 4));
  EXPECT_TRUE(predict(all, {"bending", "block", 8, 0}, "springs", 0.4, 4)->beyond);   // a Poisson's ratio outside
  EXPECT_TRUE(predict(all, {"bending", "block", 30, 0}, "springs", 0.2, 4)->beyond);  // a slenderness outside
  EXPECT_FALSE(predict(all, {"bending", "block", 10, 0}, "springs", 0.2, 4)->beyond);
}

TEST(ErrorTable, StatesASpreadFromWhatItMissesOfItsOwnMeasurements) {
  auto all = measured_law(1, {0.0, 0.2, 0.3, 0.4});
  for (std::size_t i = 0; i < all.size(); ++i) all[i].error *= i % 2 ? 1.4 : 1 / 1.4;
  const auto p = predict(all, {"bending", "block", 4, 0}, "springs", 0.25, 4);
  EXPECT_GT(p->factor, 1.4);
  EXPECT_LT(p->factor, 2.1);
}

TEST(Measurements, AreReadBackAsWritten) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "springproof-measured.csv";
  write_measurements(file, {" Made by a test.\n", measured_law(1, {0.3})});
  const MeasuredFile read = read_measurements(file);
  EXPECT_EQ(read.header, " Made by a test.\n");
  ASSERT_EQ(read.rows.size(), 6U);
  EXPECT_EQ(read.rows[5].model, "springs");
  EXPECT_DOUBLE_EQ(read.rows[5].error, 0.2);
  std::filesystem::remove(file);
}

TEST(Measurements, RefuseALineThatIsNone) {
  const std::string heading = "# x\nload,body,slenderness,strain,nu,model,cells_across,error,uncertainty\n";
  EXPECT_NO_THROW(parse_measurements(heading + "axial,block,1,0,0.3,emsm,2,0.1,0.01\n", "a.csv"));
  for (const char* bad : {"axial,block,1,0,0.3,emsm,2,0.1", "axial,block,1,0,0.3,emsm,2,0.1x,0.01", "axial"}) try {
      parse_measurements(heading + bad + "\n", "a.csv");
      FAIL() << bad;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("a.csv:3"), std::string::npos) << e.what();
    }
  EXPECT_THROW(parse_measurements("", "a.csv"), InputError);
}

}  // namespace
}  // namespace springproof::table_prediction_test
