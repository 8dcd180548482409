#include "comparisons/report/report.h"

#include <algorithm>

#include "support/sample_case.h"
#include "unit/comparisons/report/report_page.h"

namespace springproof::report_test {
namespace {

using Json = nlohmann::json;

/// Everything a case file could use to break out of its place.
CaseResult hostile_case() {
  CaseResult c = sample_case();
  c.experiment.what =
      "</script><script>document.title = 'owned'</script><img src=x onerror=\"document.title='owned'\"> & "
      "@results@";
  c.experiment.cite = "<!-- <script> --> \xff not UTF-8";
  c.experiment.text = "what = '</script>'\n";
  c.runs.back().message = "<b id=injected>1 < 2</b>";
  c.checks[0].where = "</td></table><b id=injected>";
  return c;
}

/// Text between `from` and the next `to`.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto begin = text.find(from);
  if (begin == std::string::npos) return "";
  return text.substr(begin + from.size(), text.find(to, begin) - begin - from.size());
}

TEST_F(Report, CarriesItsLibrariesOnce) {
  const std::string page = write({sample_case()});
  EXPECT_EQ(count(page, "Chart.js v3"), 1u);
  EXPECT_EQ(count(page, "three.js authors"), 1u);
  EXPECT_EQ(count(page, "exports.OrbitControls"), 1u);
  EXPECT_GT(page.size(), 1'000'000u);
  EXPECT_LT(page.size(), 1'500'000u);
}

TEST_F(Report, RefersToNothingOutside) {
  const std::string page = write({hostile_case()});
  std::string markup = page.substr(0, page.find("<script"));
  for (std::size_t style; (style = markup.find("<style>")) != std::string::npos;)  // std::regex recurses per character
    markup.erase(style, markup.find("</style>", style) - style);
  EXPECT_EQ(markup.find("://"), std::string::npos) << "the markup names an address";
  EXPECT_EQ(count(page, "<script src"), 0u);
  EXPECT_EQ(between(page, "<style>", "</style>").find("url("), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos) << "the browser is not told to refuse the network";
}

/// The rows of a case as they are in results.json, from the page's table of them.
Json unpacked(Json rows) {
  Json out = Json::array();
  const auto& named = rows.at("named");
  for (const Json& line : rows.at("values")) {
    Json row = {{"case_name", "compress"}};
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string column = rows.at("columns").at(i);
      const bool is_named = std::find(named.begin(), named.end(), column) != named.end();
      row[column] = is_named ? rows.at("words").at(line.at(i).get<std::size_t>()) : line.at(i);
    }
    out.push_back(row);
  }
  return out;
}

TEST_F(Report, HoldsTheDocumentsAsTheyWere) {
  const std::vector<CaseResult> cases = {sample_case()};
  const std::string page = write(cases);
  Json held = Json::parse(between(page, "id=\"results-data\">", "</script>"));
  held["cases"][0]["rows"] = unpacked(held["cases"][0]["rows"]);
  EXPECT_EQ(held.at("measures").at("volume_change").at("title"), "volume change");
  EXPECT_EQ(held.at("motion_measures").at(0).at(0), "period");
  for (const char* table : {"measures", "motion_measures"}) held.erase(table);
  EXPECT_EQ(held, Json::parse(document(cases).dump()));
  EXPECT_EQ(Json::parse(between(page, "id=\"pictures-data\">", "</script>")), pictures(cases));
}

TEST_F(Report, TextCannotLeaveItsPlace) {
  const std::string page = write({hostile_case()}), plain = write({sample_case()});
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
  EXPECT_EQ(count(page, "<script"), count(plain, "<script"));
  const Json data = Json::parse(between(page, "id=\"results-data\">", "</script>"));
  EXPECT_EQ(data.at("cases").at(0).at("experiment").at("what"), hostile_case().experiment.what);
  EXPECT_EQ(page.find("<b id=injected"), std::string::npos) << "in the head, which is written as HTML";
}

