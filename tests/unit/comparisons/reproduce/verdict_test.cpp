
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "comparisons/report/report.h"
#include "comparisons/reproduce/reproduce.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"
#include "support/sample_case.h"

namespace springproof::verdict_test {
namespace {

namespace fs = std::filesystem;

/// A folder with the results of one case, "golec_2019/compress".
class ReproducedResults : public testing::Test {
 protected:
  void SetUp() override {
    result.experiment = sample_experiment();
    result.cells = {{1, 1, 1}};
    add("a", 0.25, 1.02, 1.0, {});
    add("a", 0.4, 1.2, 1.0, {});
    add("b", 0.25, 3, 2.0, 0.5);
  }

  void add(const std::string& model, double nu, double value, double reference, std::optional<double> spread) {
    result.rows.push_back(
        {{model, nu, {1, 1, 1}}, "compress", "linear", "x", value, "N", reference, 0.1, value - reference, 1, spread});
  }

  PaperResults read() const {
    const nlohmann::json document = {
        {"program", {{"version", "1"}}}, {"generated", "now"}, {"cases", {to_json(result)}}};
    write_file(folder.path / "results.json", document.dump());
    write_file(folder.path / "report.html", "<script type=\"application/json\" id=\"pictures-data\">" +
                                                script_json(nlohmann::json::array({pictures_to_json(result)})) +
                                                "</script>");
    return PaperResults({folder.path});
  }

  ClaimVerdict judged(Claim claim) const {
    claim.case_name = "golec_2019/compress";
    claim.measure = "x";
    PaperFigure figure{"3", "", {claim.case_name}, "because", {claim}};
    return judge_figure(read(), figure).claims.at(0);
  }

