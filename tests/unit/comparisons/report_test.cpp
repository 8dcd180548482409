#include "comparisons/report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "unit/comparisons/sample_case.h"

namespace springproof {
namespace {

using Json = nlohmann::json;

Json document(const std::vector<CaseResult>& cases) {
  Json out = {{"program", {{"name", "springproof"}, {"version", "0.1.0"}, {"libraries", "none"}}},
              {"generated", "2026-01-01T00:00:00Z"},
              {"host", {{"cores", 2}}},
              {"cases", Json::array()}};
  for (const auto& c : cases) out["cases"].push_back(to_json(c));
  return out;
}

Json pictures(const std::vector<CaseResult>& cases) {
  Json out = Json::array();
  for (const auto& c : cases) out.push_back(pictures_to_json(c));
  return out;
}

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

std::string slurp(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

/// Text between `from` and the next `to`.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto begin = text.find(from);
  if (begin == std::string::npos) return "";
  return text.substr(begin + from.size(), text.find(to, begin) - begin - from.size());
}

class Report : public testing::Test {
 protected:
  std::string write(const std::vector<CaseResult>& cases) {
    write_report(file, document(cases), pictures(cases));
    return slurp(file);
  }
  void TearDown() override { std::filesystem::remove(file); }
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) /
      ("springproof_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".html");
};

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
  const std::string markup =
      std::regex_replace(page.substr(0, page.find("<script")), std::regex("<style>[^]*?</style>"), "");
  EXPECT_EQ(markup.find("://"), std::string::npos) << "the markup names an address";
  EXPECT_EQ(count(page, "<script src"), 0u);
  EXPECT_EQ(between(page, "<style>", "</style>").find("url("), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos)
      << "the browser is not told to refuse the network";
}

/// The rows of a case as they are in results.json, from the page's table of them.
Json unpacked(Json rows) {
  Json out = Json::array();
  for (const Json& line : rows.at("values")) {
    Json row = {{"case_name", "compress"}};
    for (std::size_t i = 0; i < line.size(); ++i)
      row[rows.at("columns").at(i).get<std::string>()] = line.at(i);
    out.push_back(row);
  }
  return out;
}

TEST_F(Report, HoldsTheDocumentsAsTheyWere) {
  const std::vector<CaseResult> cases = {sample_case()};
  const std::string page = write(cases);
  Json held = Json::parse(between(page, "id=\"results-data\">", "</script>"));
  held["cases"][0]["rows"] = unpacked(held["cases"][0]["rows"]);
  EXPECT_EQ(held, document(cases));
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
  EXPECT_THROW(write_report("no_such_folder/report.html", document({}), Json::array()), std::runtime_error);
}

// ---- in a browser, where there is one

std::string output_of(const std::string& command) {
  std::string out;
  if (FILE* pipe = popen(command.c_str(), "r")) {
    char buffer[4096];
    while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
    pclose(pipe);
  }
  return out;
}

class ReportInBrowser : public Report {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium > /dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  }
  void TearDown() override {
    std::filesystem::remove_all(profile);
    Report::TearDown();
  }
  /// The page as the browser holds it after the scripts have run, and its console.
  std::string open(const std::vector<CaseResult>& cases, const std::string& fragment = "") {
    write(cases);
    return output_of(
        "timeout 120 chromium --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
        "--enable-unsafe-swiftshader --disable-quic --no-first-run --disable-background-networking "
        "--disable-component-update --disable-sync --enable-logging=stderr --virtual-time-budget=5000 "
        "--window-size=1400,6000 --user-data-dir='" +
        profile.string() + "' --dump-dom 'file://" + file.string() + fragment + "' 2>&1");
  }
  const std::filesystem::path profile = file.string() + ".profile";
};

void expect_no_complaint(const std::string& dom) {
  ASSERT_NE(dom.find("</html>"), std::string::npos) << dom.substr(0, 2000);
  EXPECT_EQ(dom.find("could not be drawn: "), dom.find("could not be drawn: ${"))
      << "a section was not drawn";
  EXPECT_EQ(dom.find(":CONSOLE"), std::string::npos) << dom.substr(dom.find(":CONSOLE"), 300);
}