TEST_F(Report, TheVerdictNeedsNoScript) {
  const std::string page = write({sample_case()});
  const std::string head = page.substr(0, page.find("<script"));
  EXPECT_NE(head.find("displacement within 2 % of FEM for ν from 0.25 to 0.4 (worst: compress at ν = 0.4)"),
            std::string::npos);
  EXPECT_NE(head.find("compress: emsm at ν = 0.4, 2×2×2 cells: diverged at load 0.3"), std::string::npos);
  EXPECT_NE(head.find("1 hold"), std::string::npos);
  EXPECT_NE(head.find("1 fail"), std::string::npos);
}

TEST_F(Report, AFolderThatIsNotThereIsAnError) {
  EXPECT_THROW(write_report("no_such_folder/report.html", headline({}), document({}), Json::array()),
               std::runtime_error);
}

// ---- in a browser, where there is one

TEST_F(ReportInBrowser, ShowsTheCase) {
  CaseResult sample = sample_case();
  sample.notes = {"4439 cells promise 5.3 %; 6 % were asked for"};
  const std::string dom = open({sample}, "#case-golec_2019-compress");
  expect_no_complaint(dom);
  const std::string body = dom.substr(dom.find("<main>"), dom.find("</main>") - dom.find("<main>"));
  EXPECT_EQ(count(body, "<canvas"), 5u) << "three figures, the deformed shapes, the picture of the case";
  EXPECT_EQ(count(body, "class=\"panel\""), 6u) << "undeformed, FEM and hybmss; problem, FEM and hybmss";
  EXPECT_NE(body.find("<td class=\"number tint2\">2.0 %<small>ν = 0.4</small>"), std::string::npos) << "table of cases";
  EXPECT_NE(body.find("z_max: moved by -0.05 m in z"), std::string::npos) << "problem";
  EXPECT_NE(body.find("<li>4439 cells promise 5.3 %; 6 % were asked for</li>"), std::string::npos)
      << "meshes and cells";
  EXPECT_NE(body.find("<td class=\"number\">2.60</td>"), std::string::npos) << "observed order of the reference";
  EXPECT_NE(body.find("<td class=\"number\">≤ 1 %</td>"), std::string::npos) << "expectation";
  EXPECT_NE(body.find("force on z_min, magnitude [N]"), std::string::npos) << "results";
  EXPECT_NE(body.find("Measures that vanish here or repeat another in size: 5"), std::string::npos)
      << "both x components, z of z_min, magnitude and z of z_max";
  EXPECT_NE(body.find("510.00<small>+2.0 %</small>"), std::string::npos) << "value and its error";
  EXPECT_NE(body.find("explicit run, not settled"), std::string::npos) << "published value";
}

/// Springs that are cheaper to 3 %, and elements that alone reach 1 %.
CaseResult timed_case() {
  CaseResult c;
  c.experiment = sample_experiment();
  c.experiment.cost = true;
  for (int n : {1, 2}) {
    const double tenfold = n == 1 ? 1 : 10;
    const auto add = [&](const char* model, const char* kind, double cost, double error) {
      const RunKey key{model, 0.25, {n, n, n}};
      const long unknowns = std::lround(1e5 * cost);
      c.runs.push_back({key, kind, "linear", true, "", "CG", 9, 1e-9, 0.8 * cost, unknowns, 1, 0.2 * cost});
      c.rows.push_back({key, "compress", "linear", "displacement_error", error, "1", {}, 0.001, error});
    };
    add("hybmss", "msm", 0.001 * tenfold, 0.2 / tenfold);
    add("fem_q2", "fem", 0.01 * tenfold, 0.05 / tenfold);
  }
  return c;
}

TEST_F(ReportInBrowser, SetsErrorsAgainstCost) {
  const std::string dom = open({timed_case()});
  expect_no_complaint(dom);
  const std::string part = between(dom, "<section id=\"cost\"", "<section id=\"splits\"");
  EXPECT_EQ(count(part, "<canvas"), 2u) << "against time, against unknowns";
  // On straight lines in logarithms: 1 ms * 20/3 at 100 * 20/3 unknowns, and 10 ms * 5/3.
  EXPECT_NE(part.find("hybmss</span><small>6.7 ms, 670 unknowns</small>"), std::string::npos) << "3 %";
  EXPECT_NE(part.find("fem_q2: 17 ms, 1700 unknowns</small>"), std::string::npos) << "3 %, beside it";
  EXPECT_NE(part.find("fem_q2</span><small>50 ms, 5000 unknowns</small><small>no springs do</small>"),
            std::string::npos)
      << "1 %";
  EXPECT_NE(part.find("<td>–</td></tr>"), std::string::npos) << "0.3 %: no one does";
}

