#include "comparisons/report/report.h"

#include <algorithm>
#include <set>

#include "comparisons/report/png_page.h"
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

TEST_F(ReportInBrowser, ShowsTheCase) {
  const std::string dom = open({sample_case()}, "#case-golec_2019-compress");
  expect_no_complaint(dom);
  const std::string body = dom.substr(dom.find("<main>"), dom.find("</main>") - dom.find("<main>"));
  EXPECT_EQ(count(body, "<canvas"), 5u) << "three figures, the deformed shapes, the picture of the case";
  EXPECT_EQ(count(body, "class=\"panel\""), 6u) << "undeformed, FEM and hybmss; problem, FEM and hybmss";
  EXPECT_NE(body.find("<td class=\"number tint2\">2.0 %<small>ν = 0.4</small>"), std::string::npos) << "table of cases";
  EXPECT_NE(body.find("z_max: moved by -0.05 m in z"), std::string::npos) << "problem";
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
    c.runs.push_back({{"hybmss", 0.25, {n, n, n}},
                      "msm",
                      "linear",
                      true,
                      "",
                      "CG",
                      9,
                      1e-9,
                      0.0008 * tenfold,
                      long(100 * tenfold),
                      1,
                      0.0002 * tenfold});
    c.runs.push_back({{"fem_q2", 0.25, {n, n, n}},
                      "fem",
                      "linear",
                      true,
                      "",
                      "CG",
                      9,
                      1e-9,
                      0.008 * tenfold,
                      long(1000 * tenfold),
                      1,
                      0.002 * tenfold});
    for (const auto& [model, error] : {std::pair("hybmss", 0.2), std::pair("fem_q2", 0.05)})
      c.rows.push_back({{model, 0.25, {n, n, n}},
                        "compress",
                        "linear",
                        "displacement_error",
                        error / tenfold,
                        "1",
                        {},
                        0.001,
                        error / tenfold});
  }
  return c;
}

TEST_F(ReportInBrowser, SetsErrorsAgainstCost) {
  const std::string dom = open({timed_case()});
  expect_no_complaint(dom);
  const std::string part = dom.substr(dom.find("<section id=\"cost\">"),
                                      dom.find("<section id=\"splits\"") - dom.find("<section id=\"cost\">"));
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
  const std::string part = dom.substr(dom.find("<section id=\"cost\">"),
                                      dom.find("<section id=\"splits\"") - dom.find("<section id=\"cost\">"));
  EXPECT_NE(part.find("<small>displacement</small>"), std::string::npos);
  EXPECT_NE(part.find("<small>reactions</small></td><td>0.25</td><td>–</td>"), std::string::npos)
      << "20 % and 40 %: none to 10 %";
  const std::string table = dom.substr(dom.find("<section id=\"cases\">"),
                                       dom.find("<section id=\"shapes\"") - dom.find("<section id=\"cases\">"));
  EXPECT_NE(table.find("<small>reactions 40 %</small>"), std::string::npos);
}

