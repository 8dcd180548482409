#include "comparisons/judge/line_measure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msm/models.h"

namespace springproof::line_measure_test {
namespace {

const KelvinSolution solution{{0, 3, 0}, {-1, -1, -1}, {100, 0.25, 1000}};

MassSpringModel block(const char* model, int cells) {
  return build_model(resolve({model, {}, model, {}}), block_mesh({1, 1, 1}, {cells, cells, cells}), solution.material);
}

LineRecord sampled(const MassSpringModel& model) {
  NodalVectors u(model.network.nodes(), 3);
  for (int n = 0; n < u.rows(); ++n)
    u.row(n) = kelvin_displacement(solution, model.network.X.row(n).transpose()).transpose();
  return sample_line({{0.3, 0.3, 0.3}, {0.7, 0.65, 0.6}, 10, {2, 9}}, solution, model, u);
}

/// Kelvin's displacement at the nodes, far from the force: the local fields are Kelvin's.
TEST(LineMeasure, LocalFieldsOfKelvinsDisplacementAreKelvins) {
  const LineRecord record = sampled(block("msm_18", 16));
  ASSERT_EQ(record.strain.size(), 60u);
  ASSERT_EQ(record.stress.size(), 60u);
  EXPECT_NEAR(record.distance.back(), std::sqrt(0.16 + 0.1225 + 0.09), 1e-14);
  const auto deviations = line_deviations(record);
  EXPECT_LE(deviations.at("line.strain.all"), 0.005);
  // Chords of parallel springs in a ball of two edges: LocalStress.OfAnAffineFieldIsTheContinuums has the bound.
  EXPECT_LE(deviations.at("line.stress.all"), 4 * 3 / std::pow(2 * M_PI * 2, 2));
}

TEST(LineMeasure, StressIsLeftOutWhereForcesAreNoTensions) {
  const LineRecord record = sampled(block("hybmss", 8));
  EXPECT_TRUE(record.stress.empty());
  EXPECT_FALSE(line_deviations(record).contains("line.stress.all"));
  EXPECT_TRUE(line_deviations(record).contains("line.strain.xy"));
}

/// Two points in the middle, one beside it; the yz component of the exact strain vanishes.
TEST(LineMeasure, DeviationsAreWhatTheySay) {
  LineRecord record;
  record.first = 2;
  record.last = 3;
  record.exact_strain = {9, 9, 9, 9, 9, 9, 2, 0, 1, 1, 0, 0, -4, 0, 1, 1, 0, 0};
  record.strain = record.exact_strain;
  record.strain[0] = 100;   // outside the middle
  record.strain[6] += 0.3;  // xx
  record.strain[12] -= 0.9;
  record.strain[6 + 4] = 0.7;  // yz
  const auto d = line_deviations(record);
  const double size = std::sqrt(4.0 + 1 + 2) + std::sqrt(16.0 + 1 + 2);
  EXPECT_NEAR(d.at("line.strain.xx"), (0.3 + 0.9) / 6, 1e-15);
  EXPECT_NEAR(d.at("line.strain.yz"), 0.7 / size, 1e-15);
  EXPECT_NEAR(d.at("line.strain.zz"), 0, 1e-15);
  EXPECT_NEAR(d.at("line.strain.all"), (std::sqrt(0.09 + 2 * 0.49) + 0.9) / size, 1e-15);
}

TEST(LineMeasure, OrdersCompareEachLatticeWithTheNextCoarser) {
  Experiment e;
  e.models = {{"msm_18", {}, "cubic", {}}};
  std::vector<Row> rows;
  for (const int n : {40, 20, 10}) {
    Row row;
    row.model = "cubic";
    row.cells = {n, n, n};
    row.measure = "line.strain.all";
    row.value = n == 10 ? 0.9 : 400.0 / (n * n * n);
    rows.push_back(row);
  }
  add_line_orders(e, rows);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[3].measure, "line.strain.order");
  EXPECT_EQ(rows[3].cells[0], 20);
  EXPECT_NEAR(rows[3].value, std::log2(0.9 / 0.05), 1e-12);
  EXPECT_EQ(rows[4].cells[0], 40);
  EXPECT_NEAR(rows[4].value, 3, 1e-12);
}

}  // namespace
}  // namespace springproof::line_measure_test