TEST_F(ReportInBrowser, SetsReactionsBesideDisplacementsWhereASupportMoves) {
  CaseResult c = timed_case();
  for (int n : {1, 2})
    for (const auto& [model, error] : {std::pair("hybmss", 0.8), std::pair("fem_q2", 0.4)})
      c.rows.push_back(
          {{model, 0.25, {n, n, n}}, "compress", "linear", "reaction_error", error / n, "1", 0.0, 0.001, error / n});
  const std::string dom = open({c});
  expect_no_complaint(dom);
  const std::string part = between(dom, "<section id=\"cost\"", "<section id=\"splits\"");
  EXPECT_NE(part.find("<small>displacement</small>"), std::string::npos);
  EXPECT_NE(part.find("<small>reactions</small></td><td>0.25</td><td>–</td>"), std::string::npos)
      << "20 % and 40 %: none to 10 %";
  const std::string table = between(dom, "<section id=\"cases\"", "<section id=\"shapes\"");
  EXPECT_NE(table.find("<small>reactions 40 %</small>"), std::string::npos);
  EXPECT_NE(table.find("number tint4\">"), std::string::npos) << "by the worse of both: " << table;
}

TEST_F(ReportInBrowser, NamesNoModelOffItsOwnPoissonsRatioAsCheapest) {
  CaseResult c = timed_case();
  c.own_poisson_ratios["hybmss"] = 0.3;
  const std::string dom = open({c});
  expect_no_complaint(dom);
  const std::string part = between(dom, "<section id=\"cost\"", "<section id=\"splits\"");
  EXPECT_EQ(part.find("hybmss</span><small>6.7 ms"), std::string::npos);
  EXPECT_NE(part.find("fem_q2</span><small>17 ms, 1700 unknowns</small><small>no springs do</small>"),
            std::string::npos);
}

TEST_F(ReportInBrowser, StatesHowFarTheReferenceIsDeformed) {
  CaseResult c = sample_case();
  c.deformations = {{0.25, 0.02, 3.5}, {0.4, 0.08, 6.5}};
  const std::string dom = open({c}, "#case-golec_2019-compress");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("<td class=\"number\">2.0 %</td><td class=\"number\">3.5°</td>"), std::string::npos);
  EXPECT_NE(dom.find("<td class=\"number coarse\">8.0 %</td><td class=\"number coarse\">6.5°</td>"), std::string::npos);
  EXPECT_NE(dom.find("<span class=\"amber\">compress: principal strains of 8 % and rotations of 6.5° are too large for "
                     "linear theory (up to 5 % and 5°); divide the load by at least 1.6, or set"),
            std::string::npos);
}

TEST_F(ReportInBrowser, WithoutTimesThereIsNoCost) {
  EXPECT_NE(open({sample_case()}).find("<section id=\"cost\" hidden"), std::string::npos);
}

TEST_F(ReportInBrowser, HostileTextIsOnlyText) {
  const std::string dom = open({hostile_case()}, "#case-golec_2019-compress");
  expect_no_complaint(dom);
  EXPECT_EQ(dom.find("<title>owned"), std::string::npos);
  EXPECT_EQ(dom.find("<img"), dom.find("<img src=x onerror=\\\"")) << "an element was made of text";
  EXPECT_EQ(dom.find("<b id=\"injected\""), std::string::npos);
}

TEST_F(ReportInBrowser, NothingRunIsSaidSo) {
  const std::string dom = open({});
  expect_no_complaint(dom);
  EXPECT_GE(count(dom, "No model was compared."), 3u);
  EXPECT_NE(dom.find("No verification case was run."), std::string::npos);
}

