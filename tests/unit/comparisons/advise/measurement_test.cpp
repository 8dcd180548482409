// The file of held-out errors.
#include "comparisons/advise/measure.h"

#include <gtest/gtest.h>

#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof::measurement_test {
namespace {

TEST(Measurements, AreReadBackAsWritten) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "measured.csv";
  write_measurements(file, {{"bar", 0.3, "springs", 8000, 0.0125, 1e-6}, {"bar", 0.4, "fem_q2", 1, 0.2, 0}});
  const std::vector<Measurement> read = read_measurements(file);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].case_name, "bar");
  EXPECT_EQ(read[1].model, "fem_q2");
  EXPECT_EQ(read[0].cells, 8000);
  EXPECT_DOUBLE_EQ(read[0].error, 0.0125);
  EXPECT_DOUBLE_EQ(read[0].uncertainty, 1e-6);
}

TEST(Measurements, RefuseALineThatIsNone) {
  const std::string heading = "# x\ncase,nu,model,cells,error,uncertainty\n";
  EXPECT_NO_THROW(parse_measurements(heading + "bar,0.3,emsm,2,0.1,0.01\n", "a.csv"));
  for (const char* bad : {"bar,0.3,emsm,2,0.1", "bar,0.3,emsm,2,0.1x,0.01", "bar"}) try {
      parse_measurements(heading + bad + "\n", "a.csv");
      FAIL() << bad;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("a.csv:3"), std::string::npos) << e.what();
    }
  EXPECT_THROW(parse_measurements("", "a.csv"), InputError);
}

}  // namespace
}  // namespace springproof::measurement_test