TEST_F(ReportInBrowser, NamesNoModelOffItsOwnPoissonsRatioAsCheapest) {
  CaseResult c = timed_case();
  c.own_poisson_ratios["hybmss"] = 0.3;
  const std::string dom = open({c});
  expect_no_complaint(dom);
  const std::string part = dom.substr(dom.find("<section id=\"cost\">"),
                                      dom.find("<section id=\"splits\"") - dom.find("<section id=\"cost\">"));
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

/// The sample with a smooth surface, tetrahedra, and the parts of its errors.
CaseResult embedded_case() {
  CaseResult c = sample_case();
  for (const char* model : {"fem", "hybmss"}) {
    Picture p = sample_picture(model, 0.4);
    p.surface = "smooth";
    p.displacement = {0, 0, 0, 0.1f, 0, 0, 0.1f, 0.05f, 0, 0, 0, 0.02f};  // many colours
    p.quads = {0, 1, 2, -1, 0, 2, 3, -1};
    c.pictures.push_back(p);
  }
  c.rows.push_back(
      {{"fem_p1", 0.4, {812, 0, 0}}, "compress", "linear", "displacement_error", 0.01, "1", {}, 0.001, 0.01});
  return c;
}

Json some_splits() {
  Json splits = Json::array();
  for (double nu : {0.25, 0.4})
    for (int n : {1, 2})
      splits.push_back({{"model", "hybmss"},
                        {"poisson_ratio", nu},
                        {"cells", {n, n, n}},
                        {"measure", "volume_change"},
                        {"unit", "1"},
                        {"total", 0.03 / n},
                        {"model_error", -0.01 / n},
                        {"discretisation_error", 0.025 / n},
                        {"geometry_error", 0.015 / n},
                        {"uncertainty", 0.001},
                        {"voxel_edge_m", 1.0 / n}});
  return splits;
}

class FiguresInBrowser : public ReportInBrowser {
 protected:
  /// The page of embedded_case() with the parts of its errors and a script that runs after its own.
  std::string open_with(const std::string& script, const std::string& fragment = "",
                        const std::string& options = whole_page) {
    Json results = document({embedded_case()});
    results["cases"][0]["splits"] = some_splits();
    return ReportInBrowser::open_with(results, pictures({embedded_case()}), script, fragment, options);
  }
};

TEST_F(FiguresInBrowser, EveryFigureIsDrawn) {
  const std::string dom = open_with(tools + R"js(
    const canvases = () => [...document.querySelectorAll('section canvas')].filter(canvas => !canvas.closest('[hidden]'));
    until(() => canvases().length > 4 && canvases().every(drawn), () => {
      for (const canvas of canvases()) say(canvas.closest('section').id + (drawn(canvas) ? ' drawn' : ' blank'));
      endLoading();
    });
  )js");
  expect_no_complaint(dom);
  EXPECT_EQ(count(dom, "<p class=\"said\">poisson drawn"), 2u);
  EXPECT_EQ(count(dom, "<p class=\"said\">convergence drawn"), 1u);
  EXPECT_EQ(count(dom, "<p class=\"said\">splits drawn"), 1u) << "of all models at one nu";
  EXPECT_EQ(count(dom, "<p class=\"said\">shapes drawn"), 1u);
  EXPECT_EQ(count(dom, " blank</p>"), 0u);
  EXPECT_EQ(count(dom, "<button type=\"button\" class=\"png\""), 6u) << "one per figure";
  EXPECT_NE(dom.find("<option value=\"812 tets\">812 tets</option>"), std::string::npos);
  EXPECT_NE(dom.find("the springs against finite elements (eight-node bricks) on the same voxels"), std::string::npos);
  EXPECT_NE(dom.find("<b>1.5000</b>"), std::string::npos) << "total of the finer cells in percent, in the table";
}

TEST_F(FiguresInBrowser, FirstScreenShowsTwoBodiesAndADotPerModelAndCase) {
  const std::string dom = open_with(tools + R"js(
    const canvas = () => document.querySelector('#first-bodies canvas');
    until(() => canvas() && drawn(canvas()), () => {
      say('bodies ' + (drawn(canvas()) ? 'drawn' : 'blank') + ' in ' + document.querySelectorAll('#first-bodies .panel').length);
      const dots = () => [...document.querySelectorAll('.dot:not(.pale)')].map(dot => dot.title).join('; ');
      const slider = document.querySelector('#first-plot input[type=range]');
      say('worst: ' + dots());
      slider.value = 1;
      slider.dispatchEvent(new Event('input'));
      say('first: ' + dots());
      say('facts: ' + document.querySelector('#first-facts').textContent);
      endLoading();
    });
  )js",
                                    "", one_screen);
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("bodies drawn in 2"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("worst: hybmss, compress: 2.0 % at ν = 0.4; fem_p1, compress: 1.0 % at ν = 0.4<"),
            std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("first: hybmss, compress: 0.50 % at ν = 0.25"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("facts: Displacement of hybmsscompress"), std::string::npos) << said(dom);
}

TEST_F(FiguresInBrowser, ACasePageStartsWithTheBodyItsSupportsAndLoads) {
  const std::string dom = open_with(tools + R"js(
    const page = document.querySelector('details.case');
    page.open = true;
    page.fill();
    const picture = page.querySelector('.case-body').firstElementChild, viewer = picture.querySelector('.viewer');
    page.scrollIntoView({behavior: 'instant'});
    const canvas = () => viewer.querySelector('canvas');
    until(() => canvas() && drawn(canvas()), () => {
      say('panels ' + [...viewer.querySelectorAll('.panel-label')].map(label => label.textContent).join(' | '));
      say('then ' + picture.nextElementSibling.textContent.slice(0, 120));
      say('text ' + canvas().getAttribute('aria-label'));
      const before = pixelsOf(canvas()).join(), turned = () => pixelsOf(canvas()).join() !== before;
      viewer.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
      until(turned, () => { say(turned() ? 'turned' : 'still'); endLoading(); });
    });
  )js",
                                    "", one_screen);
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("panels The problemheldmoved | FEM reference"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("then fail 1 of 2 hold. Largest displacement errors: hybmss 2.0 %"), std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("text compress: z_min: held; z_max: moved by -0.05 m in z, held in x and y."), std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("<p class=\"said\">turned"), std::string::npos) << "by an arrow key" << said(dom);
}