TEST_F(ReportInBrowser, ShowsTheCase) {
  const std::string dom = open({sample_case()}, "#case-golec_2019-compress");
  expect_no_complaint(dom);
  const std::string body = dom.substr(dom.find("<main>"), dom.find("</main>") - dom.find("<main>"));
  EXPECT_EQ(count(body, "<canvas"), 4u) << "three figures and the deformed shapes";
  EXPECT_EQ(count(body, "class=\"panel\""), 2u) << "FEM and hybmss";
  EXPECT_NE(body.find("<td class=\"number tint2\">2.0 %<small>ν = 0.4</small>"), std::string::npos)
      << "table of cases";
  EXPECT_NE(body.find("z_max: moved by -0.05 m in z"), std::string::npos) << "problem";
  EXPECT_NE(body.find("<td class=\"number\">2.60</td>"), std::string::npos)
      << "observed order of the reference";
  EXPECT_NE(body.find("<td class=\"number\">≤ 1 %</td>"), std::string::npos) << "expectation";
  EXPECT_NE(body.find("force on z_min, magnitude [N]"), std::string::npos) << "results";
  EXPECT_NE(body.find("Measures that vanish here or repeat another in size: 5"), std::string::npos)
      << "both x components, z of z_min, magnitude and z of z_max";
  EXPECT_NE(body.find("510.00<small>+2.0 %</small>"), std::string::npos) << "value and its error";
  EXPECT_NE(body.find("explicit run, not settled"), std::string::npos) << "published value";
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
  c.experiment.body.size = {1, 1, 1};
  c.experiment.body.cells = {{1, 1, 1}};
  c.experiment.materials = {{1e4, 0.25, 1000}};
  c.experiment.reference.elements = {"q2", "p1"};
  c.experiment.measures = {"stress", "displacement_error"};
  const std::vector<Cells> grids = {{4, 4, 4}, {8, 8, 8}, {16, 16, 16}};
  for (const char* element : {"q2", "p1"}) {
    c.references.push_back({0.25, "stress.D.yy", "Pa", grids, {-5e6, -5.3e6, -5.37e6}, 2.1, -5.39e6, 1e4, "Richardson", element});
    c.references.push_back({0.25, "displacement_error", "1", grids, {0.08, 0.01, 0.00125}, 3.0, 0.00125, 0, "", element});
    c.rows.push_back({"plate", "linear", std::string("fem_") + element, 0.25, grids[2], "stress.D.yy", -5.37e6, "Pa", -5.38e6, {}, 1e4});
  }
  c.checks.push_back({"fem", 0.25, {1, 1, 1}, "stress.D.yy", "Pa", "published", -5.38e6, -5.39e6, 5.38e4, 1e4, Verdict::pass, "LE10"});
  c.checks.push_back({"fem_q2", 0.25, {1, 1, 1}, "displacement_error_order", "1", "analytic", 2.9, 3.0, 0, 0.0, Verdict::pass, "theory", true});
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
  const std::string cases = dom.substr(dom.find("<section id=\"cases\">"), dom.find("<section id=\"poisson\">") - dom.find("<section id=\"cases\">"));
  EXPECT_EQ(cases.find("case-verification-plate"), std::string::npos) << "a case without models is no row of the models' table";
}

TEST_F(ReportInBrowser, VerificationAloneIsAReport) {
  const std::string dom = open({verification_case()}, "#case-verification-plate");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("Orders of convergence"), std::string::npos);
  EXPECT_EQ(count(dom, "class=\"panel\""), 1u) << "the body";
  for (const char* section : {"cases", "poisson", "convergence"})
    EXPECT_NE(dom.find(std::string("<section id=\"") + section + "\" hidden"), std::string::npos) << section << " has nothing to say";
  EXPECT_EQ(dom.find("<section id=\"shapes\" hidden"), std::string::npos);
}

TEST_F(ReportInBrowser, CaseWithoutResultsIsShown) {
  CaseResult c;
  c.experiment = sample_experiment();
  c.runs.push_back({"hybmss", "msm", 0.25, {2, 2, 2}, "linear", false, "singular", "CG", 0, 0, 0, 0});
  const std::string dom = open({c}, "#case-golec_2019-compress");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("1 without result"), std::string::npos);
  EXPECT_NE(dom.find("No run of this case gave a result."), std::string::npos);
}

}  // namespace
}  // namespace springproof