  TemporaryFolder folder;
  CaseResult result;
};

TEST_F(ReproducedResults, AClaimHoldsInPartOrNotAtAll) {
  EXPECT_EQ(judged({"near one", "", "", {"a"}, Claim::number, 1, 0.2000001}).holds, ClaimVerdict::yes);
  EXPECT_EQ(judged({"near one", "", "", {"a"}, Claim::number, 1, 0.05}).holds, ClaimVerdict::partly);
  EXPECT_EQ(judged({"near one", "", "", {"a"}, Claim::number, 1, 0.05}).numbers,
            "off by at most 20 % (allowed 5 %, ours), 1 of 2 are within");
  EXPECT_EQ(judged({"near one", "", "", {"a"}, Claim::number, 1, 0.01}).holds, ClaimVerdict::no);
  EXPECT_EQ(judged({"near FEM", "", "", {"b"}, Claim::finite_elements, 0, 0.5}).holds, ClaimVerdict::yes);
  EXPECT_EQ(judged({"nu", "", "", {"a"}, Claim::wanted_nu, 0, 0.1, false}).holds, ClaimVerdict::no);
}

TEST_F(ReproducedResults, WhatHasNoResultDoesNotAgree) {
  EXPECT_EQ(judged({"b at both", "", "", {"b"}, Claim::number, 3, 0.1, true, {0.25, 0.4}}).holds, ClaimVerdict::partly);
  EXPECT_EQ(judged({"c", "", "", {"c"}, Claim::number, 3, 0.1}).holds, ClaimVerdict::no);
  EXPECT_EQ(judged({"c", "", "", {"c"}, Claim::number, 3, 0.1}).numbers, "no result");
}

TEST_F(ReproducedResults, OrderAllowsForTheSpread) {
  EXPECT_EQ(judged({"a < b", "", "", {"a", "b"}, Claim::ascending, 0, 0, true, {0.25}}).holds, ClaimVerdict::yes);
  EXPECT_EQ(judged({"b < a", "", "", {"b", "a"}, Claim::ascending, 0, 0, true, {0.25}}).holds, ClaimVerdict::no);
  add("c", 0.25, 2.6, 2.0, {});
  EXPECT_EQ(judged({"b < c", "", "", {"b", "c"}, Claim::ascending, 0, 0, true, {0.25}}).holds, ClaimVerdict::yes);
  EXPECT_EQ(judged({"b as c", "", "", {"b", "c"}, Claim::similar, 0, 0.1, true, {0.25}}).holds, ClaimVerdict::no);
  EXPECT_EQ(judged({"b as c", "", "", {"b", "c"}, Claim::similar, 0, 0.2, true, {0.25}}).holds, ClaimVerdict::yes);
}

TEST_F(ReproducedResults, OneMeasureMayBeBoundedByTheSpanOfAnother) {
  for (const auto& [model, value] : {std::pair{"a", 1.0}, std::pair{"b", 2.0}})
    result.rows.push_back({{model, 0.25, {1, 1, 1}}, "compress", "linear", "y", value, "N", {}, {}, {}});
  Claim claim{"x spans less than y", "", "", {"a", "b"}, Claim::similar, 0, 0, true, {0.25}};
  claim.against = "y";
  EXPECT_EQ(judged(claim).holds, ClaimVerdict::no) << "3 over 1.02 is more than 2 over 1";
  result.rows.back().value = 3;
  EXPECT_EQ(judged(claim).holds, ClaimVerdict::yes);
}

TEST_F(ReproducedResults, WithoutANumberOfThePaperNothingIsJudged) {
  const PaperFigure figure{"3",
                           "",
                           {"golec_2019/compress"},
                           "",
                           {{"shown", "golec_2019/compress", "x", {"a"}, Claim::number, 0, -1, false}}};
  EXPECT_EQ(judge_figure(read(), figure).word, "drawn");
  EXPECT_EQ(judge_figure(read(), figure).sentence, "shown: at most 1.2 (not judged)");
}

TEST_F(ReproducedResults, ItIsSaidWhoseTheBoundIs) {
  const Claim claim{"near one", "", "", {"a"}, Claim::number, 1, 0.05};
  EXPECT_NE(judged(claim).numbers.find("(allowed 5 %, ours)"), std::string::npos);
  EXPECT_NE(judged(claim.by_the_paper()).numbers.find("(allowed 5 %, the paper's)"), std::string::npos);
  EXPECT_NE(judged(Claim{"b as a", "", "", {"a", "b"}, Claim::similar, 0, 0.1, true, {0.25}}.by_the_paper())
                .numbers.find("(allowed 10 %, the paper's)"),
            std::string::npos);
}

TEST_F(ReproducedResults, TheScatterBetweenRunsIsNoDistance) {
  const Claim spread{"runs differ", "", "", {"b"}};  // 3 +- 0.5
  EXPECT_EQ(judged(spread.scattering(0.17)).holds, ClaimVerdict::yes);
  EXPECT_EQ(judged(spread.scattering(0.16)).holds, ClaimVerdict::no);
  EXPECT_EQ(judged(spread.scattering(0.16)).numbers, "at most 17 % (allowed 16 %, ours)");
  EXPECT_EQ(judged(Claim{"one run", "", "", {"a"}}.scattering(1)).holds, ClaimVerdict::no) << "a single run has none";
}

TEST_F(ReproducedResults, WhatIsNotJudgedIsStillSaid) {
  PaperFigure figure{"3", "", {"golec_2019/compress"}, ""};
  const auto off_one = [](double within) {
    return Claim{"near one", "golec_2019/compress", "x", {"a"}, Claim::number, 1, within};
  };
  figure.claims = {off_one(0.01), off_one(-1)};
  EXPECT_EQ(judge_figure(read(), figure).word, "differs");
  EXPECT_EQ(judge_figure(read(), figure).sentence,
            "near one: off by at most 20 % (allowed 1 %, ours), 0 of 2 are within; near one: off by at most 20 % (not "
            "judged)");
}

TEST_F(ReproducedResults, NoReasonWhyAPrintedValueDiffersStandsBesideOneThatAgrees) {
  result.published.push_back({{"a", 0.25, {1, 1, 1}}, "x", "N", 1.0, 1.001, "Table 2, a", "depends on the steps"});
  result.published.push_back({{"a", 0.4, {1, 1, 1}}, "x", "N", 1.1, 1.2, "Table 2, a", "depends on the steps"});
  PaperFigure figure{"table2", "", {"golec_2019/compress"}, ""};
  figure.last_digit = 0.01;
  const FigureVerdict verdict = judge_figure(read(), figure);
  ASSERT_EQ(verdict.values.size(), 2u);
  EXPECT_EQ(verdict.values[0].value.remark, "");
  EXPECT_EQ(verdict.values[1].value.remark, "depends on the steps");
}

TEST_F(ReproducedResults, PrintedValuesAgreeWithinTwoPerCentOrTheirLastDigit) {
  result.published.push_back({{"a", 0.25, {1, 1, 1}}, "x", "N", 1.0, 1.019, "Table 2, a", ""});
  result.published.push_back({{"a", 0.4, {1, 1, 1}}, "x", "N", 1.1, 1.2, "Table 2, a", "too far"});
  result.published.push_back({{"a", 0.4, {1, 1, 1}}, "x", "N", 1.2, 1.2, "Table 21", "of another table"});
  result.checks.push_back(
      {{"b", 0.25, {1, 1, 1}}, "x", "N", "published", 2.91, 3.0, 0.5, {}, Verdict::pass, "Table 2, b"});
  PaperFigure figure{"table2", "", {"golec_2019/compress"}, ""};
  figure.last_digit = 0.01;
  const FigureVerdict strict = judge_figure(read(), figure);
  ASSERT_EQ(strict.values.size(), 3u);
  EXPECT_EQ(strict.sentence, "1 of 3 printed values");
  figure.last_digit = 0.1;
  EXPECT_EQ(judge_figure(read(), figure).word, "agrees");
}

TEST_F(ReproducedResults, FiguresOfCasesThatWereNotRunSaySo) {
  PaperFigure figure{"3", "", {"golec_2019/compress", "golec_2019/lost"}, ""};
  EXPECT_EQ(judge_figure(read(), figure).word, "not run");
  figure.cases.clear();
  EXPECT_EQ(judge_figure(read(), figure).word, "not redone");
}

TEST_F(ReproducedResults, ShapesComeBackFromTheReport) {
  result.pictures = {sample_picture("a", 0.25)};
  const PaperResults results = read();
  const std::optional<Shape> shape = results.shape("golec_2019/compress", "a", 0.25);
  ASSERT_TRUE(shape);
  ASSERT_EQ(shape->rest.size(), 4u);
  EXPECT_NEAR((shape->displaced[2] - Vec3(1.1, 1, 0)).norm(), 0, 1e-5);
  EXPECT_EQ(shape->facets, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}}));
  EXPECT_FALSE(results.shape("golec_2019/compress", "a", 0.4));
  const std::vector<Vec3> outline = layer_outline(*shape, 2, {0, 0, 0});
  ASSERT_EQ(outline.size(), 4u);
  EXPECT_NEAR(outline[0].x(), 0.1, 1e-5) << "in order of the angle, from -180 degrees on";
  EXPECT_NEAR(outline[1].x(), 1.1, 1e-5);
  const std::string svg = bodies_svg({{"a", "", shape}, {"lost", "", {}, "no equilibrium"}}, 2, {{0, 0, 1}, {0, 1, 0}});
  EXPECT_NE(svg.find("<polygon"), std::string::npos);
  EXPECT_NE(svg.find("no equilibrium"), std::string::npos);
}