/// A benchmark with two elements, and an order.
CaseResult verification_case() {
  CaseResult c;
  c.experiment.name = "plate";
  c.experiment.folder = "verification";
  c.experiment.exact = "trigonometric";
  c.experiment.body.geo = "block.geo";
  c.size = {1, 1, 1};
  c.cells = {{1, 1, 1}};
  c.experiment.materials = {{1e4, 0.25, 1000}};
  c.experiment.reference.elements = {"q2", "p1"};
  c.experiment.measures = {"stress", "displacement_error"};
  const std::vector<Cells> grids = {{4, 4, 4}, {8, 8, 8}, {16, 16, 16}};
  for (const char* element : {"q2", "p1"}) {
    c.references.push_back(
        {0.25, "stress.D.yy", "Pa", grids, {-5e6, -5.3e6, -5.37e6}, 2.1, -5.39e6, 1e4, "Richardson", element});
    c.references.push_back(
        {0.25, "displacement_error", "1", grids, {0.08, 0.01, 0.00125}, 3.0, 0.00125, 0, "", element});
    const RunKey key{std::string("fem_") + element, 0.25, grids[2]};
    c.rows.push_back({key, "plate", "linear", "stress.D.yy", -5.37e6, "Pa", -5.38e6, {}, 1e4});
  }
  c.checks.push_back(
      {"fem", 0.25, {1, 1, 1}, "stress.D.yy", "Pa", "published", -5.38e6, -5.39e6, 5.38e4, 1e4, Verdict::pass, "LE10"});
  const RunKey order{"fem_q2", 0.25, {1, 1, 1}};
  c.checks.push_back(
      {order, "displacement_error_order", "1", "analytic", 2.9, 3.0, 0, 0.0, Verdict::pass, "theory", true});
  c.pictures.push_back(sample_picture("fem", 0.25));
  return c;
}

TEST_F(ReportInBrowser, ShowsTheVerificationOfTheReference) {
  const std::string dom = open({sample_case(), verification_case()}, "#case-verification-plate");
  expect_no_complaint(dom);
  const auto start = dom.find("<section id=\"verification\">"), end = dom.find("<section id=\"pages\">");
  const std::string section = dom.substr(start, end - start);
  EXPECT_NE(section.find("stress at D, yy [Pa]"), std::string::npos);
  EXPECT_NE(section.find("+0.19 %"), std::string::npos) << "limit against target";
  EXPECT_NE(section.find("published, LE10"), std::string::npos);
  EXPECT_EQ(count(section, "<td title=\"P1 tetrahedra\">P1</td>"), 1u) << "its order, which nothing is expected of";
  EXPECT_NE(section.find("shown, not judged"), std::string::npos);
  EXPECT_NE(section.find("<b>3.00</b>"), std::string::npos);
  const std::string page = dom.substr(end);
  EXPECT_NE(page.find("≥ 2.9"), std::string::npos);
  const std::string cases = between(dom, "<section id=\"cases\"", "<section id=\"shapes\"");
  EXPECT_EQ(cases.find("case-verification-plate"), std::string::npos)
      << "a case without models is no row of the models' table";
}

TEST_F(ReportInBrowser, VerificationAloneIsAReport) {
  const std::string dom = open({verification_case()}, "#case-verification-plate");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("Orders of convergence"), std::string::npos);
  EXPECT_EQ(count(dom, "class=\"panel\""), 4u) << "the body at rest and deformed, among the shapes and on its page";
  for (const char* section : {"cases", "poisson", "convergence"})
    EXPECT_NE(dom.find(std::string("<section id=\"") + section + "\" hidden"), std::string::npos)
        << section << " has nothing to say";
  EXPECT_EQ(dom.find("<section id=\"shapes\" hidden"), std::string::npos);
}

TEST_F(ReportInBrowser, CaseWithoutResultsIsShown) {
  CaseResult c;
  c.experiment = sample_experiment();
  c.runs.push_back({{"hybmss", 0.25, {2, 2, 2}}, "msm", "linear", false, "singular", "CG", 0, 0, 0, 0});
  const std::string dom = open({c}, "#case-golec_2019-compress");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("1 without result"), std::string::npos);
  EXPECT_NE(dom.find("No run of this case gave a result."), std::string::npos);
}

}  // namespace
}  // namespace springproof::report_test