TEST_F(FiguresInBrowser, OfASinglePoissonsRatioThereAreBarsInOrder) {
  const std::string dom = open_with(tools + R"js(
    const only = cases[0];
    const drawing = poissonDrawing([{...only, rows: only.rows.filter(row => row.poisson_ratio === 0.4)}], 'displacement_error', 'finest', true);
    const chart = drawing.make();
    say('chart ' + chart.type + ': ' + chart.data.datasets[0].data.map(bar => `${bar.model} ${bar.error.toPrecision(2)}`).join(', '));
    endLoading();
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("chart bar: fem_p1 1.0, hybmss 2.0<"), std::string::npos) << said(dom);
}

TEST_F(FiguresInBrowser, OneDragTurnsAllBodies) {
  const std::string dom = open_with(tools + R"js(
    const viewer = document.querySelector('#shapes .viewer'), canvas = viewer.querySelector('canvas');
    viewer.scrollIntoView({behavior: 'instant', block: 'center'});
    const panels = () => [...viewer.querySelectorAll('.panel')].map(panel => {
      const all = viewer.getBoundingClientRect(), box = panel.getBoundingClientRect(), scale = canvas.width / all.width;
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [box.width * scale, (box.height - 46) * scale];
      const ctx = copy.getContext('2d');
      ctx.drawImage(canvas, -(box.left - all.left) * scale, -(box.top + 46 - all.top) * scale);
      return ctx.getImageData(0, 0, copy.width, copy.height).data.join();
    });
    const mouse = (target, type, x) => target.dispatchEvent(new MouseEvent(type, {bubbles: true, button: 0, clientX: x, clientY: 300}));
    until(() => drawn(canvas), () => {
      const before = panels(), turned = () => panels().map((now, i) => now !== before[i]);
      mouse(viewer, 'mousedown', 300);
      mouse(document, 'mousemove', 380);
      mouse(document, 'mouseup', 380);
      until(() => turned().every(Boolean), () => {
        for (const panel of turned()) say('panel ' + (panel ? 'turned' : 'still'));
        endLoading();
      });
    });
  )js",
                                    "", one_screen);
  expect_no_complaint(dom);
  EXPECT_EQ(count(dom, "<p class=\"said\">panel turned"), 3u);
  EXPECT_EQ(count(dom, "<p class=\"said\">panel still"), 0u);
}

TEST_F(FiguresInBrowser, PicturesShowEverySurfaceAndColouring) {
  const PngPage page = png_page(open_with("", "#png=0&only=shapes"));
  EXPECT_EQ(page.failed, std::vector<std::string>());
  std::set<std::string> names;
  for (const PngFile& f : page.files) {
    names.insert(f.name);
    EXPECT_GT(f.bytes.size(), 10'000u) << f.name;
  }
  std::set<std::string> expected;
  for (const char* view : {"nu0.25", "nu0.4", "smooth-nu0.4"})
    for (const char* colouring : {"displacement", "difference", "volume_change"})
      expected.insert(std::string("golec_2019-compress-shapes-") + colouring + "-" + view + ".png");
  EXPECT_EQ(names, expected);
}

TEST_F(FiguresInBrowser, PicturesShowThePartsOfTheErrors) {
  const PngPage page = png_page(open_with("", "#png=0&only=split"));
  EXPECT_EQ(page.failed, std::vector<std::string>());
  std::set<std::string> names;
  for (const PngFile& f : page.files) names.insert(f.name);
  const std::string stem = "golec_2019-compress-split-";
  EXPECT_EQ(names,
            (std::set<std::string>{stem + "volume_change-hybmss.png", stem + "volume_change-nu0.25.png",
                                   stem + "volume_change-nu0.4.png", stem + "edge-volume_change-hybmss-nu0.25.png",
                                   stem + "edge-volume_change-hybmss-nu0.4.png"}));
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
    c.rows.push_back({{std::string("fem_") + element, 0.25, grids[2]},
                      "plate",
                      "linear",
                      "stress.D.yy",
                      -5.37e6,
                      "Pa",
                      -5.38e6,
                      {},
                      1e4});
  }
  c.checks.push_back(
      {"fem", 0.25, {1, 1, 1}, "stress.D.yy", "Pa", "published", -5.38e6, -5.39e6, 5.38e4, 1e4, Verdict::pass, "LE10"});
  c.checks.push_back({"fem_q2",
                      0.25,
                      {1, 1, 1},
                      "displacement_error_order",
                      "1",
                      "analytic",
                      2.9,
                      3.0,
                      0,
                      0.0,
                      Verdict::pass,
                      "theory",
                      true});
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
  const std::string cases = dom.substr(dom.find("<section id=\"cases\">"),
                                       dom.find("<section id=\"shapes\"") - dom.find("<section id=\"cases\">"));
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
