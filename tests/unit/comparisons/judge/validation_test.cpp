// The table of ASME V&V 20 from rows whose limits and sensitivities are known.
#include "comparisons/judge/validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "comparisons/judge/judge.h"
#include "comparisons/judge/patch_mean.h"
#include "meshes/mesh.h"
#include "problem/case_file/measures.h"

namespace springproof::validation_test {
namespace {

constexpr double nu = 0.3;
const std::vector<Cells> lattices = {{4, 1, 1}, {8, 2, 2}, {16, 4, 4}};
constexpr double on_coarsest = 1 - 4.0 / 1000;  // of a value, by its limit

Row row(const std::string& model, const Cells& cells, const std::string& measure, double value) {
  Row r = of_run<Row>({model, nu, cells});
  r.measure = measure;
  r.value = value;
  return r;
}

/// On every lattice a value whose error is h, in cells of the finest, over 1000.
void add(const std::string& measure, double limit, std::vector<Row>& rows) {
  for (const Cells& cells : lattices) {
    rows.push_back(row("springs", cells, measure, limit * (1 - 16.0 / cells[0] / 1000)));
    rows.push_back(row("fem_q1", cells, measure, limit * (1 - 16.0 / cells[0] / 1000 + 0.0005)));
  }
}

MeasuredValue value(const std::string& name, const std::string& quantity, double D, double u) {
  return {.name = name, .quantity = quantity, .value = D, .u = u, .source = "here", .licence = "free"};
}

/// Two quantities, f fitted by E; "width" changes f by 2 % and q by 3 %, E by 1 % and 0.5 %.
CaseResult fitted_case() {
  CaseResult r;
  Experiment& e = r.experiment;
  e.models = {{"springs", {}, "springs", {}}};
  e.materials = {{1e5, nu, 1000}};
  e.body.cells = lattices;
  r.cells = lattices;
  e.load_cases = {{"loaded", {}}};
  e.inputs = {{"E", UncertainInput::Kind::fitted, {}},
              {"width", UncertainInput::Kind::uncertain, {}},
              {"law", UncertainInput::Kind::alternative, {}}};
  e.measured = {value("f", "displacement.a.z", 0.1, 0.004), value("q", "displacement.b.z", 2.1, 0.03)};
  e.measured[0].fitted = true;
  add("displacement.a.z", 0.1, r.rows);
  add("displacement.b.z", 2, r.rows);
  const auto changed = [&](const std::string& input, double f, double q) {
    VariedRun run{"loaded", input, {}, ""};
    for (const auto& [measure, factor] : {std::pair("displacement.a.z", f), std::pair("displacement.b.z", q)})
      for (const Row& before : std::vector<Row>(r.rows))
        if (before.model == "springs" && before.cells == lattices[0] && before.measure == measure)
          run.rows.push_back(row("springs", lattices[0], measure, before.value * factor));
    r.varied.push_back(run);
  };
  changed("E", 1.01, 1.005);
  changed("width", 1.02, 1.03);
  changed("law", 1, 1.01);
  return r;
}

TEST(Validation, HasTheLimitAndItsUncertaintyOfTheLattices) {
  CaseResult r = fitted_case();
  validate(r);
  const ValidatedValue& q = r.validation.at(1);
  EXPECT_NEAR(*q.simulated, 2, 1e-6);
  EXPECT_NEAR(*q.u_numerical, 1.25 * 0.002 / 2, 1e-5);  // a safety factor of 1.25, of the finest lattice's error
  EXPECT_NEAR(*q.resolution, -0.002, 1e-6);
  EXPECT_NEAR(*q.springs, -2 * 0.0005, 1e-9);
}

TEST(Validation, KeepsOfAnInputWhatTheFitDoesNotAnswerTo) {
  CaseResult r = fitted_case();
  validate(r);
  const ValidatedValue& q = r.validation.at(1);
  const double width = on_coarsest * 2 * (0.03 - 0.5 * 0.02), fit = 2 * 0.5 * 0.04;
  ASSERT_EQ(q.inputs.size(), 3u);
  EXPECT_NEAR(*q.inputs[0].change, width, 1e-9);
  EXPECT_NEAR(*q.inputs[1].change, on_coarsest * 2 * 0.01, 1e-9);
  EXPECT_TRUE(q.inputs[1].alternative);
  EXPECT_NEAR(*q.inputs[2].change, fit, 1e-9);
  EXPECT_NEAR(*q.u_input, std::hypot(width, fit), 1e-9);
  EXPECT_NEAR(*q.error, -0.1, 1e-6);
  EXPECT_NEAR(*q.ratio, -*q.error / std::sqrt(std::pow(*q.u_numerical, 2) + std::pow(*q.u_input, 2) + 0.03 * 0.03),
              1e-12);
  EXPECT_FALSE(r.validation.at(0).ratio) << "a value that was fitted to says nothing";
}

TEST(Validation, WithoutAFitKeepsTheWholeOfAnInput) {
  CaseResult r = fitted_case();
  r.experiment.inputs.erase(r.experiment.inputs.begin());
  r.experiment.measured[0].fitted = false;
  validate(r);
  EXPECT_NEAR(*r.validation.at(1).u_input, on_coarsest * 2 * 0.03, 1e-9);
  EXPECT_TRUE(r.validation.at(0).ratio);
}

TEST(Validation, SaysNothingOfOneLatticeAlone) {
  CaseResult r = fitted_case();
  std::erase_if(r.rows, [](const Row& one) { return one.cells != lattices[0]; });
  validate(r);
  EXPECT_TRUE(r.validation.at(1).simulated);
  EXPECT_FALSE(r.validation.at(1).ratio);
  EXPECT_EQ(r.validated, "1 not judged: q (u_num is unknown, for want of two lattices that differ).");
}

/// The run of the case with one input changed.
VariedRun& changed(CaseResult& r, const std::string& input) {
  return *std::find_if(r.varied.begin(), r.varied.end(), [&](const VariedRun& run) { return run.input == input; });
}

TEST(Validation, JudgesNothingOfWhichAChangedRunHasNoValue) {
  CaseResult r = fitted_case();
  VariedRun& wider = changed(r, "width");
  wider.rows.clear();
  wider.message = "springs: no equilibrium";
  validate(r);
  EXPECT_FALSE(r.validation.at(1).u_input);
  EXPECT_FALSE(r.validation.at(1).ratio);
  EXPECT_EQ(
      r.validated,
      "1 not judged: q (no value with 'width' changed). Without a result: 'loaded' with 'width' changed (springs: "
      "no equilibrium).");
}

TEST(Validation, NeedsNoAlternative) {
  CaseResult r = fitted_case();
  changed(r, "law").rows.clear();
  validate(r);
  EXPECT_FALSE(r.validation.at(1).inputs.at(1).change);
  EXPECT_TRUE(r.validation.at(1).ratio);
}

TEST(Validation, TakesChangedRunsWhateverTheirCellsAndLabels) {
  CaseResult r = fitted_case();
  for (Row& row : changed(r, "width").rows) row.cells = {5, 1, 1}, row.model = "springs, other";
  CaseResult same = fitted_case();
  validate(r);
  validate(same);
  EXPECT_EQ(r.validation.at(1).u_input, same.validation.at(1).u_input);
}

TEST(Validation, JudgesNothingBesideAFitThatHasNoEffect) {
  for (const double factor : {1.0, std::nan("")}) {
    CaseResult r = fitted_case();
    for (const Row& before : r.rows)
      if (before.model == "springs" && before.cells == lattices[0] && before.measure == "displacement.a.z")
        changed(r, "E").rows.at(0).value = before.value * factor;
    validate(r);
    EXPECT_FALSE(r.validation.at(1).ratio) << factor;
    EXPECT_EQ(r.validated, factor == 1 ? "1 not judged: q ('f' does not change with 'E', which was fitted to it)."
                                       : "1 not judged: q ('f' has no value with 'E' changed).");
  }
}

TEST(Validation, JudgesNothingWhoseUncertaintyIsNotFinite) {
  CaseResult r = fitted_case();
  r.experiment.measured[1].u = std::numeric_limits<double>::infinity();
  validate(r);
  EXPECT_FALSE(r.validation.at(1).ratio);
  EXPECT_EQ(r.validated, "1 not judged: q (E or u_val is not finite).");
}

TEST(Validation, JudgesNothingBesideAFitThatIsNone) {
  CaseResult r = fitted_case();
  r.experiment.measured[0].value = 0.1 + 2.1 * 0.004;
  validate(r);
  EXPECT_FALSE(r.validation.at(1).ratio);
  EXPECT_EQ(r.validated,
            "1 not judged: q ('E' is not fitted to 'f', from which the simulated value is 2.1 u_num and u_D away).");
}

TEST(Validation, MeasuresChangesNearZeroByTheirOwnSize) {
  CaseResult r = fitted_case();
  r.experiment.inputs.erase(r.experiment.inputs.begin());
  r.experiment.measured[0].fitted = false;
  for (Row& row : r.rows)  // through 0 between the coarsest lattice and the limit
    if (row.measure == "displacement.b.z") row.value -= 2 * on_coarsest;
  for (Row& row : changed(r, "width").rows)
    if (row.measure == "displacement.b.z") row.value = 0.06;
  validate(r);
  EXPECT_NEAR(*r.validation.at(1).u_input, 0.06, 1e-12);
}

TEST(Validation, ExtrapolatesTwoLatticesByTheRatioOfTheirCells) {
  for (const auto& [fine, ratio] : {std::pair(Cells{12, 3, 1}, 3.0), std::pair(Cells{8, 2, 2}, 2.0)}) {
    CaseResult r = fitted_case();
    r.rows = {row("springs", {4, 1, 1}, "displacement.b.z", 1 + ratio), row("springs", fine, "displacement.b.z", 2)};
    r.cells = {{4, 1, 1}, fine};
    r.experiment.inputs.clear();
    r.experiment.measured.erase(r.experiment.measured.begin());
    validate(r);
    EXPECT_NEAR(*r.validation.at(0).simulated, 1, 1e-12) << ratio;
    EXPECT_NEAR(*r.validation.at(0).u_numerical, 1.5, 1e-12) << ratio;
  }
}

TEST(Validation, FailsAnExpectationOnItsRatio) {
  for (const double D : {2.1, 2.4}) {
    CaseResult r = fitted_case();
    r.experiment.measured[1].value = D;
    Expectation expected;
    expected.model = "springs";
    expected.measure = "measured.q";
    expected.source = Source::measured;
    expected.value = 0;
    expected.within = 2;
    r.experiment.expectations = {expected};
    validate(r);
    judge(r);
    ASSERT_EQ(r.checks.size(), 1u);
    EXPECT_EQ(r.checks[0].verdict, D < 2.2 ? Verdict::pass : Verdict::fail) << D;
    EXPECT_NE(r.validated.find(D < 2.2 ? "1 of 1 predicted values lie within" : "0 of 1"), std::string::npos)
        << r.validated;
  }
}

TEST(Validation, CarriesAMarkerOnItsArm) {
  CaseResult r = fitted_case();
  r.experiment.inputs.clear();
  r.experiment.measured = {value("marker", "mean_displacement.x_max.z", -0.1, 0.01)};
  r.experiment.measured[0].arm = Vec3(0.5, 0, 0.2);
  r.rows.clear();
  for (const Cells& cells : lattices) {
    for (const char* axis : {"x", "z"}) r.rows.push_back(row("springs", cells, std::string("turn.x_max.") + axis, 0));
    r.rows.push_back(row("springs", cells, "turn.x_max.y", 30));
    r.rows.push_back(row("springs", cells, "mean_displacement.x_max.z", -0.1));
  }
  validate(r);
  EXPECT_NEAR(*r.validation.at(0).simulated, -0.1 - 0.5 * 0.5 + 0.2 * (std::sqrt(0.75) - 1), 1e-12);
}

TEST(PatchMean, TurnIsThatOfARotatedPatch) {
  const Mesh mesh = block_mesh({1, 0.3, 0.2}, {3, 2, 2});
  const std::vector<PatchSamples> patches = samples_of_patches(mesh);
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  const double degrees = 130;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(degrees * M_PI / 180, axis).toRotationMatrix();
  Eigen::Index count = 0;
  for (const PatchSamples& p : patches) count += p.points.rows();
  NodalVectors u(count, 3);
  Eigen::Index at = 0;
  for (const PatchSamples& p : patches)
    for (Eigen::Index i = 0; i < p.points.rows(); ++i, ++at) {
      const Vec3 X = p.points.row(i).transpose();
      u.row(at) = (R * X - X + Vec3(3, 0, 1)).transpose();
    }
  const auto turned = turns(patches, u);
  ASSERT_FALSE(patches.empty());
  for (const PatchSamples& p : patches)
    for (int d = 0; d < 3; ++d)
      EXPECT_NEAR(turned.at("turn." + p.patch + '.' + "xyz"[d]), degrees * axis[d], 1e-9) << p.patch;
}

}  // namespace
}  // namespace springproof::validation_test