TEST(LayerOutline, IsOfTheNodesInThePlaneInOrderAroundItsMiddle) {
  Shape shape;
  shape.rest = {{1, 1, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
  for (const Vec3& p : shape.rest) shape.displaced.push_back(p + Vec3(2, 0, 0));
  const std::vector<Vec3> outline = layer_outline(shape, 2, {0, 0, 0});
  ASSERT_EQ(outline.size(), 4u);
  EXPECT_EQ(outline[0], Vec3(2, 0, 0));
  EXPECT_EQ(outline[1], Vec3(3, 0, 0));
  EXPECT_EQ(outline[2], Vec3(3, 1, 0));
  EXPECT_EQ(outline[3], Vec3(2, 1, 0));
}

TEST_F(ReproducedResults, ADamagedReportIsAnInputError) {
  const PaperResults results = read();
  write_file(folder.path / "report.html", "<html></html>");
  EXPECT_THROW(results.shape("golec_2019/compress", "a", 0.25), InputError);
  EXPECT_THROW(PaperResults({folder.path / "nowhere"}), InputError);
}

TEST_F(ReproducedResults, ThePageAndTheFilesAreWritten) {
  PaperFigure figure{"3",
                     "a < b",
                     {"golec_2019/compress"},
                     "because of <this>",
                     {{"near", "golec_2019/compress", "x", {"a"}, Claim::number, 1, 0.01}}};
  figure.charts = [](const PaperResults&) {
    return std::vector<Chart>{{"", "x", "y", {{"ours", CurveStyle::ours, {{0, 0}, {1, 2}}}}}};
  };
  const PaperResults results = read();
  const Paper paper{"golec_2019", "Golec et al. (2019)", "cite", {figure}};
  write_figures({draw_figure(results, figure)}, paper, folder.path / "out");
  EXPECT_TRUE(fs::exists(folder.path / "out/figures/fig_3.svg"));
  EXPECT_EQ(text_of_file(folder.path / "out/figures/fig_3.csv"), "x,ours\n0,0\n1,2\n");
  const std::string page = text_of_file(folder.path / "out/reproduce.html");
  EXPECT_NE(page.find("a &lt; b"), std::string::npos);
  EXPECT_NE(page.find("because of &lt;this&gt;"), std::string::npos);
  EXPECT_NE(page.find("<span class=\"chip fail\">differs</span>"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("http://") == page.find("http://www.w3.org/2000/svg"), true) << "nothing else is referred to";
}

}  // namespace
}  // namespace springproof::verdict_test
